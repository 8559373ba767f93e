//! The page of a diagram over one axis: a row for each output, as far as cases and branches reach.

use super::axis::AxisRequest;
use super::branch_lines::BranchLines;
use super::canvas::{Canvas, Drawn};
use super::cloud;
use super::diagram_contents::{Cases, Contents};
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{self, Header, Mark};
use super::outcome::{Outcomes, told_of_missing};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::paint::Paint;
use super::panel::{Panel, Pointing};
use super::scale::{Scale, Spacing, finite_range};
use super::style::{ONE_COLUMN, UNDECIDED_DOT};
use super::text::Text;
use super::thinned::{Thinned, with_told};
use super::track::elsewhere;
use super::view::View;
use super::without_period::WithoutPeriod;
use crate::store::catalogue::{ATTRACTOR, Place};
use crate::study::Drawing;

/// Height of the frames of section coordinates [pt].
const SECTION_HEIGHT: f64 = 125.0;
/// Height of the frames of outputs with one value per case [pt].
const OUTPUT_HEIGHT: f64 = 80.0;

/// How the points of a sort are drawn.
pub struct Sort {
    /// What they are, in the data behind the figure.
    pub name: String,
    /// Their radius, relative to the usual one.
    pub size: f64,
}

/// How the points are drawn.
pub struct PointStyle {
    /// The sorts, in the order in which they are drawn.
    pub sorts: Vec<Sort>,
    /// By what factor they are larger on a panel with lines of branches.
    pub beside_lines: f64,
}

/// A diagram with its abscissa.
pub struct Diagram<'a> {
    /// What it shows.
    pub contents: Contents<'a>,
    /// Its abscissa.
    pub abscissa: AxisRequest,
    /// Whether each value of the abscissa lies within its limits.
    within: Vec<bool>,
    /// What lies elsewhere, in words.
    left_out: Option<String>,
    /// The cases that have no period.
    without_period: WithoutPeriod,
    /// How many cases are not computed yet, in words.
    not_yet: Option<String>,
}

