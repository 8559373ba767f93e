//! From an orbit to the best one of its family: stationary within the bounds, or at the edge of the family.

use crate::capsule::{Output, Reading};
use crate::orbit::matrix::Complex;

use super::operating_point::{Family, OperatingPoint};
use super::optima::Direction;
use super::quadratic::{MOST, Quadratic, Vector, dot};

/// The relative slope at which an orbit counts as stationary.
pub const STATIONARY: f64 = 1e-8;
/// The first radius of trust, and the least, as shares of the ranges.
const TRUST: [f64; 2] = [0.05, 1e-10];
/// Steps at most.
const STEPS: usize = 200;
/// The step of the differences of exact gradients that give second derivatives, in units of the radius of trust, and the least
/// and greatest, as shares of the ranges.
const DIFFERENCE: f64 = 1e-2;
const DIFFERENCES: [f64; 2] = [1e-7, 1e-4];
/// A gain that is less than this, relative to the value, may be rounding: then the slope tells.
const NO_GAIN: f64 = 1e-9;
/// A trial must gain this share of what was foretold.
const GAIN: f64 = 1e-4;
/// Where no step gains any more, a slope above this is that of an edge of the family, and a lesser one rounding.
const AT_EDGE: f64 = 1e-4;
/// A multiplier this near to where an orbit ceases to be stable says why a family ends.
const CRITICAL: f64 = 1e-3;

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

/// What keeps an orbit from being better.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hold {
    /// Nothing: it is stationary.
    Interior,
    /// The lower or the upper bound of a free parameter, by its place.
    Bound(usize, Side),
    /// A multiplier of one: beyond it there is no such orbit.
    Fold,
    /// A multiplier of minus one: beyond it the orbit is not stable.
    PeriodDoubling,
    /// A pair of complex multipliers on the unit circle.
    NeimarkSacker,
    /// A corner, where the sequence of events changes, or a grazing, as far as no multiplier says otherwise.
    EventSequence,
    /// Nothing that is known: steps or rounding ended the search before the slope was small enough.
    Steps,
}

/// A side of a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Its lower end.
    Lower,
    /// Its upper end.
    Upper,
}

/// The best orbit found.
#[derive(Debug, Clone, PartialEq)]
pub struct Best {
    /// The orbit.
    pub at: OperatingPoint,
    /// The largest relative slope of the value that is left, for the whole range of a parameter, along directions that bounds
    /// and budget leave free [-].
    pub stationarity: f64,
    /// What holds it.
    pub held_by: Vec<Hold>,
}

/// Value, budget and their gradients at an orbit, relative to the first value and to the budget; both are to be small.
#[derive(Debug, Clone, Copy)]
struct Measured {
    value: f64,
    gradient: Vector,
    /// By how much the budget is exceeded, and the gradient of that.
    excess: Option<(f64, Vector)>,
}

struct Ascent<'a, R> {
    family: &'a Family<R>,
    goal: Goal,
    /// The magnitude of the first value.
    unit: f64,
}

/// The best orbit of a family for a goal, from an orbit of it; none where that is not stable or has no value.
///
/// # Method
///
/// Sequential quadratic programming in the shares of the free parameters: exact gradients, second derivatives of the
/// Lagrange function by central differences of them, the quadratic model solved exactly within the bounds, the budget and
/// a region of trust; a trial counts where its orbit exists, is stable and gains. The region shrinks where the family ends.
///
/// # Guarantees
///
/// The orbit is no worse than the first. Local: another start may lead to a better one.
pub fn best<R: Reading>(family: &Family<R>, first: OperatingPoint, goal: Goal) -> Option<Best> {
    let ascent = Ascent::from(family, &first, goal)?;
    let [mut trust, least] = TRUST;
    let mut at = first;
    for _ in 0..STEPS {
        let here = ascent.measured(&at);
        let multiplier = ascent.multiplier(&at, &here);
        let stationarity = ascent.stationarity(&at, &here, multiplier);
        if stationarity <= STATIONARY || trust < least {
            let held_by = ascent.holds(&at, &here, multiplier, stationarity);
            return Some(Best { at, stationarity, held_by });
        }
        let Some(found) = ascent.model(&at, &here, multiplier, trust).least() else {
            trust *= 0.25;
            continue;
        };
        let weight = 1.0 + 2.0 * found.multiplier.max(multiplier);
        let merit = |it: &Measured| it.value + weight * it.excess.map_or(0.0, |it| it.0.max(0.0));
        let shares = std::array::from_fn(|i| on_bound(at.shares[i] + found.step[i]));
        let length = found.step.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        let mut trial = family.moved(&at, &shares).map(|trial| (ascent.measured(&trial), trial));
        if let Some((there, passed)) = &trial
            && let Some(shares) = within_budget(there, &passed.shares)
            && let Some(corrected) = family.moved(passed, &shares)
        {
            trial = Some((ascent.measured(&corrected), corrected));
        }
        let gained = trial.as_ref().map(|(there, _)| merit(&here) - merit(there));
        let relieved = here.excess.map_or(0.0, |(excess, _)| weight * excess.max(0.0));
        let foretold = relieved - found.value;
        let accepts = |gained: f64, there: &Measured, trial: &OperatingPoint| {
            if foretold > NO_GAIN {
                return gained > GAIN * foretold;
            }
            let multiplier = ascent.multiplier(trial, there);
            ascent.stationarity(trial, there, multiplier) < 0.5 * stationarity
        };
        match (trial, gained) {
            (Some((there, trial)), Some(gained)) if accepts(gained, &there, &trial) => {
                if gained > 0.75 * foretold && length > 0.99 * trust {
                    trust = (2.0 * trust).min(1.0);
                } else if gained < 0.25 * foretold {
                    trust = 0.5 * length;
                }
                at = trial;
            }
            _ => trust = 0.25 * length.min(trust),
        }
    }
    let here = ascent.measured(&at);
    let multiplier = ascent.multiplier(&at, &here);
    let stationarity = ascent.stationarity(&at, &here, multiplier);
    let mut held_by = ascent.bounds(&at, &here, multiplier);
    held_by.push(Hold::Steps);
    Some(Best { at, stationarity, held_by })
}

