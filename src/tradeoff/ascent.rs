//! From an orbit to the best one of its family: stationary within the bounds, or where the family or its outputs have an edge.

use crate::orbit::matrix::norm;

use super::beyond::Beyond;
use super::goal::{Goal, Measured, Multipliers, Objective};
use super::hold::{Hold, Side};
use super::operating_point::{Family, OperatingPoint};
use super::quadratic::{MOST, Quadratic, Vector};
use super::slope;
use super::surface::Surface;

/// The relative slope at which an orbit counts as stationary.
pub const STATIONARY: f64 = 1e-8;
/// The first radius of trust, and the least, as shares of the ranges.
const TRUST: [f64; 2] = [0.05, 1e-10];
/// Steps at most.
const STEPS: usize = 500;
/// The step of the differences of exact gradients that give second derivatives, in units of the radius of trust, and the least
/// and greatest, as shares of the ranges.
const DIFFERENCE: f64 = 1e-2;
const DIFFERENCES: [f64; 2] = [1e-7, 1e-4];
/// Where it is better beyond a surface, the search goes on from an orbit there that is this near, in shares of the ranges.
const PASSES: f64 = 4e-9;
/// A gain that is less than this, relative to the value, may be rounding: then the slope tells.
const NO_GAIN: f64 = 1e-13;
/// A trial must gain this share of what was foretold.
const GAIN: f64 = 1e-4;
/// Where no step gains any more, a slope above this is that of an edge of the family, and a lesser one rounding.
const AT_EDGE: f64 = 1e-4;
/// A surface this near holds an orbit, in shares of the ranges.
const TOUCHES: f64 = 1e-9;
/// A share this near to a bound is on it: bringing an orbit back to its limits may move it off by rounding.
const ON_BOUND: f64 = 1e-13;
/// Steps end so far before a surface, where rounding does not yet mix the derivatives of its two sides.
const CLEAR: f64 = 1e-10;

/// The best orbit found.
#[derive(Debug, Clone, PartialEq)]
pub struct Best {
    /// The orbit.
    pub at: OperatingPoint,
    /// The largest relative slope of the value that is left, for the whole range of a parameter, along directions that bounds,
    /// limits and surfaces leave free [-].
    pub stationarity: f64,
    /// What holds it.
    pub held_by: Vec<Hold>,
}

struct Ascent<'a> {
    family: &'a Family,
    objective: Objective,
    /// Where events change.
    beyond: Beyond<'a>,
}

/// The slope at an orbit.
struct Slope {
    /// As in [`Best`].
    left: f64,
    /// The multipliers of the limits; zero of those that are not reached.
    limits: Multipliers,
    /// The bounds, limits and surfaces that hold the orbit, a budget aside.
    held_by: Vec<Hold>,
    /// The places of near surfaces beyond which it is better.
    passes: Vec<usize>,
}

/// A step of the quadratic model.
struct Step {
    /// The step.
    step: Vector,
    /// The value there, relative to here.
    value: f64,
    /// The multipliers of the limits; zero of those that do not hold the step.
    limits: Multipliers,
}

