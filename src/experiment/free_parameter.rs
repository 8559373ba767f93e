//! A parameter that is fitted, and the bounds that it is looked for within.

use super::least_squares::Bounds;
use crate::capsule::Parameter;

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
    /// The bound that a value lies on, if it does.
    pub fn of(value: f64, bounds: Bounds) -> Option<Side> {
        let is_least = value - bounds.least < bounds.greatest - value;
        bounds.holds(value).then_some(if is_least { Side::Least } else { Side::Greatest })
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Side::Least => "least",
            Side::Greatest => "greatest",
        }
    }
}
