//! An axis of a study: what varies along it, and the values it takes.

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

/// What varies along an axis, with its values in order (SI).
#[derive(Debug, Clone, PartialEq)]
pub struct Varying {
    /// What varies.
    pub coordinate: Coordinate,
    /// The values.
    pub values: Vec<f64>,
}

impl Varying {
    /// Whether there are several values, which all rise or all fall.
    pub fn is_ordered(&self) -> bool {
        self.values.len() > 1 && is_monotone(&self.values)
    }
}

/// One axis of a grid: a coordinate, or a path, along which several vary together.
#[derive(Clone, PartialEq)]
pub struct Axis {
    /// The name of a path; none of an axis that is called after its coordinate.
    pub path: Option<String>,
    /// What varies along it, in the order of the model, each with a value for every place; one thing where it is no path.
    pub varying: Vec<Varying>,
}

/// As fingerprints of studies have it: an axis that is no path as before there were paths.
impl Debug for Axis {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match (&self.path, &self.varying[..]) {
            (None, [Varying { coordinate, values }]) => f
                .debug_struct("Axis")
                .field("coordinate", coordinate)
                .field("values", values)
                .finish(),
            (path, varying) => {
                f.debug_struct("Path").field("name", path).field("varying", &varying).finish()
            }
        }
    }
}

impl Axis {
    /// The axis of a coordinate with these values.
    pub fn of(coordinate: Coordinate, values: Vec<f64>) -> Axis {
        Axis { path: None, varying: vec![Varying { coordinate, values }] }
    }

    /// Its name, which is that of a dimension of the results.
    pub fn name(&self) -> &str {
        let own = self.varying.first().map_or("", |it| it.coordinate.name());
        self.path.as_deref().unwrap_or(own)
    }

    /// How many places it has.
    pub fn places(&self) -> usize {
        self.varying.first().map_or(0, |it| it.values.len())
    }

    /// What varies along it.
    pub fn coordinates(&self) -> impl Iterator<Item = Coordinate> + Clone {
        self.varying.iter().map(|it| it.coordinate)
    }

    /// The values of a coordinate; none of one that does not vary along it.
    pub fn values_of(&self, coordinate: Coordinate) -> Option<&[f64]> {
        let own = self.varying.iter().find(|it| it.coordinate == coordinate)?;
        Some(&own.values)
    }

    /// What varies along it, if that is one thing.
    pub fn single(&self) -> Option<&Varying> {
        if let [single] = &self.varying[..] { Some(single) } else { None }
    }

    /// Whether coordinates of the start alone vary along it, on which the set of attractors does not depend.
    pub fn is_of_starts(&self) -> bool {
        self.coordinates().all(Coordinate::is_start)
    }

    /// Whether parameters alone vary along it.
    pub fn is_of_parameters(&self) -> bool {
        self.coordinates().all(|it| matches!(it, Coordinate::Parameter(_)))
    }

    /// Gives `case` the values at a place.
    pub fn set(&self, case: &mut Case, place: usize) {
        self.varying.iter().for_each(|it| set(case, it.coordinate, it.values[place]));
    }

    /// The value of a coordinate at a place, which may lie between two, evenly between their values; none of one that does not vary.
    pub fn value_between(&self, coordinate: Coordinate, place: f64) -> Option<f64> {
        let values = self.values_of(coordinate)?;
        let before = (place.max(0.0) as usize).min(values.len().checked_sub(1)?);
        let after = (before + 1).min(values.len() - 1);
        let share = (place - before as f64).clamp(0.0, 1.0);
        Some(values[before] * (1.0 - share) + values[after] * share)
    }

    /// Leaves out all but some places, in this order.
    pub fn keep(&mut self, places: &[usize]) {
        for it in &mut self.varying {
            it.values = places.iter().map(|place| it.values[*place]).collect();
        }
    }

    /// The places at which something that varies along it has its least or its greatest value.
    pub fn extremes(&self) -> Vec<usize> {
        let ends = self.varying.iter().flat_map(|it| {
            let by_value = |a: &usize, b: &usize| it.values[*a].total_cmp(&it.values[*b]);
            let places = 0..it.values.len();
            [places.clone().min_by(by_value), places.max_by(by_value)]
        });
        let mut places: Vec<usize> = ends.flatten().collect();
        places.sort_unstable();
        places.dedup();
        places
    }
}

/// A value this little beyond an axis, relative to its values, is at its end.
const ROUNDING: f64 = 1e-9;

/// The least and the greatest of the values of an axis; an empty range where it has none.
pub fn range(values: &[f64]) -> [f64; 2] {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    [least, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}

/// Whether values rise throughout, or fall throughout.
pub fn is_monotone(values: &[f64]) -> bool {
    let rises = |pair: &[f64]| pair[0] < pair[1];
    let falls = |pair: &[f64]| pair[0] > pair[1];
    values.windows(2).all(rises) || values.windows(2).all(falls)
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
