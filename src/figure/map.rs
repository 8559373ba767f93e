//! One output over two axes, in colours.

use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn};
use super::category;
use super::curves::{self, Curve, Ground, draw_curves, specials};
use super::error::FigureError;
use super::geometry::Rect;
use super::header::{self, Header, Mark};
use super::inferred;
use super::kind::{Kind, Names, Needs};
use super::outcome::{self, Outcomes};
use super::page::{NO_ROOM, PageRequest, PanelRequest, letter};
use super::paint::Paint;
use super::panel::{Panel, Pointing};
use super::plane::{Heights, Plane, contour};
use super::quantity::Quantity;
use super::raster::Fill;
use super::style::{ONE_COLUMN, TWO_COLUMNS};
use super::text::Text;
use super::thinned::{Thinned, with_told};
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
    let mut map = Map::of(view)?;
    // Which symbols would overlap is known once the panels have their places.
    map.thinned = map.page(view).first().map(|panel| Thinned::of(panel, specials(&map.curves)));
    let page = PageRequest { right_room: &|height| map.paint.room(height), ..map.request(view) };
    let (mut canvas, panels) = page.lay_out();
    let all: Vec<&Panel> = panels.iter().flatten().collect();
    for (number, panel) in all.iter().enumerate() {
        map.draw(&mut canvas, panel, number);
        panel.finish(&mut canvas);
    }
    if let (Some(first), Some(last)) = (all.first(), all.last()) {
        let right = all.iter().map(|panel| panel.frame.right).fold(f64::MIN, f64::max);
        map.paint.explain(&mut canvas, Rect { right, bottom: last.frame.bottom, ..first.frame });
    }
    let names = map.plane.names();
    let [x, y] = names;
    let without = (view.drawing.curves && map.curves.is_empty())
        .then(|| format!("there are no curves in {x} and {y}; `capsulemap continue` finds them"));
    let about = view.about(&[map.output], &names);
    Ok(canvas.finish(&about).noting(without).noting(map.contours.note()))
}

/// The output shown: the speed, unless another is asked for.
fn output(drawing: &Drawing, model: &'static Description) -> String {
    drawing.of.first().cloned().unwrap_or_else(|| model.main_output().name().to_owned())
}

/// The colours of the cases of all panels over a plane.
pub(super) fn paint(
    view: &View<'_>,
    panels: &[View<'_>],
    plane: &Plane<'_>,
) -> Result<Paint, FigureError> {
    let (output, free) = (&output(view.drawing, view.model()), plane.free());
    let seen = plane.seen(view);
    match (view.drawing.sweep, panels) {
        (Some(Sweep::Difference), [first]) => {
            let second = first.swept(Direction::Downward)?;
            Paint::of_difference([first, &second], output, &free, &seen)
        }
        (Some(Sweep::Difference), _) => {
            Err(view.unfit("the difference of two sweeps has one panel, and `at` asks for several"))
        }
        _ => Paint::of(view, panels, output, &free, &seen),
    }
}

/// What a map shows, in one panel or several.
struct Map<'a> {
    plane: Plane<'a>,
    /// The output shown.
    output: String,
    /// What each panel shows, row by row.
    panels: Vec<View<'a>>,
    /// How many panels each row has.
    lengths: Vec<usize>,
    /// The colours of the cases of one panel after the other.
    paint: Paint,
    /// Whether each of these cases is seen.
    seen: Vec<bool>,
    contours: Contours,
    /// The curves of special points.
    curves: Vec<Curve>,
    /// Their special points that are drawn, alike on all panels.
    thinned: Option<Thinned>,
    /// Which part of the cases is inferred, if any is, and how well.
    inferred: Vec<String>,
}

