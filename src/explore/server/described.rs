//! What the page is told of the file: its axes, its outputs, and where it comes from.

use serde_json::{Value, json};

use super::explored::Explored;
use crate::description::{Chart, Description, Output, Parameter};
use crate::figure::shown_quantity;
use crate::store::catalogue::{ATTRACTOR, DIRECTION, OUTCOME, PERIOD, STUDY_TEXT, section};
use crate::store::{has_branches, provenance};
use crate::study::Coordinate;

/// The file in one object; values of axes in SI; `running` tells how far its run is.
pub fn described(explored: &Explored, running: Value) -> Value {
    let Explored { archive, file, study, .. } = explored;
    let frame = archive.frame();
    let shown = |name: &str| shown_json(explored, name);
    let axis = |name: &str, values: Vec<f64>| {
        let mut axis = shown(name);
        axis["values"] = json!(values);
        axis
    };
    let of_axis = |it: &crate::study::Axis| axis(it.coordinate.name(), it.values.clone());
    let directions = frame.coordinate(DIRECTION.name).map(|it| &it.flags);
    let directions = directions.into_iter().flatten().map(|(_, name)| name.clone());
    let kinds = [OUTCOME, PERIOD, ATTRACTOR].map(|it| it.name);
    let model = study.base.model();
    let outputs = model.outputs().map(|it| it.name()).chain(kinds);
    let outputs = outputs.filter(|name| archive.unit(name).is_some()).map(shown);
    let varied = study.case_set.varied();
    let is_held =
        |it: &Parameter| !varied.contains(&Coordinate::Parameter(*it)) && study.has_effect(*it);
    let constant = |it: Parameter| {
        let mut constant = shown(it.symbol());
        constant["value"] = json!(study.base[it]);
        constant
    };
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    json!({
        "title": if study.title.is_empty() { stem.as_ref() } else { study.title.as_str() },
        "file": file.display().to_string(),
        "cases": study.cases(),
        "axes": study.axes().iter().map(of_axis).collect::<Vec<_>>(),
        "directions": directions.collect::<Vec<_>>(),
        "outputs": outputs.collect::<Vec<_>>(),
        "constants": model.parameters().filter(is_held).map(constant).collect::<Vec<_>>(),
        "has_curves": has_branches(frame),
        "model": model_json(explored),
        "running": running,
        "inherits": study.inherit().is_some(),
        "program": provenance::program(&frame.attributes),
        "study": frame.texts.get(STUDY_TEXT).map_or("", String::as_str),
    })
}

/// How figures show the quantity of this name.
fn shown_json(explored: &Explored, name: &str) -> Value {
    let it = shown_quantity(name, explored.archive.frame());
    json!({ "name": name, "label": it.label, "unit": it.unit, "factor": it.factor })
}

/// What the page has to know of the model: its starts, sections, states, histories and key numbers, as figures show them.
fn model_json(explored: &Explored) -> Value {
    let model: &'static Description = explored.model();
    let shown = |name: &str| shown_json(explored, name);
    let starts = Coordinate::starts(model).chain(Coordinate::phases(model).take(1));
    let surface = model.impact_surface().map(|it| shown(it.symbol()));
    json!({
        "starts": starts.map(|it| shown(it.name())).collect::<Vec<_>>(),
        "section": section(model).iter().map(|it| shown(it.name)).collect::<Vec<_>>(),
        "state": (0..model.coordinates.len()).map(|at| state_json(explored, at)).collect::<Vec<_>>(),
        "charts": model.motion.charts.iter().map(|it| chart_json(explored, it)).collect::<Vec<_>>(),
        "portrait": model.motion.portrait.map(|names| names.map(shown)),
        "keeps_histories": model.keeps_histories(),
        "surface": surface,
        "meets_surface": model.signal_of_coordinate(0).map(|it| it.name()),
        "costs": costs(explored).into_iter().map(|it| shown(it.name())).collect::<Vec<_>>(),
        "key_outputs": model.key_outputs().map(|it| shown(it.name())).collect::<Vec<_>>(),
        "main_output": shown(model.main_output().name()),
    })
}

/// What motions cost, as far as the file has it or, of the power, what it follows from; none where it does not have what they gain.
fn costs(explored: &Explored) -> Vec<Output> {
    let model: &'static Description = explored.model();
    let has = |it: Output| explored.archive.unit(it.name()).is_some();
    if !model.has_trade_off() || !has(model.speed()) {
        return Vec::new();
    }
    let is_known = |it: &Output| has(*it) || (*it == model.power() && has(model.work()));
    model.costs().filter(is_known).collect()
}

/// A coordinate of the state, by its name, in the unit of its history.
fn state_json(explored: &Explored, place: usize) -> Value {
    let model = explored.model();
    let name = model.coordinates[place].name;
    let mut told = shown_json(explored, model.coordinate_along(place).name);
    told["name"] = json!(name);
    let unit = told["unit"].as_str().unwrap_or_default();
    told["label"] =
        json!(if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") });
    told
}

/// A chart with its signals, each with its name without the unit, which the label of the chart has.
fn chart_json(explored: &Explored, chart: &Chart) -> Value {
    let signals: Vec<Value> = chart.signals.iter().map(|name| shown_json(explored, name)).collect();
    let unit = signals.first().and_then(|it| it["unit"].as_str()).unwrap_or_default().to_owned();
    let in_unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
    let label = format!("{}{in_unit}", chart.title);
    let named = |mut signal: Value| {
        let words = signal["label"].as_str().unwrap_or_default();
        signal["label"] = json!(words.strip_suffix(&in_unit).unwrap_or(words));
        signal
    };
    json!({ "label": label, "signals": signals.into_iter().map(named).collect::<Vec<_>>() })
}
