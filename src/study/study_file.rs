//! The study file: which keys it has, what they mean and what is allowed.

use toml::de::DeTable;

use super::axis_file::read_case_set;
use super::branch_file::{Surroundings, read_branches};
use super::conflicts::refuse;
use super::definition::{Study, with_parts};
use super::document::{Faults, Reader, Table};
use super::drawing_file::read_drawings;
use super::draws::Range;
use super::include;
use super::named_model::{check_model, model_in};
use super::own_outputs::{check_used, read_outputs};
use super::parameter_table::{ParameterTable, read_parameters};
use super::ramp_file::read_ramps;
use super::refine_file::{read_basin, read_map};
use super::start_file::read_start;
use super::without_effect::given_without_effect;
use super::{CaseSet, Continuation, Coordinate, Refine};
use crate::description::Parameter;
use crate::orbit::exponent::BATCHES;
use crate::orbit::{HistorySpan, Protocol};
use crate::quantity::Dimension;

/// More numbers in the results than this (32 GB) are too, rather than found out after a night.
const MOST_NUMBERS: usize = 4_000_000_000;

/// Most points kept of a case, cycles of its history and samples of a cycle.
const MOST_POINTS: u64 = 1_000_000;

/// Longest period that can be looked for, as every section point within it is remembered.
const LONGEST_PERIOD: u64 = 100_000;

impl Study {
    /// Reads a study from its text; all faults are reported at once. `name` is the file's, for messages.
    pub fn parse(name: &str, text: &str) -> Result<Study, Faults> {
        let (document, errors) = DeTable::parse_recoverable(text);
        let reader = Reader::new(text, model_in(document.get_ref(), text));
        if !errors.is_empty() {
            // What follows a broken line cannot be judged.
            errors.iter().for_each(|error| reader.syntax(error));
            return Err(reader.faults(name));
        }
        let top = Table::new(&reader, document.get_ref());
        let title = read_title(&top);
        if !check_model(&top, text) {
            // What a model does not know cannot be judged where it is not known which.
            return Err(reader.faults(name));
        }
        let study = Study { title, text: text.to_owned(), ..read_study(&top) };
        check_size(&reader, &study);
        refuse(&top, &study);
        top.finish();
        reader.finish(name)?;
        Ok(study)
    }
}

/// A study without its title and text.
fn read_study(top: &Table<'_, '_>) -> Study {
    // The name of a parameter file stands for its values, which are in the text by now.
    if let Some(entry) = top.entry(include::KEY) {
        entry.fault("must be the name of one parameter file beside the study, as \"rig.toml\"");
    }
    let mut case_set = read_case_set(top);
    let ParameterTable { values: base, given, mut remarks } =
        read_parameters(top, &case_set.varied());
    let start = read_start(top, &mut case_set);
    let protocol = read_protocol(top);
    let basin = read_basin(top, &case_set);
    let outputs = read_outputs(top, &with_parts(&base, &case_set.varied()));
    let refine = read_map(top, &case_set, &outputs).or(basin.refine.then_some(Refine::Attractors));
    let surroundings = Surroundings { case_set: &case_set, base: &base, start: start.clone() };
    let branches = read_branches(top, &surroundings);
    let ramps = read_ramps(top, &surroundings);
    let varied_beside: Vec<Parameter> = branches
        .iter()
        .flat_map(Continuation::varied)
        .chain(ramps.iter().map(|ramp| ramp.along))
        .collect();
    let with_all_parts = with_parts(&base, &varied_anywhere(&case_set, &varied_beside));
    remarks.extend(given_without_effect(&with_all_parts, &given));
    if let CaseSet::Draws(draws) = &case_set {
        remarks.extend(draws.ranges.iter().filter_map(Range::remark));
    }
    check_used(top, &with_all_parts);
    Study {
        title: String::new(),
        text: String::new(),
        remarks,
        base,
        start: start.state,
        start_phase: start.start_phase,
        section_phase: start.section_phase,
        protocol,
        early_decision: basin.early_decision,
        drawings: read_drawings(top, &case_set, &varied_beside, &outputs, refine.as_ref()),
        refine,
        outputs,
        branches,
        ramps,
        case_set,
    }
}

