//! A periodic orbit at some values of free parameters, with the derivatives of what a trade-off is between.

use crate::branch::cyclic;
use crate::capsule::{CapsuleSystem, EventKind, Output, Outputs, Parameter, Reading, Section};
use crate::flow::{Event, System};
use crate::orbit::matrix::{Complex, eigenvalues};
use crate::orbit::newton::close;
use crate::orbit::passage::{Integrator, OneByOne, ReturnRequest, image};
use crate::orbit::return_map::Cycles;

use super::limit::Limit;
use super::quadratic::{MOST, Vector};
use super::sensitivity::sensitivity;

/// An orbit closes to this residual, relative to the motion; a larger one is seen in the outputs, and they in the search.
const EXACT: f64 = 1e-11;
/// How often Newton's method is begun again from the image of the point where it has ended, as beside a kink of the return
/// map it may end early.
const AGAIN: usize = 4;

/// A family of periodic orbits over free parameters, each between two bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Family<R> {
    /// The capsule with the parameters that are held.
    pub system: CapsuleSystem<R>,
    /// The free parameters with their bounds, at most [`MOST`].
    pub free: Vec<(Parameter, [f64; 2])>,
    /// Limits of outputs within which an orbit is sought that is best, at most [`MOST_LIMITS`](super::MOST_LIMITS).
    pub limits: Vec<Limit>,
    /// Period of the orbits [cycles].
    pub period: u64,
    /// Relative local error of a step.
    pub tolerance: f64,
}

/// A stable orbit of a family.
#[derive(Debug, Clone, PartialEq)]
pub struct OperatingPoint {
    /// The free parameters as shares of the ranges between their bounds.
    pub shares: Vector,
    /// The section point.
    pub section: Section,
    /// The multipliers, the largest magnitude first.
    pub multipliers: [Complex; 3],
    /// The cyclic sequence of events.
    pub events: Vec<EventKind>,
    /// The outputs that change with parameters (SI).
    pub outputs: Outputs,
    /// The derivatives of the section point in the shares.
    pub section_slopes: [Section; MOST],
    /// The derivatives of the outputs in the shares.
    pub slopes: [Outputs; MOST],
}

impl OperatingPoint {
    /// How often the mass meets the stop in a period.
    pub fn impacts(&self) -> usize {
        self.events.iter().filter(|event| event.is_impact()).count()
    }

    /// How far it is from another, in shares of the ranges: the most of a parameter.
    pub fn apart(&self, other: &OperatingPoint) -> f64 {
        let pairs = self.shares.iter().zip(&other.shares);
        pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
    }

    /// The derivatives of an output in the shares.
    pub fn gradient(&self, output: Output, count: usize) -> Vector {
        std::array::from_fn(|i| if i < count { self.slopes[i][output] } else { 0.0 })
    }
}

impl<R: Reading> Family<R> {
    /// The value of the `place`th free parameter at a share of its range.
    pub fn value(&self, place: usize, share: f64) -> f64 {
        let [low, high] = self.free[place].1;
        if share == 1.0 { high } else { low + share * (high - low) }
    }

    /// The shares of the parameters of the system.
    pub fn shares(&self) -> Vector {
        std::array::from_fn(|place| {
            self.free.get(place).map_or(0.0, |(parameter, [low, high])| {
                (self.system.value(*parameter) - low) / (high - low)
            })
        })
    }

    /// The capsule at these shares.
    pub fn at(&self, shares: &Vector) -> CapsuleSystem<R> {
        let mut system = self.system.clone();
        for (place, (parameter, _)) in self.free.iter().enumerate() {
            system.parameters[*parameter] = self.value(place, shares[place]);
        }
        system
    }

    /// The stable orbit at these shares near a section point; none where there is none.
    ///
    /// # Method
    ///
    /// Newton's method on the return map, down to rounding, then [`sensitivity`] in each parameter.
    pub fn orbit(&self, shares: &Vector, guess: &Section) -> Option<OperatingPoint> {
        let system = self.at(shares);
        let metric = system.metric();
        let cycles = Cycles { count: self.period, tolerance: self.tolerance };
        let size = metric.size(guess).max(system.expected_size());
        let image_of = |point: &Section| image(&OneByOne, &system, point, &cycles);
        let closed_near =
            |guess: &Section| close(image_of, self.period, &metric, guess, size).ok().flatten();
        let mut closed = closed_near(guess)?;
        for _ in 0..AGAIN {
            if closed.residual <= EXACT {
                break;
            }
            closed = closed_near(&image_of(&closed.point).ok()?.end)?;
        }
        let multipliers = eigenvalues(&closed.jacobian);
        let is_stable = multipliers[0].abs() < 1.0;
        if closed.residual > EXACT || !is_stable {
            return None;
        }
        let section = closed.point;
        let passed = OneByOne.passage(ReturnRequest {
            system: system.clone(),
            along: None,
            point: section,
            units: [1.0; 3],
            cycles,
            watched: true,
        });
        let mut point = OperatingPoint {
            shares: *shares,
            section,
            multipliers,
            events: cyclic(&passed.ok()?.events),
            outputs: Outputs::unknown(),
            section_slopes: [[0.0; 3]; MOST],
            slopes: [Outputs::unknown(); MOST],
        };
        for (place, (parameter, [low, high])) in self.free.iter().enumerate() {
            let found = sensitivity(&system, (&section, self.period), self.tolerance, *parameter)?;
            let range = high - low;
            point.outputs = found.outputs;
            point.section_slopes[place] = found.section_slope.map(|slope| slope * range);
            point.slopes[place] = found.slopes.map(|slope| slope * range);
        }
        Some(point)
    }

    /// The stable orbit at other shares, sought where that at `from` leads along its tangent.
    pub fn moved(&self, from: &OperatingPoint, shares: &Vector) -> Option<OperatingPoint> {
        let guess = std::array::from_fn(|coordinate| {
            let along = from.section_slopes.iter().zip(shares.iter().zip(&from.shares));
            let moved: f64 = along.map(|(slope, (to, at))| slope[coordinate] * (to - at)).sum();
            from.section[coordinate] + moved
        });
        self.orbit(shares, &guess)
    }
}
