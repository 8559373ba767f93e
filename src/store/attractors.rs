//! The variables that number the attractors, tell of those of starts, and list their events.

use ndarray::{ArrayD, IxDyn};

use super::catalogue::{
    ATTRACTOR, ATTRACTOR_AXIS, ATTRACTOR_CASE, ATTRACTOR_CASES, ATTRACTOR_CERTIFICATE,
    ATTRACTOR_CYCLE, ATTRACTOR_CYCLES_MEAN, ATTRACTOR_CYCLES_MOST, ATTRACTOR_INDEX,
    ATTRACTOR_INTEGRITY_ERROR, ATTRACTOR_INTEGRITY_FACTOR, ATTRACTOR_KIND,
    ATTRACTOR_MINIMAL_CRITICAL_SHOCK, ATTRACTOR_MULTIPLIER_IMAG, ATTRACTOR_MULTIPLIER_REAL,
    ATTRACTOR_PERIOD, ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR, ATTRACTOR_SHARE_HIGH,
    ATTRACTOR_SHARE_LOW, BASIN_ENTROPY, BASIN_ENTROPY_BOX, BASIN_ENTROPY_ERROR,
    BOUNDARY_BASIN_ENTROPY, BOUNDARY_BASIN_ENTROPY_ERROR, EDGE_CYCLE, EDGE_HIGH, EDGE_INDEX,
    EDGE_LOW, EDGE_MULTIPLIER_IMAG, EDGE_MULTIPLIER_REAL, EDGE_PERIOD, EDGE_RESIDUAL, EVENT,
    EVENT_ATTRACTOR, EVENT_KIND, EVENT_PERIOD, EVENT_UNCERTAINTY, Entry, INFERRED_ELSEWHERE,
    INFERRED_SAMPLE, Place, edges as edge_entries, section,
};
use super::{Dataset, Values, boundary};
use crate::attractor::{Entropy, Integrity, Share};
use crate::description::{Description, StateCoordinate};
use crate::orbit::Outcome;
use crate::orbit::matrix::Complex;
use crate::run::{
    AttractorEvent, AttractorRow, AttractorTable, Attractors, Edge, InferredSample, SharesAt,
};
use crate::study::{Coordinate, Study};

/// Adds to the dataset of a study which attractor each case has ended on, the table of the attractors of starts, and
/// that of events.
///
/// A column for each parameter on an axis says where the event is; that of the axis along which attractors
/// are continued was located to the uncertainty given. Without events there is no table.
pub fn add_attractors(
    dataset: &mut Dataset,
    study: &Study,
    (attractors, table): (&Attractors, &AttractorTable),
) {
    let dimensions = study.dimensions();
    let number = |of: &Option<u32>| of.map_or(-1, i64::from);
    let numbers = attractors.of_case.iter().map(number).collect();
    let array = ArrayD::from_shape_vec(IxDyn(&study.shape()), numbers).expect("one per case");
    if let Some(axis) = attractors.axis {
        let name = study.axes()[axis].coordinate.name().to_owned();
        dataset.attributes.insert(ATTRACTOR_AXIS.to_owned(), name);
    }
    dataset.put(ATTRACTOR, &dimensions, Values::Integer(array));
    if !table.rows.is_empty() {
        add_rows(dataset, &table.rows);
    }
    add_measures(dataset, table);
    if !table.edges.is_empty() {
        add_edges(dataset, &table.edges);
    }
    if let (Some(along), Some(axis)) = (&table.along, attractors.axis) {
        add_shares(dataset, study.axes()[axis].coordinate.name(), along);
    }
    if !attractors.events.is_empty() {
        add_events(dataset, study, attractors);
    }
}

