//! The variables that number the attractors, tell of those of starts, and list their events.

use ndarray::{ArrayD, IxDyn};

use super::catalogue::{
    ATTRACTOR, ATTRACTOR_AXIS, ATTRACTOR_CASE, ATTRACTOR_CASES, ATTRACTOR_CERTIFICATE,
    ATTRACTOR_CYCLE, ATTRACTOR_CYCLES_90, ATTRACTOR_CYCLES_99, ATTRACTOR_CYCLES_MEAN,
    ATTRACTOR_CYCLES_MEDIAN, ATTRACTOR_CYCLES_MOST, ATTRACTOR_INDEX, ATTRACTOR_INTEGRITY_ERROR,
    ATTRACTOR_INTEGRITY_FACTOR, ATTRACTOR_KIND, ATTRACTOR_MINIMAL_CRITICAL_SHOCK,
    ATTRACTOR_MULTIPLIER_IMAG, ATTRACTOR_MULTIPLIER_REAL, ATTRACTOR_PERIOD, ATTRACTOR_SHARE,
    ATTRACTOR_SHARE_ERROR, ATTRACTOR_SHARE_HIGH, ATTRACTOR_SHARE_LOW, BASIN_ENTROPY,
    BASIN_ENTROPY_BOX, BASIN_ENTROPY_ERROR, BOUNDARY_BASIN_ENTROPY, BOUNDARY_BASIN_ENTROPY_ERROR,
    EDGE_CYCLE, EDGE_HIGH, EDGE_INDEX, EDGE_LOW, EDGE_MULTIPLIER_IMAG, EDGE_MULTIPLIER_REAL,
    EDGE_PERIOD, EDGE_RESIDUAL, EVENT, EVENT_ATTRACTOR, EVENT_KIND, EVENT_PERIOD, EVENT_PLACE,
    EVENT_UNCERTAINTY, Entry, INFERRED_ELSEWHERE, INFERRED_SAMPLE, Place, SETTLED_CYCLES,
    SETTLED_NEVER, SETTLED_SHARE, SETTLED_STEP, edges as edge_entries, section,
};
use super::columns::Columns;
use super::{Dataset, Values, boundary, manifolds};
use crate::attractor::{Entropy, Integrity};
use crate::description::{Description, Section};
use crate::orbit::Outcome;
use crate::orbit::matrix::Complex;
use crate::run::{
    AttractorRow, AttractorTable, Attractors, Edge, InferredSample, Settling, SettlingTimes,
    SharesAt,
};
use crate::study::{Axis, Coordinate, Study};

