//! The motion of a case, one cycle at a time.

use std::fmt;

use crate::flow::{Breakdown, Motion, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, cycle};

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

impl<S> Failure<S> {
    /// The same with the state told in another way.
    pub fn map<T>(self, told: impl FnOnce(S) -> T) -> Failure<T> {
        Failure { reason: self.reason, time: self.time, state: told(self.state) }
    }
}

impl<S: fmt::Display> fmt::Display for Failure<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, at t = {} s, {}", self.reason, self.time, self.state)
    }
}

/// How far a case has come.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Progress {
    /// Whole cycles since the first section.
    pub cycles: u64,
    /// Steps taken in the cycle so far.
    pub steps: u64,
    /// Steps taken before the cycle.
    pub steps_before: u64,
    /// Duration of the whole cycles [s].
    pub elapsed: f64,
    /// Time of the first section since the start [s]; until that is reached the time, below zero, of the section
    /// before the start.
    pub origin: f64,
}

impl Progress {
    /// That of a case which starts so long after a section [s].
    pub fn begun(time: f64) -> Self {
        Progress { origin: 0.0 - time, ..Progress::default() }
    }

    /// Steps after which the cycle is given up, of a case that may take so many in all.
    pub fn deadline(&self, max_steps: u64) -> u64 {
        STEPS_PER_CYCLE.min(self.steps_left(max_steps)).max(self.steps)
    }

    /// Steps left for the cycle and all after it, of a case that may take so many in all.
    pub fn steps_left(&self, max_steps: u64) -> u64 {
        max_steps.saturating_sub(self.steps_before)
    }

    /// Cycles that are left, if they take as many steps as those before in the mean, of a case that may take so many in all.
    pub fn affordable_cycles(&self, max_steps: u64) -> u64 {
        self.steps_left(max_steps) / self.mean_steps().max(1)
    }

    /// Steps of a cycle in the mean of those before.
    pub fn mean_steps(&self) -> u64 {
        self.steps_before / self.cycles.max(1)
    }

    /// Counts a cycle of this duration, unless it is the part of one that leads from the start to the first
    /// section.
    pub fn count(&mut self, duration: f64) {
        self.steps_before += std::mem::take(&mut self.steps);
        if self.origin < 0.0 {
            self.origin += duration;
        } else {
            self.cycles += 1;
            self.elapsed += duration;
        }
    }
}

/// The motion of a case.
pub struct Trajectory<'a, S: Stroboscopic<f64, D>, const D: usize> {
    system: &'a S,
    motion: Motion<f64, S>,
    step: Step<f64, S>,
    tolerance: f64,
    /// Steps that it may take in all.
    max_steps: u64,
    /// How far it has come.
    pub progress: Progress,
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
        Trajectory::begun(system, start, 0.0, tolerance)
    }

    /// Sets out so long after a section [s]; the first cycle is then the rest of one.
    pub fn begun(system: &'a S, start: S::State, time: f64, tolerance: f64) -> Self {
        let motion = Motion::new(system, time, start);
        Trajectory::resume(system, motion, Progress::begun(time), tolerance)
    }

    /// Continues a `motion` that has begun.
    pub fn resume(
        system: &'a S,
        motion: Motion<f64, S>,
        progress: Progress,
        tolerance: f64,
    ) -> Self {
        let (step, max_steps) = (Step::default(), u64::MAX);
        Trajectory { system, motion, step, tolerance, max_steps, progress }
    }

    /// The same, and it may take so many steps in all.
    pub fn limited(self, max_steps: u64) -> Self {
        Trajectory { max_steps, ..self }
    }

    /// The same motion further on.
    pub(super) fn go_on(&mut self, motion: Motion<f64, S>, progress: Progress) {
        (self.motion, self.progress) = (motion, progress);
    }

    /// Its motion as it is.
    pub(super) fn motion(&self) -> Motion<f64, S> {
        self.motion
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

    /// Whether a cycle has just ended or is about to begin.
    pub fn is_at_section(&self) -> bool {
        self.motion.time == 0.0
    }

    /// Duration of the whole cycles [s].
    pub fn elapsed(&self) -> f64 {
        let Progress { cycles, elapsed, .. } = self.progress;
        if S::AUTONOMOUS { elapsed } else { cycles as f64 * self.system.period() }
    }

    /// Time of the last section since the start [s].
    pub fn cycle_began(&self) -> f64 {
        self.progress.origin + self.elapsed()
    }

    /// Goes on from another point of the section, at the beginning of a cycle.
    pub fn leap(&mut self, target: [f64; D]) {
        self.motion = leap(self.system, &self.motion.state, target);
    }

    /// Goes on to the end of the cycle and shows each step to `see`.
    pub fn cycle(&mut self, mut see: impl FnMut(&Step<f64, S>)) -> Result<(), Failure<S::State>> {
        let Trajectory { system, motion, step, tolerance, max_steps, progress } = self;
        let most = progress.deadline(*max_steps) - progress.steps;
        let counted = |step: &_| {
            progress.steps += 1;
            see(step);
        };
        match cycle(*system, motion, step, (most, *tolerance), counted) {
            Ok(duration) => {
                progress.count(duration);
                Ok(())
            }
            Err(Reason::TooManySteps) => Err(self.stuck()),
            Err(reason) => Err(self.failure(reason)),
        }
    }

    /// Tells where it is when it cannot go on, and why.
    pub fn stuck(&self) -> Failure<S::State> {
        let breakdown = match self.motion.breakdown(self.system, &self.step, 0) {
            // A motion that was followed beside others comes without its last step: another one gets nowhere either.
            Some(Breakdown::NoProgress) => {
                let (mut motion, mut step) = (self.motion, Step::default());
                motion.single_step(self.system, self.system.period(), self.tolerance, &mut step);
                motion.breakdown(self.system, &step, 0)
            }
            other => other,
        };
        let out_of = match self.progress.steps {
            STEPS_PER_CYCLE.. => Reason::TooManySteps,
            _ => Reason::OutOfSteps,
        };
        self.failure(breakdown.map_or(out_of, Reason::from))
    }

    /// Tells where it is when it cannot go on.
    pub(super) fn failure(&self, reason: Reason) -> Failure<S::State> {
        let time = self.cycle_began() + self.motion.time;
        Failure { reason, time, state: self.motion.state }
    }
}