impl<'a> Diagram<'a> {
    /// The diagram of all that is found; kinds of which no case is seen are not listed.
    ///
    /// Fails where a period is shown and the outcomes cannot be read.
    pub fn of(view: &View<'_>, contents: Contents<'a>) -> Result<Diagram<'a>, FigureError> {
        let Cases { axis, ref values, .. } = contents.cases;
        let reached = contents.reached();
        let abscissa = AxisRequest::new(view.quantity(axis), span(values, &reached));
        let within = values.iter().map(|x| abscissa.scale.holds(*x)).collect();
        let nothing = nothing_within(&abscissa, values, &reached);
        let left_out = elsewhere(view, &[axis]).or(nothing);
        let without_period = WithoutPeriod::default();
        let mut diagram =
            Diagram { contents, abscissa, within, left_out, without_period, not_yet: None };
        if let Some(mut paint) = diagram.contents.paint.take() {
            paint.list(|case| diagram.is_seen(case));
            diagram.contents.paint = Some(paint);
        }
        let Contents { cases, outputs, .. } = &diagram.contents;
        diagram.not_yet = diagram.told_of_missing(&Outcomes::over(view, &cases.free)?);
        let abscissae = (0..cases.count())
            .map(|case| diagram.is_seen(case).then(|| cases.values[case / cases.per_value]));
        diagram.without_period = WithoutPeriod::of(view, &cases.free, outputs, abscissae)?;
        Ok(diagram)
    }

    /// What lies elsewhere, in words.
    pub fn left_out(&self) -> Option<&str> {
        self.left_out.as_deref()
    }

    /// Whether a case lies within the limits of the abscissa.
    pub fn is_seen(&self, case: usize) -> bool {
        let value = case / self.contents.cases.per_value.max(1);
        self.within.get(value).copied().unwrap_or(false)
    }

    /// How many of the cases that are seen are not computed yet, in words.
    fn told_of_missing(&self, outcomes: &Outcomes<'_>) -> Option<String> {
        let seen = (0..self.contents.cases.count()).filter(|case| self.is_seen(*case));
        let missing = seen.clone().filter(|case| outcomes.missing(*case)).count();
        told_of_missing(missing, seen.count())
    }

    /// Draws the diagram with a `legend` of its points; what lies `below` all else is drawn first, for each output.
    pub fn draw(
        &self,
        view: &View<'_>,
        style: &PointStyle,
        legend: Vec<header::Entry>,
        below: impl Fn(&mut Canvas, &Panel, &str),
    ) -> Drawn {
        let Contents { cases, outputs, lines, paint, measured, .. } = &self.contents;
        let legend = self.with_others(legend);
        // Which symbols would overlap is known once the panels have their places; what is said of them stands beside the panels.
        let rows = self.rows(view);
        let (_, panels) = self.laid_out(view, rows.clone(), legend.clone());
        let thinned = self.thinned(&panels);
        let (mut canvas, panels) = self.laid_out(view, rows, with_told(legend, &thinned));
        for (index, panel) in panels.iter().flatten().enumerate() {
            below(&mut canvas, panel, &outputs[index]);
            self.draw_points(&mut canvas, panel, index, view.drawing, style);
            self.contents.ramps.draw(&mut canvas, panel, index, view);
            lines[index].draw(&mut canvas, panel);
            thinned[index].draw(&mut canvas, panel);
            measured.draw(&mut canvas, panel, index);
            self.without_period.draw(&mut canvas, panel, &outputs[index]);
            panel.finish(&mut canvas);
        }
        explain(&mut canvas, &panels, paint.as_ref());
        let outside = measured.left_out(&panels);
        let about = view.about(outputs, &cases.free);
        canvas.finish(&about).noting(self.left_out.clone()).noting(outside)
    }

    /// The page of these rows with a `legend`, and its panels in their places.
    fn laid_out(
        &self,
        view: &View<'_>,
        rows: Vec<PanelRequest>,
        legend: Vec<header::Entry>,
    ) -> (Canvas, Vec<Vec<Panel>>) {
        let paint = self.contents.paint.as_ref();
        let page = PageRequest {
            right_room: &|height| paint.map_or(0.0, |it| it.room(height)),
            ..self.request(view, rows, legend)
        };
        page.lay_out()
    }

    /// The symbols of each panel that are drawn.
    fn thinned(&self, panels: &[Vec<Panel>]) -> Vec<Thinned> {
        let Contents { lines, symbols, .. } = &self.contents;
        let mut thinned = Vec::new();
        for (index, panel) in panels.iter().flatten().enumerate() {
            let of_events = symbols.get(index).into_iter().flatten().copied();
            thinned.push(Thinned::of(panel, of_events.chain(lines[index].specials())));
        }
        thinned
    }

    /// Draws the points of a panel.
    fn draw_points(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        index: usize,
        drawing: &Drawing,
        style: &PointStyle,
    ) {
        let Contents { clouds, lines, .. } = &self.contents;
        let cloud = &clouds[index];
        let wider = if lines[index].is_empty() { 1.0 } else { style.beside_lines };
        let radius = wider * cloud::radius(drawing, cloud::count(panel, cloud));
        for (dots, sort) in cloud.iter().zip(&style.sorts) {
            cloud::draw(canvas, panel, dots, radius * sort.size);
            let told = dots.iter().map(|dot| (dot.at, self.contents.value(dot.case)));
            panel.record_values(canvas, &sort.name, told);
        }
    }

    /// A row for each output. To ask for an axis counts what has no place on it, so that this is done once.
    fn rows(&self, view: &View<'_>) -> Vec<PanelRequest> {
        let outputs = &self.contents.outputs;
        let mut rows = Vec::new();
        for (index, output) in outputs.iter().enumerate() {
            let ordinates = self.contents.ordinates(index);
            let y = AxisRequest::around(view.quantity(output), &ordinates, 0.06);
            let last = index + 1 == outputs.len();
            let x = AxisRequest { labelled: last, numbered: last, ..self.abscissa.clone() };
            let letter = letter(index, outputs.len());
            rows.push(PanelRequest { x, y, header: Header { letter, ..Header::default() } });
        }
        rows
    }

    /// The page of these rows, with the legend above the first.
    fn request<'d>(
        &self,
        view: &View<'d>,
        mut rows: Vec<PanelRequest>,
        legend: Vec<header::Entry>,
    ) -> PageRequest<'d> {
        let Contents { cases, outputs, .. } = &self.contents;
        let note = view.note(&cases.free, &self.left_out);
        if let Some(first) = rows.first_mut() {
            first.header.note = note;
            first.header.legend = legend;
        }
        let heights = outputs.iter().map(|output| match has_points(view, output) {
            true => SECTION_HEIGHT,
            false => OUTPUT_HEIGHT,
        });
        PageRequest {
            drawing: view.drawing,
            width_mm: ONE_COLUMN,
            heights: heights.collect(),
            rows: rows.into_iter().map(|row| vec![row]).collect(),
            column_room: NO_ROOM,
            right_room: NO_ROOM,
            bottom_room: 0.0,
            pointing: Pointing::Inward,
        }
    }

    /// The legend of the points with what the lines of branches, the colours and the measured points mean.
    fn with_others(&self, mut legend: Vec<header::Entry>) -> Vec<header::Entry> {
        let Contents { clouds, lines, paint, measured, .. } = &self.contents;
        let first = clouds.iter().flatten().flatten().next();
        let of_lines = lines.iter().map(BranchLines::legend).max_by_key(Vec::len);
        let of_lines = of_lines.unwrap_or_default();
        // Where other marks are named, points are, too.
        let has_others = !of_lines.is_empty() || legend.iter().any(|it| it.0 != Mark::Nothing);
        let is_named = legend.iter().any(|(mark, _)| matches!(mark, Mark::Disc(..)));
        if let (true, false, true, Some(dot)) = (has_others, is_named, paint.is_none(), first) {
            legend.insert(0, (Mark::Disc(dot.colour, 1.3), Text::plain("settled motion")));
        }
        // What the sweep and the branches both have is named once.
        let known: Vec<Mark> = legend.iter().map(|(mark, _)| *mark).collect();
        legend.extend(of_lines.into_iter().filter(|(mark, _)| !known.contains(mark)));
        legend.extend(self.contents.ramps.legend());
        legend.extend(self.without_period.legend());
        // Colours tell it themselves.
        let not_yet = self.not_yet.iter().filter(|_| paint.is_none());
        legend.extend(not_yet.map(|it| (Mark::Nothing, Text::plain(it))));
        for (mark, words) in paint.iter().flat_map(|it| it.legend(|case| self.is_seen(case))) {
            let is_filled = matches!(mark, Mark::Filled(_));
            let mark = if is_filled { Mark::Disc(UNDECIDED_DOT, 1.6) } else { mark };
            legend.push((mark, words));
        }
        if !measured.is_empty() {
            if let (true, Some(dot)) = (legend.is_empty(), first) {
                legend.push((Mark::Disc(dot.colour, 1.3), Text::plain("simulated")));
            }
            legend.push(measured.legend());
        }
        legend
    }
}

