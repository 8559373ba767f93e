//! A bifurcation diagram by attractors: each in its colour, windows of coexistence shaded, events marked.

use std::collections::BTreeSet;

use super::attractors::{Attractors, Look};
use super::axis::AxisRequest;
use super::branch_lines::BranchLines;
use super::canvas::{Canvas, Drawn, Stroke};
use super::cells::Cells;
use super::cloud::{self, Dot};
use super::diagram::{
    Shown, explain, has_points, nothing_within, paint, request, seen, span, told,
    with_branch_lines, with_paint,
};
use super::error::FigureError;
use super::event_marks::EventMarks;
use super::geometry::{Point, Rect};
use super::header::{self, Mark};
use super::measured::MeasuredPoints;
use super::page::PageRequest;
use super::paint::Paint;
use super::panel::Panel;
use super::scale::Scale;
use super::style::{COEXISTENCE, FAINT_INK, MINOR_WIDTH, UNDECIDED_DOT};
use super::symbol::Symbol;
use super::text::Text;
use super::track::elsewhere;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{Entry, section};

/// Panels of the diagram, unless others are asked for: those of them that the results hold.
pub fn usual_panels(model: &'static Description) -> Vec<Entry> {
    let outputs = model.gain_and_work().into_iter().chain([model.exponent()]);
    section(model).into_iter().take(1).chain(outputs.map(Entry::of_output)).collect()
}

/// Symbols of one kind nearer than this would hide each other [pt].
const SYMBOL_SPACING: f64 = 2.6;

/// Draws the diagram that `view` asks for over `x_name`, along which `attractors` are known.
pub fn draw(
    view: &View<'_>,
    x_name: &str,
    attractors: &Attractors<'_>,
) -> Result<Drawn, FigureError> {
    let outputs = outputs(view);
    let quantity = view.quantity(x_name);
    let values: Vec<f64> =
        view.axis_values(x_name)?.iter().map(|value| value * quantity.factor).collect();
    let looks = looks(attractors);
    let mut paint = paint(view, &attractors.free, values.len())?;
    let clouds = outputs
        .iter()
        .map(|output| points(view, output, &values, (attractors, paint.as_ref()), &looks))
        .collect::<Result<Vec<_>, _>>()?;
    let has_section =
        section(view.model()).iter().any(|entry| outputs.iter().any(|it| it == entry.name));
    let marks = match has_section && view.shows("events") {
        true => EventMarks::of(view, x_name, attractors)?,
        false => EventMarks::none(),
    };
    let mut windows = windows(&values, attractors);
    let lines: Vec<BranchLines> =
        outputs.iter().map(|output| BranchLines::shown(view, x_name, output)).collect();
    let measured = MeasuredPoints::over(view, x_name, &outputs)?;
    let of_branches = lines.iter().flat_map(BranchLines::places).map(|at| at.0);
    let reached: Vec<f64> = of_branches.chain(measured.abscissae()).collect();
    let abscissa = AxisRequest::new(quantity, span(&values, &reached));
    // Other limits may be set than those of the values.
    let Scale { low, high, .. } = abscissa.scale;
    windows.retain(|[from, to]| *from < high && *to > low && view.shows("coexistence"));
    let is_seen = seen(&abscissa, &values, attractors.per_value);
    if let Some(paint) = &mut paint {
        paint.list(&is_seen);
    }
    let left_out = elsewhere(view, &[x_name]).or(nothing_within(&abscissa, &values, &reached));
    let note = view.note(&attractors.free, &left_out);
    let symbols: Vec<Vec<(Symbol, f64, f64)>> =
        outputs.iter().map(|output| marks.on(view, output)).collect();
    let mut page = request(
        view,
        &outputs,
        &Shown { clouds: &clouds, lines: &lines, symbols: &symbols, measured: &measured },
        abscissa,
        note,
    );
    if let Some(first) = page.rows.first_mut().and_then(|row| row.first_mut()) {
        first.header.legend =
            legend((&attractors.seen(&is_seen), paint.is_some()), &marks, !windows.is_empty());
    }
    page.rows =
        with_paint(with_branch_lines(page.rows, &clouds, &lines), (paint.as_ref(), &is_seen));
    page.rows = measured.with_legend(page.rows, &clouds);
    let room = |height: f64| paint.as_ref().map_or(0.0, |it| it.room(height));
    let (mut canvas, panels) = PageRequest { right_room: &room, ..page }.lay_out();
    let shown = clouds.iter().zip(&lines).zip(outputs.iter().zip(&symbols));
    for (index, (panel, ((cloud, lines), (output, symbols)))) in
        panels.iter().flatten().zip(shown).enumerate()
    {
        shade(&mut canvas, panel, &windows);
        mark_zero(&mut canvas, panel, output, view);
        // Points stand out on both sides of the lines through them.
        let wider = if lines.is_empty() { 1.0 } else { 1.4 };
        let radius = wider * view.radius(cloud::count(panel, cloud));
        for (dots, look) in cloud.iter().zip(&looks) {
            let share = if *look == Look::Undecided { 0.6 } else { 1.0 };
            cloud::draw(&mut canvas, panel, dots, radius * share);
            panel.record_values(&mut canvas, &look.name(), told(dots, paint.as_ref()));
        }
        draw_symbols(&mut canvas, panel, symbols);
        lines.draw(&mut canvas, panel);
        measured.draw(&mut canvas, panel, index);
        panel.finish(&mut canvas);
    }
    explain(&mut canvas, &panels, paint.as_ref());
    let outside = measured.left_out(&panels);
    Ok(canvas
        .finish(&view.about(&outputs, &attractors.free))
        .noting(left_out)
        .noting(outside)
        .noting(marks.left_out()))
}

