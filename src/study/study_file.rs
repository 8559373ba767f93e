//! The study file: which keys it has, what they mean and what is allowed.

use std::collections::BTreeSet;

use toml::de::DeTable;

use crate::capsule::{Allowed, Dimension, Parameter, Parameters, Resistance, Switching};
use crate::orbit::exponent::BATCHES;
use crate::orbit::{HistorySpan, Output, Protocol};

use super::axis::{linear, logarithmic};
use super::branch_file::{Surroundings, read_branches};
use super::document::{Entry, Faults, Reader, Table};
use super::drawing_file::read_drawings;
use super::start_file::read_start;
use super::study::Study;
use super::{Axis, Coordinate};

/// More values on an axis than this are taken for a slip of the pen.
const MOST_VALUES: u64 = 10_000_000;

/// More numbers in the results than this (32 GB) are too, rather than found out after a night.
const MOST_NUMBERS: usize = 4_000_000_000;

/// Most points kept of a case, cycles of its history and samples of a cycle.
const MOST_POINTS: u64 = 1_000_000;

/// Longest period that can be looked for, as every section point within it is remembered.
const LONGEST_PERIOD: u64 = 100_000;

/// The four parameters that Table 1 of the paper leaves open: a study says what they are.
const OPEN: [Parameter; 4] = [Parameter::Omega, Parameter::Pd, Parameter::K2, Parameter::Delta];

impl Study {
    /// Reads a study from its text; every fault is told at once. `name` is the file's, for messages.
    pub fn parse(name: &str, text: &str) -> Result<Study, Faults> {
        let reader = Reader::new(text);
        let (document, errors) = DeTable::parse_recoverable(text);
        if !errors.is_empty() {
            // What follows a broken line cannot be judged.
            errors.iter().for_each(|error| reader.syntax(error));
            return Err(reader.faults(name));
        }
        let top = Table::new(&reader, document.get_ref());
        let title = read_title(&top);
        let axes = read_axes(&top);
        let base = read_parameters(&top, &axes);
        let (start, follow) = read_start(&top, &axes);
        let protocol = read_protocol(&top);
        let outputs = read_outputs(&top);
        let surroundings = Surroundings { axes: &axes, base: &base, start };
        let branches = read_branches(&top, &surroundings);
        let study = Study {
            title,
            text: text.to_owned(),
            base,
            start: start.state,
            start_phase: start.start_phase,
            section_phase: start.section_phase,
            follow,
            protocol,
            drawings: read_drawings(&top, &axes, &branches, &outputs),
            outputs,
            branches,
            axes,
        };
        check_size(&reader, &study);
        top.finish();
        reader.finish(name)?;
        Ok(study)
    }
}

fn read_title(top: &Table<'_, '_>) -> String {
    let Some(entry) = top.entry("title") else { return String::new() };
    let title = entry.text().unwrap_or("");
    if title.contains(char::is_control) {
        entry.fault("must be one line without control characters");
    }
    title.to_owned()
}

/// Refuses a study whose results no machine could hold.
fn check_size(reader: &Reader<'_>, study: &Study) {
    let protocol = &study.protocol;
    let samples = protocol.history.map_or(0, |span| span.samples());
    let each = study.outputs.len() + 3 * (protocol.points + protocol.impact_points) + 5 * samples;
    let numbers = study.shape().into_iter().try_fold(each.max(1), usize::checked_mul);
    if numbers.is_none_or(|numbers| numbers > MOST_NUMBERS) {
        let cases = study.shape().iter().map(|&length| length as f64).product::<f64>();
        let message = format!(
            "{cases} cases with {each} numbers each are too many; {MOST_NUMBERS} numbers are \
             allowed (fewer values on the axes, section points, impact points or samples)"
        );
        reader.fault(None, "axes", message);
    }
}

