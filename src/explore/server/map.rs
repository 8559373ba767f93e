//! Maps: the cells of any output over two axes, with the colours of the figures.

use std::collections::BTreeMap;

use axum::response::Response;
use serde_json::{Value, json};

use super::answer::{Refusal, bytes};
use super::asked::Asked;
use super::explored::Explored;
use crate::figure::{ColouredMap, MapAxis, MapColours, coloured_map};
use crate::study::{Drawing, DrawingKind, Sweep};

/// The parameters of a request for a map or for its figure, beside the axes.
pub const KNOWN: [&str; 5] = ["of", "x", "y", "sweep", "format"];

/// The figure that a request asks for; the axes that are not drawn are held where it says.
pub fn drawing(explored: &Explored, asked: &Asked) -> Result<Drawing, Refusal> {
    asked.only(&KNOWN)?;
    let [x, y, of] = ["x", "y", "of"].map(|name| asked.text(name).map(str::to_owned));
    let is_drawn = |name: &str| x.as_deref() == Some(name) || y.as_deref() == Some(name);
    let is_axis = |name: &str| explored.study.axes().iter().any(|it| it.coordinate.name() == name);
    let held = asked.coordinates()?.into_iter().map(|(it, value)| (it.name().to_owned(), value));
    let at: BTreeMap<String, f64> = held.filter(|it| is_axis(&it.0) && !is_drawn(&it.0)).collect();
    let sweep = asked.text("sweep").map(|name| {
        let known = Sweep::NAMES.iter().find(|it| it.0 == name);
        known.map(|it| it.1).ok_or_else(|| Refusal::unfit("sweep: no such sweep"))
    });
    let sweep = sweep.transpose()?;
    let of = of.into_iter().collect();
    Ok(Drawing { x, y, of, at, sweep, ..Drawing::new("map", DrawingKind::Map) })
}

/// The map as one binary answer: the length of a JSON object as four bytes, least first; the object; then red, green, blue and
/// opacity of each cell, and its value as four bytes, least first.
pub fn map(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    let drawing = drawing(explored, asked)?;
    let dataset = explored.dataset(&drawing)?;
    let map =
        coloured_map(&*dataset, &drawing).map_err(|error| Refusal::unfit(error.to_string()))?;
    Ok(bytes(packed(&map), "application/octet-stream"))
}

fn packed(map: &ColouredMap) -> Vec<u8> {
    let mut head = described(map).to_string().into_bytes();
    // What follows begins at a multiple of four.
    head.resize(head.len().next_multiple_of(4), b' ');
    let mut packed = Vec::with_capacity(4 + head.len() + 2 * map.colours.len());
    packed.extend((head.len() as u32).to_le_bytes());
    packed.extend(head);
    packed.extend(&map.colours);
    packed.extend(map.values.iter().flat_map(|value| value.to_le_bytes()));
    packed
}

fn described(map: &ColouredMap) -> Value {
    let axis = |it: &MapAxis| {
        json!({
            "name": it.name, "label": it.label, "factor": it.factor, "values": it.values, "ends": it.ends,
            "range": it.range, "log": it.is_logarithmic,
        })
    };
    let key = match &map.key {
        MapColours::Bar(range, spread, width, colours) => {
            json!({ "range": range, "spread": spread, "width": width, "colours": colours })
        }
        MapColours::Kinds(kinds) => json!({ "kinds": kinds }),
    };
    json!({ "x": axis(&map.axes[0]), "y": axis(&map.axes[1]), "told": map.told, "key": key })
}
