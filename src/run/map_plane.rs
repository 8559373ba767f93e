//! The plane of a map: which pairs of neighbouring cases lie on the two sides of a line through it.

use std::collections::BTreeSet;

use crate::study::Grid;
use crate::study::axis::range;

/// A line this near to a point, relative to the ranges of the map, passes it: that much a polygon may deviate from a smooth curve
/// with steps of a hundredth.
pub const NEAR: f64 = 2e-4;

/// A point of the plane, relative to the ranges of the two axes.
pub type Place = [f64; 2];

/// Two neighbouring cases of a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Neighbours {
    /// The cases, that of the lower index first.
    pub cases: [usize; 2],
    /// The axis along which they differ.
    pub axis: usize,
}

/// The plane of a map of two parameters.
#[derive(Debug, Clone)]
pub struct MapPlane {
    /// The values along each axis, relative to its range.
    values: [Vec<f64>; 2],
    /// The least value and the range of each axis.
    scales: [[f64; 2]; 2],
    /// Cases for each pair of values: directions in which starts are inherited.
    directions: usize,
}

impl MapPlane {
    /// The plane of a grid of two axes.
    ///
    /// # Panics
    /// Where the grid has fewer axes.
    pub fn of(grid: &Grid) -> MapPlane {
        let values = [0, 1].map(|axis| values_along(grid, axis));
        let scales = values.map(|values| {
            let [low, high] = range(values);
            [low, high - low]
        });
        let relative = |axis: usize| {
            let [low, width] = scales[axis];
            values[axis].iter().map(|value| (value - low) / width).collect()
        };
        let directions = grid.direction_axis().map_or(1, <[_]>::len);
        MapPlane { values: [relative(0), relative(1)], scales, directions }
    }

    /// A point with these values of the two parameters.
    pub fn place(&self, values: [f64; 2]) -> Place {
        [0, 1].map(|axis| (values[axis] - self.scales[axis][0]) / self.scales[axis][1])
    }

    /// All pairs of neighbouring cases, in the order of their first cases.
    pub fn neighbours(&self) -> impl Iterator<Item = Neighbours> + '_ {
        let [slow, fast] = self.values.each_ref().map(Vec::len);
        let cells = (0..slow).flat_map(move |i| (0..fast).map(move |j| [i, j]));
        let pairs = cells.flat_map(move |[i, j]| {
            let along_slow = (i + 1 < slow).then_some(([i + 1, j], 0));
            let along_fast = (j + 1 < fast).then_some(([i, j + 1], 1));
            let both = along_slow.into_iter().chain(along_fast);
            both.map(move |(other, axis)| ([i, j], other, axis))
        });
        pairs.flat_map(move |(one, other, axis)| {
            (0..self.directions).map(move |direction| Neighbours {
                cases: [self.case(one, direction), self.case(other, direction)],
                axis,
            })
        })
    }

    fn case(&self, [i, j]: [usize; 2], direction: usize) -> usize {
        (i * self.values[1].len() + j) * self.directions + direction
    }

    /// The pairs between whose cases a line passes.
    pub fn crossed(&self, line: &[Place]) -> BTreeSet<Neighbours> {
        let mut crossed = BTreeSet::new();
        for ends in line.windows(2) {
            for axis in [0, 1] {
                self.cross([ends[0], ends[1]], axis, &mut crossed);
            }
        }
        crossed
    }

    /// Adds the pairs along an axis between whose cases a segment passes.
    fn cross(&self, [from, to]: [Place; 2], axis: usize, crossed: &mut BTreeSet<Neighbours>) {
        let other = 1 - axis;
        let [low, high] = [from[other].min(to[other]), from[other].max(to[other])];
        for (row, &level) in self.values[other].iter().enumerate() {
            if level < low - NEAR || level > high + NEAR {
                continue;
            }
            let rise = to[other] - from[other];
            let share =
                if rise == 0.0 { 0.5 } else { ((level - from[other]) / rise).clamp(0.0, 1.0) };
            let at = from[axis] + share * (to[axis] - from[axis]);
            for place in self.between(axis, at) {
                let [mut one, mut next] = [[0; 2]; 2];
                (one[axis], one[other]) = (place, row);
                (next[axis], next[other]) = (place + 1, row);
                for direction in 0..self.directions {
                    let cases = [self.case(one, direction), self.case(next, direction)];
                    crossed.insert(Neighbours { cases, axis });
                }
            }
        }
    }

    /// The places of values along an axis between which, and the next of each, a value lies.
    fn between(&self, axis: usize, at: f64) -> impl Iterator<Item = usize> + '_ {
        let pairs = self.values[axis].windows(2).enumerate();
        pairs.filter_map(move |(place, pair)| {
            let [low, high] = [pair[0].min(pair[1]), pair[0].max(pair[1])];
            (low - NEAR..=high + NEAR).contains(&at).then_some(place)
        })
    }
}

/// The values of what varies along an axis of a map; none of a path, along which several things vary.
pub fn values_along(grid: &Grid, axis: usize) -> &[f64] {
    grid.axes[axis].single().map_or(&[], |it| &it.values)
}

/// Whether a line passes a point.
pub fn passes(line: &[Place], point: Place) -> bool {
    let to_point = |at: &Place| [0, 1].map(|i| point[i] - at[i]);
    let near = |away: [f64; 2]| away[0].hypot(away[1]) <= NEAR;
    let of_segments = line.windows(2).any(|ends| {
        let along = [0, 1].map(|i| ends[1][i] - ends[0][i]);
        let from = to_point(&ends[0]);
        let square = along[0] * along[0] + along[1] * along[1];
        let share = (from[0] * along[0] + from[1] * along[1]) / square;
        let share = if square > 0.0 { share.clamp(0.0, 1.0) } else { 0.0 };
        near([0, 1].map(|i| from[i] - share * along[i]))
    });
    of_segments || line.iter().any(|at| near(to_point(at)))
}
