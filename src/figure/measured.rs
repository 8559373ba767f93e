//! Points of an experiment over a diagram of the same quantities.

use super::canvas::{Canvas, Dash, Stroke};
use super::error::FigureError;
use super::geometry::Point;
use super::header::{Entry, Mark};
use super::panel::Panel;
use super::style::{INK, MINOR_WIDTH};
use super::symbol::MEASURED;
use super::text::Text;
use super::view::View;
use crate::campaign::count::counted;

/// The line from a measured value to the ends of its error.
const BAR: Stroke = Stroke { colour: INK, width: MINOR_WIDTH, dash: Dash::None };
/// Half the length of the strokes that end it [pt].
const END: f64 = 1.4;

/// A measured point, in the units of the axes.
struct MeasuredPoint {
    at: (f64, f64),
    /// How far it may be off along each axis; NaN where that was not told.
    errors: [f64; 2],
}

impl MeasuredPoint {
    /// The ends of its errors, along one axis and along the other.
    fn bars(&self) -> impl Iterator<Item = (usize, [(f64, f64); 2])> {
        let ((x, y), [of_x, of_y]) = (self.at, self.errors);
        let bars = [[(x - of_x, y), (x + of_x, y)], [(x, y - of_y), (x, y + of_y)]];
        bars.into_iter().enumerate().filter(|(along, _)| self.errors[*along] > 0.0)
    }
}

/// The measured points on the panels of a diagram.
pub struct MeasuredPoints {
    panels: Vec<Vec<MeasuredPoint>>,
    /// How many rows of each panel have no value on one of its axes, and what is told of it.
    without: Vec<Option<String>>,
}

impl MeasuredPoints {
    /// No points of any of the `outputs`.
    pub fn none(outputs: &[String]) -> MeasuredPoints {
        MeasuredPoints {
            panels: outputs.iter().map(|_| Vec::new()).collect(),
            without: outputs.iter().map(|_| None).collect(),
        }
    }

    /// Whether there are no points at all.
    pub fn is_empty(&self) -> bool {
        self.panels.iter().all(Vec::is_empty)
    }

    /// The points of each of the `outputs` over the axis `x`; none where nothing was measured.
    ///
    /// Fails where the axis was not measured, or none of the outputs.
    pub fn over(
        view: &View<'_>,
        x: &str,
        outputs: &[String],
    ) -> Result<MeasuredPoints, FigureError> {
        let Some(measured) = view.measured else { return Ok(MeasuredPoints::none(outputs)) };
        let names: Vec<&str> = measured.columns.iter().map(|it| it.0.as_str()).collect();
        let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        let Some(abscissae) = measured.column(x) else {
            let why = format!("the measured points have no column {x} (their columns: {names})");
            return Err(view.unfit(why));
        };
        if !outputs.iter().any(|output| measured.column(output).is_some()) {
            let outputs = outputs.join(", ");
            let why = format!(
                "the measured points have a column of none of {outputs} (their columns: {names})"
            );
            return Err(view.unfit(why));
        }
        let (mut panels, mut without) = (Vec::new(), Vec::new());
        for output in outputs {
            let names = [x, output.as_str()];
            let factors = names.map(|name| view.quantity(name).factor);
            let errors = names.map(|name| measured.column(&error_of(name)));
            let mut points = Vec::new();
            let ordinates = measured.column(output).unwrap_or(&[]);
            let mut missing = 0;
            for (row, (x, y)) in abscissae.iter().zip(ordinates).enumerate() {
                if x.is_nan() || y.is_nan() {
                    missing += 1;
                    continue;
                }
                let error = |i: usize| errors[i].map_or(f64::NAN, |all| all[row] * factors[i]);
                points.push(MeasuredPoint {
                    at: (x * factors[0], y * factors[1]),
                    errors: [error(0), error(1)],
                });
            }
            panels.push(points);
            without.push((missing > 0).then(|| {
                let points = counted(missing, "measured point");
                let verb = if missing == 1 { "is" } else { "are" };
                let [x, y] = names;
                format!("{points} without a value of {x} or {y} {verb} left out")
            }));
        }
        Ok(MeasuredPoints { panels, without })
    }

    /// The abscissae of all points and of the ends of their errors.
    pub fn abscissae(&self) -> impl Iterator<Item = f64> {
        self.panels.iter().flatten().flat_map(places).map(|at| at.0)
    }

    /// The ordinates of the points on a panel and of the ends of their errors.
    pub fn ordinates(&self, panel: usize) -> impl Iterator<Item = f64> {
        self.panels.get(panel).into_iter().flatten().flat_map(places).map(|at| at.1)
    }

    /// What the points are.
    pub fn legend(&self) -> Entry {
        let has_errors = self.panels.iter().flatten().any(|it| it.bars().next().is_some());
        let more = if has_errors { ", with errors" } else { "" };
        (Mark::Symbol(MEASURED), Text::plain(&format!("{}{more}", MEASURED.words)))
    }

    /// Draws the points of a panel.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, index: usize) {
        canvas.notes.extend(self.without.get(index).cloned().flatten());
        let Some(points) = self.panels.get(index).filter(|it| !it.is_empty()) else { return };
        canvas.clipped(panel.frame, |canvas| {
            for (along, ends) in points.iter().flat_map(MeasuredPoint::bars) {
                draw_bar(canvas, along, ends.map(|(x, y)| panel.place(x, y)));
            }
        });
        let all: Vec<(f64, f64)> = points.iter().map(|it| it.at).collect();
        for place in panel.places(&all) {
            MEASURED.draw(canvas, place);
        }
        let inside = |at: &(f64, f64)| panel.holds(at.0, at.1);
        panel.record(canvas, MEASURED.words, all.into_iter().filter(inside));
        let errors = points.iter().flat_map(MeasuredPoint::bars).flat_map(|it| it.1);
        panel.record(canvas, "ends of measured errors", errors.filter(inside));
    }

    /// How many points lie outside the limits of their panels, in words.
    pub fn left_out(&self, panels: &[Vec<Panel>]) -> Option<String> {
        let mut outside = 0;
        for (points, panel) in self.panels.iter().zip(panels.iter().flatten()) {
            outside += points.iter().filter(|it| !panel.holds(it.at.0, it.at.1)).count();
        }
        match outside {
            0 => None,
            1 => Some("1 measured point lies outside the limits".to_owned()),
            count => Some(format!("{count} measured points lie outside the limits")),
        }
    }
}

/// The column that tells how far the values of a quantity may be off.
fn error_of(name: &str) -> String {
    format!("{name}_error")
}

/// Where a point and the ends of its errors are.
fn places(point: &MeasuredPoint) -> impl Iterator<Item = (f64, f64)> {
    std::iter::once(point.at).chain(point.bars().flat_map(|it| it.1))
}

/// Draws an error along an axis, 0 or 1, between its ends on the page.
fn draw_bar(canvas: &mut Canvas, along: usize, [from, to]: [Point; 2]) {
    let stroke = |(x, y): Point| match along {
        0 => ((x, y - END), (x, y + END)),
        _ => ((x - END, y), (x + END, y)),
    };
    canvas.segments(&[(from, to), stroke(from), stroke(to)], BAR);
}
