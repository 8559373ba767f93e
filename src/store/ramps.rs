//! The variables of the ramps in a file of results, beside those of the sweep.

use super::catalogue::*;
use super::columns::Columns;
use super::{Dataset, Values};
use crate::description::{Parameter, Section};
use crate::run::{RampPoint, Ramped};
use crate::study::{Ramp, Study};

/// A point of a ramp among all.
struct Row<'a> {
    ramp: usize,
    along: Parameter,
    point: &'a RampPoint,
    /// The point before on the same ramp.
    before: Option<&'a RampPoint>,
    section: Section,
}

impl Row<'_> {
    /// The mean velocity of what drifts over the cycle that ends here.
    fn drift_speed(&self) -> f64 {
        let (Some(drift), Some(before)) = (self.along.model().drift, self.before) else {
            return f64::NAN;
        };
        let progression = self.point.state.values()[drift] - before.state.values()[drift];
        progression / self.point.duration
    }
}

/// Adds what came of the ramps of `study`, in its order; nothing where it has none.
pub fn add_ramps(dataset: &mut Dataset, study: &Study, ramped: &[Ramped]) {
    if study.ramps.is_empty() {
        return;
    }
    let rows = rows(&study.ramps, ramped);
    let jumps = ramped.iter().map(|it| it.jumps.len()).sum();
    for (dimension, length) in
        [(RAMP_INDEX, ramped.len()), (RAMP_POINT, rows.len()), (RAMP_JUMP, jumps)]
    {
        dataset.put_coordinate(dimension, Values::count(length));
    }
    let names: Vec<&str> = study.ramps.iter().map(|ramp| ramp.name.as_str()).collect();
    dataset.texts.insert(RAMP_NAMES.to_owned(), names.join("\n"));
    add_index(dataset, &study.ramps, ramped);
    add_points(dataset, &rows);
    add_jumps(dataset, ramped);
}

/// The points of all ramps, one ramp after the other.
fn rows<'a>(ramps: &[Ramp], ramped: &'a [Ramped]) -> Vec<Row<'a>> {
    let of_ramp = |(ramp, (asked, found)): (usize, (&Ramp, &'a Ramped))| {
        let before = std::iter::once(None).chain(found.points.iter().map(Some));
        let along = asked.along;
        found.points.iter().zip(before).map(move |(point, before)| Row {
            ramp,
            along,
            point,
            before,
            section: point.state.section(),
        })
    };
    ramps.iter().zip(ramped).enumerate().flat_map(of_ramp).collect()
}

fn add_index(dataset: &mut Dataset, ramps: &[Ramp], ramped: &[Ramped]) {
    let model = dataset.model();
    let along = ramps.iter().map(|ramp| ramp.along.index() as i64);
    let along = Values::integers(along.collect());
    dataset.put_column(RAMP_ALONG, along).flags = parameters(model);
    let beginnings = ramped.iter().map(|it| it.settled.map_or(-1, |(outcome, _)| outcome as i64));
    dataset.put_column(RAMP_BEGINNING, Values::integers(beginnings.collect()));
    let failures = ramped.iter().map(|it| it.failure.as_ref().map_or(0, |it| it.reason as i64));
    let failures = Values::integers(failures.collect());
    dataset.put_column(RAMP_FAILURE, failures).flags = reasons(model);
    let is_told = |it: &Parameter| ramps.iter().any(|ramp| ramp.parameters.states(*it));
    for parameter in model.parameters().filter(is_told) {
        let values = ramps.iter().map(|ramp| ramp.parameters[parameter]).collect();
        let entry = Place::RampFirst.of(Entry::of_parameter(parameter));
        dataset.put_column(entry, Values::reals(values));
    }
}

/// The points; a parameter that does not change along a ramp is NaN there, and sums are those of the cycle that ends there.
fn add_points(dataset: &mut Dataset, rows: &[Row<'_>]) {
    let model = dataset.model();
    let mut columns = Columns { dataset, rows };
    columns.integers(RAMP, |row| row.ramp as i64);
    columns.reals(RAMP_TIME, |row| row.point.time);
    for parameter in model.parameters().filter(|it| rows.iter().any(|row| row.along == *it)) {
        let entry = Place::Ramp.of(Entry::of_parameter(parameter));
        columns.reals(entry, |row| match row.along == parameter {
            true => row.point.value,
            false => f64::NAN,
        });
    }
    for (place, entry) in section(model).into_iter().enumerate() {
        columns.reals(Place::Ramp.of(entry), |row| row.section[place]);
    }
    for output in ramp_outputs(model) {
        let entry = Place::Ramp.of(Entry::of_output(output));
        match model.motion.sums.iter().position(|name| *name == output.name()) {
            Some(place) => {
                columns.reals(entry, |row| row.point.sums.get(place).copied().unwrap_or(f64::NAN))
            }
            None => columns.reals(entry, Row::drift_speed),
        }
    }
}

fn add_jumps(dataset: &mut Dataset, ramped: &[Ramped]) {
    let mut jumps = Vec::new();
    let mut first = 0;
    for found in ramped {
        jumps.extend(found.jumps.iter().map(|jump| (first + jump.point, jump.size)));
        first += found.points.len();
    }
    let mut columns = Columns { dataset, rows: &jumps };
    columns.integers(JUMP_POINT, |jump| jump.0 as i64);
    columns.reals(JUMP_SIZE, |jump| jump.1);
}
