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
use super::map_file::read_map;
use super::named_model::{check_model, model_in};
use super::own_outputs::{check_used, read_outputs};
use super::parameter_table::{ParameterTable, read_parameters};
use super::protocol_file::read_protocol;
use super::ramp_file::read_ramps;
use super::refine_file::read_basin;
use super::start_file::read_start;
use super::without_effect::given_without_effect;
use super::{CaseSet, Continuation, Coordinate, Refine};
use crate::description::Parameter;

/// More numbers in the results than this (32 GB) are too, rather than found out after a night.
const MOST_NUMBERS: usize = 4_000_000_000;

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
    let basin = read_basin(top, &case_set, &start);
    let outputs = read_outputs(top, &with_parts(&base, &case_set.varied()), &protocol);
    let map = read_map(top, &case_set, &outputs);
    let refine = map.refine.or(basin.refine.then_some(Refine::Attractors));
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
        manifolds: basin.manifolds,
        outputs,
        branches,
        ramps,
        boundaries: map.boundaries,
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