/// The best orbit of a family for a goal within its limits, from an orbit of it; none where the goal has no value there.
///
/// # Method
///
/// Sequential quadratic programming in the shares of the free parameters: exact gradients, second derivatives of the
/// Lagrange function by central differences of them, the quadratic model solved exactly within the bounds, the limits and
/// a region of trust; a trial counts where its orbit exists, is stable and gains. The region shrinks where the family ends.
/// Where the sequence of events changes, outputs have a kink: the surface of the parameters between two orbits with
/// different events bounds the model, as long as the value would become worse beyond it.
///
/// # Guarantees
///
/// The orbit is no worse than the first, but for 1e-8 where a surface is passed. Local: another start may lead to a better one.
pub fn best(family: &Family, first: OperatingPoint, goal: Goal) -> Option<Best> {
    let mut ascent = Ascent::from(family, &first, goal)?;
    let [mut trust, least] = TRUST;
    let mut at = first;
    let mut known = Vec::new();
    let mut has_switched = false;
    for _ in 0..STEPS {
        let here = ascent.objective.measured(&at);
        let surfaces = ascent.beyond.located(&at, &here, trust);
        let slope = ascent.slope((&at, &here), &surfaces, 0.0);
        if slope.left <= STATIONARY || trust < least {
            let held_by = ascent.holds(&at, &slope);
            return Some(Best { at, stationarity: slope.left, held_by });
        }
        // What a step within the region of trust may reach holds it.
        let near = ascent.slope((&at, &here), &surfaces, trust);
        let passed = near.passes.iter().map(|i| &surfaces[*i]).find(|it| it.reach <= PASSES);
        if let Some(surface) = passed.filter(|_| !has_switched) {
            has_switched = true;
            at = surface.beyond.clone();
            continue;
        }
        let found = ascent.step((&at, &here), &near.limits, &surfaces, trust);
        // Before a limit that is exceeded there may be no room on this side of a surface.
        let alone = || {
            let has_surfaces = !surfaces.is_empty();
            has_surfaces.then(|| ascent.step((&at, &here), &near.limits, &[], trust))?
        };
        let Some(found) = found.or_else(alone) else {
            trust *= 0.25;
            continue;
        };
        let weights: Multipliers =
            std::array::from_fn(|i| 1.0 + 2.0 * found.limits[i].max(near.limits[i]));
        let exceeded = |it: &Measured| -> f64 {
            let parts = it.excess.iter().zip(weights);
            parts.map(|((excess, _), weight)| weight * excess.max(0.0)).sum()
        };
        let merit = |it: &Measured| it.value + exceeded(it);
        let length = found.step.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        let trial = ascent.trial(&at, &found.step);
        let foretold = exceeded(&here) - found.value;
        let Some((there, trial)) = trial else {
            trust = 0.25 * length.min(trust);
            continue;
        };
        let gained = merit(&here) - merit(&there);
        let is_new = trial.events != at.events && !known.contains(&trial.events);
        ascent.beyond.remember(&at, &trial);
        let accepted = if foretold > NO_GAIN {
            gained > GAIN * foretold
        } else {
            let surfaces = ascent.beyond.near(&trial, &there, trust);
            ascent.slope((&trial, &there), &surfaces, 0.0).left < 0.5 * slope.left
        };
        if accepted {
            if gained > 0.75 * foretold && length > 0.99 * trust {
                trust = (2.0 * trust).min(1.0);
            } else if gained < 0.25 * foretold {
                trust = 0.5 * length;
            }
            at = trial;
            known.clear();
            has_switched = false;
        } else if is_new {
            // The same step is tried again before the surface that it has passed.
            known.push(trial.events);
        } else if foretold <= NO_GAIN && length < 0.9 * trust {
            // The whole step of the model gains no more than rounding.
            let is_kinked = |it: &Hold| matches!(it, Hold::Grazing | Hold::EventSequence);
            let mut held_by = ascent.holds(&at, &slope);
            if slope.left > STATIONARY && slope.held_by.iter().any(is_kinked) {
                // At a kink a slope that is left is none of an edge.
                held_by = [slope.held_by, vec![Hold::Steps]].concat();
            }
            return Some(Best { at, stationarity: slope.left, held_by });
        } else {
            trust = 0.25 * length.min(trust);
            known.clear();
        }
    }
    let here = ascent.objective.measured(&at);
    let surfaces = ascent.beyond.near(&at, &here, trust);
    let Slope { left, mut held_by, .. } = ascent.slope((&at, &here), &surfaces, 0.0);
    held_by.push(Hold::Steps);
    Some(Best { at, stationarity: left, held_by })
}

/// The largest relative slope that is left at an orbit of a family, as in [`Best`], and what holds it of bounds alone; none
/// where the goal has no value there.
pub fn left(family: &Family, at: &OperatingPoint, goal: Goal) -> Option<(f64, Vec<Hold>)> {
    let ascent = Ascent::from(family, at, goal)?;
    let Slope { left, mut held_by, .. } =
        ascent.slope((at, &ascent.objective.measured(at)), &[], 0.0);
    if held_by.is_empty() && left <= STATIONARY {
        held_by.push(Hold::Interior);
    }
    Some((left, held_by))
}

impl<'a> Ascent<'a> {
    /// From an orbit of a family; none where the goal has no value there.
    fn from(family: &'a Family, first: &OperatingPoint, goal: Goal) -> Option<Self> {
        let objective = Objective::from(goal, &family.limits, (family.free.len(), first))?;
        let beyond = Beyond::of(family, objective.clone());
        Some(Ascent { family, objective, beyond })
    }

