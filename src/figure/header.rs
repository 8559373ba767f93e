//! What stands above a panel: its letter, a note, and the legend.

use plotters::style::RGBColor;

use super::canvas::{Anchor, Canvas, Stroke};
use super::codim2_symbol::{Codim2Symbol, RING};
use super::geometry::{Point, Rect};
use super::raster::{Fill, Raster};
use super::style::{
    CURVE_WIDTH, HEADER, INK, LABEL_SIZE, MINOR_WIDTH, PAPER, POINT_RADIUS, POINT_RIM, SMALL_SIZE,
};
use super::symbol::Symbol;
use super::text::Text;

/// What stands for a series in a legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mark {
    /// A line.
    Line(Stroke),
    /// A short upright line.
    Tick(Stroke),
    /// A disc.
    Disc(RGBColor, f64),
    /// A disc of the colour with a rim that stands out on areas.
    Rimmed(RGBColor),
    /// A ring.
    Ring(RGBColor, f64),
    /// An area.
    Patch(RGBColor),
    /// An area that is filled so.
    Filled(Fill),
    /// The symbol of a special point.
    Symbol(Symbol),
    /// The symbol of a point of codimension 2.
    Codim2(Codim2Symbol),
    /// No mark: the text continues that of the entry before.
    Nothing,
}

impl Mark {
    /// Width in a legend with the gap behind it [pt].
    fn room(self) -> f64 {
        if self == Mark::Nothing { 0.0 } else { self.width() + MARK_GAP }
    }

    /// Width in a legend [pt].
    fn width(self) -> f64 {
        match self {
            Mark::Disc(..) | Mark::Rimmed(_) | Mark::Ring(..) | Mark::Tick(_) | Mark::Symbol(_) => {
                POINT_WIDTH
            }
            Mark::Nothing => 0.0,
            Mark::Codim2(_) => 2.0 * RING,
            Mark::Line(_) | Mark::Patch(_) | Mark::Filled(_) => MARK_WIDTH,
        }
    }
}

/// A mark of a legend and what it means.
pub type Entry = (Mark, Text);

/// What stands above a panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Header {
    /// Which panel it is, if there are several.
    pub letter: Option<char>,
    /// Where its axes are held.
    pub note: Option<Text>,
    /// What its marks mean.
    pub legend: Vec<Entry>,
}

/// Width of a line or an area in a legend [pt].
const MARK_WIDTH: f64 = 13.0;
/// Width of a point in a legend [pt].
const POINT_WIDTH: f64 = 6.0;
/// Distance between a mark and its text [pt].
const MARK_GAP: f64 = 3.0;
/// Distance between lines of a header [pt].
pub const HEADER_LINE: f64 = 10.5;
/// Distance between entries of a legend [pt].
const ENTRY_GAP: f64 = 9.0;

impl Header {
    /// Draws the header above `frame`.
    pub fn draw(&self, canvas: &mut Canvas, frame: Rect) {
        let baseline = frame.top - 4.0;
        let notes = self.note_lines(frame.width());
        let first = baseline - (notes.len().max(1) - 1) as f64 * HEADER_LINE;
        if let Some(letter) = self.letter {
            canvas.text(&letter_text(letter), (frame.left, first), LABEL_SIZE, Anchor::Start);
        }
        let left = frame.left + self.letter_width();
        for (line, note) in notes.iter().enumerate() {
            let at = (left, first + line as f64 * HEADER_LINE);
            canvas.text(note, at, SMALL_SIZE, Anchor::Start);
        }
        let lines = self.legend_lines(frame.width());
        let several = lines.len() > 1;
        for (line, entries) in lines.into_iter().rev().enumerate() {
            let left = if several { frame.left } else { frame.right - legend_width(entries) };
            draw_entries(canvas, entries, (left, baseline - line as f64 * HEADER_LINE));
        }
    }

    /// Width of the panel letter with the gap after it [pt].
    fn letter_width(&self) -> f64 {
        self.letter.map_or(0.0, |letter| letter_text(letter).width(LABEL_SIZE) + 5.0)
    }

    /// The note in lines that fit beside the letter above a frame of `width` [pt].
    fn note_lines(&self, width: f64) -> Vec<Text> {
        let Some(note) = &self.note else { return Vec::new() };
        note.wrapped(width - self.letter_width(), SMALL_SIZE)
    }

    /// Width of the panel letter and the note [pt].
    fn left_width(&self) -> f64 {
        self.letter_width()
            + self.note.as_ref().map_or(0.0, |note| note.width(SMALL_SIZE) + ENTRY_GAP)
    }

