//! A study: what to compute, as a set of axes over one base case.

use std::hash::Hash;

use siphasher::sip128::{Hash128, Hasher128, SipHasher13};

use crate::capsule::{Parameters, State};
use crate::orbit::{Case, Output, Protocol};

use super::{Axis, Continuation, Coordinate, Drawing};

/// The way along an axis in which each case starts where its neighbour settled, or that none does.
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

/// Following the attractor along an axis, which is how hysteresis is found.
#[derive(Debug, Clone, PartialEq)]
pub struct Follow {
    /// Position of the axis in the study.
    pub axis: usize,
    /// In which directions; several of them make one more dimension, `direction`, the last.
    pub directions: Vec<Direction>,
}

/// What to compute.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Heading.
    pub title: String,
    /// The study as it was written.
    pub text: String,
    /// Values of the parameters that no axis varies.
    pub base: Parameters,
    /// Start of the cases, where no axis varies it.
    pub start: State<f64>,
    /// Phase of the drive at the start, where no axis varies it [rad].
    pub start_phase: f64,
    /// Phase of the drive at the stroboscopic section, where no axis varies it [rad].
    pub section_phase: f64,
    /// The axes, slowest first; none for a single case.
    pub axes: Vec<Axis>,
    /// Along which axis the attractor is followed, if any.
    pub follow: Option<Follow>,
    /// How each case is followed and judged.
    pub protocol: Protocol,
    /// The outputs to keep.
    pub outputs: Vec<Output>,
    /// The branches of periodic orbits to follow.
    pub branches: Vec<Continuation>,
    /// The figures to draw.
    pub drawings: Vec<Drawing>,
}

/// Indices of cases, each of which starts where the one before has settled.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chain {
    first: usize,
    step: isize,
    left: usize,
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

impl Study {
    /// Number of values along each dimension of the results, slowest first.
    pub fn shape(&self) -> Vec<usize> {
        let mut shape: Vec<usize> = self.axes.iter().map(|axis| axis.values.len()).collect();
        if let Some(directions) = self.direction_axis() {
            shape.push(directions.len());
        }
        shape
    }

    /// The directions, where there are several and they make a dimension of the results.
    pub fn direction_axis(&self) -> Option<&[Direction]> {
        let follow = self.follow.as_ref()?;
        (follow.directions.len() > 1).then_some(&follow.directions)
    }

    /// Tells studies apart whose cases or records differ in anything; titles, figures, branches and the way
    /// in which a study is written make no difference.
    pub fn fingerprint(&self) -> String {
        let computed = Study {
            title: String::new(),
            text: String::new(),
            branches: Vec::new(),
            drawings: Vec::new(),
            ..self.clone()
        };
        let mut hasher = SipHasher13::new();
        // Numbers are shown with all the digits that tell them apart.
        format!("{computed:?}").hash(&mut hasher);
        let Hash128 { h1, h2 } = hasher.finish128();
        format!("{h1:016x}{h2:016x}")
    }

    /// Number of cases.
    pub fn cases(&self) -> usize {
        self.shape().iter().product()
    }

    /// Case `index` with the start that the study gives it, counted with the last dimension fastest.
    pub fn case(&self, index: usize) -> Case {
        let mut case = Case {
            parameters: self.base.clone(),
            start: self.start,
            start_phase: self.start_phase,
            section_phase: self.section_phase,
        };
        for (axis, position) in self.axes.iter().zip(self.position(index)) {
            let value = axis.values[position];
            match axis.coordinate {
                Coordinate::Parameter(parameter) => case.parameters[parameter] = value,
                Coordinate::StartR => case.start.r = value,
                Coordinate::StartY1 => case.start.y1 = value,
                Coordinate::StartY2 => case.start.y2 = value,
                Coordinate::StartPhase => case.start_phase = value,
                Coordinate::SectionPhase => case.section_phase = value,
            }
        }
        case
    }

    /// Number of chains, which can be run in any order.
    pub fn chains(&self) -> usize {
        self.cases() / self.cases_of_group() * self.chains_of_group()
    }

    /// Chains of a group of cases, which differ along the followed axis and in direction only: one for each
    /// direction that is followed, and one for each case that starts afresh. Where no axis is followed, each
    /// case is a group.
    pub(super) fn chains_of_group(&self) -> usize {
        let Some(follow) = &self.follow else { return 1 };
        let length = |direction: &Direction| match direction {
            Direction::Upward | Direction::Downward => 1,
            Direction::Afresh => self.axes[follow.axis].values.len(),
        };
        follow.directions.iter().map(length).sum()
    }

    /// Cases of such a group.
    pub(super) fn cases_of_group(&self) -> usize {
        let follow = self.follow.as_ref();
        follow.map_or(1, |it| self.axes[it.axis].values.len() * it.directions.len())
    }

    /// The cases of chain `number`, to be run in order; a chain is one case where none is followed.
    pub fn chain(&self, number: usize) -> Chain {
        let Some(follow) = &self.follow else {
            return Chain { first: number, step: 0, left: 1 };
        };
        let length = self.axes[follow.axis].values.len();
        let stride: usize = self.shape()[follow.axis + 1..].iter().product();
        let inner = stride / follow.directions.len();
        let (group, mut left) = (number / self.chains_of_group(), number % self.chains_of_group());
        let corner = group / inner * stride * length + group % inner * follow.directions.len();
        for (place, direction) in follow.directions.iter().enumerate() {
            let first = corner + place;
            match direction {
                Direction::Afresh if left < length => {
                    return Chain { first: first + left * stride, step: 0, left: 1 };
                }
                Direction::Afresh => left -= length,
                _ if left > 0 => left -= 1,
                Direction::Upward => {
                    return Chain { first, step: stride as isize, left: length };
                }
                Direction::Downward => {
                    let last = first + (length - 1) * stride;
                    return Chain { first: last, step: -(stride as isize), left: length };
                }
            }
        }
        unreachable!("the lengths of a group add up to its chains")
    }

    /// The direction of case `index`, where an axis is followed.
    pub fn direction(&self, index: usize) -> Option<Direction> {
        let follow = self.follow.as_ref()?;
        Some(follow.directions[index % follow.directions.len()])
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
