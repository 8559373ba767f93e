//! Branches over the parameter in which they were continued: lines along them, and special
//! points.

use plotters::style::RGBColor;

use super::canvas::{Canvas, Dash, Stroke};
use super::header::{Entry, Mark};
use super::panel::Panel;
use super::style::{CURVE_WIDTH, INK};
use super::symbol::{SYMBOLS, Symbol};
use super::text::Text;
use super::thinned::{Placed, Special};
use super::track::{Track, tracks};
use super::view::View;

/// The branches that a diagram shows, as one output of theirs.
#[derive(Default)]
pub struct BranchLines {
    /// Lines of unstable orbits, then of stable ones.
    pub lines: [Vec<Vec<(f64, f64)>>; 2],
    /// Special points.
    specials: Vec<(Symbol, (f64, f64))>,
}

impl BranchLines {
    /// The orbits continued in `x` that lie where `view` holds the other axes, as their `output`.
    pub fn shown(view: &View<'_>, x: &str, output: &str) -> BranchLines {
        let mut branches = BranchLines::default();
        if !view.drawing.branches {
            return branches;
        }
        let (along, own) = (view.quantity(x), view.quantity(output));
        for track in tracks(view, x, output) {
            branches.add(&track, along.factor, own.factor);
        }
        let is_shown = view.shows("special-points");
        branches
            .specials
            .retain(|(_, (x, y))| is_shown && along.is_within(*x) && own.is_within(*y));
        branches
    }

    /// Adds a branch, whose parameter and output are shown times these factors.
    fn add(&mut self, track: &Track, along: f64, own: f64) {
        for cycle in 0..track.width() {
            let mut line: Vec<(f64, f64)> = Vec::new();
            let mut stable = None;
            for stop in &track.stops {
                let place = (stop.x * along, stop.values[cycle] * own);
                if let Some(now) = stop.stable {
                    if let Some(before) = stable.filter(|&before| before != now) {
                        // Both lines meet where the stability changes.
                        let meeting = line.last().copied();
                        self.keep(before, std::mem::take(&mut line));
                        line.extend(meeting);
                    }
                    stable = Some(now);
                }
                if let Some(symbol) = stop.symbol {
                    self.specials.push((symbol, place));
                }
                line.push(place);
            }
            self.keep(stable.unwrap_or(false), line);
        }
    }

    fn keep(&mut self, stable: bool, line: Vec<(f64, f64)>) {
        self.lines[usize::from(stable)].push(line);
    }

    /// Whether there is nothing to show.
    pub fn is_empty(&self) -> bool {
        self.lines.iter().all(Vec::is_empty)
    }

    /// Every place on the lines, in the units of the figure.
    pub fn places(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.lines.iter().flatten().flatten().copied()
    }

    /// Draws the lines, the stable over the unstable.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        for (lines, stroke) in self.lines.iter().zip(STROKES) {
            lines.iter().for_each(|line| panel.curve(canvas, line, stroke));
        }
        for (lines, name) in self.lines.iter().zip(STABILITIES) {
            for (number, line) in lines.iter().enumerate() {
                let series = format!("{name}, line {}", number + 1);
                panel.record(canvas, &series, line.iter().copied());
            }
        }
    }

    /// The special points.
    pub fn specials(&self) -> impl Iterator<Item = Placed> + '_ {
        self.specials.iter().map(|(symbol, at)| (Special::One(*symbol), *at))
    }

    /// What the lines and symbols mean.
    pub fn legend(&self) -> Vec<Entry> {
        let lines = STROKES.iter().zip(STABILITIES).zip(&self.lines).rev();
        let lines = lines
            .filter(|(_, lines)| lines.iter().any(|line| line.len() > 1))
            .map(|((stroke, words), _)| (Mark::Line(*stroke), Text::plain(words)));
        let symbols = SYMBOLS
            .into_iter()
            .rev()
            .filter(|symbol| self.specials.iter().any(|(other, _)| other == symbol));
        let symbols = symbols.map(|symbol| (Mark::Symbol(symbol), Text::plain(symbol.words)));
        lines.chain(symbols).collect()
    }
}

/// The lines of unstable orbits, and of stable ones.
const STROKES: [Stroke; 2] = [
    Stroke { colour: INK, width: 0.6 * CURVE_WIDTH, dash: Dash::Short },
    Stroke { colour: INK, width: 0.5 * CURVE_WIDTH, dash: Dash::None },
];

/// What the lines are of, in their order.
const STABILITIES: [&str; 2] = ["unstable orbits", "stable orbits"];

/// A colour that steps back behind lines.
pub fn faded(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let [red, green, blue] =
        [red, green, blue].map(|part| (255.0 - 0.42 * (255.0 - f64::from(part))).round() as u8);
    RGBColor(red, green, blue)
}
