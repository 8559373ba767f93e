//! Displacements and velocities over time, as stacked panels or one panel per value of an axis.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Dash, Drawn, Stroke};
use super::case_panels::{CasePanel, case_panels};
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::motion::{Motion, ShownCycles, sources, sources_of_arcs};
use super::page::{PageRequest, PanelRequest, in_rows, letter};
use super::panel::Panel;
use super::scale::Scale;
use super::style::{BLUE, CURVE_WIDTH, FAINT_INK, REFERENCE_WIDTH, VERMILION};
use super::text::Text;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{Entry, TIME};
use crate::study::{Drawing, DrawingKind};

/// Height of a frame [pt].
const HEIGHT: f64 = 82.0;
/// The line at the gap between mass and stop.
const GAP_LINE: Stroke = Stroke { colour: FAINT_INK, width: REFERENCE_WIDTH, dash: Dash::Usual };

/// One curve of a panel.
struct Curve {
    /// The name of what it shows.
    variable: &'static str,
    /// Values over time.
    points: Vec<(f64, f64)>,
    /// Colour and width.
    stroke: Stroke,
}

/// One panel: a quantity of one case.
struct Cell {
    output: String,
    curves: Vec<Curve>,
    /// Where the stops are, if the panel shows the coordinate that meets them.
    stops: Vec<f64>,
}

/// What a figure of histories shows.
struct History<'a> {
    cases: Vec<CasePanel<'a>>,
    outputs: Vec<String>,
    /// The panels, output by output.
    cells: Vec<Cell>,
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a history reads: the variables of what it shows, and what time and stops follow from.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let usual = model.motion.panels.iter().copied().filter(|_| drawing.of.is_empty());
    let of = drawing.of.iter().map(String::as_str).chain(usual);
    let shown: Vec<&str> = of.flat_map(|name| variables(name, model)).collect();
    let constants = model.drive_frequency().into_iter().chain(model.surfaces().map(|(it, _)| it));
    let constants = constants.map(Entry::of_parameter);
    let sources: Vec<Entry> = shown.iter().flat_map(|name| sources(name, model)).collect();
    let shown = shown.into_iter().map(str::to_owned).collect::<Vec<_>>();
    Names::of(sources).and(sources_of_arcs(model)).and(constants).and_named(shown)
}

/// Draws the history that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let history = History::of(view)?;
    let page = PageRequest::of_rows(view.drawing, history.rows(view), HEIGHT);
    let (mut canvas, panels) = page.lay_out();
    for (panel, cell) in panels.iter().flatten().zip(&history.cells) {
        draw_cell(&mut canvas, panel, cell);
    }
    Ok(canvas.finish(&view.about(&history.outputs, &history.cases[0].free)))
}

