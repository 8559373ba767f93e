//! The boundaries between the regions of a map that a study asks for, to be followed as curves.

use super::{Axis, Coordinate, Grid, Varying};
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
    let Varying { coordinate, values } = axis.single()?;
    match coordinate {
        Coordinate::Parameter(parameter) if spans(values) => Some(*parameter),
        _ => None,
    }
}

/// Whether there are several values, all rising or all falling.
fn spans(values: &[f64]) -> bool {
    let rises = values.windows(2).all(|pair| pair[0] < pair[1]);
    let falls = values.windows(2).all(|pair| pair[0] > pair[1]);
    values.len() > 1 && (rises || falls)
}