/// What the cases, a branch or a ramp vary.
fn varied_anywhere(case_set: &CaseSet, varied_beside: &[Parameter]) -> Vec<Coordinate> {
    let beside = varied_beside.iter().copied().map(Coordinate::Parameter);
    case_set.varied().into_iter().chain(beside).collect()
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
    let model = study.base.model();
    let each = study.outputs.len()
        + model.section.len() * protocol.points
        + model.motion.impact.len() * protocol.impact_points
        + model.motion.histories.len() * samples;
    let numbers = study.shape().into_iter().try_fold(each.max(1), usize::checked_mul);
    if numbers.is_none_or(|numbers| numbers > MOST_NUMBERS) {
        let cases = study.shape().iter().map(|&length| length as f64).product::<f64>();
        let message = format!(
            "{cases} cases with {each} numbers each are too many; {MOST_NUMBERS} numbers are \
             allowed (fewer values on the axes, draws, section points, impact points or samples)"
        );
        reader.fault(None, "axes", message);
    }
}

fn read_protocol(top: &Table<'_, '_>) -> Protocol {
    let mut protocol = top.table("protocol").map(read_settling).unwrap_or_default();
    if let Some(history) = top.entry("history").filter(|_| !top.model().keeps_histories()) {
        let name = top.model().name;
        history.fault(format!(
            "no histories are kept of motions of the model {name}: its cycles are none of a drive"
        ));
    }
    protocol.history = top.table("history").map(read_history);
    protocol
}

/// Reads `[protocol]`.
fn read_settling(table: Table<'_, '_>) -> Protocol {
    let usual = Protocol::default().tolerance;
    let mut protocol = Protocol::with_tolerance(read_tolerance(&table, "tolerance", usual));
    protocol.recurrence = read_tolerance(&table, "recurrence", protocol.recurrence);
    for (key, value) in [
        ("max_cycles", &mut protocol.max_cycles),
        ("max_steps", &mut protocol.max_steps),
        ("measured_cycles", &mut protocol.measured_cycles),
    ] {
        *value = read_whole(&table, key, 1, u64::MAX).unwrap_or(*value);
    }
    read_exponent(&table, &mut protocol);
    let max_period = read_whole(&table, "max_period", 1, LONGEST_PERIOD);
    protocol.max_period = max_period.map_or(protocol.max_period, |it| it as usize);
    let accelerate = table.entry("accelerate").and_then(|entry| entry.truth());
    protocol.accelerate = accelerate.unwrap_or(protocol.accelerate);
    for (key, value) in
        [("points", &mut protocol.points), ("impact_points", &mut protocol.impact_points)]
    {
        *value = read_whole(&table, key, 0, MOST_POINTS).map_or(*value, |it| it as usize);
    }
    table.finish();
    protocol
}

/// A tolerance, `usual` where none is given that is allowed.
fn read_tolerance(table: &Table<'_, '_>, key: &str, usual: f64) -> f64 {
    let Some(entry) = table.entry(key) else { return usual };
    match entry.quantity(Dimension::Number) {
        Some(given) if Protocol::TOLERANCES.contains(&given) => given,
        Some(given) => {
            entry.fault(format!("{given} must lie between 1e-15 and 1e-3"));
            usual
        }
        None => usual,
    }
}

fn read_whole(table: &Table<'_, '_>, key: &str, least: u64, most: u64) -> Option<u64> {
    table.entry(key)?.whole(least, most)
}

/// Reads how exponents are measured.
fn read_exponent(table: &Table<'_, '_>, protocol: &mut Protocol) {
    let cycles = read_whole(table, "exponent_cycles", 0, MOST_POINTS);
    protocol.exponent_cycles = cycles.unwrap_or(protocol.exponent_cycles);
    if (1..BATCHES as u64).contains(&protocol.exponent_cycles)
        && let Some(entry) = table.entry("exponent_cycles")
    {
        let given = protocol.exponent_cycles;
        entry.fault(format!("{given} are too few for an exponent; {BATCHES} or more, or 0"));
    }
    if let Some(entry) = table.entry("exponent_error")
        && let Some(given) = entry.quantity(Dimension::Number)
    {
        let [least, most] = [Protocol::EXPONENT_ERRORS.start(), Protocol::EXPONENT_ERRORS.end()];
        match Protocol::EXPONENT_ERRORS.contains(&given) {
            true => protocol.exponent_error = given,
            false => entry.fault(format!("{given} must lie between {least} and {most}")),
        }
    }
}

/// Reads `[history]`.
fn read_history(table: Table<'_, '_>) -> HistorySpan {
    let cycles = read_whole(&table, "cycles", 1, MOST_POINTS).map_or(5, |it| it as u32);
    let per_cycle = read_whole(&table, "samples_per_cycle", 1, MOST_POINTS);
    let per_cycle = per_cycle.map_or(400, |it| it as u32);
    let begins = [("start", true), ("attractor", false)];
    let from = table.entry("from").and_then(|entry| entry.one_of("beginning", &begins));
    table.finish();
    HistorySpan { cycles, per_cycle, from_start: from.unwrap_or(false) }
}
