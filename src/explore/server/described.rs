//! What the page is told of the file: its axes, its outputs, and where it comes from.

use serde_json::{Value, json};

use super::explored::Explored;
use super::map::SETTINGS;
use super::stored_diagram;
use super::units::Units;
use crate::description::{Chart, Description, Output};
use crate::store::catalogue::{ATTRACTOR, DIRECTION, OUTCOME, PERIOD, STUDY_TEXT, section};
use crate::store::{Design, has_branches, provenance};
use crate::study::{Axis, Coordinate};

/// The file in one object; values of axes in SI; `running` tells how far its run is.
pub fn described(explored: &Explored, units: &Units, running: Value) -> Value {
    let Explored { archive, file, study, .. } = explored;
    let frame = archive.frame();
    let directions = frame.coordinate(DIRECTION.name).map(|it| &it.flags);
    let directions = directions.into_iter().flatten().map(|(_, name)| name.clone());
    // What cannot be read is no fault of the other facts.
    let diagrams = stored_diagram::axes(explored).unwrap_or_default();
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    json!({
        "title": if study.title.is_empty() { stem.as_ref() } else { study.title.as_str() },
        "file": file.display().to_string(),
        "cases": study.cases(),
        "axes": study.axes().iter().map(|it| axis_json(explored, units, it)).collect::<Vec<_>>(),
        "draws": explored.ranges().iter().map(|it| units.json(it.coordinate.name(), explored)).collect::<Vec<_>>(),
        "diagrams": units.all(diagrams.iter().map(String::as_str), explored),
        "directions": directions.collect::<Vec<_>>(),
        "outputs": outputs_json(explored, units),
        "constants": constants_json(explored, units),
        "is_design": Design::of(frame).is_some(),
        "has_curves": has_branches(frame),
        "model": model_json(explored, units),
        "running": running,
        "settings": SETTINGS.map(|it| it.0),
        "units": units.offered(explored),
        "inherits": study.inherit().is_some(),
        "program": provenance::program(&frame.attributes),
        "study": frame.texts.get(STUDY_TEXT).map_or("", String::as_str),
    })
}

/// An axis of the study, with its values.
fn axis_json(explored: &Explored, units: &Units, axis: &Axis) -> Value {
    let mut told = units.json(axis.name(), explored);
    told["values"] = json!(axis.single().map(|it| &it.values));
    told
}

/// What the file has of its cases.
fn outputs_json(explored: &Explored, units: &Units) -> Vec<Value> {
    let kinds = [OUTCOME, PERIOD, ATTRACTOR].map(|it| it.name);
    let all = explored.model().outputs().map(|it| it.name()).chain(kinds);
    let kept = all.filter(|name| explored.archive.unit(name).is_some());
    kept.map(|name| units.json(name, explored)).collect()
}

/// The parameters that have an effect and do not vary, each with its value.
fn constants_json(explored: &Explored, units: &Units) -> Vec<Value> {
    let study = &explored.study;
    let varied = study.case_set.varied();
    let stated = study.base.stated().map(|(it, _)| it);
    let held =
        stated.filter(|it| !varied.contains(&Coordinate::Parameter(*it)) && study.has_effect(*it));
    let constants = held.map(|it| {
        let mut constant = units.json(it.symbol(), explored);
        constant["value"] = json!(study.base[it]);
        constant
    });
    constants.collect()
}

/// What the page has to know of the model: its starts, sections, states, histories and key numbers, as figures show them.
fn model_json(explored: &Explored, units: &Units) -> Value {
    let model: &'static Description = explored.model();
    let starts = Coordinate::starts(model).chain(Coordinate::phases(model).take(1));
    json!({
        "starts": units.all(starts.map(Coordinate::name), explored),
        "section": units.all(section(model).iter().map(|it| it.name), explored),
        "state": (0..model.coordinates.len()).map(|at| state_json(explored, units, at)).collect::<Vec<_>>(),
        "charts": model.motion.charts.iter().map(|it| chart_json(explored, units, it)).collect::<Vec<_>>(),
        "portrait": model.motion.portrait.map(|names| units.all(names, explored)),
        "keeps_histories": model.keeps_histories(),
        "surface": model.impact_surface().map(|it| units.json(it.symbol(), explored)),
        "meets_surface": model.signal_of_coordinate(0).map(|it| it.name()),
        "costs": units.all(costs(explored).into_iter().map(Output::name), explored),
        "key_outputs": with_errors_json(explored, units, model.key_outputs()),
        "spectrum": with_errors_json(explored, units, model.spectrum()),
        "main_output": units.json(model.main_output().name(), explored),
    })
}

/// How figures show outputs, with the names of their standard errors.
fn with_errors_json(
    explored: &Explored,
    units: &Units,
    outputs: impl Iterator<Item = Output>,
) -> Vec<Value> {
    let with_error = |output: Output| {
        let mut told = units.json(output.name(), explored);
        told["error"] = json!(explored.model().error_of(output).map(Output::name));
        told
    };
    outputs.map(with_error).collect()
}

/// What motions cost, as far as the file has it or, of the power, what it follows from; none where it does not have what they gain.
fn costs(explored: &Explored) -> Vec<Output> {
    let model: &'static Description = explored.model();
    if !model.has_trade_off() || !explored.has(model.speed()) {
        return Vec::new();
    }
    let known = model
        .costs()
        .filter(|it| explored.has(*it) || (*it == model.power() && explored.has(model.work())));
    known.collect()
}

/// A coordinate of the state, by its name, in the unit of its history.
fn state_json(explored: &Explored, units: &Units, place: usize) -> Value {
    let model = explored.model();
    let name = model.coordinates[place].name;
    let mut told = units.json(model.coordinate_along(place).name, explored);
    told["name"] = json!(name);
    let unit = told["unit"].as_str().unwrap_or_default();
    told["label"] =
        json!(if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") });
    told
}

/// A chart with its signals, each with its name without the unit, which the label of the chart has.
fn chart_json(explored: &Explored, units: &Units, chart: &Chart) -> Value {
    let signals: Vec<Value> = chart.signals.iter().map(|name| units.json(name, explored)).collect();
    let unit = signals.first().and_then(|it| it["unit"].as_str()).unwrap_or_default().to_owned();
    let in_unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
    let label = format!("{}{in_unit}", chart.title);
    let named = signals.into_iter().map(|mut signal| {
        let words = signal["label"].as_str().unwrap_or_default();
        signal["label"] = json!(words.strip_suffix(&in_unit).unwrap_or(words));
        signal
    });
    json!({ "label": label, "signals": named.collect::<Vec<_>>() })
}
