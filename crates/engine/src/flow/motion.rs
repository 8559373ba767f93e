//! The event loop: step, locate, switch.

use crate::lane::{Lane, Mask, SideBySide, series};

use super::breakdown::Breakdown;
use super::expand::Expand;
use super::locate::Locate;
use super::obey::Obey;
use super::step::Step;
use super::step_end::StepEnd;
use super::stop;
use super::switched::{Event as _, MAX_GUARDS, Switched, Zeros};

/// So many steps in a row may pass without getting anywhere: simultaneous events need a few.
const PATIENCE: f64 = 64.0;
/// A step shorter than this share of the cycle gets nowhere.
const STANDSTILL: f64 = 1e-14;

/// A motion: its time, its state and its mode.
#[derive(Debug)]
pub struct Motion<L: Lane, S: Switched<L>> {
    /// Time since the start of the cycle [s].
    pub time: L,
    /// Where it is.
    pub state: S::State,
    /// Which field acts.
    pub mode: S::Mode,
    zeros: Zeros<L>,
    /// Steps in a row that got nowhere; infinitely many where a guard is no finite number.
    idle: L,
    /// The sign of the section's function of an autonomous system; zero until it is known.
    side: L,
}

// By hand, as a derived copy would ask for a system that can be copied.
impl<L: Lane, S: Switched<L>> Clone for Motion<L, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lane, S: Switched<L>> Copy for Motion<L, S> {}

impl<L: Lane, S: Switched<L>> Motion<L, S> {
    /// A motion from `state` at `time`, in the mode that the system gives it.
    ///
    /// Guards that are due at the start are obeyed at once: the mode at the start is no event.
    pub fn new(system: &S, time: L, state: S::State) -> Self {
        let mut motion = Motion::begun(system, time, state);
        let mut step = Step::default();
        for _ in 0..MAX_GUARDS {
            if const { L::WIDTH == 1 } {
                motion.single_step(system, time, 1.0, &mut step);
            } else {
                motion.step(system, time, 1.0, &mut step);
            }
            if !step.switches.any() {
                break;
            }
        }
        motion.face_section(system, &mut step);
        motion
    }

    /// The same before the guards that are due at the start are obeyed.
    ///
    /// Steps to the same time, until one obeys no guard or [`MAX_GUARDS`] are taken, and [`Motion::face_section`] make it a new
    /// motion; a loop takes them with the step that it has, as a copy of it for lanes with derivatives takes long to compile.
    pub fn begun(system: &S, time: L, mut state: S::State) -> Self {
        let zero = L::splat(0.0);
        let mode = system.start(time, &mut state);
        Motion { time, state, mode, zeros: [zero; MAX_GUARDS], idle: zero, side: zero }
    }

    /// Notes on which side of its section an autonomous motion is.
    #[inline(always)]
    pub fn face_section(&mut self, system: &S, step: &mut Step<L, S>) {
        if S::AUTONOMOUS {
            system.expand(&self.mode, self.time, &self.state, &mut step.jet);
            self.side = side_of_section(system, &step.jet);
        }
    }

    /// Takes one step, at most to `until`, obeys the guard that ends it, and describes it in `step`.
    ///
    /// The local error is below `tolerance` relative to the motion during the step; an event ends the
    /// step where its guard falls through zero, to rounding.
    #[inline(always)]
    pub fn step(&mut self, system: &S, until: L, tolerance: f64, step: &mut Step<L, S>) {
        let left = until - self.time;
        let (mode, time, state) = (&self.mode, self.time, &self.state);
        let most = left.plain();
        let length =
            L::apart(Expand { system, mode, time, state, most, tolerance, jet: &mut step.jet });
        let (zeros, side) = (&self.zeros, &mut self.side);
        let end = L::apart(Locate { system, mode, zeros, side, length, step });

        let arrives = left.plain().le(end.length);
        let cut = L::select(arrives, left, L::from_plain(end.length));
        let length = L::select(end.falls(), end.root, cut);
        (step.start, step.mode, step.length) = (self.time, self.mode, length);
        self.state = system.at(&step.jet, length);
        self.time = L::select(arrives, until, self.time + length);
        let passed = L::splat(0.0).lt(length);
        for zeros in &mut self.zeros {
            *zeros = L::select(passed, L::splat(0.0), *zeros);
        }
        let idles = length.le(until * L::splat(STANDSTILL)) & length.lt(left);
        self.idle = L::select(idles, self.idle + L::splat(1.0), L::splat(0.0));
        self.idle = L::select(end.unknown, L::splat(f64::INFINITY), self.idle);
        step.switches = end.falls();
        let Motion { mode, state, zeros, time, .. } = self;
        step.event = L::apart(Obey { system, end: &end, mode, state, zeros, time: *time });
        step.arrives = if S::AUTONOMOUS { self.pass_section(&end) } else { until.le(self.time) };
    }

