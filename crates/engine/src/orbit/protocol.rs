//! How a case is followed and judged, and what it may turn out to be.

use std::fmt;
use std::ops::RangeInclusive;

use serde::Serialize;

use super::precision;

/// What a case turned out to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The section repeats after `period` cycles.
    Periodic = 0,
    /// Neighbouring motions part exponentially.
    Chaotic,
    /// Neither repeats nor parts.
    QuasiPeriodic,
    /// Not settled within the budget of cycles, or at an equilibrium of an autonomous system, whose section has
    /// no meaning there.
    Undecided,
    /// Could not be followed.
    Failed,
}

impl Outcome {
    /// Every outcome, in the order of their numbers.
    pub const ALL: [Outcome; 5] = [
        Outcome::Periodic,
        Outcome::Chaotic,
        Outcome::QuasiPeriodic,
        Outcome::Undecided,
        Outcome::Failed,
    ];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Outcome::Periodic => "periodic",
            Outcome::Chaotic => "chaotic",
            Outcome::QuasiPeriodic => "quasi-periodic",
            Outcome::Undecided => "undecided",
            Outcome::Failed => "failed",
        }
    }
}

/// A stretch of motion to be sampled evenly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HistorySpan {
    /// Cycles.
    pub cycles: u32,
    /// Samples in each of them.
    pub per_cycle: u32,
    /// Whether to begin where the case starts rather than where it has settled.
    pub from_start: bool,
}

impl HistorySpan {
    /// Number of samples, both ends included.
    pub fn samples(&self) -> usize {
        self.cycles as usize * self.per_cycle as usize + 1
    }
}

/// Which Lyapunov exponents are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exponents {
    /// The largest.
    Largest,
    /// As many as the section has coordinates, and the dimension that follows from them.
    All,
}

impl Exponents {
    /// Each with its name in studies.
    pub const NAMES: [(&str, Exponents); 2] =
        [("largest", Exponents::Largest), ("all", Exponents::All)];

    /// Its name in studies.
    pub fn name(self) -> &'static str {
        let named = Exponents::NAMES.into_iter().find(|(_, it)| *it == self);
        named.expect("each has a name").0
    }
}

/// How a case is followed and judged.
#[derive(Clone, Copy, PartialEq)]
pub struct Protocol {
    /// Relative local error of a step.
    pub tolerance: f64,
    /// How closely the section must repeat, relative to its size.
    pub recurrence: f64,
    /// Cycles after which a case that has not settled is undecided.
    pub max_cycles: u64,
    /// Steps after which a case fails that is not done [steps]: those to settle, to compute its exponent and to measure
    /// it, and for the orbits that are closed the mean of a cycle for each of theirs.
    pub max_steps: u64,
    /// Longest period looked for while the motion settles [cycles]; longer ones, up to 1024, are looked for
    /// where it has not settled within the budget of cycles.
    pub max_period: usize,
    /// Cycles over which a case that does not repeat is measured.
    pub measured_cycles: u64,
    /// Cycles over which its exponent is computed at most; none is for zero.
    pub exponent_cycles: u64,
    /// The standard error, relative to the exponent, at which an exponent above zero is known well enough before that [-].
    pub exponent_error: f64,
    /// Which exponents are computed.
    pub exponents: Exponents,
    /// The standard error, relative to the mean, at which the mean gain of a motion that does not repeat is known well enough [-];
    /// where there is none it is measured over `measured_cycles`.
    pub mean_error: Option<f64>,
    /// Section points kept at most.
    pub points: usize,
    /// Impacts kept at most, by an observer that notes them.
    pub impact_points: usize,
    /// Whether a motion is followed only until it is proven to lead to the orbit to which its section seems to tend, rather
    /// than until the section repeats.
    pub accelerate: bool,
    /// Time history to keep.
    pub history: Option<HistorySpan>,
}

impl Default for Protocol {
    fn default() -> Self {
        Protocol {
            tolerance: 1e-12,
            recurrence: 1e-11,
            max_cycles: 2000,
            max_steps: 50_000_000,
            max_period: 32,
            measured_cycles: 128,
            exponent_cycles: 2048,
            exponent_error: *Protocol::EXPONENT_ERRORS.end(),
            exponents: Exponents::Largest,
            mean_error: None,
            points: 64,
            impact_points: 64,
            accelerate: true,
            history: None,
        }
    }
}

/// As fingerprints of studies have it: what is asked for by few is told where it is, so that those of other studies stay.
impl fmt::Debug for Protocol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("Protocol");
        shown
            .field("tolerance", &self.tolerance)
            .field("recurrence", &self.recurrence)
            .field("max_cycles", &self.max_cycles)
            .field("max_steps", &self.max_steps)
            .field("max_period", &self.max_period)
            .field("measured_cycles", &self.measured_cycles)
            .field("exponent_cycles", &self.exponent_cycles)
            .field("exponent_error", &self.exponent_error)
            .field("points", &self.points)
            .field("impact_points", &self.impact_points)
            .field("accelerate", &self.accelerate)
            .field("history", &self.history);
        if self.exponents != Exponents::Largest {
            shown.field("exponents", &self.exponents);
        }
        if let Some(error) = self.mean_error {
            shown.field("mean_error", &error);
        }
        shown.finish()
    }
}

impl Protocol {
    /// What the error wanted of an exponent may be: chaos is told by an exponent of five standard errors, and is to be clear.
    pub const EXPONENT_ERRORS: RangeInclusive<f64> = 1e-4..=0.1;
    /// What the error wanted of a mean may be.
    pub const MEAN_ERRORS: RangeInclusive<f64> = 1e-5..=0.5;
    /// What a tolerance and a recurrence may be.
    pub const TOLERANCES: RangeInclusive<f64> = 1e-15..=1e-3;

    /// The usual protocol at another tolerance: the section cannot repeat more closely than the steps are.
    pub fn with_tolerance(tolerance: f64) -> Self {
        let usual = Protocol::default();
        Protocol {
            tolerance,
            recurrence: precision::recurrence(usual.recurrence, tolerance),
            ..usual
        }
    }
}
