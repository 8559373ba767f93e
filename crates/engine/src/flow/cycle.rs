//! The loop to the end of a cycle.

use std::fmt;

use serde::Serialize;

use crate::lane::{Lane, Mask};

use super::breakdown::Breakdown;
use super::motion::Motion;
use super::step::Step;
use super::switched::Switched;

/// A cycle of so many steps is taken for a motion that cannot be followed.
pub const STEPS_PER_CYCLE: u64 = 200_000;

/// Why a motion could not be followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// Events follow each other without time passing.
    NoProgress = 1,
    /// The state, or a guard that is watched, is no longer a finite number.
    NotFinite,
    /// A single cycle takes too many steps.
    TooManySteps,
    /// An autonomous system does not come back to its section.
    NoReturn,
    /// The case takes more steps than it may.
    OutOfSteps,
    /// Nothing holds a mean force, and the motion accelerates for ever.
    Runaway,
    /// No motion starts in such a state, as behind a rigid stop; told by models.
    NoStart,
    /// Impacts follow each other without time passing: they accumulate, and the system has no contact that lasts.
    Chatter,
}

impl Reason {
    /// Every reason with its name in files.
    pub const NAMES: [(Reason, &str); 8] = [
        (Reason::NoProgress, "no-progress"),
        (Reason::NotFinite, "not-finite"),
        (Reason::TooManySteps, "too-many-steps"),
        (Reason::NoReturn, "no-return"),
        (Reason::OutOfSteps, "out-of-steps"),
        (Reason::Runaway, "runaway"),
        (Reason::NoStart, "no-start"),
        (Reason::Chatter, "chatter"),
    ];
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::NoProgress => Breakdown::NoProgress.fmt(f),
            Reason::Chatter => Breakdown::Chatter.fmt(f),
            Reason::NotFinite => Breakdown::NotFinite.fmt(f),
            Reason::NoReturn => Breakdown::NoReturn.fmt(f),
            Reason::Runaway => Breakdown::RunsAway.fmt(f),
            Reason::TooManySteps => write!(f, "a drive cycle takes over {STEPS_PER_CYCLE} steps"),
            Reason::NoStart => f.write_str("no motion starts there"),
            Reason::OutOfSteps => f.write_str("the case takes more steps than max_steps allows"),
        }
    }
}

impl From<Breakdown> for Reason {
    fn from(breakdown: Breakdown) -> Self {
        match breakdown {
            Breakdown::NoProgress => Reason::NoProgress,
            Breakdown::Chatter => Reason::Chatter,
            Breakdown::NotFinite => Reason::NotFinite,
            Breakdown::NoReturn => Reason::NoReturn,
            Breakdown::RunsAway => Reason::Runaway,
            Breakdown::Stopped => Reason::OutOfSteps,
        }
    }
}

/// Follows the motion in lane 0 to the end of its cycle, for so many steps at `most`, and shows each step to
/// `see`; returns the duration of the cycle.
#[inline]
pub fn cycle<L: Lane, S: Switched<L>>(
    system: &S,
    motion: &mut Motion<L, S>,
    step: &mut Step<L, S>,
    budget: (u64, f64),
    mut see: impl FnMut(&Step<L, S>),
) -> Result<L, Reason> {
    cycle_changed_by(system, motion, step, budget, |_, step| see(step))
}

/// The same, where the motion may be changed after each step.
#[inline]
pub fn cycle_changed_by<L: Lane, S: Switched<L>>(
    system: &S,
    motion: &mut Motion<L, S>,
    step: &mut Step<L, S>,
    (most, tolerance): (u64, f64),
    mut change: impl FnMut(&mut Motion<L, S>, &Step<L, S>),
) -> Result<L, Reason> {
    let period = system.period();
    for _ in 0..most {
        motion.single_step(system, period, tolerance, step);
        change(motion, step);
        if let Some(breakdown) = motion.breakdown(system, step, 0) {
            return Err(breakdown.into());
        }
        if step.arrives.lane(0) {
            let duration = motion.time;
            motion.begin_cycle(system, L::Mask::splat(true));
            return Ok(duration);
        }
    }
    Err(Reason::TooManySteps)
}
