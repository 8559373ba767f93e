//! The branches of a study file: which keys they have, what they mean and what is allowed.

use std::collections::BTreeMap;

use super::continuation::{Continuation, FirstOrbit};
use super::document::{Entry, Table, unknown};
use super::start_file::{Start, read_state};
use super::{CaseSet, Coordinate};
use crate::description::{Parameter, Parameters};
use crate::quantity::Dimension;

/// Longest step unless another is asked for, as a share of the range.
const LONGEST_STEP: f64 = 0.02;
/// Shorter steps are too near the rounding of the orbits, as a share of the range.
const SHORTEST_STEP: f64 = 1e-9;

/// Points of a branch at most, unless another number is asked for.
pub(super) const USUAL_POINTS: usize = 2000;

/// More points of a branch than this are taken for a slip of the pen.
const MOST_POINTS: u64 = 1_000_000;

/// So many doublings make a period of over a million cycles.
const MOST_DOUBLINGS: u64 = 20;

/// Longest period of a first orbit [cycles].
const LONGEST_PERIOD: u64 = 100_000;

/// What is expected as the parameter of a branch or of its curves.
const CONTINUED: &str = "the parameter to continue the orbit in";

/// What the rest of the study gives to its branches and ramps.
pub(super) struct Surroundings<'s> {
    /// Its cases.
    pub case_set: &'s CaseSet,
    /// Values of the parameters that no axis varies.
    pub base: &'s Parameters,
    /// Where its cases start.
    pub start: Start,
}

impl Surroundings<'_> {
    /// Whether an axis varies `parameter`.
    fn varies(&self, parameter: Parameter) -> bool {
        self.case_set.varied().contains(&Coordinate::Parameter(parameter))
    }

    /// The ends of the axis over `parameter`, the lesser first.
    fn ends(&self, parameter: Parameter) -> Option<[f64; 2]> {
        self.case_set.ends(Coordinate::Parameter(parameter))
    }
}

/// The branches of a study.
pub(super) fn read_branches(top: &Table<'_, '_>, study: &Surroundings<'_>) -> Vec<Continuation> {
    let mut branches: Vec<Continuation> = Vec::new();
    let list = top.entry("branches");
    let entries = list.map(|list| list.list()).unwrap_or_default();
    for table in entries.iter().filter_map(Entry::table) {
        let name = read_name(&table, "a name for the branch");
        if let Some(twice) = table.entry("name").filter(|_| branches.iter().any(|b| b.name == name))
        {
            twice.fault(format!("a second branch \"{name}\""));
        }
        let branch = read_branch(&table, study);
        table.finish();
        branches.extend(branch.map(|branch| Continuation { name, ..branch }));
    }
    branches
}

/// The name, which stands in one line of the file of results.
pub(super) fn read_name(table: &Table<'_, '_>, expected: &str) -> String {
    let Some(entry) = table.entry("name") else {
        table.missing("name", expected);
        return String::new();
    };
    let name = entry.text().unwrap_or("");
    if entry.text().is_some() && (name.trim().is_empty() || name.contains(char::is_control)) {
        entry.fault("must be one line, not empty, without control characters");
    }
    name.to_owned()
}

/// A branch without its name; none where what it needs is missing, which is noted as a fault.
fn read_branch(table: &Table<'_, '_>, study: &Surroundings<'_>) -> Option<Continuation> {
    let along = read_parameter(table, "along", study, CONTINUED);
    // The ends are known keys where the parameter is not, too.
    ["from", "to"].into_iter().for_each(|key| drop(table.entry(key)));
    let second = table.table("second").map(|second| read_second(second, along, study));
    let varied: Vec<Parameter> =
        along.into_iter().chain(second.and_then(|(parameter, _)| parameter)).collect();
    let range = along.and_then(|along| read_range(table, along, study));
    let at = table.table("at");
    let parameters = read_place(table, at.as_ref(), study, &varied, None);
    let start = read_own_start(table, study);
    let first = read_first(table);
    let (longest_step, most_points) = read_steps(table, LONGEST_STEP);
    let doublings = table.entry("doublings").and_then(|entry| entry.whole(0, MOST_DOUBLINGS));
    let (along, range, parameters) = (along?, range?, parameters?);
    check_within(table, at.as_ref(), &parameters, along, range);
    let second = match second {
        Some((parameter, range)) => Some((parameter?, range?)),
        None => None,
    };
    if let Some((parameter, range)) = second {
        check_within(table, at.as_ref(), &parameters, parameter, range);
    }
    Some(Continuation {
        name: String::new(),
        along,
        range,
        parameters,
        start: start.state,
        start_phase: start.start_phase,
        section_phase: start.section_phase,
        first,
        doublings: doublings.unwrap_or(0) as u32,
        second,
        curve_range: None,
        longest_step,
        most_points,
    })
}

