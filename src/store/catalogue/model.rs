//! The entries of parameters, starts and outputs, whose names the floors below give.

use super::cases::{HISTORY_TIME, IMPACT_POINT, POINT};
use super::entry::{Entry, Extent, Type};
use super::lasting::lasting;
use super::tables::{EDGE_CYCLE, EDGE_INDEX};
use crate::description::{Description, Output, Parameter, Source};
use crate::quantity::Quantity;
use crate::study::Coordinate;

impl Entry {
    /// A parameter of the model, as an axis or a constant of the study.
    pub fn of_parameter(parameter: impl Into<Parameter>) -> Entry {
        Entry::of_coordinate(Coordinate::Parameter(parameter.into()))
    }

    /// The places of a path of the study, by its name.
    pub fn of_path(name: &str) -> Entry {
        Entry {
            name: lasting(name.to_owned()),
            unit: "1",
            meaning: "place along the path, counted from 0",
            extent: Extent::Dimension,
            numbers: Type::Whole,
            shown: None,
        }
    }

    /// What an axis can vary, as an axis or a constant of the study.
    pub fn of_coordinate(coordinate: Coordinate) -> Entry {
        Entry::of(coordinate.quantity(), Extent::Study)
    }

    /// An output of each case.
    pub fn of_output(output: impl Into<Output>) -> Entry {
        Entry::of_case(output.into().quantity())
    }

    /// A number of each case.
    pub const fn of_case(quantity: Quantity) -> Entry {
        Entry::of(quantity, Extent::Case)
    }
}

/// The coordinates of a section point.
pub fn section(model: &'static Description) -> Vec<Entry> {
    entries(model.section, Extent::CaseRow(POINT.name))
}

/// The parts of the direction of the family of a neutral orbit.
pub fn neutral(model: &'static Description) -> Vec<Entry> {
    entries(model.neutral, Extent::Case)
}

/// What is told of an impact.
pub fn impacts(model: &'static Description) -> Vec<Entry> {
    entries(model.motion.impact, Extent::CaseRow(IMPACT_POINT.name))
}

/// What is kept of a motion at each time.
pub fn histories(model: &'static Description) -> Vec<Entry> {
    entries(model.motion.histories, Extent::CaseRow(HISTORY_TIME.name))
}

/// What figures derive from what is kept of a motion: signals, and groups of them.
pub fn derived(model: &'static Description) -> Vec<Entry> {
    let signals = model.motion.signals.iter();
    let derived = signals.filter(|it| !matches!(it.source, Source::Kept(_)));
    let groups = model.motion.groups.iter().map(|it| it.quantity);
    derived
        .map(|it| it.quantity)
        .chain(groups)
        .map(|quantity| Entry::of(quantity, Extent::Derived))
        .collect()
}

/// The section points of saddles between basins.
pub fn edges(model: &'static Description) -> Vec<Entry> {
    entries(model.edge, Extent::TableRow(EDGE_INDEX.name, EDGE_CYCLE.name))
}

/// Where a case ended, in its section coordinates.
pub fn end(model: &'static Description) -> Vec<Entry> {
    entries(model.end, Extent::Block)
}

fn entries(quantities: &[Quantity], extent: Extent) -> Vec<Entry> {
    quantities.iter().map(|quantity| Entry::of(*quantity, extent)).collect()
}

/// Where a case starts, which in a block may be where its neighbour settled.
pub fn starts(model: &'static Description) -> Vec<Entry> {
    Coordinate::starts(model).map(Entry::of_coordinate).collect()
}
