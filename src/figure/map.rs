//! One output over two axes, in colours.

use super::axis::AxisRequest;
use super::canvas::Drawn;
use super::category;
use super::curves;
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{Header, Mark};
use super::inferred;
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::paint::Paint;
use super::panel::{Panel, Pointing};
use super::plane::{Plane, contour};
use super::raster::Fill;
use super::style::{ONE_COLUMN, TWO_COLUMNS};
use super::text::Text;
use super::ticks::short;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{self, Type};
use crate::study::{Direction, Drawing, Sweep};

/// Height of the frame [pt].
const HEIGHT: f64 = 158.0;
/// Height of each of several frames [pt].
const HEIGHT_OF_SEVERAL: f64 = 100.0;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What a map reads: its output, the outcomes, and what sorts cases where it shows kinds of them.
fn reads(drawing: &Drawing, model: &'static Description) -> Names {
    let output = output(drawing, model);
    let output = output.as_str();
    let entry = catalogue::named(output, model);
    let sorted = entry.is_none_or(|entry| !matches!(entry.numbers, Type::Real));
    let sorting = category::reads(model).into_iter().filter(|_| sorted);
    let names = Names::of(outcome::READS).and(inferred::READS).and(sorting);
    let names = names.and_named([output.to_owned()]);
    if drawing.curves { names.and_all(curves::reads(drawing, model)) } else { names }
}

/// Draws the map that `view` asks for, or one for each of several values of other axes.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let plane = Plane::of(view, "a map")?;
    let names = [plane.x_name, plane.y_name];
    let output = output(view.drawing, view.model());
    let rows = view.panels();
    let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
    let views: Vec<View<'_>> = rows.into_iter().flatten().collect();
    let mut paint = paint((view, &views), &plane)?;
    let seen = plane.seen(view);
    let is_seen = |case: usize| seen[case % plane.count()];
    let (levels, no_line) = levels(view, &output, &paint, is_seen);
    paint.list(is_seen);
    let legend =
        paint.legend(is_seen).into_iter().chain(told(&views, &plane)?).chain(plane.legend());
    let legend = legend.chain(contours(view, &output, &levels));
    let over = match view.drawing.curves {
        true => curves::curves(view, &names.map(str::to_owned)),
        false => Vec::new(),
    };
    let legend = legend.chain(curves::legend(&over));
    let mut page = page(view, (&plane, &views, &lengths), legend.collect());
    // A list of kinds that is longer than the frames makes them higher.
    let least = paint.least_height() / page.heights.len() as f64;
    page.heights.iter_mut().for_each(|height| *height = height.max(least));
    let room = |height: f64| paint.room(height);
    let (mut canvas, panels) = PageRequest { right_room: &room, ..page }.lay_out();
    let all: Vec<&Panel> = panels.iter().flatten().collect();
    for (number, panel) in all.iter().enumerate() {
        let first = number * plane.count();
        plane.draw(&mut canvas, panel, |case| Fill::of(paint.colour(first + case)));
        plane.record(&mut canvas, panel, (&paint.told(), |case| paint.value(first + case)));
        if let Paint::Numbers(_, values, _) = &paint {
            let of_panel = &values[first..first + plane.count()];
            let noise = view.quantity(&output).noise;
            plane.draw_contours(&mut canvas, panel, (of_panel, noise), &levels);
        }
        curves::draw_curves(&mut canvas, panel, &over);
        panel.finish(&mut canvas);
    }
    if let (Some(first), Some(last)) = (all.first(), all.last()) {
        let right = all.iter().map(|panel| panel.frame.right).fold(f64::MIN, f64::max);
        paint.explain(&mut canvas, Rect { right, bottom: last.frame.bottom, ..first.frame });
    }
    let [x, y] = names;
    let without = (view.drawing.curves && over.is_empty())
        .then(|| format!("there are no curves in {x} and {y}; `capsulemap continue` finds them"));
    Ok(canvas.finish(&view.about(&[output], &names)).noting(without).noting(no_line))
}

/// The output shown: the speed, unless another is asked for.
fn output(drawing: &Drawing, model: &'static Description) -> String {
    drawing.of.first().cloned().unwrap_or_else(|| model.main_output().name().to_owned())
}

