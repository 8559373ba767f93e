//! Two axes of a study as a plane of cells, one for each case.

use super::canvas::{Canvas, Stroke};
use super::cells::Cells;
use super::error::FigureError;
use super::header::Mark;
use super::panel::Panel;
use super::raster::{Fill, Raster};
use super::style::{FRAME_WIDTH, INK};
use super::text::Text;
use super::view::View;

/// Length of the mark of a value of an uneven axis [pt].
const VALUE_MARK: f64 = 3.0;

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

    /// Fills the cells over a panel, each as `fill` says for its case over the free axes, and marks the values of uneven
    /// axes at the upper and the right side of the frame.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel, fill: impl Fn(usize) -> Fill) {
        let columns = self.x.count();
        let raster = Raster::cells(
            panel.frame,
            |share| self.x.at(share),
            |share| self.y.at(1.0 - share),
            |column, row| fill(row * columns + column),
        );
        canvas.image(panel.frame, &raster);
        let up = |&value: &f64| {
            let (place, top) = panel.place(value, panel.y.scale.high);
            ((place, top), (place, top - VALUE_MARK))
        };
        let right = |&value: &f64| {
            let (right, place) = panel.place(panel.x.scale.high, value);
            ((right, place), (right + VALUE_MARK, place))
        };
        let marks: Vec<_> =
            self.x.uneven.iter().map(up).chain(self.y.uneven.iter().map(right)).collect();
        canvas.segments(&marks, Stroke::solid(INK, FRAME_WIDTH));
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
