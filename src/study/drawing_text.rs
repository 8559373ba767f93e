//! The figures of a study, written as those of a study file.

use super::appearance::dimension_of;
use super::toml_text::{Document, inline, list, number, plain_quantity, quantity, text};
use super::{Coordinate, Drawing, QuantitySettings, Setting};
use crate::description::Description;
use crate::quantity::Dimension;

/// Writes a figure of a study of a model.
pub(super) fn write_drawing(
    document: &mut Document,
    drawing: &Drawing,
    model: &'static Description,
) {
    document.element("figures");
    document.put("name", text(&drawing.name));
    document.put("kind", text(drawing.kind.name()));
    for (key, value) in [("title", &drawing.title), ("x", &drawing.x), ("y", &drawing.y)] {
        if let Some(value) = value {
            document.put(key, text(value));
        }
    }
    put_names(document, "of", &drawing.of);
    write_held(document, drawing, model);
    if let Some(cycles) = drawing.cycles {
        document.put("cycles", list(cycles.into_iter().map(number)));
    }
    if let Some(sweep) = drawing.sweep {
        document.put("sweep", text(sweep.name()));
    }
    if let Some(name) = &drawing.colour_by {
        document.put("colour_by", text(name));
    }
    if !drawing.colours.is_empty() {
        let colours = drawing.colours.iter();
        let each = colours.map(|(number, colour)| (number.to_string(), text(&colour.text())));
        document.put("colours", inline(each));
    }
    if let Some(budget) = drawing.budget {
        let cost = drawing.kind.cost(&drawing.of, model).map(|it| it.quantity().dimension);
        document.put("budget", quantity(budget, cost.unwrap_or(Dimension::Number)));
    }
    if drawing.curves {
        document.put("curves", drawing.curves);
    }
    document.put("branches", drawing.branches);
    write_sizes(document, drawing);
    put_names(document, "hide", &drawing.hide);
    write_texts(document, drawing, model);
    document.put("legend", drawing.legend);
    document.put("data", drawing.data);
    document.put("svg_text", drawing.svg_text);
    write_settings(document, drawing, model);
}

/// Names under a key, if there are any.
fn put_names(document: &mut Document, key: &str, names: &[String]) {
    if !names.is_empty() {
        document.put(key, list(names.iter().map(|name| text(name))));
    }
}

/// Where axes are held, also at several values.
fn write_held(document: &mut Document, drawing: &Drawing, model: &'static Description) {
    if drawing.at.is_empty() && drawing.panels.is_empty() {
        return;
    }
    let one = drawing.at.iter().map(|(name, value)| (text(name), on_axis(name, *value, model)));
    let several = drawing.panels.iter().map(|(name, values)| {
        (text(name), list(values.iter().map(|value| on_axis(name, *value, model))))
    });
    document.put("at", inline(one.chain(several)));
}

/// A value on an axis that is named so; a plain number where the model has none.
fn on_axis(name: &str, value: f64, model: &'static Description) -> String {
    let known = Coordinate::all(model).find(|coordinate| coordinate.name() == name);
    known.map_or(number(value), |it| quantity(value, it.dimension()))
}

fn write_sizes(document: &mut Document, drawing: &Drawing) {
    let sizes = [
        ("width", drawing.width_mm),
        ("height", drawing.height_mm),
        ("marker_size", drawing.marker_mm),
    ];
    for (key, size) in sizes {
        if let Some(size) = size {
            document.put(key, text(&format!("{size:?} mm")));
        }
    }
    if let Some(dpi) = drawing.dpi {
        document.put("dpi", number(dpi));
    }
}

/// The words in the figure with their places.
fn write_texts(document: &mut Document, drawing: &Drawing, model: &'static Description) {
    if drawing.texts.is_empty() {
        return;
    }
    let texts = drawing.texts.iter().map(|(words, at)| {
        let place = at
            .iter()
            .map(|(name, value)| (text(name), quantity(*value, dimension_or_number(name, model))));
        (text(words), inline(place))
    });
    document.put("texts", inline(texts));
}

/// What is set of quantities, a table for each setting.
fn write_settings(document: &mut Document, drawing: &Drawing, model: &'static Description) {
    for (key, setting) in Setting::NAMES {
        let each = drawing.settings.iter().filter_map(|(name, set)| {
            let dimension = dimension_or_number(name, model);
            Some((text(name), setting_text(set, setting, dimension)?))
        });
        let all: Vec<(String, String)> = each.collect();
        if !all.is_empty() {
            document.put(key, inline(all.into_iter()));
        }
    }
}

/// What is set of a quantity of a dimension, if it is.
fn setting_text(set: &QuantitySettings, setting: Setting, dimension: Dimension) -> Option<String> {
    let parts = set.parts(setting, |value| plain_quantity(value, dimension))?;
    let parts: Vec<String> = parts.iter().map(|part| text(part)).collect();
    Some(if setting.is_list() { list(parts.into_iter()) } else { parts.concat() })
}

/// The dimension of what figures of a model can show, that of a number where it is not known.
fn dimension_or_number(name: &str, model: &'static Description) -> Dimension {
    dimension_of(name, model).unwrap_or(Dimension::Number)
}