fn read_parameters(top: &Table<'_, '_>, axes: &[Axis]) -> Parameters {
    let mut parameters = Parameters::default();
    let table = top.table("parameters");
    let on_axis = |parameter| axes.iter().any(|a| a.coordinate == Coordinate::Parameter(parameter));
    for &parameter in Parameter::ALL {
        let entry = table.as_ref().and_then(|table| table.entry(parameter.symbol()));
        match entry {
            Some(entry) if on_axis(parameter) => entry.fault("is given here and on an axis"),
            Some(entry) => {
                let value = allowed_quantity(&entry, parameter.dimension(), parameter.allowed());
                parameters[parameter] = value.unwrap_or(parameters[parameter]);
            }
            None if OPEN.contains(&parameter) && !on_axis(parameter) => {
                let expected = format!("a value for the {} here or an axis", parameter.meaning());
                top.missing(&format!("parameters.{}", parameter.symbol()), &expected);
            }
            None => {}
        }
    }
    let Some(table) = table else { return parameters };
    if let Some(entry) = table.entry("resistance") {
        parameters.resistance = entry.one_of("resistance", &Resistance::NAMES).unwrap_or_default();
    }
    if let Some(entry) = table.entry("friction_switching") {
        parameters.switching = entry.one_of("reading", &Switching::NAMES).unwrap_or_default();
    }
    table.finish();
    parameters
}

/// The quantity of `entry`, if its value is allowed.
pub(super) fn allowed_quantity(
    entry: &Entry<'_, '_>,
    dimension: Dimension,
    allowed: Allowed,
) -> Option<f64> {
    let value = entry.quantity(dimension)?;
    if !allowed.admits(value) {
        let unit = Some(dimension.unit()).filter(|&unit| unit != "1");
        let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
        entry.fault(format!("{value}{unit} must be {allowed}"));
        return None;
    }
    Some(value)
}

fn read_axes(top: &Table<'_, '_>) -> Vec<Axis> {
    let mut axes: Vec<Axis> = Vec::new();
    for entry in top.entry("axes").map(|entry| entry.list()).unwrap_or_default() {
        let Some(table) = entry.table() else { continue };
        let names: Vec<(&str, Coordinate)> = Coordinate::all()
            .map(|coordinate| (coordinate.name(), coordinate))
            .chain([(Coordinate::PHASE, Coordinate::StartPhase)])
            .collect();
        let name = table.entry("name");
        if name.is_none() {
            table.missing(
                "name",
                "a parameter, start_r, start_y1, start_y2, start_phase or section_phase",
            );
        }
        let coordinate = name.as_ref().and_then(|name| name.one_of("axis", &names));
        let values = read_values(&table, coordinate);
        table.finish();
        let (Some(name), Some(coordinate)) = (name, coordinate) else { continue };
        if axes.iter().any(|axis| axis.coordinate == coordinate) {
            name.fault(format!("a second axis \"{}\"", coordinate.name()));
            continue;
        }
        // With faulty values too: what else names this axis is not at fault.
        axes.push(Axis { coordinate, values: values.unwrap_or_default() });
    }
    axes
}

fn read_values(table: &Table<'_, '_>, coordinate: Option<Coordinate>) -> Option<Vec<f64>> {
    let quantity = |entry: &Entry<'_, '_>| {
        let coordinate = coordinate?;
        allowed_quantity(entry, coordinate.dimension(), coordinate.allowed())
    };
    let [values, from, to, points, spacing] =
        ["values", "from", "to", "points", "spacing"].map(|key| table.entry(key));
    if let Some(values) = values {
        for extra in [from, to, points, spacing].into_iter().flatten() {
            extra.fault("does not go with a list of values");
        }
        let list = values.list();
        if list.is_empty() {
            values.fault("expected at least one value");
        }
        return Some(distinct(&list, quantity));
    }
    for (key, found) in [("from", &from), ("to", &to), ("points", &points)] {
        if found.is_none() {
            table.missing(key, "from, to and points, or a list of values");
        }
    }
    let rules: [(&str, Spacing); 2] = [("linear", linear), ("logarithmic", logarithmic)];
    let rule = match &spacing {
        Some(entry) => entry.one_of("spacing", &rules),
        None => Some(linear as Spacing),
    };
    let logarithmic = spacing.as_ref().is_some_and(|entry| entry.text() == Some("logarithmic"));
    let bounds = [&from, &to].map(|bound| bound.as_ref().and_then(quantity));
    let points = points.as_ref().and_then(|entry| entry.whole(1, MOST_VALUES));
    let ([Some(low), Some(high)], Some(points), Some(rule)) = (bounds, points, rule) else {
        return None;
    };
    if logarithmic && !(low > 0.0 && high > 0.0) {
        spacing?.fault("needs both ends above zero");
        return None;
    }
    if low == high && points > 1 {
        to?.fault("is the same as `from`");
        return None;
    }
    Some(rule(low, high, points as usize))
}

