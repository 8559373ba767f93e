//! Colours of numbers, and the colour bar with their scale.

use colorous::Gradient;
use plotters::style::RGBColor;

use super::axis::{Along, Axis, AxisRequest};
use super::canvas::{Anchor, Canvas, Stroke};
use super::geometry::{Point, Rect};
use super::panel::draw_upward;
use super::quantity::Quantity;
use super::raster::{Fill, Raster};
use super::scale::{Scale, Spacing, finite_range};
use super::style::{
    FRAME_WIDTH, INK, LABEL_GAP, LABEL_SIZE, MAJOR_LENGTH, MINOR_LENGTH, MINOR_WIDTH, SMALL_SIZE,
};
use super::text::Text;
use crate::study::{ColourMap, Colouring};

/// Distance between a frame and its bar [pt].
const BAR_GAP: f64 = 6.0;
/// Distance between the bar and its numbers [pt].
const NUMBER_GAP: f64 = 5.0;
/// Width of the bar [pt].
const BAR_WIDTH: f64 = 8.0;
/// Length of the arrow at an end of the bar beyond which there are values [pt].
const ARROW: f64 = 5.0;

/// The gradient of some colours, and whether it begins with their last.
fn gradient(map: ColourMap) -> (Gradient, bool) {
    match map {
        ColourMap::Viridis => (colorous::VIRIDIS, false),
        ColourMap::Cividis => (colorous::CIVIDIS, false),
        ColourMap::Magma => (colorous::MAGMA, false),
        ColourMap::Inferno => (colorous::INFERNO, false),
        ColourMap::Plasma => (colorous::PLASMA, false),
        ColourMap::Greys => (colorous::GREYS, false),
        ColourMap::Blues => (colorous::BLUES, false),
        ColourMap::BlueRed => (colorous::RED_BLUE, true),
        ColourMap::PurpleOrange => (colorous::PURPLE_ORANGE, false),
        ColourMap::GreenBrown => (colorous::BROWN_GREEN, true),
        ColourMap::Turbo => (colorous::TURBO, false),
    }
}

/// A scale of colours with its bar.
pub struct Colours {
    /// Range of the bar.
    scale: Scale,
    /// The value in the middle of the colours, and how far their ends are from it.
    centred: Option<[f64; 2]>,
    /// Which colours, and whether they run the other way.
    map: (Gradient, bool),
    /// Whether there are values below and above the range.
    beyond: [bool; 2],
    quantity: Quantity,
}

impl Colours {
    /// The colours for `values`: centred on zero where both signs occur,
    /// and none where no value is finite.
    pub fn for_values(values: &[f64], quantity: Quantity) -> Option<Colours> {
        let scale = quantity.scale(values, 0.0);
        quantity.note_left_out(&scale, values);
        let (low, high) = finite_range(values.iter().copied().filter(|it| scale.can_hold(*it)))?;
        // A trace of the other sign, as rounding leaves it, does not count.
        let most = high.max(-low);
        let has_both = low < -1e-3 * most && high > 1e-3 * most && most > quantity.noise;
        let is_log = scale.spacing == Spacing::Log;
        let usual = (has_both && !is_log && scale.holds(0.0)).then_some(0.0);
        let centre = quantity.chosen.centre().map(|it| it * quantity.factor).or(usual);
        let beyond =
            [low < scale.low && !scale.holds(low), high > scale.high && !scale.holds(high)];
        Some(Colours::new(quantity, scale, centre, beyond))
    }

    /// The colours for the values of an axis.
    pub fn for_axis(values: &[f64], quantity: Quantity) -> Colours {
        let scale = quantity.fitted(Scale::of_axis(values));
        let centre = quantity.chosen.centre().map(|it| it * quantity.factor);
        let outside: Vec<f64> = values.iter().copied().filter(|it| !scale.holds(*it)).collect();
        let beyond =
            [outside.iter().any(|it| *it < scale.low), outside.iter().any(|it| *it > scale.high)];
        Colours::new(quantity, scale, centre, beyond)
    }

    fn new(quantity: Quantity, scale: Scale, centre: Option<f64>, beyond: [bool; 2]) -> Colours {
        // Red for forward, blue for backward.
        let usual = if centre.is_some() { ColourMap::BlueRed } else { ColourMap::Viridis };
        let Colouring { map, reversed } =
            quantity.chosen.colour_map().unwrap_or(Colouring { map: usual, reversed: false });
        let centre = centre.filter(|it| scale.can_hold(*it)).map(|it| scale.share(it));
        let centred = centre.map(|it| [it, it.max(1.0 - it)]);
        let (gradient, is_turned) = gradient(map);
        Colours { scale, centred, map: (gradient, is_turned != reversed), beyond, quantity }
    }