/// Adds to the dataset of a study which attractor each case has ended on, the table of the attractors of starts, and
/// that of events.
///
/// A column for each parameter on an axis says where the event is; that of the axis along which attractors
/// are continued was located to the uncertainty given. Without events there is no table.
pub fn add_attractors(
    dataset: &mut Dataset,
    study: &Study,
    attractors: &Attractors,
    table: &AttractorTable,
) {
    let dimensions = study.dimensions();
    let numbers = attractors.of_case.iter().map(|it| it.map_or(-1, i64::from)).collect();
    let array = ArrayD::from_shape_vec(IxDyn(&study.shape()), numbers).expect("one per case");
    if let Some(axis) = attractors.axis {
        let name = study.axes()[axis].name().to_owned();
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
    if let Some(found) = &table.manifolds {
        manifolds::add(dataset, study, found);
    }
    if let (Some(along), Some(axis)) = (&table.along, attractors.axis) {
        add_shares(dataset, study.axes()[axis].name(), along);
    }
    if !attractors.events.is_empty() {
        add_events(dataset, study, attractors);
    }
}

/// The table of the attractors of starts.
fn add_rows(dataset: &mut Dataset, rows: &[AttractorRow]) {
    dataset.put_coordinate(ATTRACTOR_INDEX, Values::count(rows.len()));
    let mut columns = Columns { dataset, rows };
    columns.integers(ATTRACTOR_KIND, |row| row.attractor.outcome as i64);
    columns.integers(ATTRACTOR_PERIOD, |row| row.record.orbit.period as i64);
    columns.integers(ATTRACTOR_CERTIFICATE, |row| row.record.orbit.certificate.proof as i64);
    columns.integers(ATTRACTOR_CASE, |row| row.attractor.case as i64);
    columns.integers(ATTRACTOR_CASES, |row| row.share.starts as i64);
    if rows.iter().any(|row| row.settling.is_some()) {
        let quantiles = [ATTRACTOR_CYCLES_MEDIAN, ATTRACTOR_CYCLES_90, ATTRACTOR_CYCLES_99];
        for (at, entry) in quantiles.into_iter().enumerate() {
            let quantile = |it: Settling| it.quantiles[at] as i64;
            columns.integers(entry, |row| row.settling.map_or(0, quantile));
        }
        columns.integers(ATTRACTOR_CYCLES_MOST, |row| row.settling.map_or(0, |it| it.most as i64));
        columns.reals(ATTRACTOR_CYCLES_MEAN, |row| row.settling.map_or(f64::NAN, |it| it.mean));
    }
    add_basins(&mut columns);
    add_orbits(&mut columns);
    let model = dataset.model();
    name_distances(dataset, model);
}

/// How large the basins of the attractors are.
fn add_basins(columns: &mut Columns<'_, AttractorRow>) {
    columns.reals(ATTRACTOR_SHARE, |row| row.share.value);
    columns.reals(ATTRACTOR_SHARE_ERROR, |row| row.share.error);
    if columns.rows.iter().all(|row| row.share.interval.is_some()) {
        for (which, entry) in [ATTRACTOR_SHARE_LOW, ATTRACTOR_SHARE_HIGH].into_iter().enumerate() {
            columns.reals(entry, |row| row.share.interval.map_or(f64::NAN, |ends| ends[which]));
        }
    }
    if columns.rows.iter().all(|row| row.integrity.is_some()) {
        columns.reals(ATTRACTOR_MINIMAL_CRITICAL_SHOCK, |row| row.shock);
        columns.reals(ATTRACTOR_INTEGRITY_FACTOR, |row| factor(&row.integrity));
        columns.reals(ATTRACTOR_INTEGRITY_ERROR, |row| error(&row.integrity));
    }
}

fn factor(integrity: &Option<Integrity>) -> f64 {
    integrity.as_ref().map_or(f64::NAN, |it| it.factor)
}

fn error(integrity: &Option<Integrity>) -> f64 {
    integrity.as_ref().map_or(f64::NAN, |it| it.error)
}

/// The orbits of the attractors: outputs, multipliers and section points.
fn add_orbits(columns: &mut Columns<'_, AttractorRow>) {
    let model = columns.dataset.model();
    for output in model.outputs() {
        let entry = Place::Attractor.of(Entry::of_output(output));
        columns.reals(entry, |row| row.record.orbit.outputs[output]);
    }
    let count = multipliers(&columns.rows[0]).len();
    columns.several(ATTRACTOR_MULTIPLIER_REAL, count, |row, at| multipliers(row)[at].re);
    columns.several(ATTRACTOR_MULTIPLIER_IMAG, count, |row, at| multipliers(row)[at].im);
    let longest = columns.rows.iter().map(|row| points(row).len()).max().unwrap_or(0);
    if longest > 0 {
        columns.dataset.put_coordinate(ATTRACTOR_CYCLE, Values::count(longest));
        for (i, entry) in section(model).into_iter().enumerate() {
            columns.several(Place::Attractor.of(entry), longest, |row, cycle| {
                points(row).get(cycle).map_or(f64::NAN, |it| it[i])
            });
        }
    }
}

fn multipliers(row: &AttractorRow) -> &[Complex] {
    &row.record.orbit.certificate.multipliers
}

/// A periodic orbit has a section point for each cycle of its period, and what is not periodic none.
fn points(row: &AttractorRow) -> &[Section] {
    match row.attractor.outcome {
        Outcome::Periodic => &row.attractor.points,
        _ => &[],
    }
}

/// The saddles between basins.
fn add_edges(dataset: &mut Dataset, edges: &[Edge]) {
    let model = dataset.model();
    dataset.put_coordinate(EDGE_INDEX, Values::count(edges.len()));
    let mut columns = Columns { dataset, rows: edges };
    columns.integers(EDGE_LOW, |edge| i64::from(edge.between[0]));
    columns.integers(EDGE_HIGH, |edge| i64::from(edge.between[1]));
    columns.integers(EDGE_PERIOD, |edge| edge.saddle.points.len() as i64);
    columns.reals(EDGE_RESIDUAL, |edge| edge.saddle.residual);
    let count = edges[0].saddle.multipliers.len();
    columns.several(EDGE_MULTIPLIER_REAL, count, |edge, at| edge.saddle.multipliers[at].re);
    columns.several(EDGE_MULTIPLIER_IMAG, count, |edge, at| edge.saddle.multipliers[at].im);
    let longest = edges.iter().map(|edge| edge.saddle.points.len()).max().unwrap_or(1);
    columns.dataset.put_coordinate(EDGE_CYCLE, Values::count(longest));
    for (i, entry) in edge_entries(model).into_iter().enumerate() {
        columns.several(entry, longest, |edge, cycle| {
            edge.saddle.points.get(cycle).map_or(f64::NAN, |it| it[i])
        });
    }
}

/// The shares along an axis, and what each attractor is there: period 0 and undecided where no start leads to it.
fn add_shares(dataset: &mut Dataset, axis: &str, along: &[SharesAt]) {
    let attractors = along.first().map_or(0, |at| at.shares.len());
    if attractors == 0 {
        return;
    }
    dataset.put_coordinate(ATTRACTOR_INDEX, Values::count(attractors));
    let mut columns = AlongAxis { dataset, axis, along, attractors };
    columns.reals(ATTRACTOR_SHARE, |at, i| at.shares[i].value);
    columns.reals(ATTRACTOR_SHARE_ERROR, |at, i| at.shares[i].error);
    columns.integers(ATTRACTOR_KIND, |at, i| {
        at.motions[i].map_or(Outcome::Undecided, |(outcome, _)| outcome) as i64
    });
    columns.integers(ATTRACTOR_PERIOD, |at, i| {
        at.motions[i].map_or(0, |(_, period)| i64::from(period))
    });
    if along.iter().any(|at| at.integrity.iter().any(Option::is_some)) {
        columns.reals(ATTRACTOR_INTEGRITY_FACTOR, |at, i| factor(&at.integrity[i]));
        columns.reals(ATTRACTOR_INTEGRITY_ERROR, |at, i| error(&at.integrity[i]));
        columns.reals(ATTRACTOR_MINIMAL_CRITICAL_SHOCK, |at, i| at.shock[i]);
        let model = dataset.model();
        name_distances(dataset, model);
    }
}

/// The attractors at each value along an axis, of which variables over the axis and the attractors are put into a dataset.
struct AlongAxis<'a> {
    dataset: &'a mut Dataset,
    axis: &'a str,
    along: &'a [SharesAt],
    attractors: usize,
}

