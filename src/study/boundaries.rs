//! The boundaries between the regions of a map that a study asks for, to be followed as curves.

use super::{Axis, Coordinate, Grid};
use crate::description::Parameter;

/// How the boundaries of a map are followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boundaries {
    /// Longest step of a curve, as a share of the ranges of the map.
    pub longest_step: f64,
    /// Points of a curve at most.
    pub most_points: usize,
    /// Pairs of neighbouring cases between which a boundary is looked for, at most.
    pub most_tries: usize,
}

/// The two parameters of a map, slowest first.
///
/// None where a grid has other axes than two of parameters, each with several values.
pub fn parameters_of_map(grid: &Grid) -> Option<[Parameter; 2]> {
    let [slow, fast] = &grid.axes[..] else { return None };
    Some([parameter_along(slow)?, parameter_along(fast)?])
}

/// The parameter that alone varies along an axis, if its values rise or fall.
fn parameter_along(axis: &Axis) -> Option<Parameter> {
    let varying = axis.single().filter(|it| it.is_ordered())?;
    match varying.coordinate {
        Coordinate::Parameter(parameter) => Some(parameter),
        _ => None,
    }
}
