//! Shown: draws stored records.

mod along_path;
mod attractor_colours;
mod attractor_diagram;
mod attractors;
mod axis;
mod axis_numbers;
mod basin;
mod bifurcation;
mod canvas;
mod caption;
mod category;
mod chosen;
mod cells;
mod case_panels;
mod cloud;
mod coloured;
mod coloured_diagram;
mod colour;
mod contour;
mod codim2_symbol;
mod curves;
mod data;
mod diagram;
mod diagram_contents;
mod error;
mod branch_lines;
mod event_marks;
mod font;
mod format;
mod geometry;
mod header;
mod held;
mod history;
mod inferred;
mod kind;
mod known_attractors;
mod manifolds;
mod map;
mod mark;
mod measured;
mod motion;
mod notes;
mod optima_table;
mod origin;
mod outcome;
mod output;
mod over_basin;
mod over_map;
mod page;
mod paint;
mod panel;
mod phase_portrait;
mod plane;
pub mod plot;
mod quantity;
mod ramp_points;
mod raster;
mod registry;
mod requested;
mod scale;
mod section;
mod section_points;
mod sensitivity;
mod settling;
mod shares;
mod shown;
mod spectrum;
mod style;
mod symbol;
mod text;
mod thinned;
mod ticks;
mod track;
mod trade_off;
mod trade_off_cells;
mod trade_off_fronts;
mod trade_off_maps;
mod trade_off_motions;
mod trade_off_outputs;
mod trade_off_table;
mod unit;
mod varied;
mod view;
mod without_period;

use std::collections::BTreeSet;
use std::path::PathBuf;

pub use coloured::{
    ColouredMap, MapAxis, MapColours, ShownQuantity, coloured_map, label_colour, shown_quantity,
};
pub use coloured_diagram::{
    ColouredDiagram, DiagramBranch, DiagramCase, DiagramPanel, DiagramRamp, DiagramSpecial,
    coloured_diagram, coloured_diagram_variables,
};
pub use error::FigureError;
pub use format::Format;
pub use kind::Needs;
pub use output::Place;
pub use over_basin::{
    BasinAttractor, BasinCurve, BasinSaddle, OverBasin, over_basin, over_basin_variables,
};
pub use over_map::{MapLine, MapPoint, OverMap, over_map, over_map_variables, special_symbol};
pub use shown::{Measured, Shown};
pub use trade_off_cells::{TradeOffAxis, TradeOffCells, trade_off_cells};
pub use trade_off_outputs::gain_of;

use crate::description::Description;
use crate::store::catalogue::{ATTRACTOR, Entry};
use crate::store::dataset::Dataset;
use crate::study::appearance::NATURAL;
use crate::study::{Coordinate, Drawing, DrawingKind, Size, Sweep};
use along_path::ByQuantities;
use attractor_colours::Colours;
use canvas::Drawn;
use origin::Origin;
use output::Figure;
use text::Text;
use view::View;

/// What must be in a file of results before a figure of this kind can be drawn from it.
pub fn needs(kind: DrawingKind) -> Needs {
    registry::kind(kind).needs
}

/// The names of the variables whose numbers `drawing` shows or judges cases by; of others it needs no more
/// than their labels.
pub fn variables(drawing: &Drawing, model: &'static Description) -> BTreeSet<String> {
    if !drawing.kind.suits(drawing.of.len(), model) {
        return BTreeSet::new();
    }
    let reads = registry::kind(drawing.kind).reads;
    // Every figure looks for the parameters along which orbits were continued, and for what varies along paths.
    let names = reads(drawing, model).and(varied::READS);
    let names = names.and(Coordinate::all(model).map(Entry::of_coordinate));
    let of_natural = model.natural().into_iter().flatten().map(Entry::of_parameter);
    // Whatever shows attractors has their colours.
    let of_attractors = [ATTRACTOR].into_iter().filter(|_| drawing.kind.keys().attractors);
    let is_natural = drawing.settings.values().any(|it| it.unit == Some(NATURAL));
    names.and(of_attractors).and(of_natural.filter(|_| is_natural)).into_set()
}

/// The names of the variables that [`diagram_axes`] reads.
pub fn diagram_axes_variables() -> BTreeSet<String> {
    varied::READS.iter().map(|entry| entry.name.to_owned()).collect()
}

/// The parameters beside the axes of the cases over which results have a diagram: those in which orbits were continued or motions
/// followed along ramps.
pub fn diagram_axes(dataset: &Dataset) -> Vec<String> {
    varied::along(dataset).into_iter().map(str::to_owned).collect()
}

/// Draws `drawing` from the results in `shown` and writes `<folder>/<name>.<extension>` in each format of `place`,
/// each file complete or absent.
pub fn draw<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
    place: &Place<'_>,
) -> Result<Files, FigureError> {
    let shown = shown.into();
    let origin = Origin::of(shown.dataset);
    let (drawn, notes) = drawn(shown, drawing)?;
    let figure = Figure {
        name: &drawing.name,
        about: &drawn.about,
        svg: &drawn.svg,
        data: drawn.data.map(|data| data.text(&drawn.about)),
        keeps_text: drawing.svg_text,
        origin: Some(&origin),
        dpi: drawing.dpi.unwrap_or(style::DPI),
    };
    Ok(Files { paths: figure.write(place)?, notes })
}

