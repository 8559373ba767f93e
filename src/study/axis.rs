//! An axis of a study: a parameter or a coordinate of the start, and the values it takes.

use std::fmt::{self, Debug, Formatter};

use crate::description::phases::{SECTION_PHASE, START_PHASE};
use crate::description::{Description, Parameter, StateCoordinate};
use crate::motion::Case;
use crate::quantity::{Allowed, Dimension, Quantity};

/// What varies along an axis.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Coordinate {
    /// A parameter of the model.
    Parameter(Parameter),
    /// A coordinate of the state at the start.
    Start(StateCoordinate),
    /// Phase of the drive at the start [rad].
    StartPhase,
    /// Phase of the drive at the stroboscopic section [rad].
    SectionPhase,
}

/// As fingerprints of studies have it.
impl Debug for Coordinate {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Coordinate::Parameter(parameter) => {
                f.debug_tuple("Parameter").field(parameter).finish()
            }
            Coordinate::Start(coordinate) => write!(f, "{coordinate:?}"),
            Coordinate::StartPhase => f.write_str("StartPhase"),
            Coordinate::SectionPhase => f.write_str("SectionPhase"),
        }
    }
}

impl Coordinate {
    /// The older name of an axis over [`Coordinate::StartPhase`], which is still read.
    pub const PHASE: &str = "phase";

    /// The phases of the drive at the start and at the section; none of a model without a drive.
    pub fn phases(model: &'static Description) -> impl Iterator<Item = Coordinate> {
        let phases = [Coordinate::StartPhase, Coordinate::SectionPhase];
        phases.into_iter().filter(|_| model.has_drive())
    }

    /// Everything that an axis of a study of a model may vary.
    pub fn all(model: &'static Description) -> impl Iterator<Item = Coordinate> {
        let starts = Coordinate::starts(model).chain(Coordinate::phases(model));
        model.parameters().map(Coordinate::Parameter).chain(starts)
    }

    /// The coordinates of the start of a model, in its order: all of its state but that which drifts.
    pub fn starts(model: &'static Description) -> impl Iterator<Item = Coordinate> + Clone {
        model.start_coordinates().map(Coordinate::Start)
    }

    /// Those of them that are coordinates of section points, in the order of these.
    pub fn of_section(model: &'static Description) -> impl Iterator<Item = Coordinate> + Clone {
        model.section_coordinates().map(Coordinate::Start)
    }

    /// The quantity that the model describes.
    pub fn quantity(self) -> Quantity {
        match self {
            Coordinate::Parameter(parameter) => parameter.quantity(),
            Coordinate::Start(coordinate) => coordinate.start(),
            Coordinate::StartPhase => START_PHASE,
            Coordinate::SectionPhase => SECTION_PHASE,
        }
    }

    /// The name used in studies and files.
    pub fn name(self) -> &'static str {
        self.quantity().name
    }

    /// Whether it is a coordinate of the start, on which the set of attractors does not depend.
    pub fn is_start(self) -> bool {
        !matches!(self, Coordinate::Parameter(_) | Coordinate::SectionPhase)
    }

    /// What it is, in a phrase.
    pub fn meaning(self) -> &'static str {
        self.quantity().meaning
    }

    /// Its dimension.
    pub fn dimension(self) -> Dimension {
        self.quantity().dimension
    }

    /// What values it may take.
    pub fn allowed(self) -> Allowed {
        match self {
            Coordinate::Parameter(parameter) => parameter.allowed(),
            _ => Allowed::Finite,
        }
    }
}

/// Gives `case` a value of what varies (SI).
pub fn set(case: &mut Case, coordinate: Coordinate, value: f64) {
    match coordinate {
        Coordinate::Parameter(parameter) => case.parameters[parameter] = value,
        Coordinate::Start(coordinate) => case.start[coordinate] = value,
        Coordinate::StartPhase => case.start_phase = value,
        Coordinate::SectionPhase => case.section_phase = value,
    }
}

/// One axis with its values (SI).
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What varies.
    pub coordinate: Coordinate,
    /// The values, in order.
    pub values: Vec<f64>,
}

/// A value this little beyond an axis, relative to its values, is at its end.
const ROUNDING: f64 = 1e-9;

/// The least and the greatest of the values of an axis; an empty range where it has none.
pub fn range(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    [least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}

/// Whether a value lies in the range of the values of an axis, to rounding.
pub fn is_within(value: f64, values: &[f64]) -> bool {
    let [low, high] = range(values);
    let margin = ROUNDING * low.abs().max(high.abs());
    (low - margin..=high + margin).contains(&value)
}

/// What lies evenly between two ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spacing {
    /// The values.
    #[default]
    Linear,
    /// Their logarithms; both ends are above zero.
    Logarithmic,
}

impl Spacing {
    /// Each by its name in studies, in the order of declaration.
    pub const NAMES: [(&str, Spacing); 2] =
        [("linear", Spacing::Linear), ("logarithmic", Spacing::Logarithmic)];

    /// Its name.
    pub fn name(self) -> &'static str {
        Spacing::NAMES[self as usize].0
    }

    /// The value at a fraction of the distance from `from` to `to`.
    ///
    /// The logarithm and the exponential are those of the `libm` crate, the same on every machine.
    pub fn at(self, from: f64, to: f64, share: f64) -> f64 {
        match self {
            Spacing::Linear => from + (to - from) * share,
            Spacing::Logarithmic => from * libm::exp2(libm::log2(to / from) * share),
        }
    }

    /// `points` values from `from` to `to`, both included, each computed from its index.
    pub fn values(self, from: f64, to: f64, points: usize) -> Vec<f64> {
        let last = points.saturating_sub(1);
        (0..points)
            .map(|i| match i {
                0 => from,
                i if i == last => to,
                i => self.at(from, to, i as f64 / last as f64),
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacing_meets_both_ends_and_the_rule_between() {
        assert_eq!(Spacing::Linear.values(10.0, 100.0, 4), [10.0, 40.0, 70.0, 100.0]);
        assert_eq!(Spacing::Linear.values(3.0, 9.0, 1), [3.0]);
        let values = Spacing::Logarithmic.values(1e3, 1e5, 201);
        assert_eq!((values[0], values[200]), (1e3, 1e5));
        for (i, value) in values.iter().enumerate() {
            let exact = 1e3 * libm::pow(10.0, i as f64 / 100.0);
            assert!((value / exact - 1.0).abs() < 1e-14, "{i}: {value} {exact}");
        }
        let falling = Spacing::Logarithmic.values(8.0, 1.0, 4);
        assert!((falling[1] - 4.0).abs() < 1e-14 && (falling[2] - 2.0).abs() < 1e-14);
    }
}