impl<'a> History<'a> {
    /// What the figure shows of the results.
    fn of(view: &View<'a>) -> Result<History<'a>, FigureError> {
        let cases = case_panels(view)?;
        let usual = view.model().motion.panels;
        if usual.is_empty() {
            return Err(view.without_histories());
        }
        let shown = if cases.len() == 1 { usual } else { &usual[..1] };
        let outputs: Vec<String> = match view.drawing.of.is_empty() {
            false => view.drawing.of.clone(),
            true => shown.iter().map(|name| (*name).to_owned()).collect(),
        };
        let motions: Vec<Motion<'_, '_>> =
            cases.iter().map(|it| Motion::drawn(&it.view, &it.free, it.case)).collect();
        let mut cells = Vec::new();
        for output in &outputs {
            for motion in &motions {
                let curves = curves(view, motion, output)?;
                let stops = stops(view, motion, output);
                cells.push(Cell { output: output.clone(), curves, stops });
            }
        }
        Ok(History { cases, outputs, cells })
    }

    /// How many panels stand side by side: several quantities of one case stand below each other, several cases beside each other.
    fn columns(&self) -> usize {
        match (self.cases.len(), self.outputs.len()) {
            (1, _) => 1,
            (2 | 4, 1) => 2,
            (cases, 1) => cases.min(3),
            (cases, _) => cases.min(4),
        }
    }

    /// The panels in rows, those of each output in rows of their own.
    fn rows(&self, view: &View<'_>) -> Vec<Vec<PanelRequest>> {
        let columns = self.columns();
        let mut rows = Vec::new();
        for (place, output) in self.outputs.iter().enumerate() {
            let ordinates = ordinates(&self.cells, output, view.quantity(output).noise);
            let first = place * self.cases.len();
            let panels = (0..self.cases.len()).map(|case| {
                let cell = &self.cells[first + case];
                let y = AxisRequest::new(view.quantity(output), ordinates[case]);
                let is_leftmost = case.is_multiple_of(columns);
                let is_shared = ordinates.windows(2).all(|pair| pair[0] == pair[1]);
                // The quantities of a case stand below each other, and the case is named above the first.
                let note = self.cases[case].note().filter(|_| place == 0);
                let letter = letter(first + case, self.cells.len());
                PanelRequest {
                    x: self.abscissa(view, first + case),
                    y: AxisRequest {
                        labelled: is_leftmost,
                        numbered: is_leftmost || !is_shared,
                        ..y
                    },
                    header: Header { letter, note, legend: legend(view, cell) },
                }
            });
            rows.extend(in_rows(panels.collect(), columns));
        }
        rows
    }

    /// The time along one of the panels.
    fn abscissa(&self, view: &View<'_>, index: usize) -> AxisRequest {
        let times = self.cells[index].curves[0].points.iter().map(|(time, _)| *time);
        let x = AxisRequest::new(view.quantity(TIME.name), Scale::around(times, 0.0));
        // Stacked panels of one case share their time; different cases last differently long.
        let labelled = index + self.columns() >= self.cells.len();
        AxisRequest { labelled, numbered: labelled || self.cases.len() > 1, ..x }
    }
}

/// The names of the signals of an output; none where a history cannot show it.
fn variables(output: &str, model: &'static Description) -> Vec<&'static str> {
    match (model.signal(output), model.signal_group(output)) {
        (Some(signal), _) => vec![signal.name()],
        (None, Some(group)) => group.signals.to_vec(),
        (None, None) => Vec::new(),
    }
}

/// Whether a signal is another than the first of a group.
fn is_later(name: &str, model: &'static Description) -> bool {
    model.motion.groups.iter().any(|group| group.signals.iter().skip(1).any(|it| *it == name))
}

/// The signals of an output, with their colours.
fn signals_of(view: &View<'_>, output: &str) -> Result<Vec<(&'static str, Stroke)>, FigureError> {
    let model = view.model();
    let blue = Stroke::solid(BLUE, CURVE_WIDTH);
    let red = Stroke::solid(VERMILION, CURVE_WIDTH);
    let variables = variables(output, model);
    if variables.is_empty() {
        let known = DrawingKind::History.can_show(model, &[]).join(", ");
        return Err(view.unfit(format!("a history cannot show `{output}`; it can show {known}")));
    }
    let strokes = variables.iter().map(|name| if is_later(name, model) { red } else { blue });
    Ok(variables.iter().copied().zip(strokes).collect())
}

/// The curves of an output of a motion, of the cycles that are shown.
fn curves(
    view: &View<'_>,
    motion: &Motion<'_, '_>,
    output: &str,
) -> Result<Vec<Curve>, FigureError> {
    let cycles = motion.cycles()?;
    let omega = motion.frequency()?;
    let shown = ShownCycles::of(view.drawing);
    let mut curves = Vec::new();
    for (variable, stroke) in signals_of(view, output)? {
        let both = cycles.iter().zip(motion.shown(variable)?);
        let both = both.filter(|(cycle, _)| shown.has(**cycle));
        let points: Vec<_> =
            both.map(|(cycle, value)| (cycle * std::f64::consts::TAU / omega, value)).collect();
        if points.is_empty() {
            let ShownCycles { first, last } = shown;
            let why = format!("no sample of the history lies in cycles {first} to {last}");
            return Err(view.unfit(why));
        }
        curves.push(Curve { variable, points, stroke });
    }
    Ok(curves)
}

/// Where the mass meets its stops, in the unit of the figure, on the panel of the coordinate that meets them.
fn stops(view: &View<'_>, motion: &Motion<'_, '_>, output: &str) -> Vec<f64> {
    let met = view.model().signal_of_coordinate(0).filter(|it| it.name() == output);
    if met.is_none() || !view.shows("gap") {
        return Vec::new();
    }
    let factor = view.quantity(output).factor;
    motion.stops().into_iter().map(|(at, _)| at * factor).collect()
}

impl Cell {
    /// All that stands along its ordinate.
    fn ordinates(&self) -> impl Iterator<Item = f64> {
        let values = self.curves.iter().flat_map(|curve| curve.points.iter().map(|it| it.1));
        values.chain(self.stops.iter().copied())
    }
}

/// The ordinates of the cells that show `output`: the same for all unless one would be lost in it.
fn ordinates(cells: &[Cell], output: &str, noise: f64) -> Vec<Scale> {
    let ours: Vec<&Cell> = cells.iter().filter(|cell| cell.output == output).collect();
    let own: Vec<Scale> =
        ours.iter().map(|cell| Scale::above(noise, cell.ordinates(), 0.06)).collect();
    let common = Scale::above(noise, ours.iter().flat_map(|cell| cell.ordinates()), 0.06);
    let largest = own.iter().map(|scale| scale.high - scale.low).fold(0.0, f64::max);
    match common.high - common.low <= 2.0 * largest {
        true => vec![common; ours.len()],
        false => own,
    }
}

fn legend(view: &View<'_>, cell: &Cell) -> Vec<(Mark, Text)> {
    if cell.stops.len() > 1 {
        return vec![(Mark::Line(GAP_LINE), Text::plain("stops"))];
    }
    let surface = view.model().impact_surface().filter(|_| !cell.stops.is_empty());
    if let Some(delta) = surface {
        let delta = view.quantity(delta.symbol()).short_name();
        let words = Text::plain("stop at\u{a0}").then(delta);
        return vec![(Mark::Line(GAP_LINE), words)];
    }
    let mut legend = Vec::new();
    if cell.curves.len() > 1 {
        for curve in &cell.curves {
            let name = view.quantity(curve.variable).short_name();
            legend.push((Mark::Line(curve.stroke), name));
        }
    }
    legend
}

fn draw_cell(canvas: &mut Canvas, panel: &Panel, cell: &Cell) {
    for stop in &cell.stops {
        let ends = [(panel.x.scale.low, *stop), (panel.x.scale.high, *stop)];
        panel.curve(canvas, &ends, GAP_LINE);
    }
    for curve in &cell.curves {
        panel.curve(canvas, &curve.points, curve.stroke);
        panel.record(canvas, curve.variable, curve.points.iter().copied());
    }
    panel.finish(canvas);
}