/// Where the first orbit is looked for.
pub(super) fn read_own_start(table: &Table<'_, '_>, study: &Surroundings<'_>) -> Start {
    let Some(table) = table.table("start") else { return study.start.clone() };
    let start = read_state(&table, study.start.clone(), &[]);
    table.finish();
    start
}

/// The parameter that `key` names, which is what is `expected` there.
pub(super) fn read_parameter(
    table: &Table<'_, '_>,
    key: &str,
    study: &Surroundings<'_>,
    expected: &str,
) -> Option<Parameter> {
    let names: Vec<(&str, Parameter)> =
        study.base.model().parameters().map(|it| (it.symbol(), it)).collect();
    let Some(entry) = table.entry(key) else {
        table.missing(key, expected);
        return None;
    };
    entry.one_of("parameter", &names)
}

/// The ends `from` and `to`, the lesser first; those of the axis where they are not given.
fn read_range(
    table: &Table<'_, '_>,
    parameter: Parameter,
    study: &Surroundings<'_>,
) -> Option<[f64; 2]> {
    let ends = study.ends(parameter);
    let from = read_end(table, "from", parameter, study, ends.map(|ends| ends[0]));
    let to = read_end(table, "to", parameter, study, ends.map(|ends| ends[1]));
    let (from, to) = (from?, to?);
    if from == to {
        let message = "the branch would end where it begins";
        match table.entry("to").or_else(|| table.entry("from")) {
            Some(entry) => entry.fault(message),
            None => table.missing("to", "a range, as the axis has one value only"),
        }
        return None;
    }
    Some([from.min(to), from.max(to)])
}

/// The end that `key` gives, or that of the axis.
fn read_end(
    table: &Table<'_, '_>,
    key: &str,
    parameter: Parameter,
    study: &Surroundings<'_>,
    of_axis: Option<f64>,
) -> Option<f64> {
    let Some(entry) = table.entry(key) else {
        // An axis without values has its fault noted already.
        if !study.varies(parameter) {
            let expected = format!("a value, as no axis varies the {} here", parameter.meaning());
            table.missing(key, &expected);
        }
        return of_axis;
    };
    entry.allowed_quantity(parameter.dimension(), parameter.allowed())
}

/// The second parameter with its range.
fn read_second(
    table: Table<'_, '_>,
    along: Option<Parameter>,
    study: &Surroundings<'_>,
) -> (Option<Parameter>, Option<[f64; 2]>) {
    let parameter = read_parameter(&table, "name", study, CONTINUED);
    if let (Some(name), true) = (table.entry("name"), parameter.is_some() && parameter == along) {
        name.fault("is the parameter that the orbit is continued in already");
    }
    // As for the first.
    ["from", "to"].into_iter().for_each(|key| drop(table.entry(key)));
    let range = parameter.and_then(|parameter| read_range(&table, parameter, study));
    table.finish();
    (parameter, range)
}

