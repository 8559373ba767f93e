//! The quadratic model of the Lagrange function around an orbit, and the step to where it is least.

use super::goal::{Measured, Multipliers, Objective};
use super::operating_point::Family;
use super::quadratic::{MOST, Quadratic, Vector};
use super::surface::Surface;

/// The step of the differences of exact gradients that give second derivatives, in units of the radius of trust, and the least
/// and greatest, as shares of the ranges.
const DIFFERENCE: f64 = 1e-2;
const DIFFERENCES: [f64; 2] = [1e-7, 1e-4];
/// Steps end so far before a surface, where rounding does not yet mix the derivatives of its two sides.
const CLEAR: f64 = 1e-10;

/// The model of a goal with multipliers of its limits, within a region of trust around an orbit.
#[derive(Clone, Copy)]
pub struct LagrangeModel<'a> {
    /// The family of the orbit.
    pub family: &'a Family,
    /// Goal and limits.
    pub objective: &'a Objective,
    /// The orbit.
    pub here: &'a Measured,
    /// The multipliers of the limits.
    pub multipliers: &'a Multipliers,
    /// Near surfaces, which no step passes.
    pub surfaces: &'a [Surface],
    /// The radius of the region of trust, in shares of the ranges.
    pub trust: f64,
}

/// A step of the model.
pub struct Step {
    /// The step.
    pub step: Vector,
    /// The value there, relative to here.
    pub value: f64,
    /// The multipliers of the limits; zero of those that do not hold the step.
    pub limits: Multipliers,
}

impl Step {
    /// The greatest change of a share.
    pub fn length(&self) -> f64 {
        self.step.iter().fold(0.0, |most: f64, part| most.max(part.abs()))
    }
}

impl LagrangeModel<'_> {
    /// The step to where the model is least within the region of trust; none where there is no room.
    pub fn least(&self) -> Option<Step> {
        let bounds = [self.bound(-1.0), self.bound(1.0)];
        // Limits that no step reaches are no planes.
        let places: Vec<usize> = (0..self.here.limits.len())
            .filter(|&place| {
                let limit = &self.here.limits[place];
                -limit.value <= self.extreme(&bounds, &limit.gradient, 1.0)
            })
            .collect();
        let of_limits = places.iter().map(|&place| {
            let limit = &self.here.limits[place];
            let farthest = self.extreme(&bounds, &limit.gradient, -1.0);
            // Where the region of trust does not reach a limit, most of the distance to it is gone.
            (limit.gradient, (-limit.value).max(0.8 * farthest))
        });
        let before = self.surfaces.iter().map(|it| (it.normal, clear_of(it.distance)));
        let model = Quadratic {
            count: self.objective.count,
            gradient: self.here.goal.gradient,
            hessian: self.curvature(),
            bounds,
            planes: of_limits.chain(before).collect(),
        };
        let least = model.least()?;
        let mut limits = Multipliers::default();
        places.iter().zip(least.multipliers).for_each(|(&place, by)| limits[place] = by);
        Some(Step { step: least.step, value: least.value, limits })
    }

    /// A corner of the region of trust within the bounds of the parameters: the lower for a negative side, else the upper.
    fn bound(&self, side: f64) -> Vector {
        let shares = &self.here.orbit.shares;
        std::array::from_fn(|i| {
            let room = if side < 0.0 { -shares[i] } else { 1.0 - shares[i] };
            if i < self.objective.count { room.clamp(-self.trust, self.trust) } else { 0.0 }
        })
    }

    /// The most that a step between two corners goes along a normal, or the least for a negative sign.
    fn extreme(&self, bounds: &[Vector; 2], normal: &Vector, sign: f64) -> f64 {
        let ends = (0..self.objective.count)
            .map(|i| [0, 1].map(|side| sign * normal[i] * bounds[side][i]));
        sign * ends.map(|[low, high]| low.max(high)).sum::<f64>()
    }

    /// The second derivatives of the Lagrange function. Where surfaces touch, those of both sides are combined as the gradients
    /// are that leave no slope across them: so the curvature of the surfaces counts.
    fn curvature(&self) -> [Vector; MOST] {
        let near = self.hessian(self.here);
        let mut curvature = near;
        for surface in self.surfaces.iter().filter(|it| it.distance <= self.trust) {
            let share = surface.share(self.here, self.multipliers);
            if share > 0.0 {
                let far = self.hessian(&surface.beyond);
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
    fn hessian(&self, at: &Measured) -> [Vector; MOST] {
        let [least, most] = DIFFERENCES;
        let by = (DIFFERENCE * self.trust).clamp(least, most);
        let here = at.lagrange(self.multipliers);
        let mut rows = [Vector::default(); MOST];
        for (i, row) in rows.iter_mut().enumerate().take(self.objective.count) {
            let sides = [by, -by].map(|by| self.gradient_beside(at, i, by));
            let (ahead, behind, apart) = match sides {
                [Some(ahead), Some(behind)] => (ahead, behind, 2.0 * by),
                [Some(ahead), None] => (ahead, here, by),
                [None, Some(behind)] => (here, behind, by),
                [None, None] => continue,
            };
            *row = std::array::from_fn(|j| (ahead[j] - behind[j]) / apart);
        }
        std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (rows[i][j] + rows[j][i])))
    }

    /// The gradient of the Lagrange function where the share of one parameter is greater by so much; none where the family
    /// does not reach or has other events.
    fn gradient_beside(&self, at: &Measured, place: usize, by: f64) -> Option<Vector> {
        let mut shares = at.orbit.shares;
        shares[place] += by;
        let there = self.family.moved(&at.orbit, &shares)?;
        let is_same = there.events == at.orbit.events;
        is_same.then(|| self.objective.measured(there).lagrange(self.multipliers))
    }
}

/// How far a step may go towards a surface at a distance.
fn clear_of(distance: f64) -> f64 {
    let too_near = distance < 0.25 * CLEAR;
    if too_near { distance - CLEAR } else { (distance - CLEAR).max(0.0) }
}
