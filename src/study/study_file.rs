//! The study file: which keys it has, what they mean and what is allowed.

use toml::de::DeTable;

use super::Refine;
use super::axis_file::read_case_set;
use super::branch_file::{Surroundings, read_branches};
use super::definition::Study;
use super::document::{Faults, Reader, Table};
use super::drawing_file::read_drawings;
use super::include;
use super::named_model::{check_model, model_in};
use super::parameter_table::read_parameters;
use super::refine_file::{read_basin, read_map};
use super::start_file::read_start;
use crate::description::Output;
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
        let reader = Reader::new(text, model_in(document.get_ref()));
        if !errors.is_empty() {
            // What follows a broken line cannot be judged.
            errors.iter().for_each(|error| reader.syntax(error));
            return Err(reader.faults(name));
        }
        let top = Table::new(&reader, document.get_ref());
        let title = read_title(&top);
        if !check_model(&top) {
            // What a model does not know cannot be judged where it is not known which.
            return Err(reader.faults(name));
        }
        // The name of a parameter file stands for its values, which are in the text by now.
        if let Some(entry) = top.entry(include::KEY) {
            entry.fault("must be the name of one parameter file beside the study, as \"rig.toml\"");
        }
        let mut case_set = read_case_set(&top);
        let (base, remarks) = read_parameters(&top, &case_set.varied());
        let start = read_start(&top, &mut case_set);
        let protocol = read_protocol(&top);
        let basin = read_basin(&top, &case_set);
        let outputs = read_outputs(&top);
        let refine =
            read_map(&top, &case_set, &outputs).or(basin.refine.then_some(Refine::Attractors));
        let surroundings = Surroundings { case_set: &case_set, base: &base, start: start.clone() };
        let branches = read_branches(&top, &surroundings);
        let study = Study {
            title,
            text: text.to_owned(),
            remarks,
            base,
            start: start.state,
            start_phase: start.start_phase,
            section_phase: start.section_phase,
            protocol,
            early_decision: basin.early_decision,
            drawings: read_drawings(&top, &case_set, &branches, (&outputs, refine.as_ref())),
            refine,
            outputs,
            branches,
            case_set,
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
        whole("max_steps", 1, u64::MAX, &mut protocol.max_steps);
        whole("measured_cycles", 1, u64::MAX, &mut protocol.measured_cycles);
        whole("exponent_cycles", 0, MOST_POINTS, &mut protocol.exponent_cycles);
        if (1..BATCHES as u64).contains(&protocol.exponent_cycles)
            && let Some(entry) = table.entry("exponent_cycles")
        {
            let given = protocol.exponent_cycles;
            entry.fault(format!("{given} are too few for an exponent; {BATCHES} or more, or 0"));
        }
        if let Some(entry) = table.entry("exponent_error")
            && let Some(given) = entry.quantity(Dimension::Number)
        {
            let [least, most] =
                [Protocol::EXPONENT_ERRORS.start(), Protocol::EXPONENT_ERRORS.end()];
            match Protocol::EXPONENT_ERRORS.contains(&given) {
                true => protocol.exponent_error = given,
                false => entry.fault(format!("{given} must lie between {least} and {most}")),
            }
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
    if let Some(history) = top.entry("history").filter(|_| !top.model().keeps_histories()) {
        let name = top.model().name;
        history.fault(format!(
            "no histories are kept of motions of the model {name}: its cycles are none of a drive"
        ));
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
    let model = top.model();
    let Some(entry) = top.entry("outputs") else { return model.outputs().collect() };
    let names: Vec<(&str, Output)> =
        model.outputs().map(|output| (output.name(), output)).collect();
    let mut outputs = Vec::new();
    for entry in entry.list() {
        match entry.one_of("output", &names) {
            Some(output) if outputs.contains(&output) => {
                entry.fault(format!("{} is given twice", entry.shown()))
            }
            output => outputs.extend(output),
        }
    }
    outputs
}