    /// A step as [`Motion::step`] takes it, compiled once for each kind of number: what is not followed side by side takes its steps here.
    #[inline(never)]
    pub fn single_step(&mut self, system: &S, until: L, tolerance: f64, step: &mut Step<L, S>) {
        self.step(system, until, tolerance, step);
    }

    /// Where the function of the section has just fallen through zero.
    #[inline(always)]
    fn pass_section(&mut self, end: &StepEnd<L>) -> L::Mask {
        let passes = end.is_due(S::GUARDS);
        let falls = passes & L::splat(0.0).lt(self.side);
        self.side = L::select(passes, -self.side, self.side);
        falls
    }

    /// Starts the next cycle where `mask`: time counts from zero again.
    #[inline(always)]
    pub fn begin_cycle(&mut self, system: &S, mask: L::Mask) {
        self.time = L::select(mask, L::splat(0.0), self.time);
        system.begin_cycle(mask, &mut self.mode, &mut self.state);
    }

    /// Where a motion cannot go on; [`Motion::breakdown`] tells why.
    #[inline(always)]
    pub fn broken(&self, system: &S) -> L::Mask {
        if stop::is_asked() {
            return L::Mask::splat(true);
        }
        let broken = L::splat(PATIENCE).lt(self.idle) | system.lost(&self.state);
        let broken = broken | system.runs_away(&self.state);
        if S::AUTONOMOUS { broken | system.period().le(self.time) } else { broken }
    }

    /// What keeps the motion in lane `index`, whose last step this is, from going on, if anything.
    #[inline(always)]
    pub fn breakdown(&self, system: &S, last: &Step<L, S>, index: usize) -> Option<Breakdown> {
        if system.lost(&self.state).lane(index) || self.idle.lane(index) == f64::INFINITY {
            return Some(Breakdown::NotFinite);
        }
        if L::splat(PATIENCE).lt(self.idle).lane(index) {
            let event = S::Event::from_code(last.event.lane(index));
            let hits = event.is_some_and(|it| it.is_impact());
            return Some(if hits { Breakdown::Chatter } else { Breakdown::NoProgress });
        }
        if system.runs_away(&self.state).lane(index) {
            return Some(Breakdown::RunsAway);
        }
        let is_late = S::AUTONOMOUS && system.period().le(self.time).lane(index);
        let stopped = stop::is_asked().then_some(Breakdown::Stopped);
        is_late.then_some(Breakdown::NoReturn).or(stopped)
    }
}

/// The sign of the section's function at the start of a step; on the section, the sign that it takes next.
fn side_of_section<L: Lane, S: Switched<L>>(system: &S, jet: &S::Jet) -> L {
    let mut section = series::zero();
    system.section(jet, &mut section);
    series::sign_after_start(&section, L::splat(0.0))
}

impl<L, S> SideBySide for Motion<L, S>
where
    L: Lane,
    S: Switched<L, State: SideBySide, Mode: SideBySide> + SideBySide,
    S::One:
        Switched<f64, State = <S::State as SideBySide>::One, Mode = <S::Mode as SideBySide>::One>,
{
    type One = Motion<f64, S::One>;

    #[inline(always)]
    fn splat(one: &Self::One) -> Self {
        Motion {
            time: L::splat(one.time),
            state: SideBySide::splat(&one.state),
            mode: SideBySide::splat(&one.mode),
            zeros: one.zeros.map(L::splat),
            idle: L::splat(one.idle),
            side: L::splat(one.side),
        }
    }

    #[inline(always)]
    fn lane(&self, index: usize) -> Self::One {
        Motion {
            time: self.time.lane(index),
            state: self.state.lane(index),
            mode: self.mode.lane(index),
            zeros: self.zeros.map(|zeros| zeros.lane(index)),
            idle: self.idle.lane(index),
            side: self.side.lane(index),
        }
    }

    #[inline(always)]
    fn put(&mut self, index: usize, one: &Self::One) {
        self.time = self.time.with_lane(index, one.time);
        self.state.put(index, &one.state);
        self.mode.put(index, &one.mode);
        self.zeros.put(index, &one.zeros);
        self.idle = self.idle.with_lane(index, one.idle);
        self.side = self.side.with_lane(index, one.side);
    }

    #[inline(always)]
    fn take_lane(&mut self, index: usize, other: &Self) {
        self.time = self.time.with_lane_of(index, other.time);
        self.state.take_lane(index, &other.state);
        self.mode.take_lane(index, &other.mode);
        self.zeros.take_lane(index, &other.zeros);
        self.idle = self.idle.with_lane_of(index, other.idle);
        self.side = self.side.with_lane_of(index, other.side);
    }
}
