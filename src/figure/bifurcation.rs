//! Outputs of every case over one axis: a point for each point of the section.

use plotters::style::RGBColor;

use super::attractor_diagram;
use super::attractors::Attractors;
use super::axis::AxisRequest;
use super::canvas::Drawn;
use super::cloud::{self, Dot};
use super::error::FigureError;
use super::followed::{Followed, faded};
use super::header::{Header, Mark};
use super::outcome::Outcomes;
use super::page::{PageRequest, PanelRequest, letter};
use super::panel::Pointing;
use super::scale::{Scale, Spacing, finite_range};
use super::style::{BLUE, INK, ONE_COLUMN, VERMILION};
use super::text::Text;
use super::view::View;
use crate::orbit::Output;
use crate::store::catalogue::{DIRECTION, Entry, Place, SECTION_R};

/// Panels of a bifurcation diagram, unless others are asked for.
const PANELS: [Entry; 2] = [SECTION_R, Entry::of_output(Output::ProgressionSpeed)];
/// Height of the frames of section coordinates [pt].
const SECTION_HEIGHT: f64 = 125.0;
/// Height of the frames of outputs with one value per case [pt].
const OUTPUT_HEIGHT: f64 = 80.0;

/// One way along the axis: its place on the axis of directions, its name and colour.
struct Branch {
    index: usize,
    name: String,
    colour: RGBColor,
    /// Radius relative to the plain one, so that a branch that coincides with the next one shows.
    size: f64,
}

impl Branch {
    /// Makes room for what is drawn over it.
    fn step_back(&mut self) {
        self.colour = faded(self.colour);
        self.size *= 0.8;
    }
}

/// Draws the bifurcation diagram that `view` asks for.
pub fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let x_name = super::abscissa(view)?;
    if let Some(attractors) = Attractors::along(view, x_name)? {
        return attractor_diagram::draw(view, x_name, &attractors);
    }
    let mut branches = branches(view, x_name);
    let mut free = vec![x_name];
    if branches.len() > 1 {
        free.push(DIRECTION.name);
    }
    let outputs = match view.drawing.of.is_empty() {
        true => PANELS.map(|entry| entry.name.to_owned()).to_vec(),
        false => view.drawing.of.clone(),
    };
    let quantity = view.quantity(x_name);
    let values: Vec<f64> =
        view.coordinate_values(x_name).iter().map(|value| value * quantity.factor).collect();
    let followed: Vec<Followed> =
        outputs.iter().map(|output| Followed::shown(view, x_name, output)).collect();
    if followed.iter().any(|followed| !followed.is_empty()) {
        branches.iter_mut().for_each(Branch::step_back);
    }
    let clouds = outputs
        .iter()
        .map(|output| points(view, output, &values, &free, &branches))
        .collect::<Result<Vec<_>, _>>()?;
    let reached: Vec<f64> = followed.iter().flat_map(Followed::places).map(|at| at.0).collect();
    let abscissa = AxisRequest::new(quantity, span(&values, &reached));
    let page = request(view, &outputs, (&clouds, &followed), abscissa, &free);
    // Without cases there are only the lines of followed orbits to explain.
    let shown = if values.is_empty() { &[][..] } else { &branches[..] };
    let rows = with_legend(page.rows, shown);
    let page = PageRequest { rows: with_followed(rows, &clouds, &followed), ..page };
    let (mut canvas, panels) = page.lay_out();
    let shown = clouds.iter().zip(&followed).zip(&outputs);
    for (panel, ((cloud, followed), output)) in panels.iter().flatten().zip(shown) {
        if !has_points(view, output) {
            panel.mark_zero(&mut canvas);
        }
        let radius = cloud::radius(cloud.iter().map(Vec::len).sum());
        for (dots, branch) in cloud.iter().zip(&branches) {
            cloud::draw(&mut canvas, panel, dots, radius * branch.size);
        }
        followed.draw(&mut canvas, panel);
        panel.finish(&mut canvas);
    }
    Ok(canvas.finish(&super::about(view, &outputs, &free)))
}

/// The abscissa, with room for points that stand at its ends, and as far as orbits were followed.
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
    }
}

/// The branches of the diagram; one without a name where the axis was not followed both ways.
fn branches(view: &View<'_>, x_name: &str) -> Vec<Branch> {
    let count = view.coordinate_values(DIRECTION.name).len();
    if x_name == DIRECTION.name || count < 2 || !view.free_axes().contains(&DIRECTION.name) {
        return vec![Branch { index: 0, name: String::new(), colour: INK, size: 1.0 }];
    }
    let codes = view.coordinate_values(DIRECTION.name);
    let flags = view.dataset.coordinate(DIRECTION.name).map_or(&[][..], |it| &it.flags);
    let looks = [(BLUE, 1.7), (VERMILION, 0.75), (INK, 0.4)];
    let branch = |(index, (colour, size)): (usize, (RGBColor, f64))| {
        let code = codes[index] as i64;
        let flag = flags.iter().find(|(value, _)| *value == code);
        let name = flag.map_or(format!("direction {code}"), |(_, name)| name.clone());
        Branch { index, name, colour, size }
    };
    looks.into_iter().enumerate().take(count).map(branch).collect()
}

