//! Curves and points over two axes, as an identification or a comparison has them: figures that come from no file of results.

use plotters::style::RGBColor;

use super::FigureError;
use super::Files;
use super::axis::AxisRequest;
use super::canvas::Stroke;
use super::header::{Header, Mark};
use super::origin::Origin;
use super::output::{Figure, Place};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::panel::{Panel, Pointing};
use super::quantity::Quantity;
use super::style::{
    BLUE, CURVE_WIDTH, DPI, FAINT_INK, GREEN, ONE_COLUMN, REFERENCE_WIDTH, TWO_COLUMNS, VERMILION,
};
use super::text::Text;
use crate::study::{Drawing, DrawingKind};

/// Radius of points [pt].
const RADIUS: f64 = 1.5;
/// Points that are drawn smaller where there are more than this many.
const MANY: usize = 400;

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// What was measured: blue points.
    Measured,
    /// A signal that was measured: a blue curve.
    Record,
    /// What a model gives: a vermilion curve.
    Model,
    /// A simulated signal over a recorded one: a dashed vermilion curve, through which the other is seen.
    Simulated,
    /// What another model gives: a dashed green curve.
    Other,
    /// A level to compare with: a thin grey line.
    Reference,
}

impl Look {
    fn colour(self) -> RGBColor {
        match self {
            Look::Measured | Look::Record => BLUE,
            Look::Model | Look::Simulated => VERMILION,
            Look::Other => GREEN,
            Look::Reference => FAINT_INK,
        }
    }

    fn stroke(self) -> Stroke {
        match self {
            Look::Record => Stroke::solid(self.colour(), 1.4 * CURVE_WIDTH),
            Look::Other | Look::Simulated => Stroke::dashed(self.colour(), CURVE_WIDTH),
            Look::Reference => Stroke::solid(self.colour(), REFERENCE_WIDTH),
            _ => Stroke::solid(self.colour(), CURVE_WIDTH),
        }
    }

    fn mark(self) -> Mark {
        match self {
            Look::Measured => Mark::Disc(self.colour(), RADIUS),
            _ => Mark::Line(self.stroke()),
        }
    }
}

/// Points of a plot that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What it is, for the legend.
    pub label: String,
    /// How it is drawn.
    pub look: Look,
    /// Its points, in the units of the axes.
    pub points: Vec<(f64, f64)>,
}

/// A panel of a plot.
#[derive(Debug, Clone, PartialEq)]
pub struct PlotPanel {
    /// The label of the abscissa with its unit, as "Time (s)".
    pub x: String,
    /// The label of the ordinate with its unit.
    pub y: String,
    /// What is drawn, the last on top.
    pub series: Vec<Series>,
    /// A note above the panel; empty for none.
    pub note: String,
}

/// A figure of panels.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    /// Its name, the stem of its files.
    pub name: String,
    /// What it shows, in a sentence.
    pub about: String,
    /// Its panels, row by row.
    pub rows: Vec<Vec<PlotPanel>>,
    /// Height of a frame [pt].
    pub height: f64,
}

/// Draws `plot` and writes it to its place in each format, with the data as CSV.
pub fn draw_plot(plot: &Plot, place: &Place<'_>) -> Result<Files, FigureError> {
    // Only the size and what is common to all kinds is read of it.
    let drawing = Drawing { data: true, ..Drawing::new(plot.name.as_str(), DrawingKind::History) };
    let (mut canvas, panels) = page(plot, &drawing).lay_out();
    for (panel, asked) in panels.iter().flatten().zip(plot.rows.iter().flatten()) {
        for series in &asked.series {
            draw_series(&mut canvas, panel, series);
        }
        panel.finish(&mut canvas);
    }
    let drawn = canvas.finish(&plot.about);
    let figure = plot.name.clone();
    if let Some((character, label)) = drawn.missing {
        return Err(FigureError::Glyph { figure, character, label });
    }
    if let Some(why) = drawn.fault {
        return Err(FigureError::Render { figure, why });
    }
    let written = Figure {
        name: &plot.name,
        about: &drawn.about,
        svg: &drawn.svg,
        data: drawn.data.map(|data| data.text(&drawn.about)),
        keeps_text: false,
        origin: Some(&Origin::of_recordings()),
        dpi: DPI,
    };
    Ok(Files { paths: written.write(place)?, notes: drawn.notes })
}

fn page<'d>(plot: &Plot, drawing: &'d Drawing) -> PageRequest<'d> {
    let count = plot.rows.iter().map(Vec::len).sum();
    let mut rows = Vec::new();
    let mut index = 0;
    for panels in &plot.rows {
        let row = panels.iter().zip(index..);
        rows.push(row.map(|(panel, index)| panel_request(panel, letter(index, count))).collect());
        index += panels.len();
    }
    let is_wide = plot.rows.iter().any(|row| row.len() > 1);
    PageRequest {
        drawing,
        width_mm: if is_wide { TWO_COLUMNS } else { ONE_COLUMN },
        heights: vec![plot.height; rows.len()],
        rows,
        column_room: NO_ROOM,
        right_room: NO_ROOM,
        bottom_room: 0.0,
        pointing: Pointing::Inward,
    }
}

fn panel_request(panel: &PlotPanel, letter: Option<char>) -> PanelRequest {
    let points = panel.series.iter().flat_map(|it| it.points.iter().copied());
    let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
    let is_motion = panel.series.iter().all(|it| it.look != Look::Measured);
    let legend = panel.series.iter().filter(|it| !it.label.is_empty());
    PanelRequest {
        x: AxisRequest::around(
            Quantity::labelled(&panel.x),
            &x,
            if is_motion { 0.0 } else { 0.05 },
        ),
        y: AxisRequest::around(Quantity::labelled(&panel.y), &y, 0.06),
        header: Header {
            letter,
            note: (!panel.note.is_empty()).then(|| Text::tex(&panel.note)),
            legend: legend.map(|it| (it.look.mark(), Text::tex(&it.label))).collect(),
        },
    }
}

fn draw_series(canvas: &mut super::canvas::Canvas, panel: &Panel, series: &Series) {
    match series.look {
        Look::Measured => {
            let radius = if series.points.len() > MANY { 0.5 * RADIUS } else { RADIUS };
            let colour = series.look.colour();
            let discs: Vec<_> =
                panel.places(&series.points).into_iter().map(|at| (at, colour)).collect();
            canvas.discs(&discs, radius);
        }
        _ => panel.curve(canvas, &series.points, series.look.stroke()),
    }
    let drawn = series.points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite());
    panel.record(canvas, &series.label, drawn);
}