/// The largest relative slope that is left at an orbit of a family, as in [`Best`], and what holds it of bounds alone; none
/// where the goal has no value there.
pub fn left<R: Reading>(
    family: &Family<R>,
    at: &OperatingPoint,
    goal: Goal,
) -> Option<(f64, Vec<Hold>)> {
    let ascent = Ascent::from(family, at, goal)?;
    let here = ascent.measured(at);
    let multiplier = ascent.multiplier(at, &here);
    let stationarity = ascent.stationarity(at, &here, multiplier);
    let mut held_by = ascent.bounds(at, &here, multiplier);
    if held_by.is_empty() && stationarity <= STATIONARY {
        held_by.push(Hold::Interior);
    }
    Some((stationarity, held_by))
}

impl<'a, R: Reading> Ascent<'a, R> {
    /// From an orbit of a family; none where the goal has no value there.
    fn from(family: &'a Family<R>, first: &OperatingPoint, goal: Goal) -> Option<Self> {
        let ascent = Ascent { family, goal, unit: 1.0 };
        let unit = ascent.value(first).abs();
        (unit > 0.0 && unit.is_finite()).then_some(Ascent { unit, ..ascent })
    }

    fn count(&self) -> usize {
        self.family.free.len()
    }

    /// What is to be small, in SI.
    fn value(&self, at: &OperatingPoint) -> f64 {
        match self.goal {
            Goal::Speed { direction, .. } => -direction.of(at.outputs[Output::ProgressionSpeed]),
            Goal::Least(output) => at.outputs[output],
        }
    }

