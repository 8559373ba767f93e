//! Maps: the cells of any output over two axes, with the colours of the figures, and what is shown over and beside them.

use std::collections::BTreeMap;

use axum::response::Response;
use serde_json::{Map, Value, json};

use super::answer::{Refusal, bytes, json as json_answer};
use super::asked::Asked;
use super::explored::Explored;
use super::limits::{ends, limited, read};
use super::units::Units;
use crate::figure::{
    ColouredMap, MapAxis, MapColours, MapLine, MapPoint, TradeOffAxis, coloured_map, over_map,
    over_map_variables, trade_off_cells,
};
use crate::quantity::Dimension;
use crate::study::appearance::SettingText;
use crate::study::{
    Axis, Drawing, DrawingKind, QuantitySettings, Setting, Settings, Sweep, free_name,
};

/// The parameters of a request for a map or for its figure, beside the axes.
const KNOWN: [&str; 13] = [
    "of",
    "x",
    "y",
    "sweep",
    "curves",
    "kind",
    "format",
    "colour-map",
    "scale",
    "limits",
    "limits-x",
    "limits-y",
    "stored",
];
/// What may be set of the colours of a map.
pub const SETTINGS: [(&str, Setting); 3] =
    [("colour-map", Setting::ColourMap), ("scale", Setting::Scale), ("limits", Setting::Limits)];

/// The figure that a request asks for; the axes that are not drawn are held where it says.
pub fn drawing(explored: &Explored, asked: &Asked, kind: DrawingKind) -> Result<Drawing, Refusal> {
    asked.only(explored.model(), &KNOWN)?;
    let [x, y, of] = ["x", "y", "of"].map(|name| asked.text(name).map(str::to_owned));
    let axes: Vec<&str> = explored.study.axes().iter().map(Axis::name).collect();
    let mut at = BTreeMap::new();
    for (coordinate, value) in asked.coordinates(explored.model())? {
        match coordinate.name() {
            name if !axes.contains(&name) => {
                return Err(Refusal::unfit(format!("{name}: is no axis of these results")));
            }
            name if [x.as_deref(), y.as_deref()].contains(&Some(name)) => {
                return Err(Refusal::unfit(format!("{name}: is drawn and cannot be held")));
            }
            name => at.insert(name.to_owned(), value),
        };
    }
    let sweep = asked.text("sweep").map(|name| {
        let known = Sweep::NAMES.iter().find(|it| it.0 == name);
        known.map(|it| it.1).ok_or_else(|| Refusal::unfit("sweep: no such sweep"))
    });
    let sweep = sweep.transpose()?;
    let of: Vec<String> = of.into_iter().collect();
    let name = free_name(kind, &of, &explored.study.drawings);
    let curves = asked.text("curves").is_some();
    let mut settings = settings(explored, asked, &of)?;
    for (key, axis) in [("limits-x", &x), ("limits-y", &y)] {
        match axis {
            Some(name) => limited(explored, asked, key, name, &mut settings)?,
            None if asked.text(key).is_some() => {
                return Err(Refusal::unfit(format!("{key}: goes with the name of an axis")));
            }
            None => {}
        }
    }
    Units::of(asked)?.set(&mut settings, explored);
    Ok(Drawing { x, y, of, at, sweep, curves, settings, ..Drawing::new(name, kind) })
}

/// What is set of the colours of a map of this output, or of the usual one: the ends of its values are in the unit shown.
fn settings(explored: &Explored, asked: &Asked, of: &[String]) -> Result<Settings, Refusal> {
    let usual = explored.model().main_output().name();
    let name = of.first().map_or(usual, String::as_str);
    let mut set = QuantitySettings::default();
    for (key, setting) in SETTINGS {
        let Some(text) = asked.text(key) else { continue };
        let unfit = |why: String| Refusal::unfit(format!("{key}: {why}"));
        let mut parts = vec![text.to_owned()];
        if setting == Setting::Limits {
            parts = ends(&Units::of(asked)?.shown(name, explored), text).map_err(unfit)?;
        }
        let dimension = Dimension::Number;
        set.put(setting, SettingText { parts: &parts, dimension, read }).map_err(unfit)?;
    }
    let is_set = set != QuantitySettings::default();
    Ok(is_set.then(|| (name.to_owned(), set)).into_iter().collect())
}

