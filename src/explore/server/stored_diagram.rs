//! The bifurcation diagram that a file has: the points of all its sweeps, its branches with their special points, and its ramps.

use axum::response::Response;
use serde_json::{Value, json};

use super::answer::{Refusal, json as json_answer};
use super::asked::Asked;
use super::explored::Explored;
use super::limits::limited;
use super::map::key_json;
use super::units::Units;
use crate::figure::{
    ColouredDiagram, DiagramBranch, DiagramCase, DiagramPanel, DiagramRamp, DiagramSpecial,
    coloured_diagram, coloured_diagram_variables, diagram_axes, diagram_axes_variables,
};
use crate::store::catalogue::{ATTRACTOR, OUTCOME, PERIOD};
use crate::study::{Axis, Drawing, DrawingKind};

/// The parameters of a request beside what is held; `stored` says of a figure that it is one of the file.
const KNOWN: [&str; 7] = ["x", "of", "colour-by", "limits-x", "stored", "kind", "format"];
/// What parts the names of what is shown.
const COMMA: char = ',';

/// What diagrams of the file can lie over: its only axis, and the parameters in which orbits were continued or motions followed along
/// ramps; nothing where its cases lie over a plane, or are drawn.
pub fn axes(explored: &Explored) -> Result<Vec<String>, Refusal> {
    let own = explored.study.axes();
    if own.len() > 1 || !explored.ranges().is_empty() {
        return Ok(Vec::new());
    }
    let any = Drawing::new("axes", DrawingKind::Bifurcation);
    let dataset = explored.part(diagram_axes_variables(), &any)?;
    let mut names: Vec<String> = own.iter().map(|axis| axis.name().to_owned()).collect();
    let continued = diagram_axes(&dataset).into_iter();
    names.extend(continued.filter(|it| !own.iter().any(|axis| axis.name() == it)));
    Ok(names)
}

/// The diagram that a request asks for; what it does not name is as in the first diagram of the study.
pub fn drawing(explored: &Explored, asked: &Asked) -> Result<Drawing, Refusal> {
    asked.only(explored.model(), &KNOWN)?;
    let usual = explored.study.drawings.iter().find(|it| it.kind == DrawingKind::Bifurcation);
    let usual = usual.cloned();
    let mut drawing =
        usual.unwrap_or_else(|| Drawing::new("bifurcation", DrawingKind::Bifurcation));
    let axes = axes(explored)?;
    let x = asked.text("x").map(str::to_owned).or(drawing.x.take());
    let x = x.filter(|it| !it.is_empty()).or_else(|| axes.first().cloned());
    let Some(x) = x.filter(|it| axes.contains(it)) else {
        return Err(Refusal::unfit("x: these results have no diagram over it"));
    };
    if let Some(of) = asked.text("of") {
        drawing.of = of.split(COMMA).filter(|it| !it.is_empty()).map(str::to_owned).collect();
    }
    if let Some(by) = asked.text("colour-by") {
        drawing.colour_by = Some(by.to_owned()).filter(|it| !it.is_empty());
    }
    limited(explored, asked, "limits-x", &x, &mut drawing.settings)?;
    Units::of(asked)?.set(&mut drawing.settings, explored);
    drawing.x = Some(x);
    Ok(drawing)
}

/// The diagram.
pub fn diagram(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    let drawing = drawing(explored, asked)?;
    let names = coloured_diagram_variables(&drawing, explored.model());
    let dataset = explored.part(names, &drawing)?;
    let told = coloured_diagram(&*dataset, &drawing).map_err(Refusal::undrawn)?;
    Ok(json_answer(&diagram_json(explored, &drawing, &told)))
}

fn diagram_json(explored: &Explored, drawing: &Drawing, told: &ColouredDiagram) -> Value {
    let axes: Vec<&str> = explored.study.axes().iter().map(Axis::name).collect();
    let by = told.told.as_ref().map(|(told, key)| json!({ "told": told, "key": key_json(key) }));
    json!({
        "x": {
            "name": told.axis,
            "label": told.label,
            "factor": told.factor,
            "range": told.range,
            "log": told.is_logarithmic,
            "is_axis": axes.contains(&told.axis.as_str()),
        },
        "colour_by": drawing.colour_by,
        "of_cases": told.of_cases,
        "cases": told.cases.iter().map(case_json).collect::<Vec<_>>(),
        "sorts": told.sorts.iter().map(|(name, colour)| json!([name, colour])).collect::<Vec<_>>(),
        "by": by,
        "panels": told.panels.iter().map(panel_json).collect::<Vec<_>>(),
        "branches": told.branches.iter().map(branch_json).collect::<Vec<_>>(),
        "special": told.specials.iter().map(special_json).collect::<Vec<_>>(),
        "ramps": told.ramps.iter().map(ramp_json).collect::<Vec<_>>(),
        "windows": told.windows,
        "left_out": told.left_out,
    })
}

fn case_json(case: &DiagramCase) -> Value {
    json!({
        "at": case.at,
        "sweep": case.sweep,
        (OUTCOME.name): case.outcome,
        (PERIOD.name): case.period,
        (ATTRACTOR.name): case.attractor,
        "sort": case.sort,
        "colour": case.colour,
    })
}

fn panel_json(panel: &DiagramPanel) -> Value {
    let [unstable, stable] = &panel.lines;
    json!({
        "name": panel.name,
        "label": panel.label,
        "factor": panel.factor,
        "section": panel.is_section,
        "values": panel.values,
        "unstable": unstable,
        "stable": stable,
        "events": panel.events.iter().map(|(words, at)| json!({ "words": words, "at": at })).collect::<Vec<_>>(),
    })
}

fn branch_json(branch: &DiagramBranch) -> Value {
    let [orbits, stable] = branch.orbits;
    json!({
        "name": branch.name,
        (PERIOD.name): branch.period,
        "orbits": orbits,
        "stable": stable,
        "ends": branch.ends,
    })
}

fn special_json(special: &DiagramSpecial) -> Value {
    json!({
        "words": special.words,
        (PERIOD.name): special.period,
        "multipliers": special.multipliers,
        "x": special.x,
        "values": special.values,
    })
}

fn ramp_json(ramp: &DiagramRamp) -> Value {
    json!({ "name": ramp.name, "colour": ramp.colour, "panels": ramp.panels, "jumps": ramp.jumps })
}
