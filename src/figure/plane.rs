//! Two axes of a study as a plane of cells, one for each case.

use super::canvas::{Canvas, Dash, Stroke};
use super::cells::Cells;
use super::contour::Field;
use super::data::Value;
use super::error::FigureError;
use super::geometry::Rect;
use super::header::Mark;
use super::panel::Panel;
use super::raster::{Fill, Raster};
use super::style::{CURVE_WIDTH, FRAME_WIDTH, INK, PAPER};
use super::text::Text;
use super::view::View;

/// Length of the mark of a value of an uneven axis [pt].
const VALUE_MARK: f64 = 3.0;

/// Contour lines.
const CONTOUR: Stroke = Stroke { colour: INK, width: CURVE_WIDTH, dash: Dash::None };
/// How the lines of contours differ, in the order of their levels.
const DASHES: [Dash; 6] =
    [Dash::None, Dash::Usual, Dash::Dotted, Dash::Long, Dash::Mixed, Dash::Short];

/// The line of the contour at a level, by its place among the levels.
pub fn contour(place: usize) -> Stroke {
    Stroke { dash: DASHES[place % DASHES.len()], ..CONTOUR }
}

/// Two axes with their cells.
pub struct Plane<'a> {
    /// The axis along the abscissa.
    pub x_name: &'a str,
    /// The axis along the ordinate.
    pub y_name: &'a str,
    /// The cells along the abscissa.
    pub x: Cells,
    /// The cells along the ordinate.
    pub y: Cells,
}

impl<'a> Plane<'a> {
    /// The axes that the request names, or else the first that are free; `what` needs them.
    pub fn of(view: &View<'a>, what: &str) -> Result<Plane<'a>, FigureError> {
        let (x_name, y_name) = axes(view, what)?;
        Ok(Plane { x_name, y_name, x: cells(view, x_name)?, y: cells(view, y_name)? })
    }

    /// The axes over which cases are taken, the slower first.
    pub fn free(&self) -> [&'a str; 2] {
        [self.y_name, self.x_name]
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.x.count() * self.y.count()
    }

    /// Whether a part of the cell of each case over the free axes lies within the limits that are set.
    pub fn seen(&self, view: &View<'_>) -> Vec<bool> {
        let within = |cells: &Cells, name: &str| cells.within(view.quantity(name).limits());
        let (x, y) = (within(&self.x, self.x_name), within(&self.y, self.y_name));
        y.iter().flat_map(|row| x.iter().map(move |column| *row && *column)).collect()
    }

    /// Fills the cells over a panel, each as `fill` says for its case over the free axes, and marks the values of uneven
    /// axes at the upper and the right side of the frame.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, fill: impl Fn(usize) -> Fill) {
        let columns = self.x.count();
        // The limits of the axes may be others than those of the cells.
        let frame = panel.frame;
        let [left, bottom] = <[f64; 2]>::from(panel.place(self.x.scale.low, self.y.scale.low));
        let [right, top] = <[f64; 2]>::from(panel.place(self.x.scale.high, self.y.scale.high));
        let across = |at: f64| at.clamp(frame.left, frame.right);
        let down = |at: f64| at.clamp(frame.top, frame.bottom);
        let area =
            Rect { left: across(left), right: across(right), top: down(top), bottom: down(bottom) };
        if area.width() > 0.0 && area.height() > 0.0 {
            let x = |share: f64| (area.left + share * area.width() - frame.left) / frame.width();
            let y = |share: f64| (frame.bottom - area.top - share * area.height()) / frame.height();
            let raster = Raster::cells(
                area,
                |share| self.x.under(&panel.x.scale, x(share)),
                |share| self.y.under(&panel.y.scale, y(share)),
                |column, row| fill(row * columns + column),
            );
            canvas.image(area, &raster);
        }
        let up = |&value: &f64| {
            let (place, _) = panel.place(value, panel.y.scale.high);
            ((place, frame.top), (place, frame.top - VALUE_MARK))
        };
        let right = |&value: &f64| {
            let (_, place) = panel.place(panel.x.scale.high, value);
            ((frame.right, place), (frame.right + VALUE_MARK, place))
        };
        let above = self.x.uneven.iter().filter(|it| panel.x.scale.holds(**it)).map(up);
        let beside = self.y.uneven.iter().filter(|it| panel.y.scale.holds(**it)).map(right);
        let marks: Vec<_> = above.chain(beside).collect();
        canvas.segments(&marks, Stroke::solid(INK, FRAME_WIDTH));
    }

