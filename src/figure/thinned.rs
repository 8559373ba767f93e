//! The symbols of special points without those that would overlap others: what matters most is drawn, the rest is counted.

use super::canvas::Canvas;
use super::codim2_symbol::{Codim2Symbol, RING};
use super::geometry::Point;
use super::header::{Entry, Mark};
use super::page::letter;
use super::panel::Panel;
use super::symbol::{RADIUS, SYMBOLS, Symbol};
use super::text::Text;

/// Room between two symbols at least [pt].
const GAP: f64 = 0.6;
/// Symbols of one kind nearer than this on the page are one point that was found twice [pt].
const SAME: f64 = 0.02;

/// The symbol of a special point of either codimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Special {
    /// Of codimension 1.
    One(Symbol),
    /// Of codimension 2.
    Two(Codim2Symbol),
}

/// A symbol with its place, in the units of the axes.
pub type Placed = (Special, (f64, f64));

impl Special {
    /// Its name in legends.
    pub fn words(self) -> &'static str {
        match self {
            Special::One(symbol) => symbol.words,
            Special::Two(symbol) => symbol.words,
        }
    }

    /// How far it reaches [pt].
    fn radius(self) -> f64 {
        match self {
            Special::One(_) => RADIUS,
            Special::Two(_) => RING,
        }
    }

    /// How much it matters: points of codimension 2 before all others.
    fn rank(self) -> usize {
        match self {
            Special::One(symbol) => {
                SYMBOLS.iter().position(|it| *it == symbol).map_or(0, |place| place + 1)
            }
            Special::Two(_) => SYMBOLS.len() + 1,
        }
    }

    fn draw(self, canvas: &mut Canvas, at: Point) {
        match self {
            Special::One(symbol) => symbol.draw(canvas, at),
            Special::Two(symbol) => symbol.draw(canvas, at),
        }
    }
}

/// The symbols of a panel.
#[derive(Debug, Clone, Default)]
pub struct Thinned {
    /// Those that are drawn, those that matter most first.
    drawn: Vec<Placed>,
    /// All on the panel.
    all: Vec<Placed>,
    /// How many of each kind would overlap others and are left out.
    left_out: Vec<(Special, usize)>,
}

impl Thinned {
    /// Those of `symbols` that lie on a panel. Of some that would overlap the one that matters most stays, of one kind the first;
    /// points that were found twice count once.
    pub fn of(panel: &Panel, symbols: impl IntoIterator<Item = Placed>) -> Thinned {
        let on_panel = symbols.into_iter().filter(|(_, (x, y))| panel.holds(*x, *y));
        let mut all: Vec<Placed> = on_panel.collect();
        all.sort_by_key(|(special, _)| std::cmp::Reverse(special.rank()));
        let mut thinned = Thinned::default();
        let mut taken: Vec<(Special, Point)> = Vec::new();
        for (special, at) in &all {
            let place = panel.place(at.0, at.1);
            let away = |there: &Point| (place.0 - there.0).hypot(place.1 - there.1);
            if taken.iter().any(|(it, there)| it == special && away(there) < SAME) {
                continue;
            }
            let overlaps =
                |(it, there): &(Special, Point)| away(there) < it.radius() + special.radius() + GAP;
            match taken.iter().any(overlaps) {
                false => {
                    taken.push((*special, place));
                    thinned.drawn.push((*special, *at));
                }
                true => thinned.count(*special),
            }
        }
        Thinned { all, ..thinned }
    }

    fn count(&mut self, special: Special) {
        match self.left_out.iter_mut().find(|it| it.0 == special) {
            Some(counted) => counted.1 += 1,
            None => self.left_out.push((special, 1)),
        }
    }

    /// Draws the symbols that stay.
    pub fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        // What matters most lies over the rest.
        for (special, (x, y)) in self.drawn.iter().rev() {
            special.draw(canvas, panel.place(*x, *y));
        }
        for (special, at) in &self.all {
            panel.record(canvas, special.words(), [*at]);
        }
    }

    /// Whether a kind is among those that are drawn.
    fn draws(&self, special: Special) -> bool {
        self.drawn.iter().any(|it| it.0 == special)
    }

    /// Whether some are left out.
    fn is_thinned(&self) -> bool {
        !self.left_out.is_empty()
    }

    /// How many of each kind are left out, in words.
    fn told(&self) -> String {
        let each = self.left_out.iter();
        let each = each.map(|(special, count)| format!("{count}\u{a0}×\u{a0}{}", special.words()));
        each.collect::<Vec<_>>().join(", ")
    }
}

/// A legend of the panels of a page without the symbols that stand on none of them, and with what is said of those that are left out.
pub fn with_told(legend: Vec<Entry>, panels: &[Thinned]) -> Vec<Entry> {
    let is_drawn = |special: Special| panels.iter().any(|it| it.draws(special));
    let stays = |(mark, _): &Entry| match mark {
        // Optima and measured points are none of the special points.
        Mark::Symbol(symbol) => symbol.name.is_empty() || is_drawn(Special::One(*symbol)),
        Mark::Codim2(symbol) => is_drawn(Special::Two(*symbol)),
        _ => true,
    };
    let mut entries: Vec<Entry> = legend.into_iter().filter(stays).collect();
    entries.extend(told(panels));
    entries
}

/// How many symbols are left out on the panels of a page, if any are.
fn told(panels: &[Thinned]) -> Option<Entry> {
    let mut told: Vec<String> = Vec::new();
    for (place, thinned) in panels.iter().enumerate().filter(|(_, it)| it.is_thinned()) {
        let letter = letter(place, panels.len());
        let letter = letter.map_or(String::new(), |letter| format!("({letter})\u{a0}"));
        told.push(format!("{letter}{}", thinned.told()));
    }
    let words = format!("left out where symbols would overlap: {}", told.join("; "));
    (!told.is_empty()).then(|| (Mark::Nothing, Text::plain(&words)))
}
