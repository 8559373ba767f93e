//! What a search makes small, and what limits it, relative to where it began.

use super::hold::{Hold, Side};
use super::limit::Limit;
use super::operating_point::{Family, OperatingPoint};
use super::optima::Direction;
use super::quadratic::{LIMITS, Vector};
use crate::description::Output;
use crate::orbit::matrix::{dot, solve};

/// What is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// The most of an output for no more than a price, if one is given (SI).
    Most {
        /// The output, as the speed.
        gain: Output,
        /// The direction in which it counts.
        direction: Direction,
        /// The output that is the price, and the most of it.
        budget: Option<(Output, f64)>,
    },
    /// The least of an output.
    Least(Output),
}

/// The multipliers of limits, by their places; zero of those that do not hold.
pub type Multipliers = [f64; LIMITS];

/// A goal over so many free parameters, relative to the first value.
#[derive(Debug, Clone, PartialEq)]
pub struct Objective {
    goal: Goal,
    /// Free parameters.
    pub count: usize,
    /// The magnitude of the first value.
    unit: f64,
    /// The limits, the budget first if there is one, each with the size by which it is measured.
    limits: Vec<(Limit, f64)>,
}

/// An orbit with goal and limits there, relative to the first value and to the limits; all are to be small.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The orbit.
    pub orbit: OperatingPoint,
    /// The goal.
    pub goal: FirstOrder,
    /// By how much each limit is exceeded, negative where it is not.
    pub limits: Vec<FirstOrder>,
}

/// A quantity at an orbit, to first order in the shares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstOrder {
    /// Its value.
    pub value: f64,
    /// Its gradient in the shares.
    pub gradient: Vector,
}

impl Objective {
    /// A goal within the limits of a family, relative to its value at the first orbit; none where it or a limited output has
    /// none there.
    pub fn from(goal: Goal, family: &Family, first: &OperatingPoint) -> Option<Self> {
        let budget = match goal {
            Goal::Most { budget, .. } => budget.map(|(price, most)| Limit::budget(price, most)),
            Goal::Least(_) => None,
        };
        let limits = budget.into_iter().chain(family.limits.iter().copied());
        let limits = limits.map(|limit| Some((limit, size(limit, first)?)));
        let limits = limits.collect::<Option<Vec<_>>>()?;
        let objective = Objective { goal, count: family.free.len(), unit: 1.0, limits };
        let unit = objective.value(first).abs();
        (unit > 0.0 && unit.is_finite()).then_some(Objective { unit, ..objective })
    }

    /// What the limit at a place holds an orbit by; none of a budget.
    pub fn hold(&self, place: usize) -> Option<Hold> {
        let has_budget = matches!(self.goal, Goal::Most { budget: Some(_), .. });
        if has_budget { place.checked_sub(1).map(Hold::Limit) } else { Some(Hold::Limit(place)) }
    }

    /// What is to be small, in SI.
    fn value(&self, at: &OperatingPoint) -> f64 {
        match self.goal {
            Goal::Most { gain, direction, .. } => -direction.of(at.outputs[gain]),
            Goal::Least(output) => at.outputs[output],
        }
    }

    /// Goal and limits at an orbit.
    pub fn measured(&self, orbit: OperatingPoint) -> Measured {
        let (output, factor) = match self.goal {
            Goal::Most { gain, direction, .. } => {
                let value = orbit.outputs[gain];
                let sign = if direction.of(value) == value { 1.0 } else { -1.0 };
                (gain, -sign / self.unit)
            }
            Goal::Least(output) => (output, 1.0 / self.unit),
        };
        let goal = FirstOrder {
            value: self.value(&orbit) / self.unit,
            gradient: self.slopes(&orbit, output, factor),
        };
        let limits = self.limits.iter().map(|(limit, size)| self.excess(&orbit, limit, *size));
        Measured { goal, limits: limits.collect(), orbit }
    }

    /// By how much an orbit exceeds a limit, in units of its size.
    fn excess(&self, at: &OperatingPoint, limit: &Limit, size: f64) -> FirstOrder {
        let factor = if limit.side == Side::Upper { 1.0 } else { -1.0 } / size;
        let value = limit.excess(at.outputs[limit.output]) / size;
        // What is infinitely far from its limit, as grazing is of a motion that has no maximum, does not hold.
        let is_near = value.is_finite();
        let gradient =
            if is_near { self.slopes(at, limit.output, factor) } else { Vector::default() };
        FirstOrder { value, gradient }
    }

    /// The gradient of an output in the shares, times a factor.
    fn slopes(&self, at: &OperatingPoint, output: Output, factor: f64) -> Vector {
        at.gradient(output, self.count).map(|slope| slope * factor)
    }
}

/// The size by which a limit is measured, from the first orbit; none where the output has no value there.
fn size(limit: Limit, first: &OperatingPoint) -> Option<f64> {
    let sizes = [limit.value.abs(), first.outputs[limit.output].abs(), 1.0];
    sizes.into_iter().find(|size| *size > 0.0).filter(|size| size.is_finite())
}

impl Measured {
    /// The gradient of the Lagrange function with these multipliers of the limits.
    pub fn lagrange(&self, multipliers: &Multipliers) -> Vector {
        std::array::from_fn(|i| {
            let limits = self.limits.iter().zip(multipliers);
            self.goal.gradient[i] + limits.map(|(limit, by)| by * limit.gradient[i]).sum::<f64>()
        })
    }

    /// The sum of what limits are exceeded by, each with its weight.
    pub fn penalty(&self, weights: &Multipliers) -> f64 {
        let limits = self.limits.iter().zip(weights);
        limits.map(|(limit, weight)| weight * limit.value.max(0.0)).sum()
    }

    /// The value of the goal with the penalty of limits that are exceeded.
    pub fn merit(&self, weights: &Multipliers) -> f64 {
        self.goal.value + self.penalty(weights)
    }

    /// The most by which a limit is exceeded; zero where none is.
    pub fn most_excess(&self) -> f64 {
        self.limits.iter().fold(0.0, |most: f64, limit| most.max(limit.value))
    }

    /// The least step of the shares by which the limits are met that are exceeded, as their gradients tell; none where no limit is,
    /// or where the gradients depend on each other.
    pub fn back_to_limits(&self) -> Option<Vector> {
        let exceeded: Vec<&FirstOrder> = self.limits.iter().filter(|it| it.value > 0.0).collect();
        // The least step d with a d = -e for each excess e with gradient a: d = -A^T (A A^T)^-1 e.
        let (mut rows, mut right) = ([[0.0; LIMITS]; LIMITS], [0.0; LIMITS]);
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        for (i, limit) in exceeded.iter().enumerate() {
            for (j, other) in exceeded.iter().enumerate() {
                rows[i][j] = dot(&limit.gradient, &other.gradient);
            }
            right[i] = -limit.value;
        }
        let by = (!exceeded.is_empty()).then(|| solve(rows, right))??;
        Some(std::array::from_fn(|i| {
            exceeded.iter().zip(by).map(|(limit, by)| limit.gradient[i] * by).sum()
        }))
    }
}
