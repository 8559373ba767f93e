//! One output over two axes, in colours.

use plotters::style::RGBColor;

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::category::{self, Kinds};
use super::cells::Cells;
use super::colour::Colours;
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::raster::Raster;
use super::style::{FRAME_WIDTH, INFINITE, INK, ONE_COLUMN};
use super::text::Text;
use super::view::View;
use crate::capsule::Output;
use crate::store::catalogue::{self, Entry, PERIOD, Type};
use crate::study::Drawing;

/// The output shown, unless another is asked for.
const OUTPUT: Entry = Entry::of_output(Output::ProgressionSpeed);
/// Length of the mark of a value of an uneven axis [pt].
const VALUE_MARK: f64 = 3.0;
/// Height of the frame [pt].
const HEIGHT: f64 = 158.0;

/// How the cells are coloured.
enum Paint {
    Numbers(Option<Colours>, Vec<f64>),
    Kinds(Kinds),
}

impl Paint {
    /// The colour of a case; none where it has no value.
    fn colour(&self, case: usize) -> Option<RGBColor> {
        match self {
            Paint::Numbers(_, values) if values[case].is_infinite() => Some(INFINITE),
            Paint::Numbers(_, values) if values[case].is_nan() => None,
            Paint::Numbers(colours, values) => colours.as_ref().map(|it| it.of(values[case])),
            Paint::Kinds(kinds) => kinds.colour(case),
        }
    }

    /// Room beside the frame for the bar or the list of kinds [pt].
    fn room(&self) -> f64 {
        match self {
            Paint::Numbers(colours, _) => colours.as_ref().map_or(0.0, |it| it.room(HEIGHT)),
            Paint::Kinds(kinds) => kinds.room(),
        }
    }

    /// Draws the bar or the list of kinds beside `panel`.
    fn explain(&self, canvas: &mut Canvas, panel: &Panel) {
        match self {
            Paint::Numbers(Some(colours), _) => colours.draw_bar(canvas, panel.frame),
            Paint::Numbers(None, _) => {}
            Paint::Kinds(kinds) => kinds.draw_legend(canvas, panel.frame),
        }
    }

    /// The entries that the colour bar does not explain.
    fn legend(&self) -> Vec<(Mark, Text)> {
        let Paint::Numbers(_, values) = self else { return Vec::new() };
        let mut legend = Vec::new();
        if values.iter().any(|value| value.is_infinite()) {
            legend.push((Mark::Patch(INFINITE), Text::plain("infinite")));
        }
        if values.iter().any(|value| value.is_nan()) {
            legend.push((Mark::Hatched, Text::plain("no value")));
        }
        legend
    }
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a map reads: its output, the outcomes, and what sorts cases where it shows kinds of them.
fn reads(drawing: &Drawing) -> Names {
    let output = drawing.of.first().map_or(OUTPUT.name, String::as_str);
    let entry = catalogue::named(output);
    let sorted = entry.is_none_or(|entry| !matches!(entry.numbers, Type::Real));
    let sorting = category::READS.into_iter().filter(|_| sorted);
    Names::of(outcome::READS).and(sorting).and_named([output.to_owned()])
}

/// Draws the map that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let (x_name, y_name) = axes(view)?;
    let output = view.drawing.of.first().cloned().unwrap_or_else(|| OUTPUT.name.to_owned());
    let (x, y) = (cells(view, x_name)?, cells(view, y_name)?);
    let paint = paint(view, &output, &[y_name, x_name], x.count() * y.count())?;
    let panel = PanelRequest {
        x: AxisRequest::new(view.quantity(x_name), x.scale),
        y: AxisRequest::new(view.quantity(y_name), y.scale),
        header: Header {
            note: view.held_note(&[x_name, y_name]),
            legend: legend(&paint, &x, &y),
            ..Header::default()
        },
    };
    let page = PageRequest {
        title: view.drawing.title.clone(),
        width_mm: view.drawing.width_mm.unwrap_or(ONE_COLUMN),
        heights: vec![HEIGHT],
        rows: vec![vec![panel]],
        right_room: paint.room(),
        pointing: Pointing::Outward,
    };
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        canvas.image(panel.frame, &raster(panel, &x, &y, &paint));
        mark_values(&mut canvas, panel, &x.uneven, &y.uneven);
        panel.finish(&mut canvas);
        paint.explain(&mut canvas, panel);
    }
    Ok(canvas.finish(&view.about(&[output], &[x_name, y_name])))
}

