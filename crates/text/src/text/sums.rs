//! What is integrated and counted along the motion of a text.

use capsulemap_engine::flow::guard::Crossings;
use capsulemap_engine::flow::{Observer, Step};
use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::{Lane, Mask, ORDER, Series, SideBySide, series};

use crate::text::content::Measured;
use crate::text::event_names::event_symbol;
use crate::text::interpreter::{carry_out, series_of, slides};
use crate::text::mode::TextEvent;
use crate::text::oscillator::Oscillator;
use crate::text::program::Program;

/// The place of the time that was seen.
const TIME: usize = 0;
/// The place of how far the state that drifts has come.
const ADVANCE: usize = 1;
/// The place of what the last sum of that rounded away.
const ROUNDED_AWAY: usize = 2;
/// The place of the first other sum: of each friction its time at rest, then of each event how often it happened, then what is
/// measured of values.
const OTHERS: usize = 3;

/// Sums over the steps of a motion, in each lane.
///
/// Assumes: the steps follow each other without a gap; in lanes of which one has ended its stretch, the others' sums alone are to be
/// read.
#[derive(Debug, Clone, PartialEq)]
pub struct Sums<L>(Vec<L>);

impl Sums<f64> {
    /// Nothing seen yet of the motion of a program.
    pub fn none(program: &Program) -> Self {
        let others = program.frictions.len() + program.events.len();
        let mut sums = vec![0.0; OTHERS + others];
        sums.extend(program.text.measured.iter().map(|it| match it {
            Measured::Largest(_) => f64::NEG_INFINITY,
            Measured::Least(_) => f64::INFINITY,
            _ => 0.0,
        }));
        Sums(sums)
    }

    /// Time that was seen.
    pub fn time(&self) -> f64 {
        self.0[TIME]
    }

    /// How far the state that drifts has come.
    pub fn advance(&self) -> f64 {
        self.0[ADVANCE]
    }

    /// Of each friction of a program its time at rest.
    pub fn rest(&self, program: &Program) -> &[f64] {
        &self.0[OTHERS..OTHERS + program.frictions.len()]
    }

    /// How often each event of a program happened.
    pub fn events(&self, program: &Program) -> &[f64] {
        let first = OTHERS + program.frictions.len();
        &self.0[first..first + program.events.len()]
    }

    /// What was measured of values, in the order of the text, as it stands for so many cycles.
    pub fn measured(&self, program: &Program, cycles: f64) -> Vec<f64> {
        let first = OTHERS + program.frictions.len() + program.events.len();
        let values = program.text.measured.iter().zip(&self.0[first..]);
        let measured = values.map(|(it, value)| match it {
            Measured::Integral(_) => value / cycles,
            Measured::Mean(_) => value / self.time(),
            Measured::Largest(_) | Measured::Least(_) => *value,
            Measured::Count(name) => {
                let counts = program.events.iter().zip(self.events(program));
                let named = counts.filter(|it| event_symbol(&program.text, *it.0) == *name);
                named.map(|it| it.1).sum::<f64>() / cycles
            }
        });
        measured.collect()
    }
}