    /// The orbit a step away, then brought back to the limits that are exceeded; none where the family does not reach.
    fn trial(&self, at: &OperatingPoint, step: &Vector) -> Option<(Measured, OperatingPoint)> {
        let measured = |it: OperatingPoint| (self.objective.measured(&it), it);
        let shares = std::array::from_fn(|i| on_bound(at.shares[i] + step[i]));
        let (there, passed) = self.family.moved(at, &shares).map(measured)?;
        let corrected = there
            .back_to_limits()
            .map(|by| std::array::from_fn(|i| on_bound(passed.shares[i] + by[i])))
            .and_then(|shares| self.family.moved(&passed, &shares))
            .map(measured);
        Some(corrected.unwrap_or((there, passed)))
    }

    /// The slope that bounds, limits and surfaces leave which touch the orbit, or are so near [shares].
    fn slope(
        &self,
        (at, here): (&OperatingPoint, &Measured),
        surfaces: &[Surface],
        near: f64,
    ) -> Slope {
        let mut constraints: Vec<(Option<Hold>, Vector)> = Vec::new();
        let is_near =
            |(excess, normal): &(f64, Vector)| -excess <= STATIONARY + near * norm(normal);
        let limits: Vec<usize> =
            (0..here.excess.len()).filter(|&place| is_near(&here.excess[place])).collect();
        let hold = |place: usize| match self.objective.has_budget() {
            true => place.checked_sub(1).map(Hold::Limit),
            false => Some(Hold::Limit(place)),
        };
        constraints.extend(limits.iter().map(|&place| (hold(place), here.excess[place].1)));
        for place in 0..self.objective.count {
            let outward = |sign: f64| std::array::from_fn(|i| if i == place { sign } else { 0.0 });
            if at.shares[place] <= near {
                constraints.push((Some(Hold::Bound(place, Side::Lower)), outward(-1.0)));
            }
            if at.shares[place] >= 1.0 - near {
                constraints.push((Some(Hold::Bound(place, Side::Upper)), outward(1.0)));
            }
        }
        let fixed = constraints.len();
        let (mut touching, mut passes) = (Vec::new(), Vec::new());
        touching.extend(
            (0..surfaces.len())
                .filter(|&i| surfaces[i].distance <= TOUCHES + near && surfaces[i].is_located()),
        );
        loop {
            constraints.truncate(fixed);
            let of_surface = |&i: &usize| (Some(surfaces[i].hold), surfaces[i].normal);
            constraints.extend(touching.iter().map(of_surface));
            let normals: Vec<Vector> = constraints.iter().map(|(_, normal)| *normal).collect();
            let (slope, multipliers) = slope::left(&here.gradient, &normals);
            let mut of_limits = Multipliers::default();
            limits.iter().zip(&multipliers).for_each(|(&place, &by)| of_limits[place] = by);
            let count = passes.len();
            passes.extend(touching.iter().filter(|&&i| surfaces[i].lets_pass(&of_limits)));
            if passes.len() > count {
                touching.retain(|place| !passes.contains(place));
                continue;
            }
            let left = slope.iter().fold(here.most_excess(), |most, part| most.max(part.abs()));
            let holding = constraints.iter().zip(&multipliers);
            let holding = holding.filter(|(_, multiplier)| **multiplier > STATIONARY);
            let held_by = holding.filter_map(|((hold, _), _)| *hold).collect();
            return Slope { left, limits: of_limits, held_by, passes };
        }
    }