/// Draws symbols, without those that would hide an earlier one of their kind.
fn draw_symbols(canvas: &mut Canvas, panel: &Panel, symbols: &[(Symbol, f64, f64)]) {
    let mut drawn: Vec<(Symbol, Point)> = Vec::new();
    for (symbol, x, y) in symbols {
        let at = panel.place(*x, *y);
        let hides = |(other, there): &(Symbol, Point)| {
            other == symbol && (at.0 - there.0).hypot(at.1 - there.1) < SYMBOL_SPACING
        };
        if panel.holds(*x, *y) && !drawn.iter().any(hides) {
            symbol.draw(canvas, at);
            panel.record(canvas, symbol.words, [(*x, *y)]);
            drawn.push((*symbol, at));
        }
    }
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

/// The looks in the order in which they are drawn.
fn looks(attractors: &Attractors<'_>) -> Vec<Look> {
    let own = (0..attractors.own.len()).map(Look::Own);
    [Look::Undecided, Look::Other].into_iter().chain(own).collect()
}

/// The points of `output` in each look.
fn points(
    view: &View<'_>,
    output: &str,
    x_values: &[f64],
    (attractors, paint): (&Attractors<'_>, Option<&Paint>),
    looks: &[Look],
) -> Result<Vec<Vec<Dot>>, FigureError> {
    let array = view.shown(output, &attractors.free)?;
    let cases = x_values.len() * attractors.per_value;
    let per_case = array.len().checked_div(cases).unwrap_or(0);
    let values: Vec<f64> = array.iter().copied().collect();
    let mut clouds: Vec<Vec<Dot>> = looks.iter().map(|_| Vec::new()).collect();
    for case in 0..cases {
        let look = attractors.look(case);
        let Some(cloud) = looks.iter().position(|it| Some(*it) == look) else { continue };
        let shown = &values[case * per_case..(case + 1) * per_case];
        let finite: Vec<f64> = shown.iter().copied().filter(|it| it.is_finite()).collect();
        let crowding = (finite.len() * x_values.len()) as f64;
        let own = paint.map(|it| it.colour(case).unwrap_or(UNDECIDED_DOT));
        let (x, colour) =
            (x_values[case / attractors.per_value], own.unwrap_or(looks[cloud].colour()));
        clouds[cloud].extend(finite.into_iter().map(|y| Dot {
            at: (x, y),
            colour,
            crowding,
            case,
        }));
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

fn legend(
    (looks, has_own_colours): (&BTreeSet<Look>, bool),
    marks: &EventMarks,
    shaded: bool,
) -> Vec<header::Entry> {
    let mut legend = Vec::new();
    let is_own = |look: &&Look| matches!(look, Look::Own(_)) && !has_own_colours;
    let own: Vec<Look> = looks.iter().filter(is_own).copied().collect();
    match own.as_slice() {
        [] | [_] => {}
        [a, b, c, _, ..] => {
            let discs = Mark::Discs([a, b, c].map(|look| look.colour()), 1.8);
            legend.push((discs, Text::plain("attractors, each in its colour")));
        }
        few => legend.extend(
            few.iter().map(|look| (Mark::Disc(look.colour(), 1.8), Text::plain(&look.name()))),
        ),
    }
    for (look, words) in [(Look::Other, "further attractors"), (Look::Undecided, "undecided")] {
        if looks.contains(&look) && !has_own_colours {
            legend.push((Mark::Disc(look.colour(), 1.4), Text::plain(words)));
        }
    }
    if shaded {
        legend.push((Mark::Patch(COEXISTENCE), Text::plain("coexistence")));
    }
    legend.extend(marks.legend().map(|(symbol, words)| (Mark::Symbol(symbol), words)));
    legend
}