/// The points of `output` on each branch; cases that failed have none.
fn points(
    view: &View<'_>,
    output: &str,
    x_values: &[f64],
    free: &[&str],
    branches: &[Branch],
) -> Result<Vec<Vec<Dot>>, FigureError> {
    // Orbits may have been followed alone, or along what is no axis.
    let is_followed = view.dataset.variable(&Place::Branch.name(output)).is_some();
    if is_followed && (x_values.is_empty() || view.dataset.variable(output).is_none()) {
        return Ok(branches.iter().map(|_| Vec::new()).collect());
    }
    let array = view.shown(output, free)?;
    let outcomes = Outcomes::over(view, free)?;
    let directions = if free.len() > 1 { array.shape()[1] } else { 1 };
    let cases = x_values.len() * directions;
    let per_case = array.len().checked_div(cases).unwrap_or(0);
    let values: Vec<f64> = array.iter().copied().collect();
    let of_branch = |branch: &Branch| {
        let mut dots = Vec::new();
        for (at, x) in x_values.iter().enumerate() {
            let case = at * directions + branch.index;
            if outcomes.failed(case) {
                continue;
            }
            let shown = &values[case * per_case..(case + 1) * per_case];
            let finite: Vec<f64> = shown.iter().copied().filter(|it| it.is_finite()).collect();
            let crowding = (finite.len() * x_values.len()) as f64;
            let dot = |y| Dot { at: (*x, y), colour: branch.colour, crowding };
            dots.extend(finite.into_iter().map(dot));
        }
        dots
    };
    Ok(branches.iter().map(of_branch).collect())
}

/// Whether an output has several values per case.
pub fn has_points(view: &View<'_>, output: &str) -> bool {
    let axes = view.axes();
    let is_inner = |name: &String| !axes.contains(&name.as_str());
    let stored = view.dataset.variable(output);
    let stored = stored.filter(|variable| variable.dimensions.iter().any(is_inner));
    let followed = view.dataset.variable(&Place::Branch.name(output));
    stored.is_some() || followed.is_some_and(|variable| variable.dimensions.len() > 1)
}

/// The page with a row for each output.
pub fn request(
    view: &View<'_>,
    outputs: &[String],
    (clouds, followed): (&[Vec<Vec<Dot>>], &[Followed]),
    abscissa: AxisRequest,
    free: &[&str],
) -> PageRequest {
    let mut rows = Vec::new();
    let mut heights = Vec::new();
    for (index, (output, cloud)) in outputs.iter().zip(clouds).enumerate() {
        let dots = cloud.iter().flatten().map(|dot| dot.at.1);
        let values: Vec<f64> = dots.chain(followed[index].places().map(|at| at.1)).collect();
        let y = AxisRequest::around(view.quantity(output), &values, 0.06);
        let last = index + 1 == outputs.len();
        let x = AxisRequest { labelled: last, numbered: last, ..abscissa.clone() };
        let note = if index == 0 { view.held_note(free) } else { None };
        let header = Header { letter: letter(index, outputs.len()), note, legend: Vec::new() };
        rows.push(vec![PanelRequest { x, y, header }]);
        heights.push(if has_points(view, output) { SECTION_HEIGHT } else { OUTPUT_HEIGHT });
    }
    PageRequest {
        title: view.drawing.title.clone(),
        width_mm: view.drawing.width_mm.unwrap_or(ONE_COLUMN),
        heights,
        rows,
        right_room: 0.0,
        pointing: Pointing::Inward,
    }
}

/// The rows with a legend of the branches above the first.
fn with_legend(mut rows: Vec<Vec<PanelRequest>>, branches: &[Branch]) -> Vec<Vec<PanelRequest>> {
    if let (true, Some(first)) = (branches.len() > 1, rows.first_mut().and_then(|r| r.first_mut()))
    {
        let entry = |branch: &Branch| {
            (Mark::Disc(branch.colour, 1.6 * branch.size), Text::plain(&branch.name))
        };
        first.header.legend = branches.iter().map(entry).collect();
    }
    rows
}

/// The rows with what the lines of followed orbits and their symbols mean in the first legend.
pub fn with_followed(
    mut rows: Vec<Vec<PanelRequest>>,
    clouds: &[Vec<Vec<Dot>>],
    followed: &[Followed],
) -> Vec<Vec<PanelRequest>> {
    let entries = followed.iter().map(Followed::legend).max_by_key(Vec::len).unwrap_or_default();
    let first = rows.first_mut().and_then(|row| row.first_mut());
    let Some(first) = first.filter(|_| !entries.is_empty()) else { return rows };
    let legend = &mut first.header.legend;
    let dots = clouds.iter().flatten().flatten().next();
    if let (true, Some(dot)) = (legend.is_empty(), dots) {
        legend.push((Mark::Disc(dot.colour, 1.3), Text::plain("settled")));
    }
    legend.extend(entries);
    rows
}