    /// Notes what the cells over a panel show, by the number of their case over the free axes.
    pub fn record(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        (series, value): (&str, impl Fn(usize) -> Value),
    ) {
        let columns = self.x.count();
        let (x, y): (Vec<f64>, Vec<f64>) = (self.x.values().collect(), self.y.values().collect());
        let cells = (0..y.len()).flat_map(|row| (0..x.len()).map(move |column| (row, column)));
        let cell = |(row, column): (usize, usize)| {
            let case = self.y.place(row) * columns + self.x.place(column);
            ((x[column], y[row]), value(case))
        };
        panel.record_values(canvas, series, cells.map(cell));
    }

    /// Draws the lines along which the values of the cases over the free axes have these levels, and both edges of where they
    /// keep one; differences up to `noise` are none.
    pub fn draw_contours(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        (values, noise): (&[f64], f64),
        levels: &[f64],
    ) {
        let columns = self.x.count();
        let x: Vec<f64> = self.x.values().map(|x| panel.place(x, panel.y.scale.low).0).collect();
        let y: Vec<f64> = self.y.values().map(|y| panel.place(panel.x.scale.low, y).1).collect();
        let value =
            |column: usize, row: usize| values[self.y.place(row) * columns + self.x.place(column)];
        for (place, level) in levels.iter().enumerate() {
            let lines = |kept: f64| {
                let value = |column: usize, row: usize| {
                    let value = value(column, row);
                    if (value - level).abs() <= noise { kept } else { value }
                };
                Field { x: &x, y: &y, value: &value }.lines(*level)
            };
            // Values that keep the level count as above it, then as below it.
            let mut both = lines(*level);
            let below = lines(level.next_down());
            let others: Vec<_> = below.into_iter().filter(|it| !both.contains(it)).collect();
            both.extend(others);
            canvas.clipped(panel.frame, |canvas| {
                for line in &both {
                    canvas.line(line, Stroke::solid(PAPER, 2.2 * CONTOUR.width));
                    canvas.line(line, contour(place));
                }
            });
        }
    }

    /// What the marks of uneven axes mean.
    pub fn legend(&self) -> Option<(Mark, Text)> {
        let uneven = !self.x.uneven.is_empty() || !self.y.uneven.is_empty();
        uneven.then(|| (Mark::Nothing, Text::plain("marks outside the frame: computed values")))
    }
}

/// The cells along the axis called `name`.
pub(super) fn cells(view: &View<'_>, name: &str) -> Result<Cells, FigureError> {
    let factor = view.quantity(name).factor;
    let values: Vec<f64> = view.axis_values(name)?.iter().map(|value| value * factor).collect();
    match values.is_empty() {
        true => Err(view.unfit(format!("axis `{name}` has no values"))),
        false => Ok(Cells::around(&values)),
    }
}

/// The axes along the abscissa and the ordinate.
fn axes<'a>(view: &View<'a>, what: &str) -> Result<(&'a str, &'a str), FigureError> {
    let free = view.drawable_axes();
    let named = |name: &Option<String>| {
        name.as_ref().and_then(|name| view.axes().into_iter().find(|axis| axis == name))
    };
    let (x, y) = (named(&view.drawing.x), named(&view.drawing.y));
    let x = x.or_else(|| free.iter().copied().find(|name| Some(*name) != y));
    let y = y.or_else(|| free.iter().copied().find(|name| Some(*name) != x));
    match (x, y) {
        (Some(x), Some(y)) if x != y => Ok((x, y)),
        (Some(x), Some(_)) => Err(view.unfit(format!("`{x}` cannot be both axes of {what}"))),
        _ => Err(view.unfit(format!(
            "{what} needs two axes that `at` does not hold, and there is {}",
            if free.is_empty() { "none".to_string() } else { format!("only {}", free.join(", ")) }
        ))),
    }
}
