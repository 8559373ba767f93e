//! A bifurcation diagram by attractors: each in its colour, windows of coexistence shaded, events marked.

use std::collections::BTreeSet;

use super::attractors::{Attractors, Look};
use super::canvas::{Canvas, Drawn, Stroke};
use super::cells::Cells;
use super::cloud::Dot;
use super::diagram::{Diagram, PointStyle, Sort, has_points, paint};
use super::diagram_contents::{Cases, Contents, Sorted};
use super::error::FigureError;
use super::event_marks::EventMarks;
use super::geometry::Rect;
use super::header::{self, Mark};
use super::measured::MeasuredPoints;
use super::panel::Panel;
use super::scale::Scale;
use super::style::{COEXISTENCE, FAINT_INK, MINOR_WIDTH};
use super::text::Text;
use super::view::View;
use super::without_period::numbers;
use crate::description::Description;
use crate::store::catalogue::{Entry, section};

/// Panels of the diagram, unless others are asked for: those of them that the results hold.
pub fn usual_panels(model: &'static Description) -> Vec<Entry> {
    let outputs = model.gain_and_work().into_iter().chain([model.exponent()]);
    section(model).into_iter().take(1).chain(outputs.map(Entry::of_output)).collect()
}

/// Draws the diagram that `view` asks for over `x_name`, along which `attractors` are known.
pub fn draw(
    view: &View<'_>,
    x_name: &str,
    attractors: &Attractors<'_>,
) -> Result<Drawn, FigureError> {
    let looks = attractors.looks();
    let (contents, marks) = contents(view, x_name, attractors, &looks)?;
    let has_own_colours = contents.paint.is_some();
    let mut windows = windows(&contents.cases.values, attractors);
    let diagram = Diagram::of(view, contents)?;
    // Other limits may be set than those of the values.
    let Scale { low, high, .. } = diagram.abscissa.scale;
    windows.retain(|[from, to]| *from < high && *to > low && view.shows("coexistence"));
    let seen = attractors.seen(|case| diagram.is_seen(case));
    let mut legend = if has_own_colours { Vec::new() } else { legend_of_looks(&seen, attractors) };
    if !windows.is_empty() {
        legend.push((Mark::Patch(COEXISTENCE), Text::plain("coexisting attractors")));
    }
    legend.extend(marks.legend().map(|(symbol, words)| (Mark::Symbol(symbol), words)));
    legend.extend(marks.left_out().map(|words| (Mark::Nothing, Text::plain(&words))));
    let style = PointStyle {
        sorts: looks.into_iter().map(sort).collect(),
        // Points stand out on both sides of the lines through them.
        beside_lines: 1.4,
    };
    let drawn = diagram.draw(view, &style, legend, |canvas, panel, output| {
        shade(canvas, panel, &windows);
        mark_zero(canvas, panel, output, view);
    });
    Ok(drawn.noting(marks.left_out()))
}

/// What the diagram shows over `x_name`, along which `attractors` are known, for a screen that draws it itself.
pub fn sorted<'a>(
    view: &View<'_>,
    x_name: &'a str,
    attractors: &Attractors<'a>,
) -> Result<Sorted<'a>, FigureError> {
    let looks = attractors.looks();
    let (contents, marks) = contents(view, x_name, attractors, &looks)?;
    let windows = match view.shows("coexistence") {
        true => windows(&contents.cases.values, attractors),
        false => Vec::new(),
    };
    let sorts = looks.into_iter().map(|look| (look.name(), attractors.colour(look))).collect();
    Ok(Sorted { contents, sorts, windows, left_out: marks.left_out() })
}

/// What the diagram shows, and the events that its symbols stand for.
fn contents<'a>(
    view: &View<'_>,
    x_name: &'a str,
    attractors: &Attractors<'a>,
    looks: &[Look],
) -> Result<(Contents<'a>, EventMarks), FigureError> {
    let outputs = outputs(view);
    let factor = view.quantity(x_name).factor;
    let values = view.axis_values(x_name)?.iter().map(|value| value * factor).collect();
    let (free, per_value) = (attractors.free.clone(), attractors.per_value);
    let cases = Cases { axis: x_name, free, values, per_value };
    let mut contents = Contents::of_branches(view, cases, outputs);
    contents.paint = paint(view, &contents.cases)?;
    let outputs = &contents.outputs;
    let clouds = outputs.iter().map(|it| points(view, it, &contents, attractors, looks));
    contents.clouds = clouds.collect::<Result<_, _>>()?;
    let outputs = &contents.outputs;
    let has_section =
        section(view.model()).iter().any(|entry| outputs.iter().any(|it| it == entry.name));
    let marks = match has_section && view.shows("events") {
        true => EventMarks::of(view, x_name, attractors)?,
        false => EventMarks::none(),
    };
    contents.symbols = outputs.iter().map(|output| marks.on(view, output)).collect();
    contents.measured = MeasuredPoints::over(view, x_name, &contents.outputs)?;
    Ok((contents, marks))
}

