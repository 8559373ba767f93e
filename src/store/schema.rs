//! Which variables a file of results has: a study and its records as a labelled dataset.

use std::collections::BTreeMap;

use ndarray::{ArrayD, IxDyn};

use super::catalogue::*;
use super::names::MODEL;
use super::names::OF_PROTOCOL;
use super::slab::{Filling, INFERRED, MISSING, Slab};
use super::{Dataset, Values, Variable, drawn, provenance};
use crate::motion::Orbit;
use crate::of::default_model;
use crate::orbit::Exponents;
use crate::orbit::matrix::Complex;
use crate::run::Record;
use crate::study::{Axis, CaseSet, Coordinate, Study, Varying};

/// Attribute: what was taken where the study leaves it open, see [`Study::remarks`].
pub const REMARKS: &str = "study_remarks";
/// Attribute: differs between studies whose cases differ, see [`Study::fingerprint`].
pub const FINGERPRINT: &str = "study_fingerprint";

/// Attribute: where histories begin, where that is not where the case has settled: [`FROM_START`].
pub const HISTORY_FROM: &str = "history_from";
/// What it says of histories that begin where the case starts.
pub const FROM_START: &str = "start";

/// Attribute: the axis along which starts were inherited, which is the one that `direction` goes along.
pub const INHERITED_ALONG: &str = "start_inherited_along";

/// The dataset of a study; `records` holds one record per case, in any order, or fewer.
///
/// Dimensions: the axes of the study, slowest first, then `direction` where starts were inherited
/// in several directions, or `draw` alone; after them `point`, `impact_point` or `history_time` for what each case has several of.
pub fn dataset(study: &Study, records: &[Record]) -> Dataset {
    let mut dataset = frame(study);
    let columns = columns(study, records);
    let slab = Slab::whole(&study.shape());
    for (name, variable) in columns.variables {
        let mut filling = Filling::new(&slab, &name, &variable.values);
        let places = records.iter().map(|record| Some(record.index));
        match &variable.values {
            Values::Real(own) => filling.put_reals(places, own.as_slice().expect("a table")),
            Values::Integer(own) => filling.put_integers(places, own.as_slice().expect("a table")),
        }
        let label = over_axes(study, &name, variable, records.len() < study.cases());
        dataset.variables.insert(name, Variable { values: filling.finish(), ..label });
    }
    dataset.coordinates.extend(columns.coordinates);
    dataset
}

/// A variable over cases as one over the axes of the study, its numbers as they were.
pub(super) fn over_axes(
    study: &Study,
    name: &str,
    variable: Variable,
    is_partial: bool,
) -> Variable {
    let outer = study.dimensions().into_iter().map(str::to_owned);
    let inner = variable.dimensions[1..].iter().cloned();
    let dimensions = outer.chain(inner).collect();
    let mut flags = variable.flags;
    if is_partial && name == OUTCOME.name {
        flags.insert(0, (MISSING.0, MISSING.1.to_owned()));
    }
    if study.refine.is_some() && name == OUTCOME.name {
        flags.insert(0, (INFERRED.0, INFERRED.1.to_owned()));
    }
    Variable { dimensions, flags, ..variable }
}

/// The variables of a study over its `records` alone, in their order along the dimension `case`, and the
/// coordinates of what each case has several of.
pub fn columns(study: &Study, records: &[Record]) -> Dataset {
    let table = Table { study, orbits: records.iter().map(|record| &record.orbit).collect() };
    let mut columns = Dataset::default();
    add_verdicts(&mut columns, &table);
    for &output in &study.outputs {
        let values = table.reals(|orbit| orbit.outputs[output]);
        table.put(&mut columns, Entry::of_output(output), values);
    }
    add_certificates(&mut columns, &table);
    add_section(&mut columns, &table);
    add_impacts(&mut columns, &table);
    add_history(&mut columns, &table);
    columns
}

/// A study without records: its axes, its constants, and the provenance of the file.
pub fn frame(study: &Study) -> Dataset {
    let mut dataset = Dataset::default();
    add_axes(&mut dataset, study);
    add_constants(&mut dataset, study);
    dataset.attributes.insert("title".to_owned(), study.title.clone());
    dataset.attributes.extend(provenance::attributes());
    dataset.attributes.extend(protocol(study));
    if study.base.model().without_own() != default_model() {
        dataset.attributes.insert(MODEL.to_owned(), study.base.model().name.to_owned());
    }
    let choices = study.base.choices().map(|(name, chosen)| (name.to_owned(), chosen.to_owned()));
    dataset.attributes.extend(choices);
    dataset.attributes.insert(FINGERPRINT.to_owned(), study.fingerprint());
    if !study.remarks.is_empty() {
        dataset.attributes.insert(REMARKS.to_owned(), study.remarks.join("; "));
    }
    if study.protocol.history.is_some_and(|it| it.from_start) {
        dataset.attributes.insert(HISTORY_FROM.to_owned(), FROM_START.to_owned());
    }
    if let Some(inherit) = study.inherit() {
        let axis = study.axes()[inherit.axis].name();
        dataset.attributes.insert(INHERITED_ALONG.to_owned(), axis.to_owned());
    }
    dataset.texts.insert(STUDY_TEXT.to_owned(), study.text.clone());
    if let Some(equations) = study.base.model().equations {
        dataset.texts.insert(SYSTEM_TEXT.to_owned(), equations.tables.to_owned());
    }
    if let Some(own) = study.base.model().own {
        dataset.texts.insert(OWN_TEXT.to_owned(), own.table.to_owned());
    }
    dataset
}

