//! What is proven of a periodic orbit: that it closes, how it answers to small pushes, and that its period is the least.

use super::matrix::Complex;

/// How a period was proven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Proof {
    /// It was not.
    None = 0,
    /// Newton's method on the return map ended on an orbit that closes to rounding.
    Newton,
    /// The section repeats, but the return map has no derivative there, because a guard is only touched.
    Grazing,
}

impl Proof {
    /// Every proof by its name in files, in the order of declaration.
    pub const NAMES: [(&str, Proof); 3] =
        [("none", Proof::None), ("newton", Proof::Newton), ("grazing", Proof::Grazing)];
}

/// What is proven of a periodic orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// How.
    pub proof: Proof,
    /// How far the section is from repeating after a period, relative to the motion [-]; NaN without an orbit.
    pub residual: f64,
    /// Floquet multipliers of the period, the largest magnitude first [-]; NaN where they are not known.
    pub multipliers: [Complex; 3],
}

impl Certificate {
    /// Nothing is proven.
    pub fn none() -> Self {
        let unknown = Complex { re: f64::NAN, im: f64::NAN };
        Certificate { proof: Proof::None, residual: f64::NAN, multipliers: [unknown; 3] }
    }

    /// Whether small pushes die out; not where the multipliers are unknown.
    pub fn is_stable(&self) -> bool {
        self.multipliers[0].abs() < 1.0
    }
}
