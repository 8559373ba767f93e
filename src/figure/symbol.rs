//! The symbols of special points, of optima and of measured points: a shape for the point, a colour for curves of such points.

use plotters::style::RGBColor;

use super::canvas::{Canvas, Dash, Stroke};
use super::geometry::Point;
use super::style::{BLUE, CURVE_WIDTH, FAINT_INK, GREEN, INK, PAPER, PURPLE, VERMILION};

/// A kind of special point, of optimum or of measured point as figures show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Symbol {
    /// Its name in files of results; empty for optima and measured points, which are not there.
    pub name: &'static str,
    /// Its name in legends.
    pub words: &'static str,
    shape: Shape,
    /// The colour of curves of it; the symbol itself is black, as colours of points distinguish attractors.
    pub colour: RGBColor,
    /// How curves of it are drawn.
    pub dash: Dash,
}

/// The shape of a symbol.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Triangle,
    Diamond,
    Star,
    Ring,
    /// A ring that hides nothing within.
    Circle,
    /// A square that hides nothing within.
    Square,
    Cross,
}

/// Distance of the corners of a symbol from its middle [pt].
pub const RADIUS: f64 = 2.4;

/// The symbols, those that matter least first: the later are drawn over the earlier.
pub const SYMBOLS: [Symbol; 6] = [
    Symbol {
        name: "unresolved",
        words: "unresolved change",
        shape: Shape::Square,
        colour: FAINT_INK,
        dash: Dash::Dotted,
    },
    Symbol {
        name: "event-sequence",
        words: "change of event order",
        shape: Shape::Cross,
        colour: FAINT_INK,
        dash: Dash::Dotted,
    },
    Symbol {
        name: "grazing",
        words: "grazing",
        shape: Shape::Ring,
        colour: PURPLE,
        dash: Dash::Short,
    },
    Symbol {
        name: "neimark-sacker",
        words: "Neimark–Sacker",
        shape: Shape::Star,
        colour: GREEN,
        dash: Dash::Mixed,
    },
    Symbol {
        name: "period-doubling",
        words: "period doubling",
        shape: Shape::Diamond,
        colour: BLUE,
        dash: Dash::Long,
    },
    Symbol {
        name: "fold",
        words: "fold",
        shape: Shape::Triangle,
        colour: VERMILION,
        dash: Dash::None,
    },
];

/// The fastest motion of a trade-off.
pub const FASTEST: Symbol = optimum("fastest", Shape::Circle);
/// The knee of its front.
pub const KNEE: Symbol = optimum("knee", Shape::Diamond);
/// The motion with the least energy per metre.
pub const LEAST: Symbol = optimum("least J/m", Shape::Triangle);

/// The motion with the most of another gain than the speed.
pub const MOST_GAIN: Symbol = optimum("most gain", Shape::Circle);
/// The motion with the least cost per gain, of another gain.
pub const LEAST_PER_GAIN: Symbol = optimum("least cost per gain", Shape::Triangle);

/// What was measured, over what is computed.
pub const MEASURED: Symbol = optimum("measured", Shape::Square);

const fn optimum(words: &'static str, shape: Shape) -> Symbol {
    Symbol { name: "", words, shape, colour: INK, dash: Dash::None }
}

/// Corners of the shapes, in shares of the radius, upward negative.
const TRIANGLE: [Point; 3] = [(0.0, -1.15), (1.0, 0.6), (-1.0, 0.6)];
const DIAMOND: [Point; 4] = [(0.0, -1.15), (1.0, 0.0), (0.0, 1.15), (-1.0, 0.0)];
const STAR: [Point; 10] = [
    (0.0, -1.3),
    (0.32, -0.44),
    (1.24, -0.4),
    (0.52, 0.17),
    (0.76, 1.05),
    (0.0, 0.55),
    (-0.76, 1.05),
    (-0.52, 0.17),
    (-1.24, -0.4),
    (-0.32, -0.44),
];

impl Symbol {
    /// The symbol of the kind called `name` in files of results.
    pub fn named(name: &str) -> Option<Symbol> {
        SYMBOLS.into_iter().find(|symbol| symbol.name == name)
    }

    /// Draws the symbol with its middle at `at`, on a rim of paper that lifts it off the lines.
    pub fn draw(&self, canvas: &mut Canvas, at: Point) {
        match self.shape {
            Shape::Triangle => self.fill(canvas, at, &TRIANGLE),
            Shape::Diamond => self.fill(canvas, at, &DIAMOND),
            Shape::Star => self.fill(canvas, at, &STAR),
            Shape::Ring => {
                canvas.discs(&[(at, PAPER)], RADIUS * 0.85);
                canvas.rings(&[at], RADIUS * 0.85, Stroke::solid(INK, CURVE_WIDTH));
            }
            Shape::Circle => {
                canvas.rings(&[at], RADIUS * 1.4, Stroke::solid(PAPER, 2.5 * CURVE_WIDTH));
                canvas.rings(&[at], RADIUS * 1.4, Stroke::solid(INK, CURVE_WIDTH));
            }
            Shape::Square => {
                square(canvas, at, RADIUS, Stroke::solid(PAPER, 2.5 * CURVE_WIDTH));
                square(canvas, at, RADIUS, Stroke::solid(INK, CURVE_WIDTH));
            }
            Shape::Cross => cross(canvas, at, RADIUS),
        }
    }

    /// Draws the symbol smaller, without a rim, on paper.
    pub fn draw_within(&self, canvas: &mut Canvas, at: Point, radius: f64) {
        match self.shape {
            Shape::Triangle => polygon(canvas, at, &TRIANGLE, radius, INK),
            Shape::Diamond => polygon(canvas, at, &DIAMOND, radius, INK),
            Shape::Star => polygon(canvas, at, &STAR, radius, INK),
            Shape::Ring | Shape::Circle => {
                canvas.rings(&[at], radius * 0.85, Stroke::solid(INK, 0.8 * CURVE_WIDTH));
            }
            Shape::Square => square(canvas, at, radius, Stroke::solid(INK, 0.8 * CURVE_WIDTH)),
            Shape::Cross => cross(canvas, at, radius),
        }
    }

    fn fill(&self, canvas: &mut Canvas, at: Point, corners: &[Point]) {
        for (radius, colour) in [(RADIUS + 0.7, PAPER), (RADIUS, INK)] {
            polygon(canvas, at, corners, radius, colour);
        }
    }
}

fn polygon(canvas: &mut Canvas, (x, y): Point, corners: &[Point], radius: f64, colour: RGBColor) {
    let corners = corners.iter().map(|(dx, dy)| (x + dx * radius, y + dy * radius));
    canvas.polygon(&corners.collect::<Vec<Point>>(), colour);
}

/// The sides of a square whose corners are so far from its middle along each axis.
fn square(canvas: &mut Canvas, (x, y): Point, reach: f64, stroke: Stroke) {
    let [a, b, c, d] = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(u, v)| (x + u * reach, y + v * reach));
    canvas.segments(&[(a, b), (b, c), (c, d), (d, a)], stroke);
}

/// Two strokes across each other.
fn cross(canvas: &mut Canvas, (x, y): Point, radius: f64) {
    let reach = radius * 0.62;
    let ends = [
        ((x - reach, y - reach), (x + reach, y + reach)),
        ((x - reach, y + reach), (x + reach, y - reach)),
    ];
    canvas.segments(&ends, Stroke::solid(INK, CURVE_WIDTH));
}