/// Draws `drawing` from the results in `shown` as a picture for a screen.
pub fn picture<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
) -> Result<Picture, FigureError> {
    let (drawn, notes) = drawn(shown.into(), drawing)?;
    let (about, svg) = (&drawn.about, &drawn.svg);
    let (name, dpi) = (&drawing.name, style::SCREEN_DPI);
    let figure = Figure { name, about, svg, data: None, keeps_text: false, origin: None, dpi };
    let (png, width_mm) = figure.raster()?;
    Ok(Picture { png, width_mm, about: drawn.about, notes })
}

/// The drawing, and what it leaves out or takes for something else.
fn drawn(shown: Shown<'_>, drawing: &Drawing) -> Result<(Drawn, Vec<String>), FigureError> {
    let own = ByQuantities::of(shown, drawing)?;
    let (shown, drawing) = match &own {
        Some(own) => (own.shown(shown), own.drawing()),
        None => (shown, drawing),
    };
    let view = View::new(shown, drawing)?;
    if !drawing.kind.suits(drawing.of.len(), view.model()) {
        return Err(view.unfit(drawing.kind.needs_outputs(view.model())));
    }
    check_request(&view)?;
    let drawn = (registry::kind(drawing.kind).draw)(&view)?;
    if let Some(fault) = view.fault_of_settings() {
        return Err(fault);
    }
    if let Some(why) = drawn.unfit {
        return Err(view.unfit(why));
    }
    let figure = drawing.name.clone();
    if let Some((character, label)) = drawn.missing {
        return Err(FigureError::Glyph { figure, character, label });
    }
    if let Some(why) = drawn.fault {
        return Err(FigureError::Render { figure, why });
    }
    let of_colours = match view.drawing.colours.is_empty() {
        true => Vec::new(),
        false => Colours::of(&view)?.notes(&view.drawing.colours),
    };
    let notes = [view.taken_for_another(), drawn.notes.clone(), view.notes_of_settings()];
    let notes = [notes.concat(), of_colours].concat();
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
    check_words(view)?;
    check_keys(view)?;
    check_others(view)?;
    check_sizes(view)
}

/// Checks the words that are written in TeX.
fn check_words(view: &View<'_>) -> Result<(), FigureError> {
    let drawing = view.drawing;
    let labels = drawing.settings.values().filter_map(|it| it.label.as_ref());
    let words = drawing.title.iter().chain(drawing.texts.keys()).chain(labels);
    match words.into_iter().find_map(|it| Text::tex_fault(it)) {
        Some(fault) => Err(view.unfit(fault)),
        None => Ok(()),
    }
}

/// Checks that keys do not ask for more than the kind of figure has.
fn check_keys(view: &View<'_>) -> Result<(), FigureError> {
    let (drawing, kind) = (view.drawing, view.drawing.kind);
    let keys = kind.keys();
    if drawing.of.len() > keys.most && keys.most > 0 {
        let (kind, of) = (kind.name(), drawing.of.join(", "));
        let most = if keys.most == 1 { "one".to_owned() } else { keys.most.to_string() };
        return Err(view.unfit(format!("a {kind} shows {most} at most, and `of` names {of}")));
    }
    if drawing.colour_by.is_some() && !keys.coloured {
        return Err(view.unfit(format!("`colour_by` does not go with a {}", kind.name())));
    }
    if !drawing.colours.is_empty() && !keys.attractors {
        return Err(view.unfit(format!("`colours` does not go with a {}", kind.name())));
    }
    if drawing.budget.is_some() && kind != DrawingKind::TradeOff {
        return Err(
            view.unfit(format!("`budget` goes with a trade-off, not with a {}", kind.name()))
        );
    }
    if let Some(mark) = drawing.hide.iter().find(|mark| !keys.marks.contains(&mark.as_str())) {
        let marks = keys.marks.join(", ");
        let why = format!("`hide`: a {} has no mark {mark} (it has: {marks})", kind.name());
        return Err(view.unfit(why));
    }
    Ok(())
}

/// Checks what goes with one kind of figure only, and that a refined grid is shown by one that tells what is inferred.
fn check_others(view: &View<'_>) -> Result<(), FigureError> {
    let (drawing, kind) = (view.drawing, view.drawing.kind);
    if view.measured.is_some() && kind != DrawingKind::Bifurcation {
        return Err(view.unfit("measured points stand over a bifurcation diagram"));
    }
    if drawing.curves && kind != DrawingKind::Map {
        return Err(view.unfit("`curves` lie over a map"));
    }
    if drawing.sweep == Some(Sweep::Difference) && kind != DrawingKind::Map {
        return Err(view.unfit("only a map shows the difference of two sweeps"));
    }
    let shows_all = kind == DrawingKind::Bifurcation || kind.keys().between;
    if shows_all && inferred::has_inferred(view) {
        let why = "shows computed cases, and most of a refined grid are inferred; draw a map";
        return Err(view.unfit(format!("a {} {why}, or compute all", kind.name())));
    }
    Ok(())
}

/// Checks the sizes that are set.
fn check_sizes(view: &View<'_>) -> Result<(), FigureError> {
    let drawing = view.drawing;
    let sizes = [
        ("width", drawing.width_mm, Size::Width),
        ("height", drawing.height_mm, Size::Height),
        ("marker_size", drawing.marker_mm, Size::Marker),
        ("dpi", drawing.dpi, Size::Resolution),
    ];
    for (key, value, size) in sizes {
        let checked = value.map_or(Ok(()), |value| size.check(value));
        checked.map_err(|fault| view.unfit(format!("`{key}`: {fault}")))?;
    }
    Ok(())
}