/// The values of a list; one that stands there twice is a fault.
fn distinct<'r, 'a>(
    list: &[Entry<'r, 'a>],
    quantity: impl Fn(&Entry<'r, 'a>) -> Option<f64>,
) -> Vec<f64> {
    let mut values = Vec::with_capacity(list.len());
    let mut seen = BTreeSet::new();
    for entry in list {
        match quantity(entry) {
            // Adding zero makes -0 and 0 the same.
            Some(value) if !seen.insert((value + 0.0).to_bits()) => entry.fault("is given twice"),
            Some(value) => values.push(value),
            None => {}
        }
    }
    values
}

type Spacing = fn(f64, f64, usize) -> Vec<f64>;

fn read_protocol(top: &Table<'_, '_>) -> Protocol {
    let mut protocol = Protocol::default();
    if let Some(table) = top.table("protocol") {
        let between = |key: &str, value: &mut f64| {
            let Some(entry) = table.entry(key) else { return };
            match entry.quantity(Dimension::Number) {
                Some(given) if Protocol::TOLERANCES.contains(&given) => *value = given,
                Some(given) => entry.fault(format!("{given} must lie between 1e-15 and 1e-3")),
                None => {}
            }
        };
        between("tolerance", &mut protocol.tolerance);
        protocol = Protocol::with_tolerance(protocol.tolerance);
        between("recurrence", &mut protocol.recurrence);
        let whole = |key: &str, least: u64, most: u64, value: &mut u64| {
            let found = table.entry(key).and_then(|entry| entry.whole(least, most));
            *value = found.unwrap_or(*value);
        };
        whole("max_cycles", 1, u64::MAX, &mut protocol.max_cycles);
        whole("measured_cycles", 1, u64::MAX, &mut protocol.measured_cycles);
        whole("exponent_cycles", 0, MOST_POINTS, &mut protocol.exponent_cycles);
        if (1..BATCHES as u64).contains(&protocol.exponent_cycles)
            && let Some(entry) = table.entry("exponent_cycles")
        {
            let given = protocol.exponent_cycles;
            entry.fault(format!("{given} are too few for an exponent; {BATCHES} or more, or 0"));
        }
        let size = |key: &str, least: u64, most: u64, value: &mut usize| {
            let mut found = *value as u64;
            whole(key, least, most, &mut found);
            *value = found as usize;
        };
        size("max_period", 1, LONGEST_PERIOD, &mut protocol.max_period);
        let accelerate = table.entry("accelerate").and_then(|entry| entry.truth());
        protocol.accelerate = accelerate.unwrap_or(protocol.accelerate);
        size("points", 0, MOST_POINTS, &mut protocol.points);
        size("impact_points", 0, MOST_POINTS, &mut protocol.impact_points);
        table.finish();
    }
    protocol.history = top.table("history").map(|table| {
        let whole = |key: &str, value: u32| {
            let found = table.entry(key).and_then(|entry| entry.whole(1, MOST_POINTS));
            found.map_or(value, |n| n as u32)
        };
        let (cycles, per_cycle) = (whole("cycles", 5), whole("samples_per_cycle", 400));
        let begins = [("start", true), ("attractor", false)];
        let from = table.entry("from").and_then(|entry| entry.one_of("beginning", &begins));
        table.finish();
        HistorySpan { cycles, per_cycle, from_start: from.unwrap_or(false) }
    });
    protocol
}

fn read_outputs(top: &Table<'_, '_>) -> Vec<Output> {
    let Some(entry) = top.entry("outputs") else { return Output::ALL.to_vec() };
    let names: Vec<(&str, Output)> =
        Output::ALL.iter().map(|&output| (output.name(), output)).collect();
    entry.list().iter().filter_map(|entry| entry.one_of("output", &names)).collect()
}
