//! Colours of numbers, and the colour bar with their scale.

use plotters::style::RGBColor;

use super::axis::{Along, Axis, AxisRequest};
use super::canvas::{Anchor, Canvas, Stroke};
use super::geometry::Rect;
use super::panel::draw_upward;
use super::quantity::Quantity;
use super::raster::{Fill, Raster};
use super::scale::{Scale, finite_range};
use super::style::{
    FRAME_WIDTH, INK, LABEL_GAP, LABEL_SIZE, MAJOR_LENGTH, MINOR_LENGTH, MINOR_WIDTH, SMALL_SIZE,
};
use super::text::Text;

/// Distance between a frame and its bar [pt].
const BAR_GAP: f64 = 6.0;
/// Distance between the bar and its numbers [pt].
const NUMBER_GAP: f64 = 5.0;
/// Width of the bar [pt].
const BAR_WIDTH: f64 = 8.0;

/// A scale of colours with its bar.
pub struct Colours {
    /// Range of the bar.
    scale: Scale,
    /// Largest magnitude, where zero is the middle of the colours.
    centred: Option<f64>,
    quantity: Quantity,
}

impl Colours {
    /// The colours for `values`: centred on zero where both signs occur,
    /// and none where no value is finite.
    pub fn for_values(values: &[f64], quantity: Quantity) -> Option<Colours> {
        let (low, high) = finite_range(values.iter().copied())?;
        let scale = quantity.scale(values, 0.0);
        // A trace of the other sign, as rounding leaves it, does not count.
        let most = high.max(-low);
        let is_centred = low < -1e-3 * most && high > 1e-3 * most && most > quantity.noise;
        let centred = is_centred.then_some(most);
        Some(Colours { scale, centred, quantity })
    }

    /// The colours for the values of an axis.
    pub fn for_axis(values: &[f64], quantity: Quantity) -> Colours {
        Colours { scale: Scale::of_axis(values), centred: None, quantity }
    }

    /// The colour of a finite `value`.
    pub fn of(&self, value: f64) -> RGBColor {
        let colour = match self.centred {
            // Red for forward, blue for backward.
            Some(most) => colorous::RED_BLUE.eval_continuous(0.5 - 0.5 * value / most),
            None => colorous::VIRIDIS.eval_continuous(self.scale.share(value).clamp(0.0, 1.0)),
        };
        RGBColor(colour.r, colour.g, colour.b)
    }

    fn axis(&self, height: f64) -> Axis {
        let request = AxisRequest::new(self.quantity.clone(), self.scale);
        Axis::new(&request, Along::Up, height)
    }

    /// Room that the bar takes beside a frame of `height` [pt].
    pub fn room(&self, height: f64) -> f64 {
        let axis = self.axis(height);
        BAR_GAP + BAR_WIDTH + NUMBER_GAP + axis.widest + LABEL_GAP + axis.label_room() + 1.0
    }

    /// Draws the bar beside `frame`.
    pub fn draw_bar(&self, canvas: &mut Canvas, frame: Rect) {
        let left = frame.right + BAR_GAP;
        let bar = Rect { left, right: left + BAR_WIDTH, ..frame };
        let steps = 512usize;
        let row = |share: f64| (share * steps as f64) as usize;
        let colour = |_, row: usize| {
            Fill::Plain(self.of(self.scale.value(1.0 - (row as f64 + 0.5) / steps as f64)))
        };
        canvas.image(bar, &Raster::cells(bar, |_| 0, row, colour));
        canvas.frame(bar, Stroke::solid(INK, FRAME_WIDTH));
        let axis = self.axis(frame.height());
        let place = |value: f64| bar.bottom - axis.scale.share(value) * bar.height();
        let tick = |value: f64, length: f64| {
            ((bar.right, place(value)), (bar.right + length, place(value)))
        };
        let major: Vec<_> =
            axis.ticks.major.iter().map(|it| tick(it.value, MAJOR_LENGTH - 1.0)).collect();
        canvas.segments(&major, Stroke::solid(INK, FRAME_WIDTH));
        let minor: Vec<_> =
            axis.ticks.minor.iter().map(|value| tick(*value, MINOR_LENGTH - 0.6)).collect();
        canvas.segments(&minor, Stroke::solid(INK, MINOR_WIDTH));
        let numbers = bar.right + NUMBER_GAP;
        for tick in &axis.ticks.major {
            let at = (numbers, place(tick.value) + 0.32 * SMALL_SIZE);
            canvas.text(&Text::markup(&tick.label), at, SMALL_SIZE, Anchor::Start);
        }
        let first = numbers + axis.widest + LABEL_GAP + 0.75 * LABEL_SIZE;
        draw_upward(canvas, &axis, frame, first);
    }
}