    /// The colour of a finite `value`; beyond the range that of its end.
    pub fn of(&self, value: f64) -> RGBColor {
        let share = self.scale.share(value).clamp(0.0, 1.0);
        let place = match self.centred {
            Some([centre, reach]) => 0.5 + 0.5 * (share - centre) / reach,
            None => share,
        };
        let (gradient, is_turned) = self.map;
        let colour = gradient.eval_continuous(if is_turned { 1.0 - place } else { place });
        RGBColor(colour.r, colour.g, colour.b)
    }

    /// Whether a finite value has a colour: on a logarithmic scale, those above zero.
    pub fn has(&self, value: f64) -> bool {
        self.scale.can_hold(value)
    }

    /// The range of the bar.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// What they tell, with its unit.
    pub fn told(&self) -> String {
        self.quantity.told()
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

    /// An arrow at each end of the bar beyond which there are values.
    fn draw_ends(&self, canvas: &mut Canvas, bar: Rect) {
        let middle = (bar.left + bar.right) / 2.0;
        let ends = [(self.scale.low, bar.bottom, 1.0), (self.scale.high, bar.top, -1.0)];
        for ((value, end, outward), _) in ends.into_iter().zip(self.beyond).filter(|it| it.1) {
            let tip = (middle, end + outward * ARROW);
            let corners = [(bar.left, end), tip, (bar.right, end)];
            canvas.polygon(&corners, self.of(value));
            canvas.line(&corners, Stroke::solid(INK, FRAME_WIDTH));
        }
    }

    /// Draws the bar beside `frame`.
    pub fn draw_bar(&self, canvas: &mut Canvas, frame: Rect) {
        let left = frame.right + BAR_GAP;
        let bar = Rect { left, right: left + BAR_WIDTH, ..frame };
        let steps = 512usize;
        let raster = Raster::cells(
            bar,
            |_| 0,
            |share| (share * steps as f64) as usize,
            |_, row| {
                Fill::Plain(self.of(self.scale.value(1.0 - (row as f64 + 0.5) / steps as f64)))
            },
        );
        canvas.image(bar, &raster);
        canvas.frame(bar, Stroke::solid(INK, FRAME_WIDTH));
        self.draw_ends(canvas, bar);
        let axis = self.axis(frame.height());
        let major = tick_lines(bar, &axis.scale, &axis.ticks.numbered(), MAJOR_LENGTH - 1.0);
        canvas.segments(&major, Stroke::solid(INK, FRAME_WIDTH));
        let minor = tick_lines(bar, &axis.scale, &axis.ticks.minor, MINOR_LENGTH - 0.6);
        canvas.segments(&minor, Stroke::solid(INK, MINOR_WIDTH));
        let numbers = bar.right + NUMBER_GAP;
        for tick in &axis.ticks.major {
            let at = (numbers, place(bar, &axis.scale, tick.value) + 0.32 * SMALL_SIZE);
            canvas.text(&Text::markup(&tick.label), at, SMALL_SIZE, Anchor::Start);
        }
        let first = numbers + axis.widest + LABEL_GAP + 0.75 * LABEL_SIZE;
        draw_upward(canvas, &axis, frame, first);
    }
}

/// Where a value stands along a bar, from the upper side of the page [pt].
fn place(bar: Rect, scale: &Scale, value: f64) -> f64 {
    bar.bottom - scale.share(value) * bar.height()
}

/// Marks of these values on the right side of a bar.
fn tick_lines(bar: Rect, scale: &Scale, values: &[f64], length: f64) -> Vec<(Point, Point)> {
    let heights = values.iter().map(|value| place(bar, scale, *value));
    heights.map(|at| ((bar.right, at), (bar.right + length, at))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diverging_colours_run_as_they_are_called() {
        let ends = |map: ColourMap| {
            let (gradient, is_turned) = gradient(map);
            let at =
                |share: f64| gradient.eval_continuous(if is_turned { 1.0 - share } else { share });
            let channels = |share: f64| at(share).as_array().map(i32::from);
            [channels(0.1), channels(0.5), channels(0.9)]
        };
        // The channels that lead at the low end and at the high one: red 0, green 1, blue 2.
        for (map, first, last) in [
            (ColourMap::BlueRed, 2, 0),
            (ColourMap::PurpleOrange, 2, 0),
            (ColourMap::GreenBrown, 1, 0),
        ] {
            let [low, middle, high] = ends(map);
            assert!(
                low[first] > low[last] && high[last] > high[first],
                "{map:?}: {low:?} {high:?}"
            );
            assert!(middle.iter().all(|channel| *channel > 220), "{map:?}: {middle:?}");
        }
    }
}