    /// Where the quadratic model is least within the region of trust; none where there is no room.
    fn step(
        &self,
        (at, here): (&OperatingPoint, &Measured),
        multipliers: &Multipliers,
        surfaces: &[Surface],
        trust: f64,
    ) -> Option<Step> {
        let count = self.objective.count;
        let bound = |side: f64| -> Vector {
            std::array::from_fn(|i| {
                let room = if side < 0.0 { -at.shares[i] } else { 1.0 - at.shares[i] };
                if i < count { room.clamp(-trust, trust) } else { 0.0 }
            })
        };
        let bounds = [bound(-1.0), bound(1.0)];
        let extreme = |normal: &Vector, sign: f64| -> f64 {
            let ends = (0..count).map(|i| [0, 1].map(|side| sign * normal[i] * bounds[side][i]));
            sign * ends.map(|[low, high]| low.max(high)).sum::<f64>()
        };
        // Limits that no step reaches are no planes.
        let places: Vec<usize> = (0..here.excess.len())
            .filter(|&place| {
                let (excess, normal) = &here.excess[place];
                -excess <= extreme(normal, 1.0)
            })
            .collect();
        let of_limits = places.iter().map(|&place| {
            let (excess, normal) = here.excess[place];
            // Where the region of trust does not reach a limit, most of the distance to it is gone.
            (normal, (-excess).max(0.8 * extreme(&normal, -1.0)))
        });
        let clear = |distance: f64| {
            let too_near = distance < 0.25 * CLEAR;
            if too_near { distance - CLEAR } else { (distance - CLEAR).max(0.0) }
        };
        let before = surfaces.iter().map(|it| (it.normal, clear(it.distance)));
        let planes = of_limits.chain(before).collect();
        let hessian = self.curvature((at, here), multipliers, surfaces, trust);
        let model = Quadratic { count, gradient: here.gradient, hessian, bounds, planes };
        let least = model.least()?;
        let mut limits = Multipliers::default();
        places.iter().zip(least.multipliers).for_each(|(&place, by)| limits[place] = by);
        Some(Step { step: least.step, value: least.value, limits })
    }

    /// The second derivatives of the Lagrange function. Where surfaces touch, those of both sides are combined as the gradients
    /// are that leave no slope across them: so the curvature of the surfaces counts.
    fn curvature(
        &self,
        (at, here): (&OperatingPoint, &Measured),
        multipliers: &Multipliers,
        surfaces: &[Surface],
        trust: f64,
    ) -> [Vector; MOST] {
        let near = self.hessian(at, multipliers, trust);
        let mut curvature = near;
        for surface in surfaces.iter().filter(|it| it.distance <= trust) {
            let share = surface.share(here, multipliers);
            if share > 0.0 {
                let far = self.hessian(&surface.beyond, multipliers, trust);
                for i in 0..self.objective.count {
                    for j in 0..self.objective.count {
                        curvature[i][j] += share * (far[i][j] - near[i][j]);
                    }
                }
            }
        }
        curvature
    }

    /// The second derivatives of the Lagrange function, from orbits with the same events; zero where the family does not reach
    /// far enough to tell.
    fn hessian(
        &self,
        at: &OperatingPoint,
        multipliers: &Multipliers,
        trust: f64,
    ) -> [Vector; MOST] {
        let [least, most] = DIFFERENCES;
        let by = (DIFFERENCE * trust).clamp(least, most);
        let slope = |shares: &Vector| -> Option<Vector> {
            let there = self.family.moved(at, shares).filter(|it| it.events == at.events)?;
            Some(self.objective.measured(&there).lagrange(multipliers))
        };
        let here = self.objective.measured(at).lagrange(multipliers);
        let mut rows = [Vector::default(); MOST];
        for i in 0..self.objective.count {
            let shifted = |by: f64| {
                let mut shares = at.shares;
                shares[i] += by;
                slope(&shares)
            };
            let (ahead, behind, apart) = match [by, -by].map(shifted) {
                [Some(ahead), Some(behind)] => (ahead, behind, 2.0 * by),
                [Some(ahead), None] => (ahead, here, by),
                [None, Some(behind)] => (here, behind, by),
                [None, None] => continue,
            };
            rows[i] = std::array::from_fn(|j| (ahead[j] - behind[j]) / apart);
        }
        std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (rows[i][j] + rows[j][i])))
    }

    /// What holds an orbit that has this slope.
    fn holds(&self, at: &OperatingPoint, slope: &Slope) -> Vec<Hold> {
        let mut holds = slope.held_by.clone();
        if slope.left > AT_EDGE {
            holds.push(Hold::edge(&at.multipliers));
        } else if slope.left > STATIONARY {
            holds.push(Hold::Steps);
        }
        if holds.is_empty() {
            holds.push(Hold::Interior);
        }
        holds
    }
}

/// A share of a range; what rounding leaves before a bound is on it.
fn on_bound(share: f64) -> f64 {
    if share < ON_BOUND {
        0.0
    } else if share > 1.0 - ON_BOUND {
        1.0
    } else {
        share
    }
}
