//! Displacements and velocities over time, as stacked panels or one panel per value of an axis.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Dash, Drawn, Stroke};
use super::case_panels::{CasePanel, case_panels};
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::motion::{Motion, sources, sources_of_arcs};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::panel::{Panel, Pointing};
use super::scale::Scale;
use super::style::{
    BLUE, CURVE_WIDTH, FAINT_INK, ONE_COLUMN, REFERENCE_WIDTH, TWO_COLUMNS, VERMILION,
};
use super::text::Text;
use super::view::View;
use crate::description::{Description, Parameter};
use crate::store::catalogue::{Entry, TIME};
use crate::study::{Drawing, DrawingKind};

/// Height of a frame [pt].
const HEIGHT: f64 = 82.0;
/// The line at the gap between mass and plate.
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
    case: usize,
    curves: Vec<Curve>,
    /// Gap between mass and plate, where the panel shows the relative displacement.
    gap: Option<f64>,
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a history reads: the variables of what it shows, and what time and gap follow from.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let usual = model.motion.panels.iter().copied().filter(|_| drawing.of.is_empty());
    let of = drawing.of.iter().map(String::as_str).chain(usual);
    let shown: Vec<&str> = of.flat_map(|name| variables(name, model)).collect();
    let constants = model.drive_frequency().into_iter().chain(model.impact_surface());
    let constants = constants.map(Entry::of_parameter);
    let sources: Vec<Entry> = shown.iter().flat_map(|name| sources(name, model)).collect();
    let shown = shown.into_iter().map(str::to_owned).collect::<Vec<_>>();
    Names::of(sources).and(sources_of_arcs(model)).and(constants).and_named(shown)
}

/// Draws the history that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
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
    let mut cells = Vec::new();
    for output in &outputs {
        for place in 0..cases.len() {
            cells.push(cell(&cases, output, place)?);
        }
    }
    // Several quantities of one case stand below each other; several cases beside each other.
    let columns = match (cases.len(), outputs.len()) {
        (1, _) => 1,
        (2 | 4, 1) => 2,
        (cases, 1) => cases.min(3),
        (cases, _) => cases.min(4),
    };
    let notes: Vec<Option<Text>> = cases.iter().map(CasePanel::note).collect();
    let page = request(view, &cells, columns, cases.len(), &notes);
    let (mut canvas, panels) = page.lay_out();
    for (panel, cell) in panels.iter().flatten().zip(&cells) {
        draw_cell(&mut canvas, panel, cell);
    }
    Ok(canvas.finish(&view.about(&outputs, &cases[0].free())))
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
fn curves_of(view: &View<'_>, output: &str) -> Result<Vec<(&'static str, Stroke)>, FigureError> {
    let model = view.model();
    let blue = Stroke::solid(BLUE, CURVE_WIDTH);
    let red = Stroke::solid(VERMILION, CURVE_WIDTH);
    let variables = variables(output, model);
    if variables.is_empty() {
        let known = DrawingKind::History.can_show(model, &[]).join(", ");
        return Err(view.unfit(format!("a history cannot show `{output}`; it can show {known}")));
    }
    let colour = |name: &str| if is_later(name, model) { red } else { blue };
    Ok(variables.into_iter().map(|name| (name, colour(name))).collect())
}

