//! A surface in the parameters on which the sequence of events changes: there the outputs have a kink.

use super::goal::{FirstOrder, Measured, Multipliers};
use super::hold::Hold;
use super::quadratic::Vector;
use crate::orbit::matrix::{dot, norm};

/// Gradients that differ by less are those of one smooth piece.
const KINK: f64 = 1e-4;
/// A surface may seem to lie so much before the one orbit or behind the other, as a share of their distance.
const SLACK: f64 = 0.2;

/// So far beyond a surface an orbit tells well where it is, in shares of the ranges and of its distance.
const BEYOND: [f64; 2] = [1e-9, 0.1];
/// An orbit this many times as far tells well enough.
const ENOUGH: f64 = 4.0;

/// A surface near an orbit, beyond which events follow each other in another sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Its normal of length one, away from the orbit.
    pub normal: Vector,
    /// How far it is from the orbit, in shares of the ranges.
    pub distance: f64,
    /// How far the orbit beyond it is along the normal, in shares of the ranges.
    pub reach: f64,
    /// What it holds motions by.
    pub hold: Hold,
    /// The orbit beyond it that tells of it.
    pub beyond: Measured,
}

impl Surface {
    /// The surface between two orbits with different events; none where the outputs do not show one between them.
    ///
    /// # Method
    ///
    /// Outputs are continuous there and their gradients are not. So the difference of the first orders of an output from the
    /// one orbit and from the other vanishes on the surface, to second order in how far the orbits are apart.
    pub fn between(here: &Measured, there: Measured) -> Option<Self> {
        let apart: Vector = std::array::from_fn(|i| there.orbit.shares[i] - here.orbit.shares[i]);
        let of_goal = Jump::between(&here.goal, &there.goal, &apart);
        let of_limits = here.limits.iter().zip(&there.limits);
        let of_limits = of_limits.map(|(here, there)| Jump::between(here, there, &apart));
        let jumps = std::iter::once(of_goal).chain(of_limits);
        let Jump { value, gradient, steep } = jumps.max_by(|a, b| a.steep.total_cmp(&b.steep))?;
        let towards = dot(&gradient, &apart);
        let unit = towards.signum() / steep;
        let normal = gradient.map(|part| part * unit);
        let (distance, reach) = (-value * unit, towards * unit);
        let is_between = (-SLACK * reach..=(1.0 + SLACK) * reach).contains(&distance);
        let has_same_impacts = here.orbit.impacts == there.orbit.impacts;
        let hold = if has_same_impacts { Hold::EventSequence } else { Hold::Grazing };
        (steep > KINK && is_between).then(|| Surface {
            normal,
            distance: distance.clamp(0.0, reach),
            reach,
            hold,
            beyond: there,
        })
    }

    /// How far just beyond it is, in shares of the ranges.
    pub fn just_beyond(&self) -> f64 {
        let [least, share] = BEYOND;
        self.distance + least.max(share * self.distance)
    }

    /// Whether the orbit beyond it is so near to it that it is where it seems to be.
    pub fn is_located(&self) -> bool {
        self.reach - self.distance <= ENOUGH * (self.just_beyond() - self.distance)
    }

    /// Whether the Lagrange function with these multipliers of the limits falls beyond it, so that it does not hold.
    pub fn lets_pass(&self, multipliers: &Multipliers) -> bool {
        dot(&self.beyond.lagrange(multipliers), &self.normal) < 0.0
    }

    /// The share of the far side in a convex combination of the two gradients of the Lagrange function that has no slope
    /// across the surface, from the gradient of this side.
    pub fn share(&self, here: &Measured, multipliers: &Multipliers) -> f64 {
        let [near, far] =
            [here, &self.beyond].map(|it| dot(&it.lagrange(multipliers), &self.normal));
        if near < 0.0 && far > 0.0 { near / (near - far) } else { 0.0 }
    }
}

/// By how much the first order of an output from one side of a surface differs from that from the other, at the orbit of the one.
struct Jump {
    /// The difference of the values.
    value: f64,
    /// The difference of the gradients.
    gradient: Vector,
    /// Its length.
    steep: f64,
}

impl Jump {
    /// The jump between two orbits whose shares differ by so much.
    fn between(here: &FirstOrder, there: &FirstOrder, apart: &Vector) -> Jump {
        let gradient: Vector = std::array::from_fn(|i| there.gradient[i] - here.gradient[i]);
        let value = there.value - dot(&there.gradient, apart) - here.value;
        Jump { value, steep: norm(&gradient), gradient }
    }
}
