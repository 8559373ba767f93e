//! From an orbit to the best one of its family: stationary within the bounds, or where the family or its outputs have an edge.

use super::beyond::Beyond;
use super::goal::{Goal, Measured, Objective};
use super::hold::Hold;
use super::lagrange_model::{LagrangeModel, Step};
use super::operating_point::{Family, OperatingPoint};
use super::quadratic::Vector;
use super::stationarity::{STATIONARY, Slope};
use super::surface::Surface;

/// The first radius of trust, and the least, as shares of the ranges.
const TRUST: [f64; 2] = [0.05, 1e-10];
/// Steps at most.
const STEPS: usize = 500;
/// Where it is better beyond a surface, the search goes on from an orbit there that is this near, in shares of the ranges.
const PASSES: f64 = 4e-9;
/// A gain that is less than this, relative to the value, may be rounding: then the slope tells.
const NO_GAIN: f64 = 1e-13;
/// A trial must gain this share of what was foretold.
const GAIN: f64 = 1e-4;
/// A share this near to a bound is on it: bringing an orbit back to its limits may move it off by rounding.
const ON_BOUND: f64 = 1e-13;

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

/// A search, and where it has come to.
struct Ascent<'a> {
    family: &'a Family,
    objective: Objective,
    /// Where events change.
    beyond: Beyond<'a>,
    /// The best orbit so far.
    here: Measured,
    /// The radius of trust, as a share of the ranges.
    trust: f64,
    /// The sequences of events in which trials from here have ended.
    tried: Vec<Vec<u8>>,
    /// Whether it has passed a surface since its last gain.
    has_passed: bool,
}

/// A trial beside what the model foretold of it.
struct Trial {
    /// The orbit that was tried.
    there: Measured,
    /// The greatest change of a share.
    length: f64,
    /// What the model foretold that it would gain.
    foretold: f64,
    /// What it gains.
    gained: f64,
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
    let mut ascent = Ascent::from(family, first, goal)?;
    for _ in 0..STEPS {
        if let Some(best) = ascent.advance() {
            return Some(best);
        }
    }
    let surfaces = ascent.beyond.near(&ascent.here, ascent.trust);
    let Slope { left, mut held_by, .. } = ascent.slope(&ascent.here, &surfaces, 0.0);
    held_by.push(Hold::Steps);
    Some(ascent.best(left, held_by))
}

/// The largest relative slope that is left at an orbit of a family, as in [`Best`], and what holds it of bounds alone; none
/// where the goal has no value there.
pub fn left(family: &Family, at: &OperatingPoint, goal: Goal) -> Option<(f64, Vec<Hold>)> {
    let ascent = Ascent::from(family, at.clone(), goal)?;
    let Slope { left, mut held_by, .. } = ascent.slope(&ascent.here, &[], 0.0);
    if held_by.is_empty() && left <= STATIONARY {
        held_by.push(Hold::Interior);
    }
    Some((left, held_by))
}

impl<'a> Ascent<'a> {
    /// From an orbit of a family; none where the goal has no value there.
    fn from(family: &'a Family, first: OperatingPoint, goal: Goal) -> Option<Self> {
        let objective = Objective::from(goal, family, &first)?;
        let beyond = Beyond::of(family, objective.clone());
        let here = objective.measured(first);
        let trust = TRUST[0];
        Some(Ascent { family, objective, beyond, here, trust, tried: vec![], has_passed: false })
    }

    /// One step of the search; the best orbit where it ends.
    fn advance(&mut self) -> Option<Best> {
        let surfaces = self.beyond.located(&self.here, self.trust);
        let slope = self.slope(&self.here, &surfaces, 0.0);
        if slope.left <= STATIONARY || self.trust < TRUST[1] {
            let held_by = slope.holds(&self.here.orbit.multipliers);
            return Some(self.best(slope.left, held_by));
        }
        // What a step within the region of trust may reach holds it.
        let near = self.slope(&self.here, &surfaces, self.trust);
        let mut passed = near.passes.iter().map(|i| &surfaces[*i]);
        if let Some(surface) = passed.find(|it| it.reach <= PASSES).filter(|_| !self.has_passed) {
            self.has_passed = true;
            self.here = surface.beyond.clone();
            return None;
        }
        let Some(step) = self.step(&near, &surfaces) else {
            self.trust *= 0.25;
            return None;
        };
        match self.trial(&step, &near) {
            Some(trial) => self.judge(trial, slope),
            None => {
                self.shrink(step.length());
                None
            }
        }
    }

