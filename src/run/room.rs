//! How much room the basins of a grid of starts have.

use crate::attractor::{Integrity, Label, integrity};
use crate::model::Setting;
use crate::study::{Axis, CaseSet, Coordinate, Study, Varying};

/// The grid of the starts of a study, as distances are measured in it: omega r, y1 and y2 [m/s].
pub(super) struct Room {
    /// The positions along each axis of starts.
    axes: Vec<Vec<f64>>,
}

impl Room {
    /// That of the starts of a grid that begin with those of `case`, if all of its axes of starts are coordinates of the section.
    pub(super) fn of(study: &Study, case: usize) -> Option<Room> {
        let CaseSet::Grid(_) = study.case_set else { return None };
        let scales = study.model().scales(&Setting::of(&study.case(case)));
        let names: Vec<Coordinate> = Coordinate::of_section(study.base.model()).collect();
        let starts: Vec<&Axis> = study.axes().iter().filter(|axis| axis.is_of_starts()).collect();
        if starts.is_empty() {
            return None;
        }
        let mut axes = Vec::with_capacity(starts.len());
        for axis in &starts {
            // Along a path of several the distance is none along an axis.
            let Varying { coordinate, values } = axis.single()?;
            let i = names.iter().position(|name| name == coordinate)?;
            axes.push(values.iter().map(|value| scales[i] * value).collect());
        }
        Some(Room { axes })
    }

    /// The room of the basin of an attractor by its number; `label` tells what each start leads to.
    pub(super) fn around(&self, number: u32, label: impl Fn(usize) -> Label) -> Integrity {
        integrity(&self.axes, label, number)
    }
}
