//! Shown: draws stored records.

mod attractor_diagram;
mod attractors;
mod axis;
mod bifurcation;
mod canvas;
mod category;
mod cells;
mod cloud;
mod colour;
mod curves;
mod error;
mod followed;
mod event_marks;
mod font;
mod geometry;
mod header;
mod history;
mod map;
mod outcome;
mod output;
mod page;
mod panel;
mod phase_portrait;
mod quantity;
mod raster;
mod reading;
mod scale;
mod style;
mod symbol;
mod text;
mod ticks;
mod track;
mod trade_off;
mod view;

use std::path::{Path, PathBuf};

pub use error::FigureError;
pub use output::Format;
pub use reading::reads;

use crate::store::dataset::Dataset;
use crate::study::{Drawing, DrawingKind};
use output::Figure;
use view::View;

/// Draws `drawing` from the results in `dataset` and writes `<folder>/<name>.<ending>` in each of
/// `formats`, each file complete or absent; gives the paths written.
pub fn draw(
    dataset: &Dataset,
    drawing: &Drawing,
    folder: &Path,
    formats: &[Format],
) -> Result<Vec<PathBuf>, FigureError> {
    let view = View::new(dataset, drawing)?;
    check_request(&view)?;
    let drawn = match drawing.kind {
        DrawingKind::History => history::draw(&view)?,
        DrawingKind::PhasePortrait => phase_portrait::draw(&view)?,
        DrawingKind::Bifurcation => bifurcation::draw(&view)?,
        DrawingKind::Map => map::draw(&view)?,
        DrawingKind::TradeOff => trade_off::draw(&view)?,
        DrawingKind::Curves => curves::draw(&view)?,
    };
    let figure = drawing.name.clone();
    if let Some((character, label)) = drawn.missing {
        return Err(FigureError::Glyph { figure, character, label });
    }
    if let Some(why) = drawn.fault {
        return Err(FigureError::Render { figure, why });
    }
    Figure { name: &drawing.name, about: &drawn.about, svg: &drawn.svg }.write(folder, formats)
}

/// Checks what does not depend on the kind of figure.
fn check_request(view: &View<'_>) -> Result<(), FigureError> {
    let name = &view.drawing.name;
    let is_stem = !name.is_empty() && !name.starts_with('.') && !name.contains(['/', '\\', '\0']);
    if !is_stem {
        return Err(view.unfit("the name of a figure must be the stem of a file name"));
    }
    match view.drawing.width_mm {
        Some(width) if !(style::WIDTHS.0..=style::WIDTHS.1).contains(&width) => {
            let (low, high) = style::WIDTHS;
            Err(view.unfit(format!("width-mm = {width} is not within {low} to {high} mm")))
        }
        _ => Ok(()),
    }
}

/// The axes a diagram runs along: those that are free and neither the direction of a sweep nor a mere number.
fn drawable_axes<'a>(view: &View<'a>) -> Vec<&'a str> {
    view.free_axes().into_iter().filter(|name| !["direction", "draw"].contains(name)).collect()
}

/// The axis along the abscissa, or the parameter along which orbits were followed.
fn abscissa<'a>(view: &View<'a>) -> Result<&'a str, FigureError> {
    let free = drawable_axes(view);
    let named = view.drawing.x.as_ref();
    let along = followed::along(view.dataset);
    let axis = match named {
        Some(name) => view.axes().into_iter().chain(along).find(|axis| axis == name),
        None => free.first().or(along.first()).copied(),
    };
    axis.ok_or_else(|| view.unfit("it needs an axis of the study that `at` does not hold"))
}

/// What a figure shows, in a sentence kept inside its files.
fn about(view: &View<'_>, outputs: &[String], free: &[&str]) -> String {
    let over = if free.is_empty() { String::new() } else { format!(" over {}", free.join(", ")) };
    let held = view.held_record(free);
    let at = if held.is_empty() { String::new() } else { format!(" at {held}") };
    format!("{}{over}{at}", outputs.join(", "))
}