impl<'a> Map<'a> {
    /// What the figure shows of the results.
    fn of(view: &View<'a>) -> Result<Map<'a>, FigureError> {
        let plane = Plane::of(view, "a map")?;
        let output = output(view.drawing, view.model());
        let rows = view.panels();
        let lengths = rows.iter().map(Vec::len).collect();
        let panels: Vec<View<'a>> = rows.into_iter().flatten().collect();
        let mut paint = paint(view, &panels, &plane)?;
        let seen = plane.seen(view).repeat(panels.len());
        let contours = Contours::of(view.quantity(&output), &paint, &seen);
        paint.list(|case| seen[case]);
        let inferred = told_of_inferred(&panels, &plane)?;
        let curves = match view.drawing.curves {
            true => curves::curves(view, &plane.names().map(str::to_owned)),
            false => Vec::new(),
        };
        Ok(Map {
            plane,
            output,
            panels,
            lengths,
            paint,
            seen,
            contours,
            curves,
            thinned: None,
            inferred,
        })
    }

    /// The panels in their places, as far as these are known without what is said of symbols.
    fn page(&self, view: &View<'_>) -> Vec<Panel> {
        let page =
            PageRequest { right_room: &|height| self.paint.room(height), ..self.request(view) };
        page.lay_out().1.into_iter().flatten().collect()
    }

    /// The page of the panels, the numbers of whose axes stand where no panel lies beyond.
    fn request<'d>(&self, view: &View<'d>) -> PageRequest<'d> {
        let columns = self.lengths.iter().copied().max().unwrap_or(1);
        let mut panels = (0..self.panels.len()).map(|number| self.panel(number, columns));
        let rows: Vec<Vec<PanelRequest>> =
            self.lengths.iter().map(|length| panels.by_ref().take(*length).collect()).collect();
        let usual = if self.panels.len() == 1 { HEIGHT } else { HEIGHT_OF_SEVERAL };
        // A list of kinds that is longer than the frames makes them higher.
        let height = usual.max(self.paint.least_height() / rows.len() as f64);
        PageRequest {
            drawing: view.drawing,
            width_mm: if columns > 2 { TWO_COLUMNS } else { ONE_COLUMN },
            heights: vec![height; rows.len()],
            rows,
            column_room: NO_ROOM,
            right_room: NO_ROOM,
            bottom_room: 0.0,
            pointing: Pointing::Outward,
        }
    }

    /// A panel by its number, on a page of so many columns.
    fn panel(&self, number: usize, columns: usize) -> PanelRequest {
        let (view, count) = (&self.panels[number], self.panels.len());
        let (is_lowest, is_first) = (number + columns >= count, number.is_multiple_of(columns));
        let x = AxisRequest::new(view.quantity(self.plane.x_name), self.plane.x.scale);
        let y = AxisRequest::new(view.quantity(self.plane.y_name), self.plane.y.scale);
        PanelRequest {
            x: AxisRequest { labelled: is_lowest, numbered: is_lowest, ..x },
            y: AxisRequest { labelled: is_first, numbered: is_first, ..y },
            header: Header {
                letter: letter(number, count),
                note: view.held_note(&self.plane.names()),
                legend: if number == 0 { self.legend() } else { Vec::new() },
            },
        }
    }

    /// What the colours and the lines mean, beside the bar or the list of kinds.
    fn legend(&self) -> Vec<header::Entry> {
        let mut legend = self.paint.legend(|case| self.seen[case]);
        legend.extend(self.inferred.iter().map(|it| (Mark::Nothing, Text::plain(it))));
        legend.extend(self.plane.legend());
        legend.extend(self.contours.legend());
        legend.extend(curves::legend(&self.curves));
        match &self.thinned {
            Some(thinned) => with_told(legend, std::slice::from_ref(thinned)),
            None => legend,
        }
    }

    /// Draws the cells of a panel, by its number, and the lines over them.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, number: usize) {
        let (plane, paint) = (&self.plane, &self.paint);
        let first = number * plane.count();
        plane.draw(canvas, panel, |case| Fill::of(paint.colour(first + case)));
        plane.record(canvas, panel, &paint.told(), |case| paint.value(first + case));
        if let Paint::Numbers(_, values, _) = paint {
            let values = &values[first..first + plane.count()];
            let heights = Heights { values, noise: self.contours.quantity.noise };
            plane.draw_contours(canvas, panel, &heights, &self.contours.levels);
        }
        draw_curves(canvas, panel, &self.curves, Ground::Colours);
        if let Some(thinned) = &self.thinned {
            thinned.draw(canvas, panel);
        }
    }
}

/// What is inferred of the cases of all panels.
fn told_of_inferred(panels: &[View<'_>], plane: &Plane<'_>) -> Result<Vec<String>, FigureError> {
    let mut all = Vec::new();
    for view in panels {
        all.extend(inferred::inferred(&Outcomes::over(view, &plane.free())?, plane.count()));
    }
    Ok(panels.first().map_or(Vec::new(), |it| inferred::told(it, &all, "cases", "differ")))
}

/// The contour lines of an output.
struct Contours {
    quantity: Quantity,
    /// The values at which there are lines among the cases that are seen, in the unit shown.
    levels: Vec<f64>,
    /// Those that are asked for and at which there are none.
    without: Vec<f64>,
}

impl Contours {
    /// Those that the request sets, where cases have numbers.
    fn of(quantity: Quantity, paint: &Paint, seen: &[bool]) -> Contours {
        let mut contours = Contours { quantity, levels: Vec::new(), without: Vec::new() };
        let Paint::Numbers(_, values, _) = paint else { return contours };
        let seen: Vec<f64> =
            values.iter().zip(seen).filter(|(_, seen)| **seen).map(|(value, _)| *value).collect();
        for level in contours.quantity.chosen.contours() {
            let level = level * contours.quantity.factor;
            let is_crossed =
                seen.iter().any(|it| *it <= level) && seen.iter().any(|it| *it >= level);
            match is_crossed {
                true => contours.levels.push(level),
                false => contours.without.push(level),
            }
        }
        contours
    }

    /// What the lines mean.
    fn legend(&self) -> Vec<header::Entry> {
        let unit = match self.quantity.unit().is_empty() {
            true => Text::default(),
            false => Text::plain("\u{a0}").then(self.quantity.unit()),
        };
        let mut legend = Vec::new();
        for (place, level) in self.levels.iter().enumerate() {
            let value = Text::markup(&short(*level)).then(unit.clone());
            legend.push((Mark::Line(contour(place)), value));
        }
        legend
    }

    /// Which of them there are not, if any.
    fn note(&self) -> Option<String> {
        let numbers: Vec<String> = self.without.iter().map(ToString::to_string).collect();
        let unit = self.quantity.unit().content();
        let numbers = (!numbers.is_empty()).then(|| numbers.join(", "))?;
        Some(format!("no contour at {numbers} {unit}: all values lie on one side"))
    }
}
