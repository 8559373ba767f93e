//! How much room the basins of a grid of starts have.

use crate::attractor::{Attractor, Integrity, Label, SeenPoint, integrity};
use crate::capsule::{AsPrinted, Filippov, Switching};
use crate::flow::{Metric, System};
use crate::orbit::Outcome;
use crate::study::{Axis, CaseSet, Coordinate, Study};

/// The grid of the starts of a study, as distances are measured in it: omega r, y1 and y2 [m/s].
pub(super) struct Room {
    /// The positions along each axis of starts.
    axes: Vec<Vec<f64>>,
    /// For each coordinate of the section the place of its axis, or else its value.
    coordinates: [Result<usize, f64>; 3],
    /// Whether the starts lie at the section.
    in_section: bool,
    metric: Metric<3>,
}

impl Room {
    /// That of the starts of a grid that begin with those of `case`, if all of its axes of starts are coordinates of the section.
    pub(super) fn of(study: &Study, case: usize) -> Option<Room> {
        let CaseSet::Grid(_) = study.case_set else { return None };
        let first = study.case(case);
        let metric = match first.parameters.switching {
            Switching::Filippov => first.read::<Filippov>().system.metric(),
            Switching::AsPrinted => first.read::<AsPrinted>().system.metric(),
        };
        let names = [Coordinate::StartR, Coordinate::StartY1, Coordinate::StartY2];
        let held = [first.start.r, first.start.y1, first.start.y2];
        let starts: Vec<&Axis> =
            study.axes().iter().filter(|axis| axis.coordinate.is_start()).collect();
        if starts.is_empty() {
            return None;
        }
        let mut axes = Vec::with_capacity(starts.len());
        for axis in &starts {
            let i = names.iter().position(|name| *name == axis.coordinate)?;
            axes.push(axis.values.iter().map(|value| metric.scales[i] * value).collect());
        }
        let place = |i: usize| starts.iter().position(|axis| axis.coordinate == names[i]);
        let coordinates = std::array::from_fn(|i| place(i).ok_or(metric.scales[i] * held[i]));
        let in_section = first.start_phase == first.section_phase;
        Some(Room { axes, coordinates, in_section, metric })
    }

    /// The room of the basin of an attractor; `label` tells what each start leads to.
    pub(super) fn around(
        &self,
        (number, attractor): (u32, Option<&Attractor<3>>),
        label: impl Fn(usize) -> Label,
    ) -> Integrity {
        let is_known = |it: &&Attractor<3>| it.outcome == Outcome::Periodic && self.in_section;
        let points = attractor.filter(is_known).map_or(&[][..], |it| &it.points);
        let points: Vec<SeenPoint> = points.iter().map(|point| self.seen(point)).collect();
        integrity(&self.axes, label, number, &points)
    }

    fn seen(&self, point: &[f64; 3]) -> SeenPoint {
        let (mut along, mut beside) = (vec![0.0; self.axes.len()], 0.0);
        for (i, coordinate) in self.coordinates.iter().enumerate() {
            let here = self.metric.scales[i] * point[i];
            match coordinate {
                Ok(axis) => along[*axis] = here,
                Err(held) => beside += (here - held) * (here - held),
            }
        }
        SeenPoint { along, beside: beside.sqrt() }
    }
}
