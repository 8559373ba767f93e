//! Outputs of every case over one axis: a point for each point of the section.

use plotters::style::RGBColor;

use super::attractor_diagram;
use super::attractors::Attractors;
use super::branch_lines::faded;
use super::canvas::Drawn;
use super::cloud::Dot;
use super::diagram::{Diagram, PointStyle, Sort, has_points, paint};
use super::diagram_contents::{Cases, Contents, Sorted};
use super::error::FigureError;
use super::header::{self, Mark};
use super::kind::{Kind, Names, Needs};
use super::measured::MeasuredPoints;
use super::outcome::{self, Outcomes};
use super::style::{BLUE, INK, VERMILION};
use super::text::Text;
use super::varied::along;
use super::view::View;
use super::without_period::numbers;
use super::{attractors, category, event_marks, ramp_points, track};
use crate::description::Description;
use crate::store::catalogue::{ATTRACTOR, DIRECTION, Entry, Place, section};
use crate::study::Drawing;

/// Panels of a bifurcation diagram, unless others are asked for.
fn usual_panels(model: &'static Description) -> Vec<Entry> {
    let section = section(model).into_iter().take(1);
    section.chain([Entry::of_output(model.main_output())]).collect()
}

/// One direction along the axis: its place on the axis of directions, its name and colour.
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

    /// How its points are drawn.
    fn sort(&self) -> Sort {
        let name = if self.name.is_empty() { "cases" } else { &self.name };
        Sort { name: name.to_owned(), size: self.size }
    }
}

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::CasesOrBranches, reads, draw };

/// What a diagram reads: without `of`, the panels of either sort of diagram.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let usual = usual_panels(model).into_iter().chain(attractor_diagram::usual_panels(model));
    let usual = usual.map(|it| it.name.to_owned());
    let outputs: Vec<String> = match drawing.of.is_empty() {
        true => usual.collect(),
        false => drawing.of.clone(),
    };
    Names::of(outcome::READS)
        .and(attractors::READS)
        .and(category::reads(model))
        .and_named(drawing.colour_by.clone())
        .and_all(event_marks::reads(model))
        .and_all(track::reads(&outputs, model))
        .and_all(ramp_points::reads(&outputs, model))
        .and_named(outputs)
}

/// The axis along the abscissa, or the parameter along which orbits were continued.
fn abscissa<'a>(view: &View<'a>) -> Result<&'a str, FigureError> {
    let free = view.drawable_axes();
    let named = view.drawing.x.as_ref();
    let along = along(view.dataset);
    let axis = match named {
        Some(name) => view.axes().into_iter().chain(along).find(|axis| axis == name),
        None => free.first().or(along.first()).copied(),
    };
    axis.ok_or_else(|| view.unfit("it needs an axis of the study that `at` does not hold"))
}

/// Draws the bifurcation diagram that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let x_name = abscissa(view)?;
    match by_attractors(view, x_name)? {
        Some(attractors) => attractor_diagram::draw(view, x_name, &attractors),
        None => draw_branches(view, x_name),
    }
}

/// What the diagram that `view` asks for shows, for a screen that draws it itself.
pub fn sorted<'a>(view: &View<'a>) -> Result<Sorted<'a>, FigureError> {
    let x_name = abscissa(view)?;
    if let Some(attractors) = by_attractors(view, x_name)? {
        return attractor_diagram::sorted(view, x_name, &attractors);
    }
    let mut branches = branches(view, x_name);
    let contents = contents(view, x_name, &mut branches)?;
    let sorts = branches.iter().map(|branch| (branch.sort().name, branch.colour)).collect();
    Ok(Sorted { contents, sorts, windows: Vec::new(), left_out: None })
}

/// The attractors along the abscissa, where the diagram is drawn by them.
fn by_attractors<'a>(
    view: &View<'a>,
    x_name: &'a str,
) -> Result<Option<Attractors<'a>>, FigureError> {
    let by = view.drawing.colour_by.as_deref();
    match Attractors::along(view, x_name)? {
        // By direction, both sweeps are drawn, where they find the same attractor too.
        Some(attractors) if by != Some(DIRECTION.name) => Ok(Some(attractors)),
        None if by == Some(ATTRACTOR.name) => {
            Err(view.unfit("`colour_by`: the results tell no attractors"))
        }
        _ => Ok(None),
    }
}

