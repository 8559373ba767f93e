//! A case, and what it has settled to.

use super::matrix::Complex;
use super::protocol::Outcome;
use super::{Certificate, Exponent, Failure, Spectrum};
use crate::flow::System;

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case<M: System<D>, const D: usize> {
    /// Its parameters.
    pub system: M,
    /// Where it starts.
    pub start: M::State<f64>,
    /// When it starts, after the last passage of the section [s]; zero where it starts at the section, as an
    /// autonomous system does.
    pub begins: f64,
}

impl<M: System<D>, const D: usize> Case<M, D> {
    /// A case that starts at its section.
    pub fn new(system: M, start: M::State<f64>) -> Self {
        Case { system, start, begins: 0.0 }
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
    pub certificate: Certificate<[f64; D]>,
    /// Its largest Lyapunov exponent, where it is known.
    pub exponent: Exponent,
    /// All of them, where they are asked for and known.
    pub spectrum: Option<Spectrum<D>>,
    /// The longest period that is excluded, with all shorter ones [cycles]; NaN where none is known.
    pub excluded: f64,
    /// How far the section is from repeating after the period, relative to the motion [-].
    pub residual: f64,
    /// The largest defect of a step of the measured cycles, times its length and relative to the motion [-].
    pub defect: f64,
    /// Size of the motion at the section, in the units of the metric.
    pub size: f64,
    /// Cycles followed since the first section, measuring included.
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
    /// What had been observed at the end of each batch of them, see [`batch_ends`]; none of a periodic orbit.
    ///
    /// [`batch_ends`]: super::measuring::batch_ends
    pub batches: Vec<O>,
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
            spectrum: None,
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
            batches: Vec::new(),
            failure: Some(failure),
        }
    }

    /// The same where its steps or its balance cannot be trusted: undecided, with no certificate and nothing that follows
    /// from one.
    pub fn withdrawn(self) -> Self {
        let unknown = Exponent { value: f64::NAN, uncertainty: f64::NAN };
        // The exponent of an orbit is that of its multipliers, and goes with its certificate.
        let (exponent, spectrum) = match self.outcome {
            Outcome::Periodic => (unknown, None),
            _ => (self.exponent, self.spectrum),
        };
        Orbit {
            outcome: Outcome::Undecided,
            period: 0,
            certificate: Certificate::none(),
            exponent,
            spectrum,
            excluded: f64::NAN,
            ..self
        }
    }

    /// The multipliers of its period, the largest magnitude first; NaN where they are not known.
    pub fn multipliers(&self) -> &[Complex] {
        &self.certificate.multipliers
    }
}