    /// The legend in lines that fit `width` [pt], the lowest last; it shares its line with letter
    /// and note where there is room for all, and else stands above them.
    fn legend_lines(&self, width: f64) -> Vec<&[Entry]> {
        let is_short = self.note_lines(width).len() <= 1;
        if is_short && self.left_width() + legend_width(&self.legend) <= width {
            return vec![&self.legend];
        }
        let mut lines = in_lines(&self.legend, width);
        let below = if self.left_width() > 0.0 { self.note_lines(width).len().max(1) } else { 0 };
        lines.extend(std::iter::repeat_n(&[] as &[Entry], below));
        lines
    }

    /// Room above a frame of `width` [pt].
    pub fn room(&self, width: f64) -> f64 {
        if self.left_width() == 0.0 && self.legend.is_empty() {
            return 0.5 * SMALL_SIZE;
        }
        HEADER + (self.legend_lines(width).len() - 1) as f64 * HEADER_LINE
    }
}

/// The text of a panel letter.
fn letter_text(letter: char) -> Text {
    Text::bold(&format!("({letter})"))
}

/// Entries in lines that fit `width` [pt].
pub fn in_lines(legend: &[Entry], width: f64) -> Vec<&[Entry]> {
    let mut lines = Vec::new();
    let mut rest = legend;
    while !rest.is_empty() {
        let mut counts = (1..=rest.len()).rev();
        let count = counts.find(|count| legend_width(&rest[..*count]) <= width).unwrap_or(1);
        lines.push(&rest[..count]);
        rest = &rest[count..];
    }
    lines
}

/// Draws entries in a line, from the left end of its baseline.
pub fn draw_entries(canvas: &mut Canvas, entries: &[Entry], (left, baseline): Point) {
    let mut at = left;
    for (mark, words) in entries {
        draw_mark(canvas, *mark, (at, baseline - 0.3 * SMALL_SIZE));
        at += mark.room();
        canvas.text(words, (at, baseline), SMALL_SIZE, Anchor::Start);
        at += words.width(SMALL_SIZE) + ENTRY_GAP;
    }
}

/// Width of an entry [pt].
pub fn entry_width((mark, words): &Entry) -> f64 {
    mark.room() + words.width(SMALL_SIZE)
}

/// Entries of which none is wider than `width` [pt]: longer words go on without a mark.
pub fn broken(legend: Vec<Entry>, width: f64) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (mark, words) in legend {
        let mut lines = words.wrapped(width - mark.room(), SMALL_SIZE).into_iter();
        entries.extend(lines.next().map(|first| (mark, first)));
        entries.extend(lines.map(|line| (Mark::Nothing, line)));
    }
    entries
}

/// Width of a legend in a row [pt].
pub fn legend_width(legend: &[Entry]) -> f64 {
    let entries = legend.iter().map(entry_width);
    entries.sum::<f64>() + legend.len().saturating_sub(1) as f64 * ENTRY_GAP
}

/// Draws a disc with a rim of ink and one of paper, so that it stands out on any colour.
pub fn rimmed_disc(canvas: &mut Canvas, at: Point, colour: RGBColor) {
    canvas.discs(&[(at, PAPER)], POINT_RADIUS + POINT_RIM);
    canvas.discs(&[(at, INK)], POINT_RADIUS);
    canvas.discs(&[(at, colour)], POINT_RADIUS - POINT_RIM);
}

/// A mark of a legend, from its left end at the height of its middle.
pub fn draw_mark(canvas: &mut Canvas, mark: Mark, at: Point) {
    let (left, middle) = at;
    let centre = (left + mark.width() / 2.0, middle);
    let patch = Rect {
        left: left + 1.0,
        top: middle - 3.3,
        right: left + MARK_WIDTH - 1.0,
        bottom: middle + 3.3,
    };
    match mark {
        Mark::Line(stroke) => canvas.line(&[at, (left + MARK_WIDTH, middle)], stroke),
        Mark::Tick(stroke) => {
            let (x, y) = centre;
            canvas.line(&[(x, y - 3.0), (x, y + 3.0)], stroke);
        }
        Mark::Disc(colour, radius) => canvas.discs(&[(centre, colour)], radius),
        Mark::Rimmed(colour) => rimmed_disc(canvas, centre, colour),
        Mark::Ring(colour, radius) => {
            canvas.rings(&[centre], radius, Stroke::solid(colour, CURVE_WIDTH));
        }
        Mark::Symbol(symbol) => symbol.draw(canvas, centre),
        Mark::Codim2(symbol) => symbol.draw(canvas, centre),
        Mark::Nothing => {}
        Mark::Patch(colour) => canvas.fill(patch, colour),
        Mark::Filled(fill) => canvas.image(patch, &Raster::cells(patch, |_| 0, |_| 0, |_, _| fill)),
    }
    if matches!(mark, Mark::Patch(_) | Mark::Filled(_)) {
        canvas.frame(patch, Stroke::solid(INK, MINOR_WIDTH));
    }
}
