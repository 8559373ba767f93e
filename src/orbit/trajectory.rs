//! A case on its way, one drive cycle at a time.

use std::fmt;

use serde::Serialize;

use crate::capsule::{Locomotion, State};
use crate::flow::{Breakdown, Motion, Step};

use super::Case;

/// A cycle of so many steps is taken for a motion that cannot be followed.
pub(super) const STEPS_PER_CYCLE: u64 = 200_000;

/// A point of the stroboscopic section: r [m], y1 [m/s], y2 [m/s].
pub type Section = [f64; 3];

/// Why a case could not be followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// Events follow each other without time passing.
    NoProgress = 1,
    /// The state is no longer a finite number.
    NotFinite,
    /// A single drive cycle takes too many steps.
    TooManySteps,
}

impl Reason {
    /// Every reason with its name in files.
    pub const NAMES: [(Reason, &str); 3] = [
        (Reason::NoProgress, "no-progress"),
        (Reason::NotFinite, "not-finite"),
        (Reason::TooManySteps, "too-many-steps"),
    ];
}

impl From<Breakdown> for Reason {
    fn from(breakdown: Breakdown) -> Self {
        match breakdown {
            Breakdown::NoProgress => Reason::NoProgress,
            Breakdown::NotFinite => Reason::NotFinite,
        }
    }
}

/// Where and why a case failed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Failure {
    /// Why.
    pub reason: Reason,
    /// Time since the start [s].
    pub time: f64,
    /// Where it was.
    pub state: State<f64>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let State { r, y1, x2, y2 } = self.state;
        let reason = match self.reason {
            Reason::NoProgress => Breakdown::NoProgress.to_string(),
            Reason::NotFinite => Breakdown::NotFinite.to_string(),
            Reason::TooManySteps => format!("a drive cycle takes over {STEPS_PER_CYCLE} steps"),
        };
        write!(
            f,
            "{reason}, at t = {} s, r = {r} m, y1 = {y1} m/s, x2 = {x2} m, y2 = {y2} m/s",
            self.time
        )
    }
}

/// A case on its way.
pub struct Trajectory<'a, S: Locomotion> {
    system: &'a S,
    motion: Motion<f64, S>,
    step: Step<f64, S>,
    drive_period: f64,
    tolerance: f64,
    /// Whole cycles since the first section.
    pub cycles: u64,
    /// Time of the first section since the start [s]; on the way there the time, below zero, of the section
    /// before the start.
    pub(super) origin: f64,
    /// Steps taken in the cycle so far.
    steps: u64,
}

/// The point of the section of a state at the end of a cycle.
pub fn section(state: &State<f64>) -> Section {
    [state.r, state.y1, state.y2]
}

/// The motion from another point of the section than that of `state`, as far along the ground.
pub fn leap<S: Locomotion>(system: &S, state: &State<f64>, [r, y1, y2]: Section) -> Motion<f64, S> {
    Motion::new(system, 0.0, State { r, y1, y2, ..*state })
}

impl<'a, S: Locomotion> Trajectory<'a, S> {
    /// Sets out from `start` at t = 0; `drive_period` [s], relative local `tolerance`.
    pub fn new(system: &'a S, start: State<f64>, drive_period: f64, tolerance: f64) -> Self {
        let motion = Motion::new(system, 0.0, start);
        Trajectory::resume(system, motion, [0, 0], drive_period, tolerance)
    }

    /// Sets out where `case` starts; the first cycle is the rest of one where that is not on the section.
    pub fn of(system: &'a S, case: &Case, tolerance: f64) -> Self {
        let time = case.start_time();
        let motion = Motion::new(system, time, case.start);
        let drive_period = case.parameters.drive_period();
        let trajectory = Trajectory::resume(system, motion, [0, 0], drive_period, tolerance);
        Trajectory { origin: 0.0 - time, ..trajectory }
    }

    /// Goes on with a `motion` under way for so many whole cycles and steps of the next.
    pub fn resume(
        system: &'a S,
        motion: Motion<f64, S>,
        [cycles, steps]: [u64; 2],
        drive_period: f64,
        tolerance: f64,
    ) -> Self {
        let (step, origin) = (Step::default(), 0.0);
        Trajectory { system, motion, step, drive_period, tolerance, cycles, origin, steps }
    }

    /// The system that moves.
    pub fn system(&self) -> &'a S {
        self.system
    }

    /// Where it is.
    pub fn state(&self) -> State<f64> {
        self.motion.state
    }

    /// The point of the section, when a cycle has just ended.
    pub fn section(&self) -> Section {
        section(&self.motion.state)
    }

    /// Whether a cycle has just ended or is about to begin.
    pub fn is_at_section(&self) -> bool {
        self.motion.time == 0.0
    }

    /// Time of the last section since the start [s].
    pub fn cycle_began(&self) -> f64 {
        self.origin + self.cycles as f64 * self.drive_period
    }

    /// Goes on from another point of the section, at the beginning of a cycle.
    pub fn leap(&mut self, target: Section) {
        self.motion = leap(self.system, &self.motion.state, target);
    }

    /// Goes on to the end of the drive cycle and shows each step to `see`.
    pub fn cycle(&mut self, mut see: impl FnMut(&Step<f64, S>)) -> Result<(), Failure> {
        loop {
            self.motion.step(self.system, self.drive_period, self.tolerance, &mut self.step);
            self.steps += 1;
            see(&self.step);
            if self.look()? {
                return Ok(());
            }
        }
    }

    /// Looks where the last step has led: whether to the end of a cycle, and if not, what is in the way.
    pub fn look(&mut self) -> Result<bool, Failure> {
        if let Some(breakdown) = self.motion.breakdown(self.system, 0) {
            return Err(self.failure(breakdown.into()));
        }
        if self.motion.time >= self.drive_period {
            self.motion.begin_cycle(true);
            count_cycle(&mut self.cycles, &mut self.origin, self.drive_period);
            self.steps = 0;
            return Ok(true);
        }
        if self.steps >= STEPS_PER_CYCLE {
            return Err(self.failure(Reason::TooManySteps));
        }
        Ok(false)
    }

    /// Tells where it is when it cannot go on.
    pub(super) fn failure(&self, reason: Reason) -> Failure {
        let time = self.cycle_began() + self.motion.time;
        Failure { reason, time, state: self.motion.state }
    }
}

/// Counts a cycle that has ended, unless it is the part of one that leads from the start to the first
/// section.
pub(super) fn count_cycle(cycles: &mut u64, origin: &mut f64, drive_period: f64) {
    if *origin < 0.0 {
        *origin += drive_period;
    } else {
        *cycles += 1;
    }
}
