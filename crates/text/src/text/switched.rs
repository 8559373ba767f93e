//! How the oscillator of a text moves: its series, its guards, its section.

use capsulemap_engine::flow::{MAX_GUARDS, Stroboscopic, Switched, Zeros, longest_step};
use capsulemap_engine::in_lanes;
use capsulemap_engine::lane::elementary::not_finite;
use capsulemap_engine::lane::{Lane, Mask, ORDER, Series, series};

use crate::text::content::Section;
use crate::text::due::Due;
use crate::text::instructions::{Guard, Place, Unseen};
use crate::text::interpreter::{carry_out, complete, series_of, slides};
use crate::text::jet::TextJet;
use crate::text::mode::{TextEvent, TextMode, is_on};
use crate::text::oscillator::Oscillator;

/// An exponential whose argument is below this is less than the rounding of one.
const UNSEEN: f64 = -36.0;
/// By so much the argument may change even where it is hardly below.
const NEARLY: f64 = 4.0;
/// A step is halved so often at most.
const HALVINGS: usize = 60;

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool>
        Oscillator<L, D, N, AUTONOMOUS>
    {
        /// Writes the series of a value.
        fn write(&self, place: Place, jet: &TextJet<L>, guard: &mut Series<L>) {
            let mut room = [L::ZERO; ORDER + 1];
            *guard = *series_of(place, &jet.numbers, &jet.registers, &mut room);
        }

        /// Writes what presses on the contact of an event, where it lasts.
        fn write_pressing(
            &self,
            event: usize,
            mode: &TextMode<L>,
            jet: &TextJet<L>,
            guard: &mut Series<L>,
        ) {
            let Some(it) = self.program.lasting[event] else { return };
            let (holds, loose) = (is_on(mode.contacts[event]), is_on(mode.loose[event]));
            let mut room = [L::ZERO; ORDER + 1];
            let acceleration = series_of(it.acceleration, &jet.numbers, &jet.registers, &mut room);
            let towards = L::Plain::splat(it.towards);
            for (k, own) in guard.iter_mut().enumerate() {
                let falls = L::splat(if k == 1 { -1.0 } else { 0.0 });
                let pressing = L::select(loose, falls, acceleration[k].scaled(towards));
                *own = L::select(holds, pressing, *own);
            }
        }

        /// Writes the guard of a friction: what it is of while it slides, else what it holds on a side.
        fn write_friction(
            &self,
            (friction, side): (usize, f64),
            mode: &TextMode<L>,
            jet: &TextJet<L>,
            guard: &mut Series<L>,
        ) {
            let it = &self.program.frictions[friction];
            let (side, sliding) = (L::Plain::splat(side), slides(mode, friction));
            let sign = mode.signs[friction];
            let mut rooms = [[L::ZERO; ORDER + 1]; 3];
            let [first, second, third] = &mut rooms;
            let of = series_of(it.of, &jet.numbers, &jet.registers, first);
            let holds = series_of(it.holds, &jet.numbers, &jet.registers, second);
            let at_rest = series_of(it.at_rest, &jet.numbers, &jet.registers, third);
            for (k, own) in guard.iter_mut().enumerate() {
                let left = holds[k] - at_rest[k].scaled(side);
                *own = L::select(sliding, of[k].scaled(sign), left);
            }
            // What is thrown out of rest leaves at once, at the time of the jump.
            let thrown = (mode.thrown[friction] - side).abs().lt(L::Plain::splat(0.5));
            if thrown.any() {
                for (k, own) in guard.iter_mut().enumerate() {
                    let falls = L::splat(if k == 1 { -1.0 } else { 0.0 });
                    *own = L::select(thrown, falls, *own);
                }
            }
        }
    }
}

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool> Switched<L>
        for Oscillator<L, D, N, AUTONOMOUS>
    {
        type State = [L; N];
        type Mode = TextMode<L>;
        type Jet = TextJet<L>;
        type Event = TextEvent;

        const GUARDS: usize = if AUTONOMOUS { MAX_GUARDS - 1 } else { MAX_GUARDS };
        const AUTONOMOUS: bool = AUTONOMOUS;
        // A contact that lasts opens with the third derivative of the distance.
        const MOST_ZEROS: usize = 3;

        fn period(&self) -> L {
            self.numbers[self.program.period]
        }

        fn start(&self, time: L, state: &mut [L; N]) -> TextMode<L> {
            self.mode_at(time, state)
        }

        fn begin_cycle(&self, mask: L::Mask, mode: &mut TextMode<L>, _: &mut [L; N]) {
            for passed in &mut mode.passed {
                *passed = L::Plain::select(mask, L::Plain::splat(0.0), *passed);
            }
        }

        fn expand(&self, mode: &TextMode<L>, time: L, state: &[L; N], jet: &mut TextJet<L>) {
            let program = self.program;
            let TextJet { registers, numbers, row, until_edge } = jet;
            if registers.is_empty() {
                registers.resize(program.registers, series::zero());
                row.resize(program.registers, L::splat(0.0));
            }
            numbers.clear();
            numbers.extend_from_slice(&self.numbers);
            complete(program, mode, &self.pulses(mode), numbers);
            *until_edge = self.next_of_all(mode) - time;
            for (place, at) in program.layout.iter().enumerate() {
                (row[place], registers[place][0]) = (state[*at], state[*at]);
            }
            for k in 0..ORDER + 1 {
                for step in &program.series {
                    carry_out(step, numbers, (mode, time + self.later), (row, registers), k);
                }
                if k == ORDER {
                    break;
                }
                let per = L::Plain::splat(series::INVERSE[k + 1]);
                for (place, rate) in program.rates.iter().enumerate() {
                    registers[place][k + 1] = match *rate {
                        Place::Series(it) => row[it].scaled(per),
                        Place::Scalar(it) if k == 0 => numbers[it].scaled(per),
                        Place::Scalar(_) => L::splat(0.0),
                    };
                }
                for (place, it) in program.frictions.iter().enumerate() {
                    // What a friction that rests is of does not move: rounding would not keep it so.
                    let mut others = L::splat(0.0);
                    for (state, factor) in &it.others {
                        others = others + numbers[*factor] * registers[*state][k + 1];
                    }
                    let (leading, factor) = it.leading;
                    let own = registers[leading][k + 1];
                    let rests = !slides(mode, place);
                    registers[leading][k + 1] = L::select(rests, -(others / numbers[factor]), own);
                }
                for (place, it) in program.lasting.iter().enumerate() {
                    let Some(it) = it else { continue };
                    let holds = is_on(mode.contacts[place]);
                    for held in [it.state, it.velocity] {
                        let own = registers[held][k + 1];
                        registers[held][k + 1] = L::select(holds, L::splat(0.0), own);
                    }
                }
                for place in 0..program.rates.len() {
                    row[place] = registers[place][k + 1];
                }
            }
        }

        fn pace<'a>(&self, jet: &'a TextJet<L>) -> [&'a Series<L>; 2] {
            [&jet.registers[0], &jet.registers[0]]
        }

        fn longest_step(&self, jet: &TextJet<L>, tolerance: f64) -> L::Plain {
            let mut longest = L::Plain::splat(f64::INFINITY);
            for register in &self.program.paced {
                longest = longest.min(longest_step(&jet.registers[*register], tolerance));
            }
            longest
        }

        /// An exponential that is too small to be seen has no coefficients by which its growth could be foretold: while its argument is
        /// far below zero, the step ends where it may come near.
        fn step_bound(
            &self,
            _: &TextMode<L>,
            jet: &TextJet<L>,
            length: L::Plain,
            _: f64,
        ) -> L::Plain {
            let mut bounded = length;
            for (argument, unseen) in &self.program.arguments {
                bounded = before_it_is_seen(&jet.registers[*argument], *unseen, bounded);
            }
            bounded
        }

        fn watched(&self, which: usize, mode: &TextMode<L>) -> L::Mask {
            match self.program.guards.get(which) {
                None => L::Mask::splat(false),
                Some(Guard::Backward(friction)) => !slides(mode, *friction),
                Some(Guard::Edge) => self.next_of_all(mode).lt(L::splat(f64::INFINITY)),
                _ => L::Mask::splat(true),
            }
        }

        fn guard(
            &self,
            which: usize,
            mode: &TextMode<L>,
            jet: &TextJet<L>,
            guard: &mut Series<L>,
        ) {
            let Some(which) = self.program.guards.get(which) else {
                // A guard that the text does not have is not watched.
                *guard = series::zero();
                return;
            };
            match *which {
                Guard::Event(event) => {
                    self.write(self.program.lasts[event], jet, guard);
                    self.write_pressing(event, mode, jet, guard);
                }
                Guard::Switch(switch) => {
                    self.write(self.program.sides[switch], jet, guard);
                    let on = L::Plain::splat(0.5).lt(mode.switches[switch]);
                    for term in guard.iter_mut() {
                        *term = L::select(on, *term, -*term);
                    }
                }
                Guard::Forward(friction) => self.write_friction((friction, 1.0), mode, jet, guard),
                Guard::Backward(friction) => self.write_friction((friction, -1.0), mode, jet, guard),
                Guard::Edge => {
                    *guard = series::zero();
                    (guard[0], guard[1]) = (jet.until_edge, L::splat(-1.0));
                }
            }
        }

        fn at(&self, jet: &TextJet<L>, h: L) -> [L; N] {
            let mut state = [L::ZERO; N];
            for (place, at) in self.program.layout.iter().enumerate() {
                state[*at] = series::value(&jet.registers[place], h);
            }
            state
        }

        fn motion(&self, jet: &TextJet<L>, h: L) -> ([L; N], [L; N]) {
            let (mut state, mut slope) = ([L::ZERO; N], [L::ZERO; N]);
            for (place, at) in self.program.layout.iter().enumerate() {
                (state[*at], slope[*at]) = series::value_and_slope(&jet.registers[place], h);
            }
            (state, slope)
        }

        fn switch(
            &self,
            which: usize,
            due: L::Mask,
            mode: &mut TextMode<L>,
            state: &mut [L; N],
            zeros: &mut Zeros<L>,
            time: L,
        ) -> L {
            let (opens, came) = (L::Mask::splat(false), L::splat(0.0));
            self.obey(Due { which, here: due, mode, state, zeros, time, opens, came })
        }

        fn lost(&self, state: &[L; N]) -> L::Mask {
            let mut sum = L::splat(0.0);
            for value in state {
                sum = sum + *value;
            }
            not_finite(sum)
        }

        fn section(&self, jet: &TextJet<L>, section: &mut Series<L>) {
            let Section::When { state, falls, .. } = self.program.text.section else { return };
            *section = jet.registers[state];
            if !falls {
                for term in section.iter_mut() {
                    *term = -*term;
                }
            }
        }

        fn touching<'a>(&self, jet: &'a TextJet<L>) -> Option<(&'a Series<L>, [L; 2])> {
            let (state, [first, second]) = self.program.touching?;
            Some((&jet.registers[state], [self.numbers[first], self.numbers[second]]))
        }
    }
}

