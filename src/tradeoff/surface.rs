//! A surface in the parameters on which the sequence of events changes: there the outputs have a kink.

use super::goal::{Measured, Multipliers};
use super::hold::Hold;
use super::operating_point::OperatingPoint;
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
    pub beyond: OperatingPoint,
    /// Value and limits there.
    of_beyond: Measured,
}

impl Surface {
    /// The surface between two orbits with different events; none where the outputs do not show one between them.
    ///
    /// # Method
    ///
    /// Outputs are continuous there and their gradients are not. So the difference of the first orders of an output from the
    /// one orbit and from the other vanishes on the surface, to second order in how far the orbits are apart.
    pub fn between(
        (here, of_here): (&OperatingPoint, &Measured),
        (there, of_there): (&OperatingPoint, &Measured),
    ) -> Option<Self> {
        let apart: Vector = std::array::from_fn(|i| there.shares[i] - here.shares[i]);
        let jump = |here: (f64, Vector), there: (f64, Vector)| {
            let gradient: Vector = std::array::from_fn(|i| there.1[i] - here.1[i]);
            (norm(&gradient), there.0 - dot(&there.1, &apart) - here.0, gradient)
        };
        let of_value = jump((of_here.value, of_here.gradient), (of_there.value, of_there.gradient));
        let of_limits = of_here.excess.iter().zip(&of_there.excess);
        let of_limits = of_limits.map(|(here, there)| jump(*here, *there));
        let jumps = std::iter::once(of_value).chain(of_limits);
        let (steep, jump, gradient) = jumps.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let towards = dot(&gradient, &apart);
        let unit = towards.signum() / steep;
        let normal = gradient.map(|part| part * unit);
        let (distance, reach) = (-jump * unit, towards * unit);
        let is_between = (-SLACK * reach..=(1.0 + SLACK) * reach).contains(&distance);
        let has_same_impacts = here.impacts == there.impacts;
        let hold = if has_same_impacts { Hold::EventSequence } else { Hold::Grazing };
        (steep > KINK && is_between).then(|| Surface {
            normal,
            distance: distance.clamp(0.0, reach),
            reach,
            hold,
            beyond: there.clone(),
            of_beyond: of_there.clone(),
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
        dot(&self.of_beyond.lagrange(multipliers), &self.normal) < 0.0
    }

    /// The share of the far side in a convex combination of the two gradients of the Lagrange function that has no slope
    /// across the surface, from the gradient of this side.
    pub fn share(&self, here: &Measured, multipliers: &Multipliers) -> f64 {
        let [near, far] =
            [here, &self.of_beyond].map(|it| dot(&it.lagrange(multipliers), &self.normal));
        if near < 0.0 && far > 0.0 { near / (near - far) } else { 0.0 }
    }
}