/// What is drawn, a panel each.
fn outputs(view: &View<'_>) -> Vec<String> {
    if !view.drawing.of.is_empty() {
        return view.drawing.of.clone();
    }
    let usual = usual_panels(view.model());
    let held = usual.iter().filter(|entry| view.dataset.variable(entry.name).is_some());
    held.map(|entry| entry.name.to_owned()).collect()
}

/// How the points of a look are drawn.
fn sort(look: Look) -> Sort {
    let size = if look == Look::Undecided { 0.6 } else { 1.0 };
    Sort { name: look.name(), size }
}

/// The points of `output` in each look.
fn points(
    view: &View<'_>,
    output: &str,
    contents: &Contents<'_>,
    attractors: &Attractors<'_>,
    looks: &[Look],
) -> Result<Vec<Vec<Dot>>, FigureError> {
    let numbers = numbers(view, output, &attractors.free)?;
    let mut clouds: Vec<Vec<Dot>> = looks.iter().map(|_| Vec::new()).collect();
    for case in 0..contents.cases.count() {
        let look = attractors.look(case);
        let Some(cloud) = looks.iter().position(|it| Some(*it) == look) else { continue };
        clouds[cloud].extend(contents.dots(case, &numbers, attractors.colour(looks[cloud])));
    }
    Ok(clouds)
}

/// The ranges of the axis in which attractors coexist, as shares of the axis of cells.
fn windows(values: &[f64], attractors: &Attractors<'_>) -> Vec<[f64; 2]> {
    if values.len() < 2 {
        return Vec::new();
    }
    let (cells, coexist) = (Cells::around(values), attractors.coexist());
    let mut windows: Vec<[f64; 2]> = Vec::new();
    let mut before = false;
    for place in 0..cells.count() {
        let here = coexist[cells.place(place)];
        let [from, to] = cells.range(place).map(|share| cells.scale.value(share));
        match windows.last_mut() {
            Some(window) if here && before => window[1] = to,
            _ if here => windows.push([from, to]),
            _ => {}
        }
        before = here;
    }
    windows
}

fn shade(canvas: &mut Canvas, panel: &Panel, windows: &[[f64; 2]]) {
    let Rect { left, top, right, bottom } = panel.frame;
    for [from, to] in windows {
        let [from, to] = [from, to].map(|x| panel.place(*x, panel.y.scale.low).0);
        let band =
            Rect { left: from.clamp(left, right), top, right: to.clamp(left, right), bottom };
        canvas.fill(band, COEXISTENCE);
    }
}

/// A line at zero: always for the exponent, whose sign matters, else where both signs occur.
fn mark_zero(canvas: &mut Canvas, panel: &Panel, output: &str, view: &View<'_>) {
    if output == view.model().exponent().name() && !panel.y.empty {
        let zero = [(panel.x.scale.low, 0.0), (panel.x.scale.high, 0.0)];
        panel.curve(canvas, &zero, Stroke::solid(FAINT_INK, MINOR_WIDTH));
    } else if !has_points(view, output) {
        panel.mark_zero(canvas);
    }
}

/// What the colours of the looks mean, of those that are seen.
fn legend_of_looks(looks: &BTreeSet<Look>, attractors: &Attractors<'_>) -> Vec<header::Entry> {
    let mut legend = Vec::new();
    // One alone needs no name.
    let several = looks.len() > 1;
    for look in looks.iter().filter(|_| several) {
        let Look::Own(number) = look else { continue };
        // Of several the first says what the numbers are of.
        let words = if legend.is_empty() { look.name() } else { number.to_string() };
        legend.push((Mark::Disc(attractors.colour(*look), 1.8), Text::plain(&words)));
    }
    for (look, words) in [(Look::Other, "further attractors"), (Look::Undecided, "undecided")] {
        if looks.contains(&look) {
            legend.push((Mark::Disc(attractors.colour(look), 1.4), Text::plain(words)));
        }
    }
    legend
}
