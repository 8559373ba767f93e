//! A segment of a branch: what becomes of a periodic orbit from one value of a parameter to another.

use crate::flow::{Metric, System};
use crate::orbit::matrix::Complex;

use super::SpecialKind;

/// Values of the parameter closer together than this, relative to them and for each cycle of the period, are one
/// value: each cycle adds its rounding to the orbit's.
pub const ONE_VALUE: f64 = 2e-13;

/// What is held while one parameter varies.
#[derive(Debug, Clone)]
pub struct Along<M: System<D>, const D: usize> {
    /// The system with the values of the other parameters.
    pub system: M,
    /// The parameter that varies.
    pub parameter: M::Parameter,
    /// Relative local error of a step of the integrator.
    pub tolerance: f64,
}

impl<M: System<D>, const D: usize> Along<M, D> {
    /// How far two section points are apart at a value of the parameter.
    pub fn metric(&self, value: f64) -> Metric<D> {
        self.system.with(self.parameter, value).metric()
    }
}

/// A periodic orbit at a value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicOrbit<const D: usize> {
    /// The value.
    pub value: f64,
    /// Its section points, one for each cycle of its period.
    pub points: Vec<[f64; D]>,
    /// Floquet multipliers of the period, the largest magnitude first.
    pub multipliers: [Complex; D],
    /// How far the section is from repeating, relative to the motion [-].
    pub residual: f64,
}

impl<const D: usize> PeriodicOrbit<D> {
    /// Whether small perturbations decay.
    pub fn is_stable(&self) -> bool {
        self.multipliers[0].abs() < 1.0
    }
}

/// A special point between two values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecialValue<const D: usize> {
    /// What happens.
    pub kind: SpecialKind,
    /// The value of the parameter.
    pub value: f64,
    /// How far the true value may be.
    pub uncertainty: f64,
    /// Period of the orbit [cycles].
    pub period: u64,
    /// Its section point.
    pub section: [f64; D],
    /// Whether the branch goes on with stable orbits.
    pub is_stable_beyond: bool,
}

/// How a segment ends.
#[derive(Debug, Clone, PartialEq)]
pub enum SegmentEnd<const D: usize> {
    /// At the other value, with this orbit.
    Reached(PeriodicOrbit<D>),
    /// Before: the branch turns back, or has a corner.
    Ended,
    /// Before: it runs into an orbit of half its period, which continues it.
    Merged,
    /// Before, and it is not known why: the cycles became too many, or the steps too short for an unstable orbit.
    Lost,
}

/// A segment of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment<const D: usize> {
    /// The special points up to the one at which the orbit ceases to be stable, or at which the branch ends.
    pub special: Vec<SpecialValue<D>>,
    /// How it ends.
    pub end: SegmentEnd<D>,
}
