//! Outputs of every case over one axis: a point for each point of the section.

use plotters::style::RGBColor;

use super::attractor_diagram;
use super::attractors::Attractors;
use super::axis::AxisRequest;
use super::canvas::Drawn;
use super::cloud::{self, Dot};
use super::error::FigureError;
use super::header::{Header, Mark};
use super::outcome::Outcomes;
use super::page::{PageRequest, PanelRequest, letter};
use super::panel::Pointing;
use super::scale::{Scale, Spacing};
use super::style::{BLUE, INK, ONE_COLUMN, VERMILION};
use super::text::Text;
use super::view::View;

/// Panels of a bifurcation diagram, unless others are asked for.
const PANELS: [&str; 2] = ["section_r", "progression_speed"];
/// Height of the frames of section coordinates [pt].
const SECTION_HEIGHT: f64 = 125.0;
/// Height of the frames of outputs with one value per case [pt].
const OUTPUT_HEIGHT: f64 = 80.0;
/// The axis along which the attractor was followed up and down.
const DIRECTION: &str = "direction";

/// One way along the axis: its place on the axis of directions, its name and colour.
struct Branch {
    index: usize,
    name: String,
    colour: RGBColor,
    /// Radius relative to the plain one, so that a branch that coincides with the next one shows.
    size: f64,
}

/// Draws the bifurcation diagram that `view` asks for.
pub fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let x_name = super::abscissa(view)?;
    if let Some(attractors) = Attractors::along(view, x_name)? {
        return attractor_diagram::draw(view, x_name, &attractors);
    }
    let branches = branches(view, x_name);
    let mut free = vec![x_name];
    if branches.len() > 1 {
        free.push(DIRECTION);
    }
    let outputs = match view.drawing.of.is_empty() {
        true => PANELS.map(String::from).to_vec(),
        false => view.drawing.of.clone(),
    };
    let quantity = view.quantity(x_name);
    let values: Vec<f64> =
        view.axis_values(x_name)?.iter().map(|value| value * quantity.factor).collect();
    let clouds = outputs
        .iter()
        .map(|output| points(view, output, &values, &free, &branches))
        .collect::<Result<Vec<_>, _>>()?;
    let page = request(view, &outputs, &clouds, AxisRequest::new(quantity, span(&values)), &free);
    let page = PageRequest { rows: with_legend(page.rows, &branches), ..page };
    let (mut canvas, panels) = page.lay_out();
    for (panel, (cloud, output)) in panels.iter().flatten().zip(clouds.iter().zip(&outputs)) {
        if !has_points(view, output) {
            panel.mark_zero(&mut canvas);
        }
        let radius = cloud::radius(cloud.iter().map(Vec::len).sum());
        for (dots, branch) in cloud.iter().zip(&branches) {
            cloud::draw(&mut canvas, panel, dots, radius * branch.size);
        }
        panel.finish(&mut canvas);
    }
    Ok(canvas.finish(&super::about(view, &outputs, &free)))
}

/// The abscissa, with room for points that stand at its ends.
pub fn span(values: &[f64]) -> Scale {
    let plain = Scale::of_axis(values);
    if values.len() > 60 {
        return plain;
    }
    match plain.spacing {
        Spacing::Linear => Scale::around(values.iter().copied(), 0.02),
        Spacing::Log => Scale::log_around(values.iter().copied(), 0.02),
    }
}

/// The branches of the diagram; one without a name where the axis was not followed both ways.
fn branches(view: &View<'_>, x_name: &str) -> Vec<Branch> {
    let count = view.coordinate_values(DIRECTION).len();
    if x_name == DIRECTION || count < 2 || !view.free_axes().contains(&DIRECTION) {
        return vec![Branch { index: 0, name: String::new(), colour: INK, size: 1.0 }];
    }
    let codes = view.coordinate_values(DIRECTION);
    let flags = view.dataset.coordinate(DIRECTION).map_or(&[][..], |it| &it.flags);
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
    view.dataset.variable(output).is_some_and(|variable| variable.dimensions.iter().any(is_inner))
}

/// The page with a row for each output.
pub fn request(
    view: &View<'_>,
    outputs: &[String],
    clouds: &[Vec<Vec<Dot>>],
    abscissa: AxisRequest,
    free: &[&str],
) -> PageRequest {
    let mut rows = Vec::new();
    let mut heights = Vec::new();
    for (index, (output, cloud)) in outputs.iter().zip(clouds).enumerate() {
        let values: Vec<f64> = cloud.iter().flatten().map(|dot| dot.at.1).collect();
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