/// The table of the attractors of starts; a periodic orbit has a section point for each cycle of its period, and what
/// is not periodic none.
fn add_rows(dataset: &mut Dataset, rows: &[AttractorRow]) {
    let points = |row: &AttractorRow| match row.attractor.outcome {
        Outcome::Periodic => row.attractor.points.clone(),
        _ => Vec::new(),
    };
    let longest = rows.iter().map(|row| points(row).len()).max().unwrap_or(0);
    let model = dataset.model();
    dataset.put_coordinate(ATTRACTOR_INDEX, Values::count(rows.len()));
    let mut whole = |entry: Entry, of: fn(&AttractorRow) -> i64| {
        dataset.put_column(entry, Values::integers(rows.iter().map(of).collect()));
    };
    whole(ATTRACTOR_KIND, |row| row.attractor.outcome as i64);
    whole(ATTRACTOR_PERIOD, |row| row.record.orbit.period as i64);
    whole(ATTRACTOR_CERTIFICATE, |row| row.record.orbit.certificate.proof as i64);
    whole(ATTRACTOR_CASE, |row| row.attractor.case as i64);
    whole(ATTRACTOR_CASES, |row| row.share.starts as i64);
    if rows.iter().any(|row| row.settling.is_some()) {
        whole(ATTRACTOR_CYCLES_MOST, |row| row.settling.map_or(0, |it| it.most as i64));
    }
    let mut real = |entry: Entry, of: &dyn Fn(&AttractorRow) -> f64| {
        dataset.put_column(entry, Values::reals(rows.iter().map(of).collect()));
    };
    real(ATTRACTOR_SHARE, &|row| row.share.value);
    real(ATTRACTOR_SHARE_ERROR, &|row| row.share.error);
    if rows.iter().all(|row| row.share.interval.is_some()) {
        let end =
            |row: &AttractorRow, which: usize| row.share.interval.map_or(f64::NAN, |it| it[which]);
        real(ATTRACTOR_SHARE_LOW, &|row| end(row, 0));
        real(ATTRACTOR_SHARE_HIGH, &|row| end(row, 1));
    }
    if rows.iter().all(|row| row.integrity.is_some()) {
        let of = |row: &AttractorRow, which: fn(&Integrity) -> f64| {
            row.integrity.as_ref().map_or(f64::NAN, which)
        };
        real(ATTRACTOR_MINIMAL_CRITICAL_SHOCK, &|row| row.shock);
        real(ATTRACTOR_INTEGRITY_FACTOR, &|row| of(row, |it| it.factor));
        real(ATTRACTOR_INTEGRITY_ERROR, &|row| of(row, |it| it.error));
    }
    if rows.iter().any(|row| row.settling.is_some()) {
        real(ATTRACTOR_CYCLES_MEAN, &|row| row.settling.map_or(f64::NAN, |it| it.mean));
    }
    for output in model.outputs() {
        let entry = Place::Attractor.of(Entry::of_output(output));
        real(entry, &|row| row.record.orbit.outputs[output]);
    }
    name_distances(dataset, model);
    let several = |width: usize, of: &dyn Fn(&AttractorRow, usize) -> f64| {
        let numbers = rows.iter().flat_map(|row| (0..width).map(move |at| of(row, at))).collect();
        Values::Real(ArrayD::from_shape_vec(IxDyn(&[rows.len(), width]), numbers).expect("a table"))
    };
    fn multipliers(row: &AttractorRow) -> &[Complex] {
        &row.record.orbit.certificate.multipliers
    }
    let real_parts = several(multipliers(&rows[0]).len(), &|row, at| multipliers(row)[at].re);
    let imaginary = several(multipliers(&rows[0]).len(), &|row, at| multipliers(row)[at].im);
    dataset.put_column(ATTRACTOR_MULTIPLIER_REAL, real_parts);
    dataset.put_column(ATTRACTOR_MULTIPLIER_IMAG, imaginary);
    if longest > 0 {
        dataset.put_coordinate(ATTRACTOR_CYCLE, Values::count(longest));
        for (i, entry) in section(dataset.model()).into_iter().enumerate() {
            let of = |row: &AttractorRow, cycle: usize| {
                points(row).get(cycle).map_or(f64::NAN, |it| it[i])
            };
            dataset.put_column(Place::Attractor.of(entry), several(longest, &of));
        }
    }
}