/// The map as one binary answer: red, green, blue and opacity of each cell, and its value.
pub fn map(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    let drawing = drawing(explored, asked, DrawingKind::Map)?;
    let dataset = explored.dataset(&drawing)?;
    let map = coloured_map(&*dataset, &drawing).map_err(Refusal::undrawn)?;
    Ok(packed(&described(&map), &map.colours, &[&map.values]))
}

/// The curves of special points and the branches over a map.
pub fn curves(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    let drawing = drawing(explored, asked, DrawingKind::Map)?;
    let dataset =
        explored.part(over_map_variables(&drawing, explored.archive.frame().model()), &drawing)?;
    let over = over_map(&*dataset, &drawing).map_err(Refusal::undrawn)?;
    let lines: Vec<Value> = over.lines.iter().map(line_json).collect();
    let points: Vec<Value> = over.points.iter().map(point_json).collect();
    Ok(json_answer(&json!({ "lines": lines, "points": points, "left_out": over.left_out })))
}

fn line_json(line: &MapLine) -> Value {
    json!({ "words": line.words, "colour": line.colour, "dash": line.is_dashed, "points": line.points })
}

fn point_json(point: &MapPoint) -> Value {
    json!({ "words": point.words, "colour": point.colour, "at": point.at })
}

/// The trade-off of the cells of a map as one binary answer: prices, and speeds.
pub fn trade_off(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    if !explored.model().has_trade_off() {
        return Err(Refusal::unfit(explored.model().without_trade_off()));
    }
    let drawing = drawing(explored, asked, DrawingKind::TradeOff)?;
    let dataset = explored.dataset(&drawing)?;
    let cells = trade_off_cells(&*dataset, &drawing).map_err(Refusal::undrawn)?;
    let [price, speed] = &cells.axes;
    let fronts: Map<String, Value> = cells
        .fronts
        .iter()
        .map(|(direction, front)| (direction.name().to_owned(), json!(front)))
        .collect();
    let left_out: Vec<(&String, &usize)> = cells.left_out.iter().collect();
    let head = json!({
        "price": price_or_speed_json(price),
        "speed": price_or_speed_json(speed),
        "count": price.values.len(),
        "fronts": fronts,
        "left_out": left_out,
    });
    Ok(packed(&head, &[], &[&price.values, &speed.values]))
}

fn price_or_speed_json(axis: &TradeOffAxis) -> Value {
    json!({ "name": axis.name, "label": axis.label })
}

/// The length of a JSON object as four bytes, least first; the object; bytes; and columns of numbers of four bytes, least first.
fn packed(head: &Value, bytes_of_cells: &[u8], columns: &[&[f32]]) -> Response {
    let mut head = head.to_string().into_bytes();
    // What follows begins at a multiple of four.
    head.resize(head.len().next_multiple_of(4), b' ');
    let numbers: usize = columns.iter().map(|it| it.len()).sum();
    let mut packed = Vec::with_capacity(4 + head.len() + bytes_of_cells.len() + 4 * numbers);
    packed.extend((head.len() as u32).to_le_bytes());
    packed.extend(head);
    packed.extend(bytes_of_cells);
    for column in columns {
        packed.extend(column.iter().flat_map(|value| value.to_le_bytes()));
    }
    bytes(packed, "application/octet-stream")
}

fn described(map: &ColouredMap) -> Value {
    let [x, y] = &map.axes;
    json!({ "x": axis_json(x), "y": axis_json(y), "told": map.told, "key": key_json(&map.key) })
}

/// What the colours tell.
pub(super) fn key_json(key: &MapColours) -> Value {
    match key {
        MapColours::Bar(range, spread, width, colours) => {
            json!({ "range": range, "spread": spread, "width": width, "colours": colours })
        }
        MapColours::Kinds(kinds) => json!({ "kinds": kinds }),
    }
}

fn axis_json(axis: &MapAxis) -> Value {
    json!({
        "name": axis.name, "label": axis.label, "factor": axis.factor, "values": axis.values, "ends": axis.ends,
        "range": axis.range, "log": axis.is_logarithmic,
    })
}
