//! The symbols of points of codimension 2: in a ring, what meets there or the number of the resonance.

use super::canvas::{Anchor, Canvas, Stroke};
use super::geometry::Point;
use super::style::{CURVE_WIDTH, INK, PAPER};
use super::symbol::Symbol;
use super::text::Text;

/// A kind of point of codimension 2 as figures show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Codim2Symbol {
    /// Its name in files of results.
    pub name: &'static str,
    /// Its name in legends.
    pub words: &'static str,
    content: Content,
}

/// What the ring holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Content {
    /// The symbols of the two kinds that meet, by their names in files.
    Both(&'static str, &'static str),
    /// The symbol of one kind.
    One(&'static str),
    /// A resonance with this many steps in a turn.
    Turn(&'static str),
}

/// Radius of the ring [pt].
pub const RING: f64 = 4.4;
/// Radius of a symbol alone, and of each of two within the ring; how far these are from its middle [pt].
const ALONE: f64 = 2.2;
const OF_TWO: f64 = 1.6;
const ASIDE: f64 = 1.9;
/// Size of a number [pt].
const NUMBER: f64 = 6.0;

/// Every symbol, in the order of legends.
pub const CODIM2_SYMBOLS: [Codim2Symbol; 13] = [
    symbol("cusp", "cusp", Content::One("fold")),
    symbol("fold-flip", "fold-flip", Content::Both("fold", "period-doubling")),
    symbol("fold-neimark-sacker", "fold–Neimark–Sacker", Content::Both("fold", "neimark-sacker")),
    symbol(
        "flip-neimark-sacker",
        "flip–Neimark–Sacker",
        Content::Both("period-doubling", "neimark-sacker"),
    ),
    symbol("resonance-1-1", "resonance 1:1", Content::Turn("1")),
    symbol("resonance-1-2", "resonance 1:2", Content::Turn("2")),
    symbol("resonance-1-3", "resonance 1:3", Content::Turn("3")),
    symbol("resonance-1-4", "resonance 1:4", Content::Turn("4")),
    symbol("fold-grazing", "fold-grazing", Content::Both("fold", "grazing")),
    symbol("doubling-grazing", "doubling-grazing", Content::Both("period-doubling", "grazing")),
    symbol(
        "neimark-sacker-grazing",
        "Neimark–Sacker–grazing",
        Content::Both("neimark-sacker", "grazing"),
    ),
    symbol("double-grazing", "double grazing", Content::Both("grazing", "grazing")),
    symbol("unresolved", "unresolved meeting", Content::One("unresolved")),
];

const fn symbol(name: &'static str, words: &'static str, content: Content) -> Codim2Symbol {
    Codim2Symbol { name, words, content }
}

impl Codim2Symbol {
    /// The symbol of the kind called `name` in files of results.
    pub fn named(name: &str) -> Option<Codim2Symbol> {
        CODIM2_SYMBOLS.into_iter().find(|symbol| symbol.name == name)
    }

    /// Draws the symbol with its middle at `at`.
    pub fn draw(&self, canvas: &mut Canvas, at: Point) {
        let (x, y) = at;
        canvas.discs(&[(at, PAPER)], RING + 0.5 * CURVE_WIDTH);
        canvas.rings(&[at], RING, Stroke::solid(INK, 0.7 * CURVE_WIDTH));
        match self.content {
            Content::One(name) => within(canvas, name, at, ALONE),
            Content::Both(first, second) => {
                within(canvas, first, (x - ASIDE, y), OF_TWO);
                within(canvas, second, (x + ASIDE, y), OF_TWO);
            }
            Content::Turn(number) => {
                let baseline = (x, y + 0.36 * NUMBER);
                canvas.text(&Text::plain(number), baseline, NUMBER, Anchor::Middle);
            }
        }
    }
}

/// Draws the symbol of a kind of special point within a ring.
fn within(canvas: &mut Canvas, name: &str, at: Point, radius: f64) {
    if let Some(symbol) = Symbol::named(name) {
        symbol.draw_within(canvas, at, radius);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::branch::Codim2Kind;

    #[test]
    fn every_kind_has_its_symbol_and_all_differ() {
        for (place, (name, _)) in Codim2Kind::NAMES.iter().enumerate() {
            let own = Codim2Symbol::named(name).expect(name);
            let others = CODIM2_SYMBOLS[..place].iter();
            assert!(others.clone().all(|it| it.content != own.content && it.words != own.words));
            match own.content {
                Content::Both(a, b) => assert!([a, b].iter().all(|it| Symbol::named(it).is_some())),
                Content::One(name) => assert!(Symbol::named(name).is_some()),
                Content::Turn(number) => assert!(name.ends_with(number)),
            }
        }
    }
}