/// The saddles between basins.
fn add_edges(dataset: &mut Dataset, edges: &[Edge]) {
    dataset.put_coordinate(EDGE_INDEX, Values::count(edges.len()));
    let mut whole = |entry: Entry, of: fn(&Edge) -> i64| {
        dataset.put_column(entry, Values::integers(edges.iter().map(of).collect()));
    };
    whole(EDGE_LOW, |edge| i64::from(edge.between[0]));
    whole(EDGE_HIGH, |edge| i64::from(edge.between[1]));
    whole(EDGE_PERIOD, |edge| edge.saddle.points.len() as i64);
    let residuals = edges.iter().map(|edge| edge.saddle.residual).collect();
    dataset.put_column(EDGE_RESIDUAL, Values::reals(residuals));
    let several = |width: usize, of: &dyn Fn(&Edge, usize) -> f64| {
        let numbers =
            edges.iter().flat_map(|edge| (0..width).map(move |at| of(edge, at))).collect();
        Values::Real(
            ArrayD::from_shape_vec(IxDyn(&[edges.len(), width]), numbers).expect("a table"),
        )
    };
    let count = edges[0].saddle.multipliers.len();
    let real_parts = several(count, &|edge, at| edge.saddle.multipliers[at].re);
    let imaginary = several(count, &|edge, at| edge.saddle.multipliers[at].im);
    dataset.put_column(EDGE_MULTIPLIER_REAL, real_parts);
    dataset.put_column(EDGE_MULTIPLIER_IMAG, imaginary);
    let longest = edges.iter().map(|edge| edge.saddle.points.len()).max().unwrap_or(1);
    dataset.put_coordinate(EDGE_CYCLE, Values::count(longest));
    for (i, entry) in edge_entries(dataset.model()).into_iter().enumerate() {
        let of = |edge: &Edge, at: usize| edge.saddle.points.get(at).map_or(f64::NAN, |it| it[i]);
        dataset.put_column(entry, several(longest, &of));
    }
}

/// The shares along an axis, and what each attractor is there: period 0 and undecided where no start leads to it.
fn add_shares(dataset: &mut Dataset, axis: &str, along: &[SharesAt]) {
    let count = along.first().map_or(0, |at| at.shares.len());
    if count == 0 {
        return;
    }
    let (shape, dimensions) = (IxDyn(&[along.len(), count]), [axis, ATTRACTOR_INDEX.name]);
    dataset.put_coordinate(ATTRACTOR_INDEX, Values::count(count));
    let mut real = |entry: Entry, of: fn(&Share) -> f64| {
        let numbers = along.iter().flat_map(|at| at.shares.iter().map(of)).collect();
        let numbers = ArrayD::from_shape_vec(shape.clone(), numbers).expect("one per attractor");
        dataset.put(entry, &dimensions, Values::Real(numbers));
    };
    real(ATTRACTOR_SHARE, |share| share.value);
    real(ATTRACTOR_SHARE_ERROR, |share| share.error);
    if along.iter().any(|at| at.integrity.iter().any(Option::is_some)) {
        let mut room = |entry: Entry, of: fn(&Integrity) -> f64| {
            let all = along.iter().flat_map(|at| &at.integrity);
            let numbers = all.map(|it| it.as_ref().map_or(f64::NAN, of)).collect();
            let numbers =
                ArrayD::from_shape_vec(shape.clone(), numbers).expect("one per attractor");
            dataset.put(entry, &dimensions, Values::Real(numbers));
        };
        room(ATTRACTOR_INTEGRITY_FACTOR, |it| it.factor);
        room(ATTRACTOR_INTEGRITY_ERROR, |it| it.error);
        let shocks = along.iter().flat_map(|at| at.shock.iter().copied()).collect();
        let shocks = ArrayD::from_shape_vec(shape.clone(), shocks).expect("one per attractor");
        dataset.put(ATTRACTOR_MINIMAL_CRITICAL_SHOCK, &dimensions, Values::Real(shocks));
        let model = dataset.model();
        name_distances(dataset, model);
    }
    let mut whole = |entry: Entry, of: fn(&Option<(Outcome, u32)>) -> i64| {
        let numbers = along.iter().flat_map(|at| at.motions.iter().map(of)).collect();
        let numbers = ArrayD::from_shape_vec(shape.clone(), numbers).expect("one per attractor");
        dataset.put(entry, &dimensions, Values::Integer(numbers));
    };
    whole(ATTRACTOR_KIND, |it| it.map_or(Outcome::Undecided, |it| it.0) as i64);
    whole(ATTRACTOR_PERIOD, |it| it.map_or(0, |it| i64::from(it.1)));
}

