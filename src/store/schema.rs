//! Which variables a file of results has: a study and its records as a labelled dataset.

use ndarray::{ArrayD, IxDyn};

use crate::capsule::{Parameter, State};
use crate::orbit::matrix::Complex;
use crate::orbit::{Certificate, History, Impact, Orbit, Outcome, Proof, Reason};
use crate::run::Record;
use crate::study::{CaseSet, Coordinate, Direction, Study};

use super::piece::{Filling, MISSING, Piece};
use super::{Dataset, Values, Variable, drawn, provenance};

/// The dimension of the cases of a block, which in a whole dataset gives way to the axes.
pub const CASE: &str = "case";

/// Attribute: tells studies apart whose cases differ, see [`Study::fingerprint`].
pub const FINGERPRINT: &str = "study_fingerprint";

/// The dataset of a study; `records` holds one record per case, in any order, or fewer.
///
/// Dimensions: the axes of the study, slowest first, then `direction` where the attractor was followed
/// both ways, or `draw` alone; after them `point`, `impact_point` or `history_time` for what each case has several of.
pub fn dataset(study: &Study, records: &[Record]) -> Dataset {
    let mut dataset = frame(study);
    let columns = columns(study, records);
    let piece = Piece::whole(&study.shape());
    for (name, variable) in columns.variables {
        let mut filling = Filling::new(&piece, &name, &variable.values);
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
    if is_partial && name == "outcome" {
        flags.insert(0, (MISSING.0, MISSING.1.to_owned()));
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
        let variable = table.variable(output.unit(), output.meaning(), values);
        columns.variables.insert(output.name().to_owned(), variable);
    }
    add_certificates(&mut columns, &table);
    add_section(&mut columns, &table);
    add_impacts(&mut columns, &table);
    add_history(&mut columns, &table);
    columns
}

/// A study without records: its axes, its constants, and what made the file.
pub fn frame(study: &Study) -> Dataset {
    let mut dataset = Dataset::default();
    add_axes(&mut dataset, study);
    add_constants(&mut dataset, study);
    dataset.attributes.insert("title".to_owned(), study.title.clone());
    dataset.attributes.extend(provenance::attributes());
    dataset.attributes.extend(protocol(study));
    dataset
        .attributes
        .insert("friction_switching".to_owned(), study.base.switching.name().to_owned());
    dataset.attributes.insert("resistance".to_owned(), study.base.resistance.name().to_owned());
    dataset.attributes.insert(FINGERPRINT.to_owned(), study.fingerprint());
    dataset.texts.insert("study".to_owned(), study.text.clone());
    dataset
}

/// How the cases were followed, so that the file tells it even where the study left it to the program.
fn protocol(study: &Study) -> [(String, String); 7] {
    let protocol = &study.protocol;
    [
        ("tolerance", format!("{:e}", protocol.tolerance)),
        ("recurrence", format!("{:e}", protocol.recurrence)),
        ("accelerate", protocol.accelerate.to_string()),
        ("max_cycles", protocol.max_cycles.to_string()),
        ("max_period", protocol.max_period.to_string()),
        ("measured_cycles", protocol.measured_cycles.to_string()),
        ("exponent_cycles", protocol.exponent_cycles.to_string()),
    ]
    .map(|(key, value)| (format!("protocol_{key}"), value))
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

    fn variable(&self, unit: &str, long_name: &str, values: Values) -> Variable {
        Variable {
            dimensions: vec![CASE.to_owned()],
            unit: unit.to_owned(),
            long_name: long_name.to_owned(),
            values,
            flags: Vec::new(),
        }
    }

    /// Adds variables of which each case has a row along the dimension `row`.
    fn add_rows<'n>(
        &self,
        dataset: &mut Dataset,
        row: &str,
        rows: impl IntoIterator<Item = (&'n str, &'n str, &'n str, Values)>,
    ) {
        for (name, unit, long_name, values) in rows {
            let mut variable = self.variable(unit, long_name, values);
            variable.dimensions.push(row.to_owned());
            dataset.variables.insert(name.to_owned(), variable);
        }
    }
}

/// A coordinate, with its name.
pub(super) fn coordinate(
    name: &str,
    unit: &str,
    long_name: &str,
    values: Values,
) -> (String, Variable) {
    let variable = Variable {
        dimensions: vec![name.to_owned()],
        unit: unit.to_owned(),
        long_name: long_name.to_owned(),
        values,
        flags: Vec::new(),
    };
    (name.to_owned(), variable)
}

fn line(values: Vec<f64>) -> Values {
    Values::Real(ArrayD::from_shape_vec(IxDyn(&[values.len()]), values).expect("a line of values"))
}

/// The numbers from zero along one dimension.
pub(super) fn count(length: usize) -> Values {
    Values::Integer(ArrayD::from_shape_fn(IxDyn(&[length]), |index| index[0] as i64))
}

fn add_axes(dataset: &mut Dataset, study: &Study) {
    if let CaseSet::Draws(draws) = &study.case_set {
        drawn::add(dataset, draws);
    }
    for axis in study.axes() {
        let (name, unit) = (axis.coordinate.name(), axis.coordinate.dimension().unit());
        let values = line(axis.values.clone());
        dataset.coordinates.push(coordinate(name, unit, axis.coordinate.meaning(), values));
    }
    if let Some(directions) = study.direction_axis() {
        let codes = directions.iter().map(|&direction| direction as i64).collect();
        let values =
            ArrayD::from_shape_vec(IxDyn(&[directions.len()]), codes).expect("a line of codes");
        let (name, mut variable) = coordinate(
            "direction",
            "1",
            "direction in which the attractor was followed",
            Values::Integer(values),
        );
        let named = Direction::ALL.iter().filter(|it| directions.contains(it));
        variable.flags = named.map(|&d| (d as i64, d.name().to_owned())).collect();
        dataset.coordinates.push((name, variable));
    }
}

/// Everything that the axes leave constant, so that a file tells its whole case.
fn add_constants(dataset: &mut Dataset, study: &Study) {
    let State { r, y1, y2, .. } = study.start;
    let parameters = Parameter::ALL.iter().map(|&p| (Coordinate::Parameter(p), study.base[p]));
    let starts = [
        (Coordinate::StartR, r),
        (Coordinate::StartY1, y1),
        (Coordinate::StartY2, y2),
        (Coordinate::StartPhase, study.start_phase),
        (Coordinate::SectionPhase, study.section_phase),
    ];
    for (constant, value) in parameters.chain(starts) {
        if study.case_set.varied().contains(&constant) {
            continue;
        }
        let variable = Variable {
            dimensions: Vec::new(),
            unit: constant.dimension().unit().to_owned(),
            long_name: constant.meaning().to_owned(),
            values: Values::Real(ArrayD::from_elem(IxDyn(&[]), value)),
            flags: Vec::new(),
        };
        dataset.variables.insert(constant.name().to_owned(), variable);
    }
}

fn add_verdicts(dataset: &mut Dataset, table: &Table<'_>) {
    let mut outcome = table.variable(
        "1",
        "what the case turned out to be",
        table.integers(|orbit| orbit.outcome as i64),
    );
    outcome.flags = Outcome::ALL.iter().map(|&o| (o as i64, o.name().to_owned())).collect();
    let periods = table.integers(|orbit| orbit.period as i64);
    let period = table.variable("1", "period in drive cycles, 0 unless periodic", periods);
    let cycles = table.integers(|orbit| orbit.cycles as i64);
    let cycles = table.variable("1", "drive cycles followed, measuring included", cycles);
    for (name, variable) in [("outcome", outcome), ("period", period), ("cycles", cycles)] {
        dataset.variables.insert(name.to_owned(), variable);
    }
    add_failures(dataset, table);
}

/// Why and when a case could not be followed on.
fn add_failures(dataset: &mut Dataset, table: &Table<'_>) {
    let reasons = table.integers(|orbit| orbit.failure.map_or(0, |why| why.reason as i64));
    let mut reason = table.variable("1", "why the case could not be followed", reasons);
    let names = Reason::NAMES.map(|(reason, name)| (reason as i64, name.to_owned()));
    reason.flags = std::iter::once((0, "none".to_owned())).chain(names).collect();
    let times = table.reals(|orbit| orbit.failure.map_or(f64::NAN, |why| why.time));
    let time = table.variable("s", "time at which the case could not be followed on", times);
    dataset.variables.insert("failure_reason".to_owned(), reason);
    dataset.variables.insert("failure_time".to_owned(), time);
}

/// What is proven of the periods.
fn add_certificates(dataset: &mut Dataset, table: &Table<'_>) {
    let proofs = table.integers(|orbit| orbit.certificate.proof as i64);
    let mut proof = table.variable("1", "how the period was proven", proofs);
    proof.flags = Proof::NAMES.map(|(name, proof)| (proof as i64, name.to_owned())).to_vec();
    dataset.variables.insert("certificate".to_owned(), proof);
    let count = Certificate::none().multipliers.len();
    dataset.coordinates.push(coordinate(
        "multiplier",
        "1",
        "Floquet multiplier of the period, the largest magnitude first",
        self::count(count),
    ));
    let of = |part: fn(&Complex) -> f64| {
        table.rows(count, move |orbit, i| orbit.certificate.multipliers.get(i).map(part))
    };
    let rows = [
        ("multiplier_real", "1", "real part of a Floquet multiplier of the period", of(|m| m.re)),
        ("multiplier_imag", "1", "imaginary part of a Floquet multiplier", of(|m| m.im)),
    ];
    table.add_rows(dataset, "multiplier", rows);
    let along = |i: usize| {
        table.reals(move |orbit| orbit.certificate.neutral.map_or(f64::NAN, |along| along[i]))
    };
    let directions = [
        (
            "neutral_r",
            "part of omega r in the direction of the family of a neutral orbit",
            along(0),
        ),
        ("neutral_y1", "part of y1 in the direction of the family of a neutral orbit", along(1)),
        ("neutral_y2", "part of y2 in the direction of the family of a neutral orbit", along(2)),
    ];
    for (name, long_name, values) in directions {
        dataset.variables.insert(name.to_owned(), table.variable("1", long_name, values));
    }
}

fn add_section(dataset: &mut Dataset, table: &Table<'_>) {
    let length = table.study.protocol.points;
    if length == 0 {
        return;
    }
    dataset.coordinates.push(coordinate("point", "1", "point of the section", count(length)));
    let along =
        |i: usize| table.rows(length, move |orbit, n| orbit.section.get(n).map(|point| point[i]));
    table.add_rows(
        dataset,
        "point",
        [
            (
                "section_r",
                "m",
                "relative displacement x1 - x2 at the stroboscopic section",
                along(0),
            ),
            ("section_y1", "m/s", "velocity of the mass at the stroboscopic section", along(1)),
            ("section_y2", "m/s", "velocity of the capsule at the stroboscopic section", along(2)),
        ],
    );
}

fn add_impacts(dataset: &mut Dataset, table: &Table<'_>) {
    let length = table.study.protocol.impact_points;
    if length == 0 {
        return;
    }
    let name = "impact_point";
    dataset.coordinates.push(coordinate(name, "1", "point of the impact section", count(length)));
    let impact = |value: fn(&Impact) -> f64| {
        table.rows(length, move |orbit, n| orbit.impacts.get(n).map(value))
    };
    let rows = [
        (
            "impact_phase",
            "rad",
            "phase of the drive at the impact, since the section",
            impact(|i| i.phase),
        ),
        ("impact_y1", "m/s", "velocity of the mass at the impact", impact(|i| i.y1)),
        ("impact_y2", "m/s", "velocity of the capsule at the impact", impact(|i| i.y2)),
    ];
    table.add_rows(dataset, name, rows);
}

fn add_history(dataset: &mut Dataset, table: &Table<'_>) {
    let Some(span) = table.study.protocol.history else { return };
    let name = "history_time";
    let times =
        (0..span.samples()).map(|i| i as f64 / f64::from(span.per_cycle)).collect::<Vec<f64>>();
    dataset.coordinates.push(coordinate(name, "1", "time in drive cycles", line(times)));
    let sampled = |value: fn(&History, usize) -> Option<f64>| {
        table.rows(span.samples(), move |orbit, n| {
            orbit.history.as_ref().and_then(|history| value(history, n))
        })
    };
    let rows = [
        (
            "history_r",
            "m",
            "relative displacement x1 - x2",
            sampled(|h, n| h.states.get(n).map(|s| s.r)),
        ),
        (
            "history_y1",
            "m/s",
            "velocity of the mass",
            sampled(|h, n| h.states.get(n).map(|s| s.y1)),
        ),
        (
            "history_x2",
            "m",
            "displacement of the capsule",
            sampled(|h, n| h.states.get(n).map(|s| s.x2)),
        ),
        (
            "history_y2",
            "m/s",
            "velocity of the capsule",
            sampled(|h, n| h.states.get(n).map(|s| s.y2)),
        ),
        ("history_drive", "N", "force of the drive", sampled(|h, n| h.drive.get(n).copied())),
    ];
    table.add_rows(dataset, name, rows);
}
