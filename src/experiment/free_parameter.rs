//! A parameter that is fitted, and the bounds that it is looked for within.

use super::least_squares::Bounds;
use crate::description::Parameter;

/// A parameter to be fitted, and where it is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Free {
    /// Which.
    pub parameter: Parameter,
    /// From where to where (SI).
    pub bounds: Bounds,
}

/// A side of the bounds of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The least value that is allowed.
    Least,
    /// The greatest.
    Greatest,
}

impl Side {
    /// The bound that a value lies on, if it does, within a ten-thousandth of their distance: a search may stop that far from it.
    pub fn of(value: f64, bounds: Bounds) -> Option<Side> {
        let near = 1e-4 * (bounds.greatest - bounds.least);
        let (below, above) = (value - bounds.least, bounds.greatest - value);
        let side = if below < above { Side::Least } else { Side::Greatest };
        (near.is_finite() && below.min(above) < near).then_some(side)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Side::Least => "least",
            Side::Greatest => "greatest",
        }
    }
}
