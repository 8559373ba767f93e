//! A case, how it is followed and judged, and what it has settled to.

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::flow::System;

use super::matrix::Complex;
use super::{Certificate, Exponent, Failure};

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
    /// Not settled within the budget of cycles.
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

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<M: System<D>, const D: usize> {
    /// Its parameters.
    pub system: M,
    /// Where it starts, at the section.
    pub start: M::State<f64>,
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

/// How a case is followed and judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Protocol {
    /// Relative local error of a step.
    pub tolerance: f64,
    /// How closely the section must repeat, relative to its size.
    pub recurrence: f64,
    /// Cycles after which a case that has not settled is undecided.
    pub max_cycles: u64,
    /// Longest period looked for while the motion settles [cycles]; longer ones, up to 1024, are looked for
    /// where it has not settled within the budget of cycles.
    pub max_period: usize,
    /// Cycles over which a case that does not repeat is measured.
    pub measured_cycles: u64,
    /// Cycles over which its exponent is computed at most; none is for zero.
    pub exponent_cycles: u64,
    /// Section points kept at most.
    pub points: usize,
    /// Impacts kept at most, by an observer that notes them.
    pub impact_points: usize,
    /// Whether to leap to where the section tends, once it is clear, rather than wait until it is there.
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
            max_period: 32,
            measured_cycles: 128,
            exponent_cycles: 2048,
            points: 64,
            impact_points: 64,
            accelerate: true,
            history: None,
        }
    }
}

impl Protocol {
    /// What a tolerance and a recurrence may be.
    pub const TOLERANCES: RangeInclusive<f64> = 1e-15..=1e-3;

    /// The usual protocol at another tolerance: the section cannot repeat more closely than the steps are.
    pub fn with_tolerance(tolerance: f64) -> Self {
        let usual = Protocol::default();
        Protocol { tolerance, recurrence: usual.recurrence.max(10.0 * tolerance), ..usual }
    }
}

/// What a case settled to: states of the kind `S`, an observer `O`, `D` coordinates of the section.
#[derive(Debug, Clone, PartialEq)]
pub struct Orbit<S, O, const D: usize> {
    /// What it turned out to be.
    pub outcome: Outcome,
    /// Its period [cycles]; zero unless periodic.
    pub period: u64,
    /// What is proven of its period.
    pub certificate: Certificate<D>,
    /// Its largest Lyapunov exponent, where it is known.
    pub exponent: Exponent,
    /// The longest period that is excluded, with all shorter ones [cycles]; NaN where none is known.
    pub excluded: f64,
    /// How far the section is from repeating after the period, relative to the motion [-].
    pub residual: f64,
    /// The largest defect of a step of the measured cycles, times its length and relative to the motion [-].
    pub defect: f64,
    /// Size of the motion at the section, in the units of the metric.
    pub size: f64,
    /// Cycles followed, measuring included.
    pub cycles: u64,
    /// Cycles over which it was measured.
    pub measured_cycles: u64,
    /// Mean duration of a cycle [s].
    pub duration: f64,
    /// Section points of the measured cycles, up to `Protocol::points`.
    pub section: Vec<[f64; D]>,
    /// Where the measured cycles begin.
    pub begins: S,
    /// Where it was last.
    pub end: S,
    /// What was observed over the measured cycles.
    pub observed: O,
    /// Why it could not be followed, if so.
    pub failure: Option<Failure<S>>,
}

/// What a case of a system settles to.
pub type OrbitOf<M, const D: usize> =
    Orbit<<M as System<D>>::State<f64>, <M as System<D>>::Observer, D>;

impl<S: Copy, O, const D: usize> Orbit<S, O, D> {
    /// A case that could not be followed.
    pub(super) fn failed(failure: Failure<S>, end: S, observed: O) -> Self {
        let unknown = f64::NAN;
        Orbit {
            outcome: Outcome::Failed,
            period: 0,
            certificate: Certificate::none(),
            exponent: Exponent { value: unknown, uncertainty: unknown },
            excluded: unknown,
            residual: unknown,
            defect: unknown,
            size: unknown,
            cycles: 0,
            measured_cycles: 0,
            duration: unknown,
            section: Vec::new(),
            begins: end,
            end,
            observed,
            failure: Some(failure),
        }
    }

    /// The same where its steps cannot be trusted: undecided, with no certificate and nothing that follows
    /// from one.
    pub(super) fn withdrawn(self) -> Self {
        let unknown = Exponent { value: f64::NAN, uncertainty: f64::NAN };
        // The exponent of an orbit is that of its multipliers, and goes with its certificate.
        let exponent = if self.outcome == Outcome::Periodic { unknown } else { self.exponent };
        Orbit {
            outcome: Outcome::Undecided,
            period: 0,
            certificate: Certificate::none(),
            exponent,
            excluded: f64::NAN,
            ..self
        }
    }

    /// The multipliers of its period, the largest magnitude first; NaN where they are not known.
    pub fn multipliers(&self) -> &[Complex; D] {
        &self.certificate.multipliers
    }
}
