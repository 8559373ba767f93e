//! The page of a diagram over one axis: a row for each output, as far as cases and branches reach.

use super::axis::AxisRequest;
use super::branch_lines::BranchLines;
use super::canvas::Canvas;
use super::cloud::Dot;
use super::data::Value;
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{Header, Mark};
use super::measured::MeasuredPoints;
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::paint::Paint;
use super::panel::{Panel, Pointing};
use super::scale::{Scale, Spacing, finite_range};
use super::style::{ONE_COLUMN, UNDECIDED_DOT};
use super::symbol::Symbol;
use super::text::Text;
use super::view::View;
use crate::store::catalogue::{ATTRACTOR, Place};

/// Height of the frames of section coordinates [pt].
const SECTION_HEIGHT: f64 = 125.0;
/// Height of the frames of outputs with one value per case [pt].
const OUTPUT_HEIGHT: f64 = 80.0;

/// A symbol with its place, in the units of the axes.
pub type Placed = (Symbol, f64, f64);

/// What a diagram shows, by output.
pub struct Shown<'a> {
    /// The points, by sort.
    pub clouds: &'a [Vec<Vec<Dot>>],
    /// The lines of branches.
    pub lines: &'a [BranchLines],
    /// The symbols of events; empty where there are none.
    pub symbols: &'a [Vec<Placed>],
    /// The measured points.
    pub measured: &'a MeasuredPoints,
}

/// The abscissa, with room for points that stand at its ends, and as far as orbits were continued.
pub fn span(values: &[f64], reached: &[f64]) -> Scale {
    let axis = Scale::of_axis(values);
    let plain = match finite_range(reached.iter().copied()) {
        Some((low, high)) if values.is_empty() => Scale::around([low, high], 0.02),
        Some((low, high)) => Scale { low: axis.low.min(low), high: axis.high.max(high), ..axis },
        None => axis,
    };
    if values.is_empty() {
        return plain;
    }
    if values.len() > 60 {
        return plain;
    }
    match plain.spacing {
        Spacing::Linear => Scale::around([plain.low, plain.high], 0.02),
        Spacing::Log => Scale::log_around([plain.low, plain.high], 0.02),
        Spacing::Symmetric(_) => plain,
    }
}

/// Whether an output has several values per case.
pub fn has_points(view: &View<'_>, output: &str) -> bool {
    let axes = view.axes();
    let is_inner = |name: &String| !axes.contains(&name.as_str());
    let stored = view.dataset.variable(output);
    let stored = stored.filter(|variable| variable.dimensions.iter().any(is_inner));
    let stored_on_branch = view.dataset.variable(&Place::Branch.name(output));
    stored.is_some() || stored_on_branch.is_some_and(|variable| variable.dimensions.len() > 1)
}

/// The page with a row for each output.
pub fn request<'a>(
    view: &View<'a>,
    outputs: &[String],
    shown: &Shown<'_>,
    abscissa: AxisRequest,
    header: Option<Text>,
) -> PageRequest<'a> {
    let Shown { clouds, lines, symbols, measured } = *shown;
    let mut rows = Vec::new();
    let mut heights = Vec::new();
    for (index, (output, cloud)) in outputs.iter().zip(clouds).enumerate() {
        let dots = cloud.iter().flatten().map(|dot| dot.at.1);
        let of_symbols = symbols.get(index).into_iter().flatten().map(|it| it.2);
        let values: Vec<f64> = dots
            .chain(lines[index].places().map(|at| at.1))
            .chain(of_symbols)
            .chain(measured.ordinates(index))
            .collect();
        let y = AxisRequest::around(view.quantity(output), &values, 0.06);
        let last = index + 1 == outputs.len();
        let x = AxisRequest { labelled: last, numbered: last, ..abscissa.clone() };
        let note = header.clone().filter(|_| index == 0);
        let header = Header { letter: letter(index, outputs.len()), note, legend: Vec::new() };
        rows.push(vec![PanelRequest { x, y, header }]);
        heights.push(if has_points(view, output) { SECTION_HEIGHT } else { OUTPUT_HEIGHT });
    }
    PageRequest {
        drawing: view.drawing,
        width_mm: ONE_COLUMN,
        heights,
        rows,
        column_room: NO_ROOM,
        right_room: NO_ROOM,
        bottom_room: 0.0,
        pointing: Pointing::Inward,
    }
}