/// What is known of the basins as a whole.
fn add_measures(dataset: &mut Dataset, table: &AttractorTable) {
    let mut real = |entry: Entry, value: f64| {
        dataset.put(entry, &[], Values::Real(ArrayD::from_elem(IxDyn(&[]), value)));
    };
    if let Some(Entropy { basin, boundary, .. }) = table.entropy {
        real(BASIN_ENTROPY, basin.value);
        real(BASIN_ENTROPY_ERROR, basin.error);
        real(BOUNDARY_BASIN_ENTROPY, boundary.value);
        real(BOUNDARY_BASIN_ENTROPY_ERROR, boundary.error);
    }
    let mut whole = |entry: Entry, number: usize| {
        let number = ArrayD::from_elem(IxDyn(&[]), number as i64);
        dataset.put(entry, &[], Values::Integer(number));
    };
    if let Some(Entropy { side, .. }) = table.entropy {
        whole(BASIN_ENTROPY_BOX, side);
    }
    if let Some(uncertainty) = &table.uncertainty {
        boundary::add(dataset, uncertainty);
    }
    if let Some(sample) = table.inferred {
        add_sample(dataset, sample);
    }
}

/// Adds how many of a sample of inferred cases are not as was inferred.
pub fn add_sample(dataset: &mut Dataset, sample: InferredSample) {
    let InferredSample { cases, elsewhere } = sample;
    for (entry, number) in [(INFERRED_SAMPLE, cases), (INFERRED_ELSEWHERE, elsewhere)] {
        let number = ArrayD::from_elem(IxDyn(&[]), number as i64);
        dataset.put(entry, &[], Values::Integer(number));
    }
}

fn add_events(dataset: &mut Dataset, study: &Study, attractors: &Attractors) {
    let events = &attractors.events;
    dataset.put_coordinate(EVENT, Values::count(events.len()));
    let mut whole = |entry: Entry, of: fn(&AttractorEvent) -> i64| {
        let values = Values::integers(events.iter().map(of).collect());
        dataset.put_column(entry, values);
    };
    whole(EVENT_KIND, |event| event.kind as i64);
    whole(EVENT_ATTRACTOR, |event| i64::from(event.attractor));
    whole(EVENT_PERIOD, |event| event.period as i64);
    let sections = section(dataset.model());
    let mut real = |entry: Entry, of: &dyn Fn(&AttractorEvent) -> f64| {
        let values = Values::reals(events.iter().map(of).collect());
        dataset.put_column(entry, values);
    };
    for (place, axis) in study.axes().iter().enumerate() {
        if let Coordinate::Parameter(parameter) = axis.coordinate {
            let at = |event: &AttractorEvent| match attractors.axis == Some(place) {
                true => event.value,
                false => study.case(event.case).parameters[parameter],
            };
            real(Place::Event.of(Entry::of_parameter(parameter)), &at);
        }
    }
    for (i, entry) in sections.into_iter().enumerate() {
        real(Place::Event.of(entry), &|event| event.section[i]);
    }
    let uncertainties = events.iter().map(|event| event.uncertainty).collect();
    let coordinate = attractors.axis.map(|axis| study.axes()[axis].coordinate);
    let unit = coordinate.map_or("1", |coordinate| coordinate.dimension().unit());
    dataset.put_column(EVENT_UNCERTAINTY, Values::reals(uncertainties)).unit = unit.to_owned();
}

/// Says of the distances between section points in what they are, and in which unit, as the model compares them.
fn name_distances(dataset: &mut Dataset, model: &'static Description) {
    let compared = match model.compared_as {
        [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        all => all.join(", "),
    };
    // A coordinate that is compared as it is has the unit of the distance.
    let as_it_is = |(it, words): &(StateCoordinate, &&str)| it.name() == **words;
    let mut coordinates = model.section_coordinates().zip(model.compared_as);
    let unit = coordinates.find(as_it_is).map(|(it, _)| it.start().dimension.unit());
    for entry in
        [ATTRACTOR_MINIMAL_CRITICAL_SHOCK, ATTRACTOR_INTEGRITY_FACTOR, ATTRACTOR_INTEGRITY_ERROR]
    {
        if let Some(variable) = dataset.variables.get_mut(entry.name) {
            variable.unit = unit.unwrap_or("1").to_owned();
            if entry.name != ATTRACTOR_INTEGRITY_ERROR.name {
                variable.long_name = format!("{}, by {compared}", entry.meaning);
            }
        }
    }
}