/// A quantity of one of `cases`, by its place among them.
fn cell(cases: &[CasePanel<'_>], output: &str, place: usize) -> Result<Cell, FigureError> {
    let (view, case) = (&cases[place].view, cases[place].case);
    let free: &[&str] = &cases[place].free();
    let motion = Motion::drawn(view, free, case);
    let cycles = motion.cycles()?;
    let omega = motion.frequency()?;
    let [first, last] = view.drawing.cycles.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let shown = |cycle: f64| (first - 1e-9..=last + 1e-9).contains(&cycle);
    let mut curves = Vec::new();
    for (variable, stroke) in curves_of(view, output)? {
        let both = cycles.iter().zip(motion.shown(variable)?);
        let both = both.filter(|(cycle, _)| shown(**cycle));
        let points: Vec<_> =
            both.map(|(cycle, value)| (cycle * std::f64::consts::TAU / omega, value)).collect();
        if points.is_empty() {
            let why = format!("no sample of the history lies in cycles {first} to {last}");
            return Err(view.unfit(why));
        }
        curves.push(Curve { variable, points, stroke });
    }
    let met = view.model().signal_of_coordinate(0).map(|it| it.name());
    let is_shown = met == Some(output) && view.shows("gap");
    let delta = view.model().impact_surface().filter(|_| is_shown).map(Parameter::symbol);
    let gap = delta.and_then(|delta| {
        let gap = view.parameter(delta, free).ok()?.iter().nth(case).copied()?;
        Some(gap * view.quantity(delta).factor)
    });
    Ok(Cell { output: output.to_string(), case: place, curves, gap })
}

/// The ordinates of the cells that show `output`: the same for all unless one would be lost in it.
fn ordinates(cells: &[Cell], output: &str, noise: f64) -> Vec<Scale> {
    let ours: Vec<&Cell> = cells.iter().filter(|cell| cell.output == output).collect();
    let values = |cell: &Cell| {
        let curves = cell.curves.iter().flat_map(|curve| curve.points.iter().map(|(_, y)| *y));
        curves.chain(cell.gap).collect::<Vec<_>>()
    };
    let own: Vec<Scale> = ours.iter().map(|cell| Scale::above(noise, values(cell), 0.06)).collect();
    let common = Scale::above(noise, ours.iter().flat_map(|cell| values(cell)), 0.06);
    let largest = own.iter().map(|scale| scale.high - scale.low).fold(0.0, f64::max);
    match common.high - common.low <= 2.0 * largest {
        true => vec![common; ours.len()],
        false => own,
    }
}

/// The page for `cells`, which come output by output.
fn request<'a>(
    view: &View<'a>,
    cells: &[Cell],
    columns: usize,
    cases: usize,
    notes: &[Option<Text>],
) -> PageRequest<'a> {
    let mut rows: Vec<Vec<PanelRequest>> = Vec::new();
    for (index, cell) in cells.iter().enumerate() {
        let column = cell.case % columns;
        let (x, y) = axes(view, cells, index, columns, cases);
        // The quantities of a case stand below each other, and the case is named above the first.
        let note = notes[cell.case].clone().filter(|_| index < cases);
        let header =
            Header { letter: letter(index, cells.len()), note, legend: legend(view, cell) };
        let panel = PanelRequest { x, y, header };
        match rows.last_mut() {
            Some(row) if column > 0 => row.push(panel),
            _ => rows.push(vec![panel]),
        }
    }
    let width = if columns > 1 { TWO_COLUMNS } else { ONE_COLUMN };
    PageRequest {
        drawing: view.drawing,
        width_mm: width,
        heights: vec![HEIGHT; rows.len()],
        rows,
        column_room: NO_ROOM,
        right_room: NO_ROOM,
        bottom_room: 0.0,
        pointing: Pointing::Inward,
    }
}

/// Abscissa and ordinate of one of `cells`, with numbers and labels only where they are needed.
fn axes(
    view: &View<'_>,
    cells: &[Cell],
    index: usize,
    columns: usize,
    cases: usize,
) -> (AxisRequest, AxisRequest) {
    let cell = &cells[index];
    let times = cell.curves[0].points.iter().map(|(time, _)| *time);
    let mut x = AxisRequest::new(view.quantity(TIME.name), Scale::around(times, 0.0));
    // Stacked panels of one case share their time; different cases last differently long.
    x.labelled = cells.get(index + columns).is_none();
    x.numbered = x.labelled || cases > 1;
    let scales = ordinates(cells, &cell.output, view.quantity(&cell.output).noise);
    let shared = scales.windows(2).all(|pair| pair[0] == pair[1]);
    let leftmost = cell.case.is_multiple_of(columns);
    let mut y = AxisRequest::new(view.quantity(&cell.output), scales[cell.case]);
    y.labelled = leftmost;
    y.numbered = leftmost || !shared;
    (x, y)
}

fn legend(view: &View<'_>, cell: &Cell) -> Vec<(Mark, Text)> {
    let entry =
        |curve: &Curve| (Mark::Line(curve.stroke), view.quantity(curve.variable).short_name());
    let surface = view.model().impact_surface().filter(|_| cell.gap.is_some());
    match (surface, cell.curves.len()) {
        (Some(delta), _) => {
            vec![(Mark::Line(GAP_LINE), view.quantity(delta.symbol()).short_name())]
        }
        (None, 1) => Vec::new(),
        _ => cell.curves.iter().map(entry).collect(),
    }
}

fn draw_cell(canvas: &mut Canvas, panel: &Panel, cell: &Cell) {
    if let Some(gap) = cell.gap {
        let ends = [(panel.x.scale.low, gap), (panel.x.scale.high, gap)];
        panel.curve(canvas, &ends, GAP_LINE);
    }
    for curve in &cell.curves {
        panel.curve(canvas, &curve.points, curve.stroke);
        panel.record(canvas, curve.variable, curve.points.iter().copied());
    }
    panel.finish(canvas);
}
