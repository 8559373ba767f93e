//! What a search makes small, and what it may spend, relative to where it began.

use crate::capsule::Output;

use super::operating_point::OperatingPoint;
use super::optima::Direction;
use super::quadratic::Vector;

/// What is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// The most speed for no more than a price, if one is given (SI).
    Speed {
        /// The direction in which speed counts.
        direction: Direction,
        /// The output that is the price, and the most of it.
        budget: Option<(Output, f64)>,
    },
    /// The least of an output.
    Least(Output),
}

/// A goal over so many free parameters, relative to the first value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Objective {
    goal: Goal,
    /// Free parameters.
    pub count: usize,
    /// The magnitude of the first value.
    unit: f64,
}

/// Value, budget and their gradients at an orbit, relative to the first value and to the budget; both are to be small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Its gradient in the shares.
    pub gradient: Vector,
    /// By how much the budget is exceeded, and the gradient of that.
    pub excess: Option<(f64, Vector)>,
}

impl Objective {
    /// A goal relative to its value at the first orbit; none where it has none there.
    pub fn from(goal: Goal, count: usize, first: &OperatingPoint) -> Option<Self> {
        let objective = Objective { goal, count, unit: 1.0 };
        let unit = objective.value(first).abs();
        (unit > 0.0 && unit.is_finite()).then_some(Objective { unit, ..objective })
    }

    /// What is to be small, in SI.
    fn value(&self, at: &OperatingPoint) -> f64 {
        match self.goal {
            Goal::Speed { direction, .. } => -direction.of(at.outputs[Output::ProgressionSpeed]),
            Goal::Least(output) => at.outputs[output],
        }
    }

    /// Value, budget and their gradients at an orbit.
    pub fn measured(&self, at: &OperatingPoint) -> Measured {
        let slopes = |output: Output, factor: f64| -> Vector {
            at.gradient(output, self.count).map(|slope| slope * factor)
        };
        let (gradient, budget) = match self.goal {
            Goal::Speed { direction, budget } => {
                let speed = at.outputs[Output::ProgressionSpeed];
                let sign = if direction.of(speed) == speed { 1.0 } else { -1.0 };
                (slopes(Output::ProgressionSpeed, -sign / self.unit), budget)
            }
            Goal::Least(output) => (slopes(output, 1.0 / self.unit), None),
        };
        let excess = budget
            .map(|(output, most)| (at.outputs[output] / most - 1.0, slopes(output, 1.0 / most)));
        Measured { value: self.value(at) / self.unit, gradient, excess }
    }
}

impl Measured {
    /// The gradient of the Lagrange function with this multiplier of the budget.
    pub fn lagrange(&self, multiplier: f64) -> Vector {
        let normal = self.normal();
        std::array::from_fn(|i| self.gradient[i] + multiplier * normal[i])
    }

    /// The gradient of the budget; zero where there is none.
    fn normal(&self) -> Vector {
        self.excess.map_or(Vector::default(), |(_, normal)| normal)
    }
}
