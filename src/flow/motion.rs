//! The event loop: step, locate, switch.

use std::fmt;

use crate::lane::{Lane, Mask};
use crate::model::switched::{MAX_GUARDS, Switched, Zeros};

use super::guard::{divide_by_time, first_fall};
use super::pace::longest_step;

/// So many steps in a row may pass without getting anywhere: simultaneous events need a few.
const PATIENCE: f64 = 64.0;
/// A step shorter than this share of the cycle gets nowhere.
const STANDSTILL: f64 = 1e-14;

/// A motion under way: where it is, and in which mode.
#[derive(Debug, Clone, Copy)]
pub struct Motion<L: Lane, S: Switched<L>> {
    /// Time since the start of the cycle [s].
    pub time: L,
    /// Where it is.
    pub state: S::State,
    /// Which field acts.
    pub mode: S::Mode,
    zeros: Zeros<L>,
    idle: L,
}

/// One step that was taken.
#[derive(Debug, Clone)]
pub struct Step<L: Lane, S: Switched<L>> {
    /// Time at its start since the start of the cycle [s].
    pub start: L,
    /// Duration [s].
    pub length: L,
    /// The mode during the step.
    pub mode: S::Mode,
    /// The series of the motion during the step.
    pub jet: S::Jet,
    /// The event at its end, as `Switched::switch` numbers it; zero for none.
    pub event: L,
}

/// Why a motion cannot go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Breakdown {
    /// Events follow each other without time passing.
    NoProgress,
    /// The state is no longer a finite number.
    NotFinite,
}

impl fmt::Display for Breakdown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Breakdown::NoProgress => "events follow each other without time passing",
            Breakdown::NotFinite => "the state is no longer a finite number",
        })
    }
}

impl<L: Lane, S: Switched<L>> Motion<L, S> {
    /// A motion from `state` at `time`, in the mode that the system gives it.
    ///
    /// Guards that are due at the start are obeyed at once: the mode at the start is no event.
    pub fn new(system: &S, time: L, state: S::State) -> Self {
        let zero = L::splat(0.0);
        let mode = system.start(time, &state);
        let mut motion = Motion { time, state, mode, zeros: [zero; MAX_GUARDS], idle: zero };
        for _ in 0..MAX_GUARDS {
            let jet = system.jet(&motion.mode, time, &motion.state);
            motion.locate(system, &jet, zero).switch(system, &mut motion);
        }
        motion
    }

    /// Takes one step, at most to `until`, and obeys the guard that ends it.
    ///
    /// The local error is below `tolerance` relative to the motion during the step; an event ends the
    /// step where its guard falls through zero, to rounding.
    #[inline(always)]
    pub fn step(&mut self, system: &S, until: L, tolerance: f64) -> Step<L, S> {
        let jet = system.jet(&self.mode, self.time, &self.state);
        let left = until - self.time;
        let [first, second] = system.pace(&jet);
        let allowed = longest_step(first, tolerance).min(longest_step(second, tolerance));
        let end = self.locate(system, &jet, allowed.min(left));

        let (start, mode, length) = (self.time, self.mode, end.length);
        self.state = system.at(&jet, length);
        self.time = L::select(left.le(length), until, start + length);
        let passed = L::splat(0.0).lt(length);
        for zeros in &mut self.zeros {
            *zeros = L::select(passed, L::splat(0.0), *zeros);
        }
        let idles = length.le(until * L::splat(STANDSTILL)) & length.lt(left);
        self.idle = L::select(idles, self.idle + L::splat(1.0), L::splat(0.0));
        let event = end.switch(system, self);
        Step { start, length, mode, jet, event }
    }

    /// Starts the next cycle where `mask`: time counts from zero again.
    #[inline(always)]
    pub fn begin_cycle(&mut self, mask: L::Mask) {
        self.time = L::select(mask, L::splat(0.0), self.time);
    }

    /// What keeps `lane` from going on, if anything.
    #[inline(always)]
    pub fn breakdown(&self, system: &S, lane: usize) -> Option<Breakdown> {
        let stuck = L::splat(PATIENCE).lt(self.idle);
        let lost = system.lost(&self.state);
        if !(stuck | lost).any() {
            return None;
        }
        let marked = |mask| L::select(mask, L::splat(1.0), L::splat(0.0)).lane(lane) > 0.0;
        if marked(lost) {
            return Some(Breakdown::NotFinite);
        }
        marked(stuck).then_some(Breakdown::NoProgress)
    }

    /// The first guard to fall within `length`.
    #[inline(always)]
    fn locate(&self, system: &S, jet: &S::Jet, length: L) -> StepEnd<L> {
        let none = L::splat(-1.0);
        let mut end = StepEnd { length, guard: none };
        for which in 0..S::GUARDS {
            let watched = system.watched(which, &self.mode);
            if !watched.any() {
                continue;
            }
            let mut guard = system.guard(which, &self.mode, jet);
            for vanished in [0.5, 1.5] {
                let drop = L::splat(vanished).lt(self.zeros[which]);
                if drop.any() {
                    divide_by_time(&mut guard, drop);
                }
            }
            let fall = first_fall(&guard, end.length, watched);
            let sooner = fall.length.lt(end.length);
            end.guard = L::select(sooner, none, end.guard);
            end.guard = L::select(fall.falls, L::splat(which as f64), end.guard);
            end.length = fall.length;
        }
        end
    }
}

/// Where a step ends, and which guard ends it (-1 for none).
struct StepEnd<L> {
    length: L,
    guard: L,
}

impl<L: Lane> StepEnd<L> {
    /// Obeys the guard that ended the step; returns the kind of event.
    #[inline(always)]
    fn switch<S: Switched<L>>(&self, system: &S, motion: &mut Motion<L, S>) -> L {
        let mut event = L::splat(0.0);
        for which in 0..S::GUARDS {
            let due = (self.guard - L::splat(which as f64)).abs().lt(L::splat(0.5));
            if due.any() {
                let Motion { mode, state, zeros, .. } = motion;
                event = event + system.switch(which, due, mode, state, zeros, motion.time);
            }
        }
        event
    }
}