impl AlongAxis<'_> {
    fn reals(&mut self, entry: Entry, of: impl Fn(&SharesAt, usize) -> f64) {
        let values = Values::Real(self.array(of));
        self.dataset.put(entry, &[self.axis, ATTRACTOR_INDEX.name], values);
    }

    fn integers(&mut self, entry: Entry, of: impl Fn(&SharesAt, usize) -> i64) {
        let values = Values::Integer(self.array(of));
        self.dataset.put(entry, &[self.axis, ATTRACTOR_INDEX.name], values);
    }

    fn array<T>(&self, of: impl Fn(&SharesAt, usize) -> T) -> ArrayD<T> {
        let shape = IxDyn(&[self.along.len(), self.attractors]);
        ArrayD::from_shape_fn(shape, |place| of(&self.along[place[0]], place[1]))
    }
}

/// What is known of the basins as a whole.
fn add_measures(dataset: &mut Dataset, table: &AttractorTable) {
    if let Some(Entropy { basin, boundary, side }) = &table.entropy {
        dataset.put(BASIN_ENTROPY, &[], Values::real(basin.value));
        dataset.put(BASIN_ENTROPY_ERROR, &[], Values::real(basin.error));
        dataset.put(BOUNDARY_BASIN_ENTROPY, &[], Values::real(boundary.value));
        dataset.put(BOUNDARY_BASIN_ENTROPY_ERROR, &[], Values::real(boundary.error));
        dataset.put(BASIN_ENTROPY_BOX, &[], Values::integer(*side as i64));
    }
    if let Some(uncertainty) = &table.uncertainty {
        boundary::add(dataset, uncertainty);
    }
    if let Some(wada) = &table.wada {
        boundary::add_wada(dataset, wada);
    }
    if let Some(times) = &table.settling {
        add_settled(dataset, times);
    }
    if let Some(sample) = table.inferred {
        add_sample(dataset, sample);
    }
}