/// The abscissa, with room for points that stand at its ends, and as far as orbits were continued.
fn span(values: &[f64], reached: &[f64]) -> Scale {
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
    let of_cases = view.dataset.variable(output).is_some_and(|variable| {
        variable.dimensions.iter().any(|name| !axes.contains(&name.as_str()))
    });
    let on_branches = view.dataset.variable(&Place::Branch.name(output));
    of_cases || on_branches.is_some_and(|variable| variable.dimensions.len() > 1)
}

/// The colours of the cases, where the request names what tells them; attractors have colours of their own.
pub fn paint(view: &View<'_>, cases: &Cases<'_>) -> Result<Option<Paint>, FigureError> {
    let by = view.drawing.colour_by.as_deref();
    let by = by.filter(|by| *by != ATTRACTOR.name && !cases.values.is_empty());
    let Some(by) = by else { return Ok(None) };
    let lengths = cases.free.iter().map(|axis| view.coordinate_values(axis).len());
    let count = lengths.product();
    Paint::of(view, std::slice::from_ref(view), by, &cases.free, &vec![true; count]).map(Some)
}

/// A note where no case and no orbit lies within the limits of the abscissa.
fn nothing_within(abscissa: &AxisRequest, values: &[f64], reached: &[f64]) -> Option<String> {
    let mut all = values.iter().chain(reached).peekable();
    let is_any = all.peek().is_some();
    let is_empty = is_any && !all.any(|x| abscissa.scale.holds(*x));
    is_empty.then(|| format!("no case lies within the limits of {}", abscissa.quantity.key))
}

/// Draws the bar or the list that explains the colours beside all panels.
fn explain(canvas: &mut Canvas, panels: &[Vec<Panel>], paint: Option<&Paint>) {
    let mut all = panels.iter().flatten();
    if let (Some(first), Some(paint)) = (all.next(), paint) {
        let last = all.last().unwrap_or(first);
        paint.explain(canvas, Rect { bottom: last.frame.bottom, ..first.frame });
    }
}