in_lanes! {
    impl<L: Lane, const D: usize, const N: usize, const AUTONOMOUS: bool> Stroboscopic<L, D>
        for Oscillator<L, D, N, AUTONOMOUS>
    {
        fn point(state: &[L; N]) -> [L; D] {
            let mut point = [L::ZERO; D];
            for (own, value) in point.iter_mut().zip(state) {
                *own = *value;
            }
            point
        }

        fn state(point: [L; D]) -> [L; N] {
            Self::moved_to([L::ZERO; N], point)
        }

        fn moved_to(from: [L; N], point: [L; D]) -> [L; N] {
            let mut state = from;
            for (own, value) in state.iter_mut().zip(&point) {
                *own = *value;
            }
            state
        }
    }
}

in_lanes! {
    /// The part of a step in which an exponential stays too small to be seen; all of it where it can be seen from the start.
    ///
    /// Method: the argument changes by no more than the sum of the magnitudes of its terms, which a halved step has at most half of.
    fn before_it_is_seen<L: Lane>(
        argument: &Series<L>,
        unseen: Unseen,
        length: L::Plain,
    ) -> L::Plain {
        let first = argument[0].plain();
        let far = match unseen {
            Unseen::Below => L::Plain::splat(UNSEEN) - first,
            Unseen::Beyond => first.abs() + L::Plain::splat(0.5 * UNSEEN),
        };
        let is_unseen = L::Plain::splat(0.0).lt(far);
        let mut length = length;
        if !is_unseen.any() {
            return length;
        }
        let allowed = far.max(L::Plain::splat(NEARLY));
        for _ in 0..HALVINGS {
            let mut change = L::Plain::splat(0.0);
            for term in argument[1..].iter().rev() {
                change = (change + term.plain().abs()) * length;
            }
            let is_far = is_unseen & allowed.lt(change);
            if !is_far.any() {
                break;
            }
            length = L::Plain::select(is_far, length * L::Plain::splat(0.5), length);
        }
        length
    }
}
