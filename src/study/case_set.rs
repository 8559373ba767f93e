//! Which cases a study has, as a function of an index: a grid or draws.

use super::axis::set;
use super::{Axis, Coordinate, Draws, Grid};
use crate::motion::Case;

/// The cases of a study, each known by its index alone.
///
/// Blocks, files and resumed runs use the number of cases and the case of an index, and nothing else, so that
/// another kind of set needs no change there. The place of `Refined`, a set whose later cases lie where the
/// earlier ones differ most, is beside these two: it has to keep the list of its cases with the results, as
/// they do not follow from the study.
#[derive(Debug, Clone, PartialEq)]
pub enum CaseSet {
    /// Every combination of the values of some axes.
    Grid(Grid),
    /// Points drawn from ranges.
    Draws(Draws),
}

impl Default for CaseSet {
    fn default() -> Self {
        CaseSet::Grid(Grid::default())
    }
}

impl CaseSet {
    /// Number of values along each dimension of the results, slowest first.
    pub fn shape(&self) -> Vec<usize> {
        match self {
            CaseSet::Grid(grid) => grid.shape(),
            CaseSet::Draws(draws) => vec![draws.count],
        }
    }

    /// The names of the dimensions of the results, slowest first.
    pub fn dimensions(&self) -> Vec<&str> {
        match self {
            CaseSet::Grid(grid) => grid.dimensions(),
            CaseSet::Draws(_) => vec![Draws::DIMENSION],
        }
    }

    /// What differs from case to case, in the order of the study.
    pub fn varied(&self) -> Vec<Coordinate> {
        match self {
            CaseSet::Grid(grid) => grid.axes.iter().flat_map(Axis::coordinates).collect(),
            CaseSet::Draws(draws) => draws.ranges.iter().map(|range| range.coordinate).collect(),
        }
    }

    /// Whether all cases have the same parameters and section, and several start elsewhere.
    pub fn varies_starts_alone(&self) -> bool {
        let varied = self.varied();
        !varied.is_empty() && varied.iter().all(|coordinate| coordinate.is_start())
    }

    /// The axes of a grid; none of draws.
    pub fn axes(&self) -> &[Axis] {
        match self {
            CaseSet::Grid(grid) => &grid.axes,
            CaseSet::Draws(_) => &[],
        }
    }

    /// The least and the greatest value that a coordinate takes, if it varies.
    pub fn ends(&self, coordinate: Coordinate) -> Option<[f64; 2]> {
        let own = match self {
            CaseSet::Grid(grid) => grid.axes.iter().find_map(|axis| axis.values_of(coordinate))?,
            CaseSet::Draws(draws) => {
                let range = draws.ranges.iter().find(|range| range.coordinate == coordinate)?;
                &[range.from, range.to]
            }
        };
        let own = own.iter().copied().filter(|value| value.is_finite());
        Some([own.clone().reduce(f64::min)?, own.reduce(f64::max)?])
    }

    /// Makes case `index` of a case with what the study holds constant.
    pub(super) fn vary(&self, index: usize, case: &mut Case) {
        match self {
            CaseSet::Grid(grid) => {
                for (axis, position) in grid.axes.iter().zip(grid.position(index)) {
                    axis.set(case, position);
                }
            }
            CaseSet::Draws(draws) => {
                for (place, range) in draws.ranges.iter().enumerate() {
                    set(case, range.coordinate, draws.value(index, place));
                }
            }
        }
    }

    /// Position of case `index` along each dimension of the results.
    pub fn position(&self, index: usize) -> Vec<usize> {
        match self {
            CaseSet::Grid(grid) => grid.position(index),
            CaseSet::Draws(_) => vec![index],
        }
    }

    /// Leaves out all but the first few values of each dimension, and the last of an axis, so that it keeps its range; rows of a design
    /// stay whole.
    pub fn truncate(&mut self, most: usize) {
        match self {
            CaseSet::Grid(grid) => {
                let varying = grid.axes.iter_mut().flat_map(|axis| &mut axis.varying);
                varying.for_each(|it| shorten(&mut it.values, most));
            }
            CaseSet::Draws(draws) => draws.truncate(most),
        }
    }
}

/// Leaves out all but the first few values and the last.
fn shorten(values: &mut Vec<f64>, most: usize) {
    if let Some(last) = values.last().copied().filter(|_| values.len() > most) {
        values.truncate(most.saturating_sub(1));
        values.push(last);
    }
}
