//! The entries of parameters, starts and outputs, whose names the floors below give.

use super::entry::{Entry, Extent};
use crate::description::{Output, Parameter};
use crate::of::default_model;
use crate::quantity::Quantity;
use crate::study::Coordinate;

impl Entry {
    /// A parameter of the model, as an axis or a constant of the study.
    pub fn of_parameter(parameter: impl Into<Parameter>) -> Entry {
        Entry::of_coordinate(Coordinate::Parameter(parameter.into()))
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

/// Where a case starts, which in a block may be where its neighbour settled.
pub fn starts() -> Vec<Entry> {
    Coordinate::starts(default_model()).map(Entry::of_coordinate).collect()
}