/// Adds which share of the starts has settled after so many cycles, and how many never do.
fn add_settled(dataset: &mut Dataset, times: &SettlingTimes) {
    dataset.put(SETTLED_NEVER, &[], Values::integer(times.unsettled() as i64));
    let curve = times.curve();
    let Some(first) = curve.first() else { return };
    dataset.put_coordinate(SETTLED_STEP, Values::count(curve.len()));
    let mut columns = Columns { dataset, rows: &curve };
    columns.integers(SETTLED_CYCLES, |at| at.cycles as i64);
    columns.several(SETTLED_SHARE, first.shares.len(), |at, number| at.shares[number]);
}

/// Adds how many of a sample of inferred cases are not as was inferred.
pub fn add_sample(dataset: &mut Dataset, sample: InferredSample) {
    let InferredSample { cases, elsewhere } = sample;
    dataset.put(INFERRED_SAMPLE, &[], Values::integer(cases as i64));
    dataset.put(INFERRED_ELSEWHERE, &[], Values::integer(elsewhere as i64));
}

fn add_events(dataset: &mut Dataset, study: &Study, attractors: &Attractors) {
    let events = &attractors.events;
    dataset.put_coordinate(EVENT, Values::count(events.len()));
    let sections = section(dataset.model());
    let mut columns = Columns { dataset, rows: events };
    columns.integers(EVENT_KIND, |event| event.kind as i64);
    columns.integers(EVENT_ATTRACTOR, |event| i64::from(event.attractor));
    columns.integers(EVENT_PERIOD, |event| event.period as i64);
    let along = attractors.axis.map(|axis| &study.axes()[axis]);
    for coordinate in study.case_set.varied() {
        let Coordinate::Parameter(parameter) = coordinate else { continue };
        let entry = Place::Event.of(Entry::of_parameter(parameter));
        let own = along.filter(|axis| axis.values_of(coordinate).is_some());
        columns.reals(entry, |event| match own {
            Some(axis) if axis.single().is_some() => event.value,
            Some(path) => path.value_between(coordinate, event.value).unwrap_or(f64::NAN),
            None => study.case(event.case).parameters[parameter],
        });
    }
    let single = along.and_then(Axis::single);
    if along.is_some() && single.is_none() {
        columns.reals(EVENT_PLACE, |event| event.value);
    }
    for (i, entry) in sections.into_iter().enumerate() {
        columns.reals(Place::Event.of(entry), |event| event.section[i]);
    }
    columns.reals(EVENT_UNCERTAINTY, |event| event.uncertainty);
    let unit = single.map_or("1", |it| it.coordinate.dimension().unit());
    if let Some(uncertainty) = dataset.variables.get_mut(EVENT_UNCERTAINTY.name) {
        uncertainty.unit = unit.to_owned();
    }
}

/// Says of the distances between section points in what they are, and in which unit, as the model compares them.
fn name_distances(dataset: &mut Dataset, model: &'static Description) {
    let compared = match model.compared_as {
        [others @ .., last] if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        all => all.join(", "),
    };
    // A coordinate that is compared as it is has the unit of the distance.
    let mut coordinates = model.section_coordinates().zip(model.compared_as);
    let as_it_is = coordinates.find(|(it, words)| it.name() == **words);
    let unit = as_it_is.map(|(it, _)| it.start().dimension.unit());
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