/// Draws the diagram by directions, or in one colour.
fn draw_branches(view: &View<'_>, x_name: &str) -> Result<Drawn, FigureError> {
    let mut branches = branches(view, x_name);
    let contents = contents(view, x_name, &mut branches)?;
    // Without cases there are only the lines of branches to explain.
    let is_told = contents.cases.values.is_empty() || contents.paint.is_some();
    let legend = if is_told { Vec::new() } else { legend(&branches) };
    let diagram = Diagram::of(view, contents)?;
    let style =
        PointStyle { sorts: branches.iter().map(Branch::sort).collect(), beside_lines: 1.0 };
    Ok(diagram.draw(view, &style, legend, |canvas, panel, output| {
        if !has_points(view, output) {
            panel.mark_zero(canvas);
        }
    }))
}

/// What the diagram shows; `branches` of cases make room for lines of branches of orbits.
fn contents<'a>(
    view: &View<'_>,
    x_name: &'a str,
    branches: &mut [Branch],
) -> Result<Contents<'a>, FigureError> {
    let factor = view.quantity(x_name).factor;
    let values = view.coordinate_values(x_name).iter().map(|value| value * factor).collect();
    let (free, per_value) = match branches.len() > 1 {
        true => (vec![x_name, DIRECTION.name], view.coordinate_values(DIRECTION.name).len()),
        false => (vec![x_name], 1),
    };
    let cases = Cases { axis: x_name, free, values, per_value };
    let outputs = match view.drawing.of.is_empty() {
        true => usual_panels(view.model()).iter().map(|entry| entry.name.to_owned()).collect(),
        false => view.drawing.of.clone(),
    };
    let mut contents = Contents::of_branches(view, cases, outputs);
    if contents.lines.iter().any(|lines| !lines.is_empty()) {
        branches.iter_mut().for_each(Branch::step_back);
    }
    // Directions have colours of their own.
    let is_by_direction = view.drawing.colour_by.as_deref() == Some(DIRECTION.name);
    if !(is_by_direction && branches.len() > 1) {
        contents.paint = paint(view, &contents.cases)?;
    }
    let clouds = contents.outputs.iter().map(|output| points(view, output, &contents, branches));
    contents.clouds = clouds.collect::<Result<_, _>>()?;
    contents.measured = MeasuredPoints::over(view, x_name, &contents.outputs)?;
    Ok(contents)
}

/// The branches of the diagram; one without a name where the starts were not inherited in both directions.
fn branches(view: &View<'_>, x_name: &str) -> Vec<Branch> {
    let count = view.coordinate_values(DIRECTION.name).len();
    if x_name == DIRECTION.name || count < 2 || !view.free_axes().contains(&DIRECTION.name) {
        return vec![Branch { index: 0, name: String::new(), colour: INK, size: 1.0 }];
    }
    let codes = view.coordinate_values(DIRECTION.name);
    let flags = view.dataset.coordinate(DIRECTION.name).map_or(&[][..], |it| &it.flags);
    let looks = [(BLUE, 1.7), (VERMILION, 0.75), (INK, 0.4)];
    let mut branches = Vec::new();
    for (index, (colour, size)) in looks.into_iter().enumerate().take(count) {
        let code = codes[index] as i64;
        let flag = flags.iter().find(|(value, _)| *value == code);
        let name = flag.map_or(format!("direction {code}"), |(_, name)| name.clone());
        let name = view.direction_name(&name, x_name);
        branches.push(Branch { index, name, colour, size });
    }
    branches
}

/// The points of `output` on each branch; cases that failed have none.
fn points(
    view: &View<'_>,
    output: &str,
    contents: &Contents<'_>,
    branches: &[Branch],
) -> Result<Vec<Vec<Dot>>, FigureError> {
    let Cases { free, values, per_value, .. } = &contents.cases;
    // Orbits may have been continued alone, or along what is no axis.
    let is_beside = |place: Place| view.dataset.variable(&place.name(output)).is_some();
    let is_continued = is_beside(Place::Branch) || is_beside(Place::Ramp);
    if is_continued && (values.is_empty() || view.dataset.variable(output).is_none()) {
        return Ok(branches.iter().map(|_| Vec::new()).collect());
    }
    let numbers = numbers(view, output, free)?;
    let outcomes = Outcomes::over(view, free)?;
    let mut clouds = Vec::new();
    for branch in branches {
        let cases = (0..values.len()).map(|at| at * per_value + branch.index);
        let known = cases.filter(|case| !outcomes.failed(*case));
        clouds.push(known.flat_map(|it| contents.dots(it, &numbers, branch.colour)).collect());
    }
    Ok(clouds)
}

/// The branches in their colours, where there are several.
fn legend(branches: &[Branch]) -> Vec<header::Entry> {
    let mut legend = Vec::new();
    if branches.len() > 1 {
        for Branch { name, colour, size, .. } in branches {
            legend.push((Mark::Disc(*colour, 1.6 * size), Text::plain(name)));
        }
    }
    legend
}