/// Numbers that a file has of each case of a study, by the name of the variable.
pub fn numbers_of_case(study: &Study) -> BTreeMap<String, usize> {
    let variables = columns(study, &[]).variables.into_iter();
    variables.map(|(name, it)| (name, it.values.shape()[1..].iter().product())).collect()
}

/// How the cases were integrated, which the file says even where the study left it to the program.
fn protocol(study: &Study) -> impl Iterator<Item = (String, String)> {
    let protocol = &study.protocol;
    let asked = (protocol.exponents != Exponents::Largest)
        .then(|| ("exponents", protocol.exponents.name().to_owned()));
    let wanted = protocol.mean_error.map(|error| ("mean_error", format!("{error:e}")));
    let always = [
        ("tolerance", format!("{:e}", protocol.tolerance)),
        ("recurrence", format!("{:e}", protocol.recurrence)),
        ("accelerate", protocol.accelerate.to_string()),
        ("max_cycles", protocol.max_cycles.to_string()),
        ("max_steps", protocol.max_steps.to_string()),
        ("max_period", protocol.max_period.to_string()),
        ("measured_cycles", protocol.measured_cycles.to_string()),
        ("exponent_cycles", protocol.exponent_cycles.to_string()),
        ("exponent_error", format!("{:e}", protocol.exponent_error)),
    ];
    let all = always.into_iter().chain(asked).chain(wanted);
    all.map(|(key, value)| (format!("{OF_PROTOCOL}{key}"), value))
}

/// The orbits of some cases of a study.
struct Table<'a> {
    study: &'a Study,
    orbits: Vec<&'a Orbit>,
}

impl Table<'_> {
    fn array<T: Clone>(&self, extra: Option<usize>, values: Vec<T>) -> ArrayD<T> {
        let shape: Vec<usize> = std::iter::once(self.orbits.len()).chain(extra).collect();
        ArrayD::from_shape_vec(IxDyn(&shape), values).expect("one value per case and point")
    }

    /// One real per case.
    fn reals(&self, value: impl Fn(&Orbit) -> f64) -> Values {
        Values::Real(self.array(None, self.orbits.iter().map(|orbit| value(orbit)).collect()))
    }

    /// One integer per case.
    fn integers(&self, value: impl Fn(&Orbit) -> i64) -> Values {
        Values::Integer(self.array(None, self.orbits.iter().map(|orbit| value(orbit)).collect()))
    }

    /// Several reals per case, padded with NaN.
    fn rows(&self, length: usize, value: impl Fn(&Orbit, usize) -> Option<f64>) -> Values {
        let mut values = Vec::with_capacity(self.orbits.len() * length);
        for orbit in &self.orbits {
            values.extend((0..length).map(|i| value(orbit, i).unwrap_or(f64::NAN)));
        }
        Values::Real(self.array(Some(length), values))
    }

    /// A part of each of so many multipliers per case.
    fn multipliers(&self, count: usize, part: fn(&Complex) -> f64) -> Values {
        self.rows(count, |orbit, i| orbit.certificate.multipliers.get(i).map(part))
    }

    /// Adds a variable over the cases, with what each case has several of.
    fn put<'d>(&self, dataset: &'d mut Dataset, entry: Entry, values: Values) -> &'d mut Variable {
        let dimensions: Vec<&str> = std::iter::once(CASE).chain(entry.dimensions()).collect();
        dataset.put(entry, &dimensions, values)
    }
}

fn add_axes(dataset: &mut Dataset, study: &Study) {
    if let CaseSet::Draws(draws) = &study.case_set {
        drawn::add(dataset, draws);
    }
    for axis in study.axes() {
        add_axis(dataset, axis);
    }
    if let Some(directions) = study.direction_axis() {
        let codes = directions.iter().map(|&direction| direction as i64).collect();
        let mut flags = DIRECTION.flags();
        flags.retain(|(code, _)| directions.iter().any(|&it| it as i64 == *code));
        let axis = [DIRECTION.name.to_owned()].to_vec();
        let variable = Variable::of(DIRECTION, axis, Values::integers(codes)).with_flags(flags);
        dataset.coordinates.push((DIRECTION.name.to_owned(), variable));
    }
}

