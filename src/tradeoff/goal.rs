//! What a search makes small, and what limits it, relative to where it began.

use super::hold::Side;
use super::limit::Limit;
use super::operating_point::OperatingPoint;
use super::optima::Direction;
use super::quadratic::{LIMITS, Vector};
use crate::description::Output;
use crate::orbit::matrix::{dot, solve};

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

/// Value, limits and their gradients at an orbit, relative to the first value and to the limits; all are to be small.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Its gradient in the shares.
    pub gradient: Vector,
    /// By how much each limit is exceeded, negative where it is not, and the gradient of that.
    pub excess: Vec<(f64, Vector)>,
}

impl Objective {
    /// A goal within limits, relative to its value at the first orbit; none where it or a limited output has none there.
    pub fn from(
        goal: Goal,
        limits: &[Limit],
        (count, first): (usize, &OperatingPoint),
    ) -> Option<Self> {
        let budget = match goal {
            Goal::Speed { budget, .. } => budget.map(Limit::budget),
            Goal::Least(_) => None,
        };
        let measured = |limit: Limit| {
            let sizes = [limit.value.abs(), first.outputs[limit.output].abs(), 1.0];
            let size = sizes.into_iter().find(|size| *size > 0.0)?;
            size.is_finite().then_some((limit, size))
        };
        let limits = budget.into_iter().chain(limits.iter().copied()).map(measured);
        let limits = limits.collect::<Option<Vec<_>>>()?;
        let objective = Objective { goal, count, unit: 1.0, limits };
        let unit = objective.value(first).abs();
        (unit > 0.0 && unit.is_finite()).then_some(Objective { unit, ..objective })
    }

    /// Whether the first limit is a budget.
    pub fn has_budget(&self) -> bool {
        matches!(self.goal, Goal::Speed { budget: Some(_), .. })
    }

    /// What is to be small, in SI.
    fn value(&self, at: &OperatingPoint) -> f64 {
        match self.goal {
            Goal::Speed { direction, .. } => -direction.of(at.outputs.speed()),
            Goal::Least(output) => at.outputs[output],
        }
    }

    /// Value, limits and their gradients at an orbit.
    pub fn measured(&self, at: &OperatingPoint) -> Measured {
        let slopes = |output: Output, factor: f64| -> Vector {
            at.gradient(output, self.count).map(|slope| slope * factor)
        };
        let gradient = match self.goal {
            Goal::Speed { direction, .. } => {
                let speed = at.outputs.speed();
                let sign = if direction.of(speed) == speed { 1.0 } else { -1.0 };
                slopes(at.outputs.model().speed(), -sign / self.unit)
            }
            Goal::Least(output) => slopes(output, 1.0 / self.unit),
        };
        let excess = |(limit, size): &(Limit, f64)| {
            let factor = if limit.side == Side::Upper { 1.0 } else { -1.0 } / size;
            let excess = limit.excess(at.outputs[limit.output]) / size;
            // What is infinitely far from its limit, as grazing is of a motion that has no maximum, does not hold.
            let is_near = excess.is_finite();
            (excess, if is_near { slopes(limit.output, factor) } else { Vector::default() })
        };
        let excess = self.limits.iter().map(excess).collect();
        Measured { value: self.value(at) / self.unit, gradient, excess }
    }
}

impl Measured {
    /// The gradient of the Lagrange function with these multipliers of the limits.
    pub fn lagrange(&self, multipliers: &Multipliers) -> Vector {
        let with = |i: usize| {
            let limits = self.excess.iter().zip(multipliers);
            self.gradient[i] + limits.map(|((_, normal), by)| by * normal[i]).sum::<f64>()
        };
        std::array::from_fn(with)
    }

    /// The most by which a limit is exceeded; zero where none is.
    pub fn most_excess(&self) -> f64 {
        self.excess.iter().fold(0.0, |most: f64, (excess, _)| most.max(*excess))
    }

    /// The least step of the shares by which the limits are met that are exceeded, as their gradients tell; none where no limit is,
    /// or where the gradients depend on each other.
    pub fn back_to_limits(&self) -> Option<Vector> {
        let exceeded: Vec<&(f64, Vector)> = self.excess.iter().filter(|it| it.0 > 0.0).collect();
        // The least step d with a d = -e for each excess e with gradient a: d = -A^T (A A^T)^-1 e.
        let (mut rows, mut right) = ([[0.0; LIMITS]; LIMITS], [0.0; LIMITS]);
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        for (i, (excess, normal)) in exceeded.iter().enumerate() {
            for (j, (_, other)) in exceeded.iter().enumerate() {
                rows[i][j] = dot(normal, other);
            }
            right[i] = -excess;
        }
        let by = (!exceeded.is_empty()).then(|| solve(rows, right))??;
        let moved =
            |i: usize| exceeded.iter().zip(by).map(|((_, normal), by)| normal[i] * by).sum();
        Some(std::array::from_fn(moved))
    }
}