    /// The slope at an orbit that constraints leave which it touches, or which are so near [shares].
    fn slope(&self, at: &Measured, surfaces: &[Surface], near: f64) -> Slope {
        Slope::at(&self.objective, at, surfaces, near)
    }

    /// The best step within the region of trust; none where there is no room.
    fn step(&self, near: &Slope, surfaces: &[Surface]) -> Option<Step> {
        let model = LagrangeModel {
            family: self.family,
            objective: &self.objective,
            here: &self.here,
            multipliers: &near.limits,
            surfaces,
            trust: self.trust,
        };
        let found = model.least();
        if found.is_some() || surfaces.is_empty() {
            return found;
        }
        // Before a limit that is exceeded there may be no room on this side of a surface.
        LagrangeModel { surfaces: &[], ..model }.least()
    }

    /// What a step leads to; none where the family does not reach.
    fn trial(&self, step: &Step, near: &Slope) -> Option<Trial> {
        let weights = std::array::from_fn(|i| 1.0 + 2.0 * step.limits[i].max(near.limits[i]));
        let there = self.moved(&step.step)?;
        let foretold = self.here.penalty(&weights) - step.value;
        let gained = self.here.merit(&weights) - there.merit(&weights);
        Some(Trial { there, length: step.length(), foretold, gained })
    }

    /// The orbit a step away, then brought back to the limits that are exceeded; none where the family does not reach.
    fn moved(&self, step: &Vector) -> Option<Measured> {
        let at = &self.here.orbit;
        let shares = std::array::from_fn(|i| on_bound(at.shares[i] + step[i]));
        let passed = self.objective.measured(self.family.moved(at, &shares)?);
        let corrected = passed
            .back_to_limits()
            .map(|by| std::array::from_fn(|i| on_bound(passed.orbit.shares[i] + by[i])))
            .and_then(|shares| self.family.moved(&passed.orbit, &shares))
            .map(|orbit| self.objective.measured(orbit));
        Some(corrected.unwrap_or(passed))
    }

    /// Goes on from a trial that is better, or learns from one that is not; the best orbit where neither leads on.
    fn judge(&mut self, trial: Trial, slope: Slope) -> Option<Best> {
        let Trial { there, length, foretold, gained } = trial;
        let events = &there.orbit.events;
        let is_new = *events != self.here.orbit.events && !self.tried.contains(events);
        self.beyond.remember(&self.here.orbit, &there.orbit);
        let is_better = if foretold > NO_GAIN {
            gained > GAIN * foretold
        } else {
            let surfaces = self.beyond.near(&there, self.trust);
            self.slope(&there, &surfaces, 0.0).left < 0.5 * slope.left
        };
        if is_better {
            if gained > 0.75 * foretold && length > 0.99 * self.trust {
                self.trust = (2.0 * self.trust).min(1.0);
            } else if gained < 0.25 * foretold {
                self.trust = 0.5 * length;
            }
            self.here = there;
            self.tried.clear();
            self.has_passed = false;
        } else if is_new {
            // The same step is tried again before the surface that it has passed.
            self.tried.push(there.orbit.events);
        } else if foretold <= NO_GAIN && length < 0.9 * self.trust {
            // The whole step of the model gains no more than rounding.
            return Some(self.ended_by_rounding(slope));
        } else {
            self.shrink(length);
            self.tried.clear();
        }
        None
    }

    /// Trusts the model a quarter as far as a step of it that failed.
    fn shrink(&mut self, length: f64) {
        self.trust = 0.25 * length.min(self.trust);
    }

    /// The present orbit, where steps gain no more than rounding.
    fn ended_by_rounding(&self, slope: Slope) -> Best {
        let left = slope.left;
        if left > STATIONARY && slope.is_at_kink() {
            // At a kink a slope that is left is none of an edge.
            return self.best(left, [slope.held_by, vec![Hold::Steps]].concat());
        }
        self.best(left, slope.holds(&self.here.orbit.multipliers))
    }

    /// The present orbit as the best.
    fn best(&self, stationarity: f64, held_by: Vec<Hold>) -> Best {
        Best { at: self.here.orbit.clone(), stationarity, held_by }
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
