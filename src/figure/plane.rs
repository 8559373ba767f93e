//! Two axes of a study as a plane of cells, one for each case.

use super::canvas::{Canvas, Dash, Stroke};
use super::cells::Cells;
use super::contour::Field;
use super::data::Value;
use super::error::FigureError;
use super::geometry::{Point, Rect};
use super::header::Mark;
use super::panel::Panel;
use super::raster::{Fill, Raster};
use super::style::{CURVE_WIDTH, FRAME_WIDTH, INK, PAPER};
use super::text::Text;
use super::view::View;
use crate::store::catalogue::starts;

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

/// What contours are drawn of.
pub struct Heights<'v> {
    /// The value of each case over the free axes.
    pub values: &'v [f64],
    /// Differences up to this are none.
    pub noise: f64,
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
        Plane::of_first(view, what, &[])
    }

    /// The same, where axes of these names go first.
    fn of_first(view: &View<'a>, what: &str, first: &[&str]) -> Result<Plane<'a>, FigureError> {
        let (x_name, y_name) = axes(view, what, first)?;
        Ok(Plane { x_name, y_name, x: cells(view, x_name)?, y: cells(view, y_name)? })
    }

    /// The same where both are coordinates of a start; `lies` says of the figure that it must lie over such.
    pub fn of_starts(view: &View<'a>, what: &str, lies: &str) -> Result<Plane<'a>, FigureError> {
        let of_starts: Vec<&str> =
            starts(view.model()).into_iter().map(|entry| entry.name).collect();
        let plane = Plane::of_first(view, what, &of_starts)?;
        if let Some(name) = plane.names().into_iter().find(|name| !of_starts.contains(name)) {
            let allowed = of_starts.join(", ");
            let why = format!("{lies} over two of {allowed}, and `{name}` is none of these");
            return Err(view.unfit(why));
        }
        Ok(plane)
    }

    /// The axes along the abscissa and the ordinate.
    pub fn names(&self) -> [&'a str; 2] {
        [self.x_name, self.y_name]
    }

    /// The axes over which cases are taken, the slower first.
    pub fn free(&self) -> [&'a str; 2] {
        [self.y_name, self.x_name]
    }

    /// How many cells there are.
    pub fn count(&self) -> usize {
        self.x.count() * self.y.count()
    }

    /// The case of a cell over the free axes.
    pub fn case(&self, column: usize, row: usize) -> usize {
        self.y.place(row) * self.x.count() + self.x.place(column)
    }

    /// Whether a part of the cell of each case over the free axes lies within the limits that are set.
    pub fn seen(&self, view: &View<'_>) -> Vec<bool> {
        let [x, y] = [(&self.x, self.x_name), (&self.y, self.y_name)]
            .map(|(cells, name)| cells.within(view.quantity(name).limits()));
        y.iter().flat_map(|row| x.iter().map(move |column| *row && *column)).collect()
    }

    /// Fills the cells over a panel, each as `fill` says for its case over the free axes, and marks the values of uneven
    /// axes at the upper and the right side of the frame.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, fill: impl Fn(usize) -> Fill) {
        let columns = self.x.count();
        let (frame, area) = (panel.frame, self.area(panel));
        if area.width() > 0.0 && area.height() > 0.0 {
            let raster = Raster::cells(
                area,
                |share| {
                    let x = area.left + share * area.width() - frame.left;
                    self.x.under(&panel.x.scale, x / frame.width())
                },
                |share| {
                    let y = frame.bottom - area.top - share * area.height();
                    self.y.under(&panel.y.scale, y / frame.height())
                },
                |column, row| fill(row * columns + column),
            );
            canvas.image(area, &raster);
        }
        self.mark_uneven(canvas, panel);
    }

    /// The part of the frame that the cells take: the limits of its axes may be others than theirs.
    fn area(&self, panel: &Panel) -> Rect {
        let frame = panel.frame;
        let (left, bottom) = panel.place(self.x.scale.low, self.y.scale.low);
        let (right, top) = panel.place(self.x.scale.high, self.y.scale.high);
        Rect {
            left: left.clamp(frame.left, frame.right),
            right: right.clamp(frame.left, frame.right),
            top: top.clamp(frame.top, frame.bottom),
            bottom: bottom.clamp(frame.top, frame.bottom),
        }
    }

    /// Marks the values of uneven axes outside the frame.
    fn mark_uneven(&self, canvas: &mut Canvas, panel: &Panel) {
        let frame = panel.frame;
        let mut marks = Vec::new();
        for &value in self.x.uneven.iter().filter(|it| panel.x.scale.holds(**it)) {
            let (x, _) = panel.place(value, panel.y.scale.high);
            marks.push(((x, frame.top), (x, frame.top - VALUE_MARK)));
        }
        for &value in self.y.uneven.iter().filter(|it| panel.y.scale.holds(**it)) {
            let (_, y) = panel.place(panel.x.scale.high, value);
            marks.push(((frame.right, y), (frame.right + VALUE_MARK, y)));
        }
        canvas.segments(&marks, Stroke::solid(INK, FRAME_WIDTH));
    }

    /// Notes what the cells over a panel show, by the number of their case over the free axes.
    pub fn record(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        series: &str,
        value: impl Fn(usize) -> Value,
    ) {
        let (x, y): (Vec<f64>, Vec<f64>) = (self.x.values().collect(), self.y.values().collect());
        let cells = (0..y.len()).flat_map(|row| (0..x.len()).map(move |column| (column, row)));
        let rows = cells.map(|(column, row)| ((x[column], y[row]), value(self.case(column, row))));
        panel.record_values(canvas, series, rows);
    }

    /// Draws the lines along which the cases over the free axes have these levels, and both edges of where they keep one.
    pub fn draw_contours(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        heights: &Heights<'_>,
        levels: &[f64],
    ) {
        for (place, &level) in levels.iter().enumerate() {
            // Values that keep the level count as above it, then as below it.
            let mut both = self.lines(panel, heights, level, level);
            let mut below = self.lines(panel, heights, level, level.next_down());
            below.retain(|it| !both.contains(it));
            both.extend(below);
            canvas.clipped(panel.frame, |canvas| {
                for line in &both {
                    canvas.line(line, Stroke::solid(PAPER, 2.2 * CONTOUR.width));
                    canvas.line(line, contour(place));
                }
            });
        }
    }

    /// The lines along which the cases have a level, on the page; values that keep it count as `kept`.
    fn lines(
        &self,
        panel: &Panel,
        heights: &Heights<'_>,
        level: f64,
        kept: f64,
    ) -> Vec<Vec<Point>> {
        let x: Vec<f64> = self.x.values().map(|x| panel.place(x, panel.y.scale.low).0).collect();
        let y: Vec<f64> = self.y.values().map(|y| panel.place(panel.x.scale.low, y).1).collect();
        let field = Field {
            x: &x,
            y: &y,
            value: &|column, row| {
                let value = heights.values[self.case(column, row)];
                if (value - level).abs() <= heights.noise { kept } else { value }
            },
        };
        field.lines(level)
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

/// The axes along the abscissa and the ordinate: those that the request names, or else the first that are free, of `first` before others.
fn axes<'a>(
    view: &View<'a>,
    what: &str,
    first: &[&str],
) -> Result<(&'a str, &'a str), FigureError> {
    let mut free = view.drawable_axes();
    free.sort_by_key(|name| !first.contains(name));
    let [x, y] = [&view.drawing.x, &view.drawing.y].map(|name| {
        let name = name.as_ref()?;
        view.axes().into_iter().find(|axis| axis == name)
    });
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
