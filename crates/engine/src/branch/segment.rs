//! A segment of a branch: what becomes of a periodic orbit from one value of a parameter to another.

use super::SpecialKind;
use crate::flow::{Metric, System};
use crate::orbit::Varied;
use crate::orbit::matrix::Complex;

/// Values of the parameter closer together than this, relative to them and for each cycle of the period, are one
/// value: each cycle adds its rounding to the orbit's.
pub const ONE_VALUE: f64 = 2e-13;

/// What is held while one parameter varies, or several in step.
#[derive(Debug, Clone)]
pub struct Along<M: System<D>, const D: usize> {
    /// The system with the values of the other parameters.
    pub system: M,
    /// What varies; what is called the value of the parameter is the number of this.
    pub varied: Varied<M::Parameter>,
    /// Relative local error of a step of the integrator.
    pub tolerance: f64,
}

impl<M: System<D>, const D: usize> Along<M, D> {
    /// How far two section points are apart at a value of the parameter.
    pub fn metric(&self, value: f64) -> Metric<D> {
        self.varied.of(&self.system, value).metric()
    }
}

/// A periodic orbit at a value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicOrbit<P> {
    /// The value.
    pub value: f64,
    /// Its section points, one for each cycle of its period.
    pub points: Vec<P>,
    /// Floquet multipliers of the period, the largest magnitude first.
    pub multipliers: Vec<Complex>,
    /// How far the section is from repeating, relative to the motion [-].
    pub residual: f64,
}

impl<P> PeriodicOrbit<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q) -> PeriodicOrbit<Q> {
        let PeriodicOrbit { value, points, multipliers, residual } = self;
        let points = points.into_iter().map(held).collect();
        PeriodicOrbit { value, points, multipliers, residual }
    }

    /// Whether small perturbations decay.
    pub fn is_stable(&self) -> bool {
        self.multipliers[0].abs() < 1.0
    }
}

/// A special point between two values of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecialValue<P> {
    /// What happens.
    pub kind: SpecialKind,
    /// The value of the parameter.
    pub value: f64,
    /// How far the true value may be.
    pub uncertainty: f64,
    /// Period of the orbit [cycles].
    pub period: u64,
    /// Its section point.
    pub section: P,
    /// Whether the branch goes on with stable orbits.
    pub is_stable_beyond: bool,
}

impl<P> SpecialValue<P> {
    /// The same with the section point held in another way.
    pub fn map<Q>(self, held: impl FnOnce(P) -> Q) -> SpecialValue<Q> {
        let SpecialValue { kind, value, uncertainty, period, section, is_stable_beyond } = self;
        let section = held(section);
        SpecialValue { kind, value, uncertainty, period, section, is_stable_beyond }
    }
}

/// How a segment ends.
#[derive(Debug, Clone, PartialEq)]
pub enum SegmentEnd<P> {
    /// At the other value, with this orbit.
    Reached(PeriodicOrbit<P>),
    /// Before: the branch turns back, or has a corner.
    Ended,
    /// Before: it runs into an orbit of half its period, which continues it.
    Merged,
    /// Before, and it is not known why: the cycles became too many, or the steps too short for an unstable orbit.
    Lost,
}

/// A segment of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment<P> {
    /// The special points up to the one at which the orbit ceases to be stable, or at which the branch ends.
    pub special: Vec<SpecialValue<P>>,
    /// How it ends.
    pub end: SegmentEnd<P>,
}

impl<P> Segment<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q + Copy) -> Segment<Q> {
        let end = match self.end {
            SegmentEnd::Reached(orbit) => SegmentEnd::Reached(orbit.map(held)),
            SegmentEnd::Ended => SegmentEnd::Ended,
            SegmentEnd::Merged => SegmentEnd::Merged,
            SegmentEnd::Lost => SegmentEnd::Lost,
        };
        Segment { special: self.special.into_iter().map(|it| it.map(held)).collect(), end }
    }
}