/// The parameters at which the first orbit is: those of the study, and those that `at` gives; none after a
/// fault. One that is given elsewhere has no place in `at`.
pub(super) fn read_place(
    table: &Table<'_, '_>,
    at: Option<&Table<'_, '_>>,
    study: &Surroundings<'_>,
    varied: &[Parameter],
    elsewhere: Option<Parameter>,
) -> Option<Parameters> {
    let mut parameters = study.base.clone();
    let mut complete = true;
    let is_open = |it: &Parameter| study.varies(*it) && elsewhere != Some(*it);
    let open: Vec<Parameter> = study.base.model().parameters().filter(is_open).collect();
    let given: BTreeMap<String, Entry<'_, '_>> =
        at.map(Table::entries).unwrap_or_default().into_iter().collect();
    for (name, entry) in &given {
        let named = study.base.model().parameter(name);
        match named.filter(|it| open.contains(it) || varied.contains(it)) {
            Some(parameter) => {
                let value = entry.allowed_quantity(parameter.dimension(), parameter.allowed());
                parameters[parameter] = value.unwrap_or(parameters[parameter]);
                complete &= value.is_some();
            }
            None => {
                let names = open.iter().chain(varied).map(|parameter| parameter.symbol());
                entry.fault(unknown("parameter that varies", name, distinct(names)));
            }
        }
    }
    for parameter in open.iter().filter(|parameter| !given.contains_key(parameter.symbol())) {
        let key = format!("at.{}", parameter.symbol());
        let expected =
            format!("the {} of the first orbit, as an axis varies it", parameter.meaning());
        table.missing(&key, &expected);
        complete = false;
    }
    let parts = |all: Parameters, it: &Parameter| all.with_part(*it);
    complete.then(|| varied.iter().fold(parameters, parts))
}

fn distinct<'n>(names: impl Iterator<Item = &'n str>) -> impl Iterator<Item = &'n str> {
    let mut seen = Vec::new();
    names.filter(move |name| {
        let new = !seen.contains(name);
        seen.push(name);
        new
    })
}

/// Sure that the first orbit lies where the branch may go.
fn check_within(
    table: &Table<'_, '_>,
    at: Option<&Table<'_, '_>>,
    parameters: &Parameters,
    parameter: Parameter,
    [from, to]: [f64; 2],
) {
    let value = parameters[parameter];
    if (from..=to).contains(&value) {
        return;
    }
    let symbol = parameter.symbol();
    let unit = Some(parameter.dimension().unit()).filter(|&unit| unit != "1");
    let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
    let message =
        format!("the first orbit, at {symbol} = {value}{unit}, lies outside {from} to {to}{unit}");
    let given = at.and_then(|at| at.entry(symbol)).or_else(|| table.entry("name"));
    given.into_iter().for_each(|entry| entry.fault(&message));
}

fn read_first(table: &Table<'_, '_>) -> FirstOrbit {
    let names = [("settle", false), ("newton", true)];
    let newton =
        table.entry("orbit").and_then(|entry| entry.one_of("method to find the orbit", &names));
    let period = table.entry("period");
    match (newton.unwrap_or(false), &period) {
        (true, None) => table.missing("period", "the period of the orbit in cycles"),
        (false, Some(entry)) if newton.is_some() || table.entry("orbit").is_none() => {
            entry.fault("goes with `orbit = \"newton\"`; settling finds the period itself");
        }
        _ => {}
    }
    let period = period.and_then(|entry| entry.whole(1, LONGEST_PERIOD));
    match newton {
        Some(true) => FirstOrbit::Newton { period: period.unwrap_or(1) },
        _ => FirstOrbit::Settle,
    }
}

/// The longest step, as a share of the range, unless one is given the `usual` one, and the number of points at most.
pub(super) fn read_steps(table: &Table<'_, '_>, usual: f64) -> (f64, usize) {
    let step = table.entry("longest_step").and_then(|entry| {
        let step = entry.quantity(Dimension::Number)?;
        let fits = (SHORTEST_STEP..=1.0).contains(&step);
        if !fits {
            entry.fault(format!(
                "{step} must lie between {SHORTEST_STEP:e} and 1, a share of the range"
            ));
        }
        fits.then_some(step)
    });
    let points = table.entry("most_points").and_then(|entry| entry.whole(2, MOST_POINTS));
    (step.unwrap_or(usual), points.map_or(USUAL_POINTS, |points| points as usize))
}
