//! A case on its way, one cycle at a time.

use crate::flow::{Motion, Reason, Step, Stroboscopic, cycle};

/// Where and why a case failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Failure<S> {
    /// Why.
    pub reason: Reason,
    /// Time since the start [s].
    pub time: f64,
    /// Where it was.
    pub state: S,
}

/// A case on its way.
pub struct Trajectory<'a, S: Stroboscopic<f64, D>, const D: usize> {
    system: &'a S,
    motion: Motion<f64, S>,
    step: Step<f64, S>,
    tolerance: f64,
    /// Whole cycles since the start.
    pub cycles: u64,
    /// Steps taken in the cycle so far.
    steps: u64,
    /// Duration of the whole cycles of an autonomous system [s].
    elapsed: f64,
}

/// The motion from another point of the section than that of `state`; what the section leaves out stays.
pub fn leap<S: Stroboscopic<f64, D>, const D: usize>(
    system: &S,
    state: &S::State,
    target: [f64; D],
) -> Motion<f64, S> {
    Motion::new(system, 0.0, S::moved_to(*state, target))
}

impl<'a, S: Stroboscopic<f64, D>, const D: usize> Trajectory<'a, S, D> {
    /// Sets out from `start` at the section; relative local `tolerance`.
    pub fn new(system: &'a S, start: S::State, tolerance: f64) -> Self {
        Trajectory::resume(system, Motion::new(system, 0.0, start), Progress::default(), tolerance)
    }

    /// Goes on with a `motion` under way.
    pub fn resume(
        system: &'a S,
        motion: Motion<f64, S>,
        progress: Progress,
        tolerance: f64,
    ) -> Self {
        let Progress { cycles, steps, elapsed } = progress;
        Trajectory { system, motion, step: Step::default(), tolerance, cycles, steps, elapsed }
    }

    /// The system that moves.
    pub fn system(&self) -> &'a S {
        self.system
    }

    /// Where it is.
    pub fn state(&self) -> S::State {
        self.motion.state
    }

    /// The point of the section, when a cycle has just ended.
    pub fn section(&self) -> [f64; D] {
        S::point(&self.motion.state)
    }

    /// Time since the start, whole cycles only [s].
    pub fn elapsed(&self) -> f64 {
        if S::AUTONOMOUS { self.elapsed } else { self.cycles as f64 * self.system.period() }
    }

    /// Goes on from another point of the section, at the beginning of a cycle.
    pub fn leap(&mut self, target: [f64; D]) {
        self.motion = leap(self.system, &self.motion.state, target);
    }

    /// Goes on to the end of the cycle and shows each step to `see`.
    pub fn cycle(&mut self, see: impl FnMut(&Step<f64, S>)) -> Result<(), Failure<S::State>> {
        let Trajectory { system, motion, step, steps, tolerance, .. } = self;
        match cycle(*system, motion, step, (*steps, *tolerance), see) {
            Ok(duration) => {
                self.cycles += 1;
                self.steps = 0;
                self.elapsed += duration;
                Ok(())
            }
            Err(reason) => Err(self.failure(reason)),
        }
    }

    /// Tells where it is when it cannot go on, and why.
    pub fn stuck(&self) -> Failure<S::State> {
        let breakdown = self.motion.breakdown(self.system, 0);
        self.failure(breakdown.map_or(Reason::TooManySteps, Reason::from))
    }

    /// Tells where it is when it cannot go on.
    pub(super) fn failure(&self, reason: Reason) -> Failure<S::State> {
        let time = self.elapsed() + self.motion.time;
        Failure { reason, time, state: self.motion.state }
    }
}

/// How far a case has come.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Progress {
    /// Whole cycles since the start.
    pub cycles: u64,
    /// Steps of the next.
    pub steps: u64,
    /// Duration of the whole cycles [s].
    pub elapsed: f64,
}
