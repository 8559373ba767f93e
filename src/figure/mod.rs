//! Shown: draws stored records.

mod attractor_diagram;
mod attractors;
mod axis;
mod basin;
mod bifurcation;
mod canvas;
mod category;
mod cells;
mod cloud;
mod colour;
mod curves;
mod diagram;
mod error;
mod branch_lines;
mod event_marks;
mod font;
mod format;
mod geometry;
mod header;
mod history;
mod inferred;
mod kind;
mod map;
mod mark;
mod optima_table;
mod outcome;
mod output;
mod page;
mod panel;
mod phase_portrait;
mod plane;
mod quantity;
mod raster;
mod registry;
mod scale;
mod section;
mod settling;
mod shares;
mod shown;
mod style;
mod symbol;
mod text;
mod ticks;
mod track;
mod trade_off;
mod trade_off_maps;
mod trade_off_motions;
mod trade_off_table;
mod varied;
mod view;

use std::collections::BTreeSet;
use std::path::PathBuf;

pub use error::FigureError;
pub use format::Format;
pub use kind::Needs;
pub use output::Place;
pub use shown::Shown;

use crate::study::{Drawing, DrawingKind};
use canvas::Drawn;
use output::Figure;
use view::View;

/// What must be in a file of results before a figure of this kind can be drawn from it.
pub fn needs(kind: DrawingKind) -> Needs {
    registry::kind(kind).needs
}

/// The names of the variables whose numbers `drawing` shows or judges cases by; of others it needs no more
/// than their labels.
pub fn variables(drawing: &Drawing) -> BTreeSet<String> {
    let reads = registry::kind(drawing.kind).reads;
    // Every figure looks for the parameters along which orbits were continued.
    reads(drawing).and(varied::READS).into_set()
}

/// Draws `drawing` from the results in `shown` and writes `<folder>/<name>.<extension>` in each format of `place`,
/// each file complete or absent.
pub fn draw<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
    place: &Place<'_>,
) -> Result<Files, FigureError> {
    let (drawn, notes) = drawn(shown.into(), drawing)?;
    let figure = Figure { name: &drawing.name, about: &drawn.about, svg: &drawn.svg };
    Ok(Files { paths: figure.write(place)?, notes })
}

/// Draws `drawing` from the results in `shown` as a picture for a screen.
pub fn picture<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
) -> Result<Picture, FigureError> {
    let (drawn, notes) = drawn(shown.into(), drawing)?;
    let figure = Figure { name: &drawing.name, about: &drawn.about, svg: &drawn.svg };
    let (png, width_mm) = figure.raster(style::SCREEN_DPI)?;
    Ok(Picture { png, width_mm, about: drawn.about, notes })
}

/// The drawing, and what it leaves out or takes for something else.
fn drawn(shown: Shown<'_>, drawing: &Drawing) -> Result<(Drawn, Vec<String>), FigureError> {
    let view = View::new(shown, drawing)?;
    check_request(&view)?;
    let drawn = (registry::kind(drawing.kind).draw)(&view)?;
    let figure = drawing.name.clone();
    if let Some((character, label)) = drawn.missing {
        return Err(FigureError::Glyph { figure, character, label });
    }
    if let Some(why) = drawn.fault {
        return Err(FigureError::Render { figure, why });
    }
    let notes = [view.taken_for_another(), drawn.notes.clone()].concat();
    Ok((drawn, notes))
}

/// A figure for a screen.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// The bytes of a PNG file.
    pub png: Vec<u8>,
    /// Its width [mm].
    pub width_mm: f64,
    /// What it shows, in a sentence.
    pub about: String,
    /// What it leaves out or takes for something else, a sentence each; it stands in the picture, too.
    pub notes: Vec<String>,
}

/// The files of a figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Files {
    /// Their paths, in the order of the formats.
    pub paths: Vec<PathBuf>,
    /// What the figure leaves out or takes for something else, a sentence each; it stands in the figure, too.
    pub notes: Vec<String>,
}

/// Checks what does not depend on the kind of figure.
fn check_request(view: &View<'_>) -> Result<(), FigureError> {
    let name = &view.drawing.name;
    let is_stem = !name.is_empty() && !name.starts_with('.') && !name.contains(['/', '\\', '\0']);
    if !is_stem {
        return Err(view.unfit("the name of a figure must be the stem of a file name"));
    }
    let (kind, of) = (view.drawing.kind, &view.drawing.of);
    let most = kind.keys().most;
    if of.len() > most && most > 0 {
        let (kind, of) = (kind.name(), of.join(", "));
        return Err(view.unfit(format!("a {kind} shows one output, and `of` names {of}")));
    }
    let shows_all = kind == DrawingKind::Bifurcation || kind.keys().between;
    if shows_all && inferred::has_inferred(view) {
        let why = "shows computed cases, and most of a refined grid are inferred; draw a map";
        return Err(view.unfit(format!("a {} {why}, or compute all", kind.name())));
    }
    match view.drawing.width_mm {
        Some(width) if !(style::WIDTHS.0..=style::WIDTHS.1).contains(&width) => {
            let (low, high) = style::WIDTHS;
            Err(view.unfit(format!("width-mm = {width} is not within {low} to {high} mm")))
        }
        _ => Ok(()),
    }
}