/// The rows with what the lines of branches and their symbols mean in the first legend.
pub fn with_branch_lines(
    mut rows: Vec<Vec<PanelRequest>>,
    clouds: &[Vec<Vec<Dot>>],
    lines: &[BranchLines],
) -> Vec<Vec<PanelRequest>> {
    let entries = lines.iter().map(BranchLines::legend).max_by_key(Vec::len).unwrap_or_default();
    let first = rows.first_mut().and_then(|row| row.first_mut());
    let Some(first) = first.filter(|_| !entries.is_empty()) else { return rows };
    let legend = &mut first.header.legend;
    let dots = clouds.iter().flatten().flatten().next();
    if let (true, Some(dot)) = (legend.is_empty(), dots) {
        legend.push((Mark::Disc(dot.colour, 1.3), Text::plain("settled")));
    }
    // What the sweep and the branches both have is named once.
    let known: Vec<Mark> = legend.iter().map(|(mark, _)| *mark).collect();
    legend.extend(entries.into_iter().filter(|(mark, _)| !known.contains(mark)));
    rows
}

/// The colours of the cases over the axes `free`, where the request names what tells them; attractors have colours of their own.
pub fn paint(view: &View<'_>, free: &[&str], values: usize) -> Result<Option<Paint>, FigureError> {
    let by = view.drawing.colour_by.as_deref().filter(|by| *by != ATTRACTOR.name && values > 0);
    let Some(by) = by else { return Ok(None) };
    let lengths = free.iter().map(|axis| view.coordinate_values(axis).len());
    let cases = lengths.product();
    Paint::of((view, std::slice::from_ref(view)), by, (free, cases)).map(Some)
}

/// Which cases lie within the limits of the abscissa, of which each of its `values` has so many.
pub fn seen(
    abscissa: &AxisRequest,
    values: &[f64],
    per_value: usize,
) -> impl Fn(usize) -> bool + use<> {
    let within: Vec<bool> = values.iter().map(|x| abscissa.scale.holds(*x)).collect();
    move |case| within.get(case / per_value.max(1)).copied().unwrap_or(false)
}

/// A note where no case and no orbit lies within the limits of the abscissa.
pub fn nothing_within(abscissa: &AxisRequest, values: &[f64], reached: &[f64]) -> Option<String> {
    let mut all = values.iter().chain(reached).peekable();
    let is_any = all.peek().is_some();
    let is_empty = is_any && !all.any(|x| abscissa.scale.holds(*x));
    is_empty.then(|| format!("no case lies within the limits of {}", abscissa.quantity.key))
}

/// The points of a diagram with what their colours tell, for the data behind it.
pub fn told<'a>(
    dots: &'a [Dot],
    paint: Option<&'a Paint>,
) -> impl Iterator<Item = ((f64, f64), Value)> + 'a {
    dots.iter().map(move |dot| (dot.at, paint.map_or(Value::None, |it| it.value(dot.case))))
}

/// The rows with what colours do not explain in the first legend.
pub fn with_paint(
    mut rows: Vec<Vec<PanelRequest>>,
    (paint, is_seen): (Option<&Paint>, &dyn Fn(usize) -> bool),
) -> Vec<Vec<PanelRequest>> {
    let first = rows.first_mut().and_then(|row| row.first_mut());
    if let (Some(first), Some(paint)) = (first, paint) {
        let mark = |(mark, words): (Mark, Text)| match mark {
            Mark::Filled(_) => (Mark::Disc(UNDECIDED_DOT, 1.6), words),
            mark => (mark, words),
        };
        first.header.legend.extend(paint.legend(is_seen).into_iter().map(mark));
    }
    rows
}

/// Draws the bar or the list that explains the colours beside all panels.
pub fn explain(canvas: &mut Canvas, panels: &[Vec<Panel>], paint: Option<&Paint>) {
    let all = || panels.iter().flatten();
    if let (Some(first), Some(last), Some(paint)) = (all().next(), all().last(), paint) {
        paint.explain(canvas, Rect { bottom: last.frame.bottom, ..first.frame });
    }
}