/// The colours of the cases of all panels over a plane.
pub(super) fn paint(
    (view, panels): (&View<'_>, &[View<'_>]),
    plane: &Plane<'_>,
) -> Result<Paint, FigureError> {
    let (output, free) = (&output(view.drawing, view.model()), plane.free());
    let cases: (&[&str], usize) = (&free, plane.count());
    match (view.drawing.sweep, panels) {
        (Some(Sweep::Difference), [first]) => {
            let second = first.swept(Direction::Downward)?;
            Paint::of_difference([first, &second], output, cases)
        }
        (Some(Sweep::Difference), _) => {
            Err(view.unfit("the difference of two sweeps has one panel, and `at` asks for several"))
        }
        _ => Paint::of((view, panels), output, cases),
    }
}

/// The values at which there are contour lines among the cases that are seen, in the unit shown, and a note on those at which
/// there are none.
fn levels(
    view: &View<'_>,
    output: &str,
    paint: &Paint,
    is_seen: impl Fn(usize) -> bool,
) -> (Vec<f64>, Option<String>) {
    let quantity = view.quantity(output);
    let Paint::Numbers(_, values, _) = paint else { return (Vec::new(), None) };
    let asked = quantity.chosen.contours().iter().map(|it| it * quantity.factor);
    let seen = || values.iter().enumerate().filter(|(case, _)| is_seen(*case)).map(|it| *it.1);
    let is_crossed = |level: &f64| seen().any(|it| it <= *level) && seen().any(|it| it >= *level);
    let (levels, without): (Vec<f64>, Vec<f64>) = asked.partition(is_crossed);
    let numbers: Vec<String> = without.iter().map(ToString::to_string).collect();
    let unit = quantity.unit().content();
    let note = format!("no contour at {} {unit}: all values lie on one side", numbers.join(", "));
    (levels, (!without.is_empty()).then_some(note))
}

/// What the contour lines mean.
fn contours(view: &View<'_>, output: &str, levels: &[f64]) -> Vec<(Mark, Text)> {
    let quantity = view.quantity(output);
    let unit = Text::plain("\u{a0}").then(quantity.unit());
    let unit = if quantity.unit().is_empty() { Text::default() } else { unit };
    let entry = |(place, level): (usize, &f64)| {
        (Mark::Line(contour(place)), Text::markup(&short(*level)).then(unit.clone()))
    };
    levels.iter().enumerate().map(entry).collect()
}

/// What is inferred of the cases of all panels.
fn told(views: &[View<'_>], plane: &Plane<'_>) -> Result<Vec<(Mark, Text)>, FigureError> {
    let mut all = Vec::new();
    for view in views {
        all.extend(inferred::inferred(&Outcomes::over(view, &plane.free())?, plane.count()));
    }
    let told = views.first().map_or(Vec::new(), |it| inferred::told(it, &all, "cases", "differ"));
    Ok(told.iter().map(|it| (Mark::Nothing, Text::plain(it))).collect())
}

/// The page of some panels in rows of these lengths.
fn page<'a>(
    view: &View<'a>,
    (plane, views, lengths): (&Plane<'_>, &[View<'_>], &[usize]),
    legend: Vec<(Mark, Text)>,
) -> PageRequest<'a> {
    let names = [plane.x_name, plane.y_name];
    let columns = lengths.iter().copied().max().unwrap_or(1);
    let is_alone = views.len() == 1;
    let mut number = 0;
    let mut rows = Vec::new();
    for length in lengths {
        let mut row = Vec::new();
        for column in 0..*length {
            // Numbers stand where no panel lies beyond.
            let (is_lowest, is_first) = (number + columns >= views.len(), column == 0);
            let x = AxisRequest::new(view.quantity(names[0]), plane.x.scale);
            let y = AxisRequest::new(view.quantity(names[1]), plane.y.scale);
            row.push(PanelRequest {
                x: AxisRequest { labelled: is_lowest, numbered: is_lowest, ..x },
                y: AxisRequest { labelled: is_first, numbered: is_first, ..y },
                header: Header {
                    letter: letter(number, views.len()),
                    note: views[number].held_note(&names),
                    legend: if number == 0 { legend.clone() } else { Vec::new() },
                },
            });
            number += 1;
        }
        rows.push(row);
    }
    let width = if columns > 2 { TWO_COLUMNS } else { ONE_COLUMN };
    PageRequest {
        drawing: view.drawing,
        width_mm: width,
        heights: vec![if is_alone { HEIGHT } else { HEIGHT_OF_SEVERAL }; lengths.len()],
        rows,
        column_room: NO_ROOM,
        right_room: NO_ROOM,
        bottom_room: 0.0,
        pointing: Pointing::Outward,
    }
}
