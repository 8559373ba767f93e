//! What the page is told of the file: its axes, its outputs, and where it comes from.

use serde_json::{Value, json};

use super::explored::Explored;
use crate::description::{Output, Parameter};
use crate::figure::shown_quantity;
use crate::store::catalogue::{ATTRACTOR, DIRECTION, OUTCOME, PERIOD, STUDY_TEXT};
use crate::store::{has_branches, provenance};
use crate::study::Coordinate;

/// The file in one object; values of axes in SI; `running` tells how far its run is.
pub fn described(explored: &Explored, running: Value) -> Value {
    let Explored { archive, file, study, .. } = explored;
    let frame = archive.frame();
    let shown = |name: &str| {
        let it = shown_quantity(name, frame);
        json!({ "name": name, "label": it.label, "unit": it.unit, "factor": it.factor })
    };
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
    let has = |it: Output| archive.unit(it.name()).is_some();
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
        "has_trade_off": model.has_trade_off()
            && has(model.speed())
            && (has(model.work()) || has(model.power())),
        "running": running,
        "inherits": study.inherit().is_some(),
        "program": provenance::program(&frame.attributes),
        "study": frame.texts.get(STUDY_TEXT).map_or("", String::as_str),
    })
}