/// What the colour bar does not explain, and what marks mean.
fn legend(paint: &Paint, x: &Cells, y: &Cells) -> Vec<(Mark, Text)> {
    let mut legend = paint.legend();
    if !x.uneven.is_empty() || !y.uneven.is_empty() {
        legend.push((Mark::Nothing, Text::plain("marks outside the frame: computed values")));
    }
    legend
}

/// Marks the values of uneven axes at the upper and the right side of the frame.
fn mark_values(canvas: &mut Canvas, panel: &Panel, x: &[f64], y: &[f64]) {
    let up = |&value: &f64| {
        let (place, top) = panel.place(value, panel.y.scale.high);
        ((place, top), (place, top - VALUE_MARK))
    };
    let right = |&value: &f64| {
        let (right, place) = panel.place(panel.x.scale.high, value);
        ((right, place), (right + VALUE_MARK, place))
    };
    let marks: Vec<_> = x.iter().map(up).chain(y.iter().map(right)).collect();
    canvas.segments(&marks, Stroke::solid(INK, FRAME_WIDTH));
}

/// The cells along the axis called `name`.
fn cells(view: &View<'_>, name: &str) -> Result<Cells, FigureError> {
    let factor = view.quantity(name).factor;
    let values: Vec<f64> = view.axis_values(name)?.iter().map(|value| value * factor).collect();
    match values.is_empty() {
        true => Err(view.unfit(format!("axis `{name}` has no values"))),
        false => Ok(Cells::around(&values)),
    }
}

/// The axes along the abscissa and the ordinate.
fn axes<'a>(view: &View<'a>) -> Result<(&'a str, &'a str), FigureError> {
    let free = view.drawable_axes();
    let named = |name: &Option<String>| {
        name.as_ref().and_then(|name| view.axes().into_iter().find(|axis| axis == name))
    };
    let (x, y) = (named(&view.drawing.x), named(&view.drawing.y));
    let x = x.or_else(|| free.iter().copied().find(|name| Some(*name) != y));
    let y = y.or_else(|| free.iter().copied().find(|name| Some(*name) != x));
    match (x, y) {
        (Some(x), Some(y)) if x != y => Ok((x, y)),
        (Some(x), Some(_)) => Err(view.unfit(format!("`{x}` cannot be both axes of a map"))),
        _ => Err(view.unfit(format!(
            "a map needs two axes that `at` does not hold, and there is {}",
            if free.is_empty() { "none".to_string() } else { format!("only {}", free.join(", ")) }
        ))),
    }
}

fn paint(view: &View<'_>, output: &str, free: &[&str], cases: usize) -> Result<Paint, FigureError> {
    let mut values: Vec<f64> = view.shown(output, free)?.into_iter().collect();
    if values.len() != cases {
        let why = format!("`{output}` has several values per case, and a map shows one");
        return Err(view.unfit(why));
    }
    if output == PERIOD.name || !view.flags(output).is_empty() {
        return Ok(Paint::Kinds(Kinds::of(view, output, free)?));
    }
    let outcomes = Outcomes::over(view, free)?;
    for (case, value) in values.iter_mut().enumerate() {
        if outcomes.failed(case) {
            *value = f64::NAN;
        }
    }
    Ok(Paint::Numbers(Colours::for_values(&values, view.quantity(output)), values))
}

/// The cells of the map as pixels over the panel.
fn raster(panel: &Panel, x: &Cells, y: &Cells, paint: &Paint) -> Raster {
    let columns = x.count();
    Raster::cells(
        panel.frame,
        |share| x.at(share),
        |share| y.at(1.0 - share),
        |column, row| paint.colour(row * columns + column),
    )
}
