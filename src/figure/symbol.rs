//! The symbols that mark what happens to an attractor: one for each kind of event.

use plotters::style::RGBColor;

use super::canvas::{Canvas, Stroke};
use super::geometry::{Point, Rect};
use super::style::{INK, PAPER, REFERENCE_WIDTH};

/// A symbol, the same in every figure for the same kind of event.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symbol {
    /// An open circle: grazing.
    Ring,
    /// A filled square: period doubling.
    Square,
    /// A filled triangle: fold.
    Triangle,
    /// A star: Neimark-Sacker.
    Star,
    /// A small cross: another change of the sequence of events.
    Cross,
}

impl Symbol {
    /// Each symbol with the name of its kind in files and its words in legends, in the order of legends.
    pub const KINDS: [(&str, &str, Symbol); 5] = [
        ("grazing", "grazing", Symbol::Ring),
        ("period-doubling", "period doubling", Symbol::Square),
        ("fold", "fold", Symbol::Triangle),
        ("neimark-sacker", "Neimark–Sacker", Symbol::Star),
        ("event-sequence", "event sequence", Symbol::Cross),
    ];

    /// The symbol of the kind of event that files call `name`.
    pub fn named(name: &str) -> Option<Symbol> {
        Symbol::KINDS.iter().find(|(kind, _, _)| *kind == name).map(|(_, _, symbol)| *symbol)
    }

    /// Draws the symbol around `centre` with about this `radius` [pt].
    pub fn draw(self, canvas: &mut Canvas, centre: Point, radius: f64) {
        match self {
            Symbol::Ring => {
                canvas.discs(&[(centre, PAPER)], radius);
                canvas.rings(&[centre], radius, Stroke::solid(INK, REFERENCE_WIDTH));
            }
            Symbol::Square => square(canvas, centre, 0.85 * radius, INK),
            Symbol::Triangle => canvas.polygon(&corners(centre, 1.25 * radius, &[1.0; 3]), INK),
            Symbol::Star => {
                let spikes: [f64; 10] =
                    std::array::from_fn(|i| if i % 2 == 0 { 1.0 } else { 0.42 });
                canvas.polygon(&corners(centre, 1.5 * radius, &spikes), INK);
            }
            Symbol::Cross => cross(canvas, centre, 0.75 * radius),
        }
    }
}

fn square(canvas: &mut Canvas, (x, y): Point, half: f64, colour: RGBColor) {
    canvas.fill(Rect { left: x - half, top: y - half, right: x + half, bottom: y + half }, colour);
}

fn cross(canvas: &mut Canvas, (x, y): Point, half: f64) {
    let lines = [
        ((x - half, y - half), (x + half, y + half)),
        ((x - half, y + half), (x + half, y - half)),
    ];
    canvas.segments(&lines, Stroke::solid(INK, REFERENCE_WIDTH));
}

/// Corners around `centre` from the top, each at its share of the radius.
fn corners((x, y): Point, radius: f64, shares: &[f64]) -> Vec<Point> {
    let count = shares.len() as f64;
    let corner = |(i, share): (usize, &f64)| {
        let angle = std::f64::consts::TAU * i as f64 / count;
        (x + radius * share * angle.sin(), y - radius * share * angle.cos())
    };
    shares.iter().enumerate().map(corner).collect()
}