    fn measured(&self, at: &OperatingPoint) -> Measured {
        let slopes = |output: Output, factor: f64| -> Vector {
            at.gradient(output, self.count()).map(|slope| slope * factor)
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

    /// The slope along a parameter as far as its bounds let the orbit go down it.
    fn downhill(&self, at: &OperatingPoint, slope: &Vector) -> Vector {
        std::array::from_fn(|i| {
            let held =
                at.shares[i] <= 0.0 && slope[i] > 0.0 || at.shares[i] >= 1.0 && slope[i] < 0.0;
            if held { 0.0 } else { slope[i] }
        })
    }

    /// The multiplier of the budget that leaves the least slope; zero where the budget is not reached.
    fn multiplier(&self, at: &OperatingPoint, here: &Measured) -> f64 {
        let Some((excess, normal)) = here.excess else { return 0.0 };
        if excess < -STATIONARY {
            return 0.0;
        }
        // The slope that is left is convex in the multiplier, and its square has this half derivative.
        let falls = |multiplier: f64| {
            let slope = self.downhill(at, &lagrange(here, &normal, multiplier));
            dot(&slope, &normal) < 0.0
        };
        let (mut low, mut high) = (0.0, 1.0);
        while falls(high) && high < 1e12 {
            high *= 2.0;
        }
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if falls(middle) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    fn stationarity(&self, at: &OperatingPoint, here: &Measured, multiplier: f64) -> f64 {
        let (excess, normal) = here.excess.unwrap_or((0.0, [0.0; MOST]));
        let slope = self.downhill(at, &lagrange(here, &normal, multiplier));
        slope.iter().fold(excess.max(0.0), |most, part| most.max(part.abs()))
    }

    /// The quadratic model within the region of trust.
    fn model(
        &self,
        at: &OperatingPoint,
        here: &Measured,
        multiplier: f64,
        trust: f64,
    ) -> Quadratic {
        let count = self.count();
        let bound = |side: f64| -> Vector {
            std::array::from_fn(|i| {
                let room = if side < 0.0 { -at.shares[i] } else { 1.0 - at.shares[i] };
                if i < count { room.clamp(-trust, trust) } else { 0.0 }
            })
        };
        let bounds = [bound(-1.0), bound(1.0)];
        let plane = here.excess.map(|(excess, normal)| {
            let deepest: f64 =
                (0..count).map(|i| (normal[i] * bounds[0][i]).min(normal[i] * bounds[1][i])).sum();
            // Where the region of trust does not reach the budget, most of the distance to it is gone.
            (normal, (-excess).max(0.8 * deepest))
        });
        let hessian = self.hessian(at, multiplier, trust);
        Quadratic { count, gradient: here.gradient, hessian, bounds, plane }
    }

    /// The second derivatives of the Lagrange function; zero where the family does not reach far enough to tell.
    fn hessian(&self, at: &OperatingPoint, multiplier: f64, trust: f64) -> [Vector; MOST] {
        let [least, most] = DIFFERENCES;
        let by = (DIFFERENCE * trust).clamp(least, most);
        let slope = |shares: &Vector| -> Option<Vector> {
            let here = self.measured(&self.family.moved(at, shares)?);
            let normal = here.excess.map_or([0.0; MOST], |(_, normal)| normal);
            Some(lagrange(&here, &normal, multiplier))
        };
        let mut rows = [[0.0; MOST]; MOST];
        for i in 0..self.count() {
            let shifted = |by: f64| {
                let mut shares = at.shares;
                shares[i] += by;
                slope(&shares)
            };
            let pair = [by, -by].map(shifted);
            if let [Some(ahead), Some(behind)] = pair {
                rows[i] = std::array::from_fn(|j| (ahead[j] - behind[j]) / (2.0 * by));
            }
        }
        std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (rows[i][j] + rows[j][i])))
    }

    fn holds(
        &self,
        at: &OperatingPoint,
        here: &Measured,
        multiplier: f64,
        stationarity: f64,
    ) -> Vec<Hold> {
        let mut holds = self.bounds(at, here, multiplier);
        if stationarity > AT_EDGE {
            holds.push(edge(&at.multipliers));
        } else if stationarity > STATIONARY {
            holds.push(Hold::Steps);
        }
        if holds.is_empty() {
            holds.push(Hold::Interior);
        }
        holds
    }

    /// The bounds that hold an orbit.
    fn bounds(&self, at: &OperatingPoint, here: &Measured, multiplier: f64) -> Vec<Hold> {
        let normal = here.excess.map_or([0.0; MOST], |(_, normal)| normal);
        let slope = lagrange(here, &normal, multiplier);
        let held = (0..self.count()).filter_map(|i| match at.shares[i] {
            share if share <= 0.0 && slope[i] > STATIONARY => Some(Hold::Bound(i, Side::Lower)),
            share if share >= 1.0 && slope[i] < -STATIONARY => Some(Hold::Bound(i, Side::Upper)),
            _ => None,
        });
        held.collect()
    }
}

/// The nearest shares at which the budget is met, as its gradient tells, from some that exceed it; none where they do not.
fn within_budget(there: &Measured, shares: &Vector) -> Option<Vector> {
    let (excess, normal) = there.excess?;
    let steep = dot(&normal, &normal);
    (excess > 0.0 && steep > 0.0)
        .then(|| std::array::from_fn(|i| on_bound(shares[i] - normal[i] * excess / steep)))
}

/// A share of a range; what rounding leaves before a bound is on it.
fn on_bound(share: f64) -> f64 {
    let near = 4.0 * f64::EPSILON;
    if share < near {
        0.0
    } else if share > 1.0 - near {
        1.0
    } else {
        share
    }
}

/// The gradient of the Lagrange function.
fn lagrange(here: &Measured, normal: &Vector, multiplier: f64) -> Vector {
    std::array::from_fn(|i| here.gradient[i] + multiplier * normal[i])
}

/// Why a family ends beside an orbit.
fn edge(multipliers: &[Complex; 3]) -> Hold {
    let critical = multipliers.iter().find(|it| it.abs() > 1.0 - CRITICAL);
    match critical {
        Some(it) if it.im != 0.0 => Hold::NeimarkSacker,
        Some(it) if it.re > 0.0 => Hold::Fold,
        Some(_) => Hold::PeriodDoubling,
        None => Hold::EventSequence,
    }
}