in_lanes! {
    impl<L: Lane> SideBySide for Sums<L> {
        type One = Sums<f64>;

        fn splat(one: &Sums<f64>) -> Self {
            Sums(one.0.iter().map(|it| L::splat(*it)).collect())
        }
        fn lane(&self, index: usize) -> Sums<f64> {
            Sums(self.0.iter().map(|it| it.lane(index)).collect())
        }
        fn put(&mut self, index: usize, one: &Sums<f64>) {
            for (own, one) in self.0.iter_mut().zip(&one.0) {
                *own = own.with_lane(index, *one);
            }
        }
        fn take_lane(&mut self, index: usize, other: &Self) {
            for (own, other) in self.0.iter_mut().zip(&other.0) {
                *own = own.with_lane_of(index, *other);
            }
        }
    }

    impl<L: Lane> Sums<L> {
        /// Adds how far the state that drifts comes in a step, by Kahan's compensated sum.
        fn add_advance(&mut self, part: L, passes: L::Mask) {
            let part = part - self.0[ROUNDED_AWAY];
            let sum = self.0[ADVANCE] + part;
            let rounded_away = (sum - self.0[ADVANCE]) - part;
            // A lane whose step has no length keeps its bits.
            self.0[ROUNDED_AWAY] = L::select(passes, rounded_away, self.0[ROUNDED_AWAY]);
            self.0[ADVANCE] = L::select(passes, sum, self.0[ADVANCE]);
        }
    }

    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool>
        Observer<L, Oscillator<L, D, N, AUTONOMOUS>> for Sums<L>
    {
        fn see(
            &mut self,
            system: &Oscillator<L, D, N, AUTONOMOUS>,
            step: &Step<L, Oscillator<L, D, N, AUTONOMOUS>>,
        ) {
            let (zero, h) = (L::splat(0.0), step.length);
            self.0[TIME] = self.0[TIME] + h;
            if let Some(drift) = system.program.text.drift {
                let part = series::change(&step.jet.registers[drift], h);
                self.add_advance(part, zero.lt(h));
            }
            let mut place = OTHERS;
            for friction in 0..system.program.frictions.len() {
                let rests = L::select(slides(&step.mode, friction), zero, h);
                self.0[place] = self.0[place] + rests;
                place += 1;
            }
            let of_values = place + system.program.events.len();
            if !system.program.observed.is_empty() {
                self.see_values(system, step, of_values);
            }
            if !L::splat(0.5).lt(step.event).any() {
                return;
            }
            for event in &system.program.events {
                let happens = is(*event, step.event);
                self.0[place] = self.0[place] + L::select(happens, L::splat(1.0), zero);
                place += 1;
            }
        }
    }

    impl<L: Lane> Sums<L> {
        /// Adds what is measured of values, from a place on.
        fn see_values<const D: usize, const N: usize, const AUTONOMOUS: bool>(
            &mut self,
            system: &Oscillator<L, D, N, AUTONOMOUS>,
            step: &Step<L, Oscillator<L, D, N, AUTONOMOUS>>,
            first: usize,
        ) {
            let (program, jet, h) = (system.program, &step.jet, step.length);
            let mut registers = jet.registers.clone();
            let mut row = vec![L::splat(0.0); program.registers];
            let time = step.start + system.later;
            for k in 0..ORDER + 1 {
                for register in &program.observed_from {
                    row[*register] = jet.registers[*register][k];
                }
                for it in &program.of_observed {
                    let places = (&mut row[..], &mut registers[..]);
                    carry_out(it, &jet.numbers, (&step.mode, time), places, k);
                }
            }
            let passes = L::splat(0.0).lt(h);
            let mut room = [L::ZERO; ORDER + 1];
            for (place, observed) in program.observed.iter().enumerate() {
                let Some(observed) = observed else { continue };
                let series = series_of(*observed, &jet.numbers, &registers, &mut room);
                let own = self.0[first + place];
                let seen = match program.text.measured[place] {
                    Measured::Largest(_) => own.max(extreme(series, h, 1.0)),
                    Measured::Least(_) => own.min(extreme(series, h, -1.0)),
                    _ => own + series::integral(series, h),
                };
                self.0[first + place] = L::select(passes, seen, own);
            }
        }
    }

    /// The largest value of a series in a step, or with the sign -1 the least.
    fn extreme<L: Lane>(series: &Series<L>, h: L, sign: f64) -> L {
        let sign = L::splat(sign);
        let mut largest = (sign * series[0]).max(sign * series::value(series, h));
        let all = L::Mask::splat(true);
        let slope = series::plain(&series::derivative(series));
        let mut turns = Crossings::new(&slope, h.plain(), all);
        loop {
            let turn = turns.next(all);
            if !turn.found.any() {
                break;
            }
            let there = sign * series::value(series, L::from_plain(turn.time));
            largest = L::select(turn.found, largest.max(there), largest);
        }
        sign * largest
    }

    /// Where the event of a code is this.
    fn is<L: Lane>(event: TextEvent, code: L) -> L::Mask {
        use capsulemap_engine::flow::Event;
        (code - event.code()).abs().lt(L::splat(0.5))
    }
}
