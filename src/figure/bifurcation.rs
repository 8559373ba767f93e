//! Outputs of every case over one axis: a point for each point of the section.

use plotters::style::RGBColor;

use super::attractor_diagram;
use super::attractors::Attractors;
use super::axis::AxisRequest;
use super::branch_lines::{BranchLines, faded};
use super::canvas::Drawn;
use super::cloud::{self, Dot};
use super::diagram::{
    Shown, explain, has_points, nothing_within, paint, request, seen, span, told,
    with_branch_lines, with_paint,
};
use super::error::FigureError;
use super::header::Mark;
use super::kind::{Kind, Names, Needs};
use super::measured::MeasuredPoints;
use super::outcome::{self, Outcomes};
use super::page::{PageRequest, PanelRequest};
use super::paint::Paint;
use super::style::{BLUE, INK, UNDECIDED_DOT, VERMILION};
use super::text::Text;
use super::varied::along;
use super::view::View;
use super::{attractors, category, event_marks, track};
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
    let by = view.drawing.colour_by.as_deref();
    match Attractors::along(view, x_name)? {
        // By direction, both sweeps are drawn, where they find the same attractor too.
        Some(attractors) if by != Some(DIRECTION.name) => {
            return attractor_diagram::draw(view, x_name, &attractors);
        }
        Some(_) => {}
        None if by == Some(ATTRACTOR.name) => {
            let why = "`colour_by`: the results tell no attractors";
            return Err(view.unfit(why));
        }
        None => {}
    }
    let mut branches = branches(view, x_name);
    let mut free = vec![x_name];
    if branches.len() > 1 {
        free.push(DIRECTION.name);
    }
    let outputs = match view.drawing.of.is_empty() {
        true => usual_panels(view.model()).iter().map(|entry| entry.name.to_owned()).collect(),
        false => view.drawing.of.clone(),
    };
    let quantity = view.quantity(x_name);
    let values: Vec<f64> =
        view.coordinate_values(x_name).iter().map(|value| value * quantity.factor).collect();
    let lines: Vec<BranchLines> =
        outputs.iter().map(|output| BranchLines::shown(view, x_name, output)).collect();
    if lines.iter().any(|lines| !lines.is_empty()) {
        branches.iter_mut().for_each(Branch::step_back);
    }
    // Directions have colours of their own.
    let mut paint = match by == Some(DIRECTION.name) && free.len() > 1 {
        true => None,
        false => paint(view, &free, values.len())?,
    };
    let clouds = outputs
        .iter()
        .map(|output| points(view, output, &values, (&free, paint.as_ref()), &branches))
        .collect::<Result<Vec<_>, _>>()?;
    let measured = MeasuredPoints::over(view, x_name, &outputs)?;
    let of_branches = lines.iter().flat_map(BranchLines::places).map(|at| at.0);
    let reached: Vec<f64> = of_branches.chain(measured.abscissae()).collect();
    let abscissa = AxisRequest::new(quantity, span(&values, &reached));
    let is_seen = seen(
        &abscissa,
        &values,
        free[1..].iter().map(|it| view.coordinate_values(it).len()).product(),
    );
    if let Some(paint) = &mut paint {
        paint.list(&is_seen);
    }
    let left_out =
        track::elsewhere(view, &[x_name]).or(nothing_within(&abscissa, &values, &reached));
    let note = view.note(&free, &left_out);
    let page = request(
        view,
        &outputs,
        &Shown { clouds: &clouds, lines: &lines, symbols: &[], measured: &measured },
        abscissa,
        note,
    );
    // Without cases there are only the lines of branches to explain.
    let shown = if values.is_empty() || paint.is_some() { &[][..] } else { &branches[..] };
    let rows = with_legend(page.rows, shown);
    let rows = with_paint(with_branch_lines(rows, &clouds, &lines), (paint.as_ref(), &is_seen));
    let rows = measured.with_legend(rows, &clouds);
    let room = |height: f64| paint.as_ref().map_or(0.0, |it| it.room(height));
    let (mut canvas, panels) = PageRequest { rows, right_room: &room, ..page }.lay_out();
    let shown = clouds.iter().zip(&lines).zip(&outputs);
    for (index, (panel, ((cloud, lines), output))) in panels.iter().flatten().zip(shown).enumerate()
    {
        if !has_points(view, output) {
            panel.mark_zero(&mut canvas);
        }
        let radius = view.radius(cloud::count(panel, cloud));
        for (dots, branch) in cloud.iter().zip(&branches) {
            cloud::draw(&mut canvas, panel, dots, radius * branch.size);
            let name = if branch.name.is_empty() { "cases" } else { &branch.name };
            panel.record_values(&mut canvas, name, told(dots, paint.as_ref()));
        }
        lines.draw(&mut canvas, panel);
        measured.draw(&mut canvas, panel, index);
        panel.finish(&mut canvas);
    }
    explain(&mut canvas, &panels, paint.as_ref());
    let outside = measured.left_out(&panels);
    Ok(canvas.finish(&view.about(&outputs, &free)).noting(left_out).noting(outside))
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
    let branch = |(index, (colour, size)): (usize, (RGBColor, f64))| {
        let code = codes[index] as i64;
        let flag = flags.iter().find(|(value, _)| *value == code);
        let name = flag.map_or(format!("direction {code}"), |(_, name)| name.clone());
        let name = view.direction_name(&name, x_name);
        Branch { index, name, colour, size }
    };
    looks.into_iter().enumerate().take(count).map(branch).collect()
}

/// The points of `output` on each branch; cases that failed have none.
fn points(
    view: &View<'_>,
    output: &str,
    x_values: &[f64],
    (free, paint): (&[&str], Option<&Paint>),
    branches: &[Branch],
) -> Result<Vec<Vec<Dot>>, FigureError> {
    // Orbits may have been continued alone, or along what is no axis.
    let is_continued = view.dataset.variable(&Place::Branch.name(output)).is_some();
    if is_continued && (x_values.is_empty() || view.dataset.variable(output).is_none()) {
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
            let own = paint.map(|it| it.colour(case).unwrap_or(UNDECIDED_DOT));
            let colour = own.unwrap_or(branch.colour);
            let dot = |y| Dot { at: (*x, y), colour, crowding, case };
            dots.extend(finite.into_iter().map(dot));
        }
        dots
    };
    Ok(branches.iter().map(of_branch).collect())
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