/// Adds an axis: its values, or of a path its places, with the values of what varies along it as variables over these.
fn add_axis(dataset: &mut Dataset, axis: &Axis) {
    let Some(path) = &axis.path else {
        for Varying { coordinate, values } in &axis.varying {
            let values = Values::reals(values.clone());
            dataset.put_coordinate(Entry::of_coordinate(*coordinate), values);
        }
        return;
    };
    dataset.put_coordinate(Entry::of_path(path), Values::count(axis.places()));
    for Varying { coordinate, values } in &axis.varying {
        let values = Values::reals(values.clone());
        dataset.put(Entry::of_coordinate(*coordinate), &[path], values);
    }
}

/// Everything that the axes leave constant, so that a file holds every parameter of its cases.
fn add_constants(dataset: &mut Dataset, study: &Study) {
    for constant in Coordinate::all(study.base.model()) {
        if study.case_set.varied().contains(&constant) || !is_told(study, constant) {
            continue;
        }
        let value = match constant {
            Coordinate::Parameter(parameter) => study.base[parameter],
            Coordinate::Start(coordinate) => study.start[coordinate],
            Coordinate::StartPhase => study.start_phase,
            Coordinate::SectionPhase => study.section_phase,
        };
        dataset.put(Entry::of_coordinate(constant), &[], Values::real(value));
    }
}

/// Whether there is something to tell of a coordinate that a study holds.
fn is_told(study: &Study, coordinate: Coordinate) -> bool {
    match coordinate {
        Coordinate::Parameter(parameter) => study.base.states(parameter),
        _ => true,
    }
}

fn add_verdicts(dataset: &mut Dataset, table: &Table<'_>) {
    table.put(dataset, OUTCOME, table.integers(|orbit| orbit.outcome as i64));
    table.put(dataset, PERIOD, table.integers(|orbit| orbit.period as i64));
    table.put(dataset, CYCLES, table.integers(|orbit| orbit.cycles as i64));
    let why = table.integers(|orbit| orbit.failure.as_ref().map_or(0, |why| why.reason as i64));
    let names = reasons(table.study.base.model());
    table.put(dataset, FAILURE_REASON, why).flags = names;
    let times = table.reals(|orbit| orbit.failure.as_ref().map_or(f64::NAN, |why| why.time));
    table.put(dataset, FAILURE_TIME, times);
}

/// What is proven of the periods.
fn add_certificates(dataset: &mut Dataset, table: &Table<'_>) {
    table.put(dataset, CERTIFICATE, table.integers(|orbit| orbit.certificate.proof as i64));
    let model = table.study.base.model();
    let count = model.section.len();
    dataset.put_coordinate(MULTIPLIER, Values::count(count));
    table.put(dataset, MULTIPLIER_REAL, table.multipliers(count, |it| it.re));
    table.put(dataset, MULTIPLIER_IMAG, table.multipliers(count, |it| it.im));
    for (i, entry) in neutral(model).into_iter().enumerate() {
        let values =
            table.reals(|orbit| orbit.certificate.neutral.map_or(f64::NAN, |along| along[i]));
        table.put(dataset, entry, values);
    }
}

fn add_section(dataset: &mut Dataset, table: &Table<'_>) {
    let length = table.study.protocol.points;
    if length == 0 {
        return;
    }
    dataset.put_coordinate(POINT, Values::count(length));
    for (i, entry) in section(table.study.base.model()).into_iter().enumerate() {
        let values = table.rows(length, |orbit, n| orbit.section.get(n).map(|point| point[i]));
        table.put(dataset, entry, values);
    }
}

fn add_impacts(dataset: &mut Dataset, table: &Table<'_>) {
    let length = table.study.protocol.impact_points;
    if length == 0 || table.study.base.model().motion.impact.is_empty() {
        return;
    }
    dataset.put_coordinate(IMPACT_POINT, Values::count(length));
    for (i, entry) in impacts(table.study.base.model()).into_iter().enumerate() {
        let values = table.rows(length, |orbit, n| orbit.impacts.get(i)?.get(n).copied());
        table.put(dataset, entry, values);
    }
}

fn add_history(dataset: &mut Dataset, table: &Table<'_>) {
    let Some(span) = table.study.protocol.history else { return };
    let times =
        (0..span.samples()).map(|i| i as f64 / f64::from(span.per_cycle)).collect::<Vec<f64>>();
    dataset.put_coordinate(HISTORY_TIME, Values::reals(times));
    for (i, entry) in histories(table.study.base.model()).into_iter().enumerate() {
        let values = table.rows(span.samples(), |orbit, n| orbit.history.get(i)?.get(n).copied());
        table.put(dataset, entry, values);
    }
}
