//! A grid: every combination of the values of some axes, in which a case may inherit its start from its neighbour.

use super::Axis;

/// The direction along an axis in which each case starts from the final state of its neighbour, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From the first value to the last.
    Upward = 0,
    /// From the last value to the first.
    Downward,
    /// Each case starts as the study says.
    Afresh,
}

impl Direction {
    /// All of them, in the order of their numbers.
    pub const ALL: [Direction; 3] = [Direction::Upward, Direction::Downward, Direction::Afresh];

    /// Its name in studies and files.
    pub fn name(self) -> &'static str {
        match self {
            Direction::Upward => "upward",
            Direction::Downward => "downward",
            Direction::Afresh => "afresh",
        }
    }
}

/// Each case starts from the final state of its neighbour along an axis, which is how hysteresis is found.
#[derive(Debug, Clone, PartialEq)]
pub struct Inherit {
    /// Position of the axis in the study.
    pub axis: usize,
    /// In which directions; several of them make one more dimension, `direction`, the last.
    pub directions: Vec<Direction>,
}

/// Every combination of the values of some axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Grid {
    /// The axes, slowest first; none for a single case.
    pub axes: Vec<Axis>,
    /// Along which axis the cases inherit their start, if any.
    pub inherit: Option<Inherit>,
}

/// Indices of cases, each of which starts from the final state of the one before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chain {
    first: usize,
    step: isize,
    left: usize,
}

impl Chain {
    /// The chain of case `index` alone.
    pub fn one(index: usize) -> Chain {
        Chain { first: index, step: 0, left: 1 }
    }
}

impl Iterator for Chain {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        self.left = self.left.checked_sub(1)?;
        let index = self.first;
        self.first = index.wrapping_add_signed(self.step);
        Some(index)
    }
}

impl Grid {
    /// The name of the dimension of the directions in which starts are inherited.
    pub const DIRECTION: &'static str = "direction";

    /// Number of values along each dimension, slowest first.
    pub fn shape(&self) -> Vec<usize> {
        let axes = self.axes.iter().map(Axis::places);
        axes.chain(self.direction_axis().map(<[Direction]>::len)).collect()
    }

    /// The names of the dimensions, slowest first.
    pub fn dimensions(&self) -> Vec<&str> {
        let axes = self.axes.iter().map(Axis::name);
        axes.chain(self.direction_axis().map(|_| Grid::DIRECTION)).collect()
    }

    /// The directions, where there are several and they make a dimension of the results.
    pub fn direction_axis(&self) -> Option<&[Direction]> {
        let inherit = self.inherit.as_ref()?;
        (inherit.directions.len() > 1).then_some(&inherit.directions)
    }

    /// Chains of a group of cases, which differ in direction and along the axis of `inherit` only: one for each
    /// direction upward or downward, and one for each case that starts afresh. Without `inherit` each case is a
    /// group.
    pub(super) fn chains_of_group(&self) -> usize {
        let Some(inherit) = &self.inherit else { return 1 };
        let chains = inherit.directions.iter().map(|direction| match direction {
            Direction::Upward | Direction::Downward => 1,
            Direction::Afresh => self.axes[inherit.axis].places(),
        });
        chains.sum()
    }

    /// Cases of such a group.
    pub(super) fn cases_of_group(&self) -> usize {
        let inherit = self.inherit.as_ref();
        inherit.map_or(1, |it| self.axes[it.axis].places() * it.directions.len())
    }

    /// The cases of chain `number`, to be run in order; a chain is one case where no start is inherited.
    pub fn chain(&self, number: usize) -> Chain {
        let Some(inherit) = &self.inherit else {
            return Chain::one(number);
        };
        let length = self.axes[inherit.axis].places();
        let spacing: usize = self.shape()[inherit.axis + 1..].iter().product();
        let inner = spacing / inherit.directions.len();
        let (group, mut left) = (number / self.chains_of_group(), number % self.chains_of_group());
        let corner = group / inner * spacing * length + group % inner * inherit.directions.len();
        for (place, direction) in inherit.directions.iter().enumerate() {
            let first = corner + place;
            match direction {
                Direction::Afresh if left < length => {
                    return Chain::one(first + left * spacing);
                }
                Direction::Afresh => left -= length,
                _ if left > 0 => left -= 1,
                Direction::Upward => {
                    return Chain { first, step: spacing as isize, left: length };
                }
                Direction::Downward => {
                    let last = first + (length - 1) * spacing;
                    return Chain { first: last, step: -(spacing as isize), left: length };
                }
            }
        }
        unreachable!("the lengths of a group add up to its chains")
    }

    /// Position of case `index` along each dimension.
    pub fn position(&self, index: usize) -> Vec<usize> {
        let mut rest = index;
        let mut position: Vec<usize> = self
            .shape()
            .iter()
            .rev()
            .map(|&length| {
                let here = rest % length;
                rest /= length;
                here
            })
            .collect();
        position.reverse();
        position
    }
}
