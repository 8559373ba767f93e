//! A panel: a frame with ticks, numbers and labels, and what stands above it.

use plotters::style::RGBColor;

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Point, Reading, Rect, Stroke};
use super::raster::Raster;
use super::scale::Spacing;
use super::style::{
    CURVE_WIDTH, FAINT_INK, FRAME_WIDTH, INK, LABEL_GAP, LABEL_SIZE, MAJOR_LENGTH, MINOR_LENGTH,
    MINOR_WIDTH, SMALL_SIZE, TICK_GAP,
};
use super::text::Text;

/// The side of the frame that ticks point to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pointing {
    /// Into the panel, from all four sides.
    Inward,
    /// Out of the panel, where its inside is covered.
    Outward,
}

/// What stands for a series in a legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mark {
    /// A line.
    Line(Stroke),
    /// A disc.
    Disc(RGBColor, f64),
    /// A ring.
    Ring(RGBColor, f64),
    /// An area.
    Patch(RGBColor),
    /// The area without values.
    Hatched,
}

/// What stands above a panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Header {
    /// Which panel it is, if there are several.
    pub letter: Option<char>,
    /// Where its axes are held.
    pub note: Option<Text>,
    /// What its marks mean.
    pub legend: Vec<(Mark, Text)>,
}

/// A panel with its place on the page.
pub struct Panel {
    /// The frame around the data.
    pub frame: Rect,
    /// The abscissa.
    pub x: Axis,
    /// The ordinate.
    pub y: Axis,
    /// Distance of the ordinate's label from the frame [pt].
    pub label_distance: f64,
    /// Where ticks point.
    pub pointing: Pointing,
    /// What stands above it.
    pub header: Header,
}

/// Width of a mark in a legend [pt].
const MARK_WIDTH: f64 = 13.0;
/// Distance between a mark and its words [pt].
const MARK_GAP: f64 = 3.0;
/// Distance between entries of a legend [pt].
const ENTRY_GAP: f64 = 9.0;

impl Panel {
    /// The place of a value on the page.
    pub fn place(&self, x: f64, y: f64) -> Point {
        (
            self.frame.left + self.x.scale.share(x) * self.frame.width(),
            self.frame.bottom - self.y.scale.share(y) * self.frame.height(),
        )
    }

    /// The places of values on the page, without those that have none.
    pub fn places(&self, values: &[(f64, f64)]) -> Vec<Point> {
        let finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
        values.iter().filter(|value| finite(value)).map(|(x, y)| self.place(*x, *y)).collect()
    }

    /// A curve, broken where values are missing.
    pub fn curve(&self, canvas: &mut Canvas, values: &[(f64, f64)], stroke: Stroke) {
        canvas.clipped(self.frame, |canvas| {
            for piece in values.split(|(x, y)| !x.is_finite() || !y.is_finite()) {
                let places = self.places(piece);
                match places.as_slice() {
                    [] => {}
                    [alone] => canvas.discs(&[(*alone, stroke.colour)], CURVE_WIDTH),
                    places => canvas.line(&thinned(places), stroke),
                }
            }
        });
    }

    /// A thin line at zero, where both signs occur along the ordinate.
    pub fn mark_zero(&self, canvas: &mut Canvas) {
        if self.y.scale.spacing == Spacing::Linear && self.y.scale.low * self.y.scale.high < 0.0 {
            let zero = [(self.x.scale.low, 0.0), (self.x.scale.high, 0.0)];
            self.curve(canvas, &zero, Stroke::solid(FAINT_INK, MINOR_WIDTH));
        }
    }

    /// The frame, ticks, numbers, labels and header, over the data.
    pub fn finish(&self, canvas: &mut Canvas) {
        if self.x.empty || self.y.empty {
            let middle = (self.frame.left + self.frame.right) / 2.0;
            let centre = (middle, (self.frame.top + self.frame.bottom) / 2.0);
            let text = Text::plain("no finite values");
            canvas.label(&text, centre, SMALL_SIZE, Anchor::Middle, Reading::Across, FAINT_INK);
        }
        self.draw_ticks(canvas);
        canvas.frame(self.frame, Stroke::solid(INK, FRAME_WIDTH));
        self.draw_numbers(canvas);
        self.draw_labels(canvas);
        self.draw_header(canvas);
    }

    fn draw_ticks(&self, canvas: &mut Canvas) {
        let majors = |axis: &Axis| axis.ticks.major.iter().map(|t| t.value).collect::<Vec<_>>();
        let (x, y) = (majors(&self.x), majors(&self.y));
        let major = self.tick_lines(&x, &y, MAJOR_LENGTH);
        canvas.segments(&major, Stroke::solid(INK, FRAME_WIDTH));
        let minor = self.tick_lines(&self.x.ticks.minor, &self.y.ticks.minor, MINOR_LENGTH);
        canvas.segments(&minor, Stroke::solid(INK, MINOR_WIDTH));
    }

    fn tick_lines(&self, x: &[f64], y: &[f64], length: f64) -> Vec<(Point, Point)> {
        let mut lines = Vec::new();
        let Rect { left, top, right, bottom } = self.frame;
        for value in x {
            let (at, _) = self.place(*value, self.y.scale.low);
            match self.pointing {
                Pointing::Inward => {
                    lines.push(((at, bottom), (at, bottom - length)));
                    lines.push(((at, top), (at, top + length)));
                }
                Pointing::Outward => lines.push(((at, bottom), (at, bottom + length))),
            }
        }
        for value in y {
            let (_, at) = self.place(self.x.scale.low, *value);
            match self.pointing {
                Pointing::Inward => {
                    lines.push(((left, at), (left + length, at)));
                    lines.push(((right, at), (right - length, at)));
                }
                Pointing::Outward => lines.push(((left, at), (left - length, at))),
            }
        }
        lines
    }

    fn draw_numbers(&self, canvas: &mut Canvas) {
        let outside = self.tick_room();
        if self.x.numbered {
            let baseline = self.frame.bottom + outside + 0.75 * SMALL_SIZE;
            for tick in &self.x.ticks.major {
                let (at, _) = self.place(tick.value, self.y.scale.low);
                let text = Text::markup(&tick.label);
                canvas.text(&text, (at, baseline), SMALL_SIZE, Anchor::Middle);
            }
        }
        if self.y.numbered {
            for tick in &self.y.ticks.major {
                let (_, at) = self.place(self.x.scale.low, tick.value);
                let place = (self.frame.left - outside, at + 0.32 * SMALL_SIZE);
                canvas.text(&Text::markup(&tick.label), place, SMALL_SIZE, Anchor::End);
            }
        }
    }

    fn tick_room(&self) -> f64 {
        tick_room(self.pointing)
    }

    fn draw_labels(&self, canvas: &mut Canvas) {
        if self.x.labelled {
            let middle = (self.frame.left + self.frame.right) / 2.0;
            let numbers = if self.x.numbered { SMALL_SIZE + LABEL_GAP } else { 0.0 };
            let baseline = self.frame.bottom + self.tick_room() + numbers + 0.75 * LABEL_SIZE;
            canvas.text(&self.x.label, (middle, baseline), LABEL_SIZE, Anchor::Middle);
        }
        if self.y.labelled {
            draw_upward(canvas, &self.y, self.frame, self.frame.left - self.label_distance);
        }
    }

    fn draw_header(&self, canvas: &mut Canvas) {
        let baseline = self.frame.top - 4.0;
        let mut left = self.frame.left;
        if let Some(letter) = self.header.letter {
            let text = Text::bold(&format!("({letter})"));
            canvas.text(&text, (left, baseline), LABEL_SIZE, Anchor::Start);
            left += text.width(LABEL_SIZE) + 5.0;
        }
        if let Some(note) = &self.header.note {
            canvas.text(note, (left, baseline), SMALL_SIZE, Anchor::Start);
        }
        let mut at = self.frame.right - legend_width(&self.header.legend);
        for (mark, words) in &self.header.legend {
            draw_mark(canvas, *mark, (at, baseline - 0.3 * SMALL_SIZE));
            at += MARK_WIDTH + MARK_GAP;
            canvas.text(words, (at, baseline), SMALL_SIZE, Anchor::Start);
            at += words.width(SMALL_SIZE) + ENTRY_GAP;
        }
    }
}

/// Distance between a frame and its numbers [pt].
pub fn tick_room(pointing: Pointing) -> f64 {
    match pointing {
        Pointing::Inward => TICK_GAP,
        Pointing::Outward => TICK_GAP + MAJOR_LENGTH - 1.0,
    }
}

/// The label of an upright axis, its last baseline at `x`; in two lines where it is too long.
pub fn draw_upward(canvas: &mut Canvas, axis: &Axis, frame: Rect, x: f64) {
    let middle = (frame.top + frame.bottom) / 2.0;
    let mut set = |text: &Text, x: f64| {
        canvas.label(text, (x, middle), LABEL_SIZE, Anchor::Middle, Reading::Upward, INK);
    };
    match label_rows(axis, frame.height()) {
        1 => set(&axis.label, x),
        _ => {
            set(&axis.label_lines.0, x - 1.15 * LABEL_SIZE);
            set(&axis.label_lines.1, x);
        }
    }
}

/// How many lines the label of an upright axis of `length` [pt] takes.
pub fn label_rows(axis: &Axis, length: f64) -> usize {
    let fits = axis.label.width(LABEL_SIZE) <= length + 6.0;
    if fits || axis.label_lines.1.content().is_empty() { 1 } else { 2 }
}

/// Width of a legend in a row [pt].
pub fn legend_width(legend: &[(Mark, Text)]) -> f64 {
    let entries: f64 = legend.iter().map(|(_, words)| words.width(SMALL_SIZE)).sum();
    let count = legend.len() as f64;
    entries + count * (MARK_WIDTH + MARK_GAP) + (count - 1.0).max(0.0) * ENTRY_GAP
}

/// A mark of a legend, from its left end at the height of its middle.
pub fn draw_mark(canvas: &mut Canvas, mark: Mark, at: Point) {
    let (left, middle) = at;
    let centre = (left + MARK_WIDTH / 2.0, middle);
    let patch = Rect {
        left: left + 1.0,
        top: middle - 3.3,
        right: left + MARK_WIDTH - 1.0,
        bottom: middle + 3.3,
    };
    match mark {
        Mark::Line(stroke) => canvas.line(&[at, (left + MARK_WIDTH, middle)], stroke),
        Mark::Disc(colour, radius) => canvas.discs(&[(centre, colour)], radius),
        Mark::Ring(colour, radius) => {
            canvas.rings(&[centre], radius, Stroke::solid(colour, CURVE_WIDTH));
        }
        Mark::Patch(colour) => canvas.fill(patch, colour),
        Mark::Hatched => canvas.image(patch, &Raster::cells(patch, |_| 0, |_| 0, |_, _| None)),
    }
    if matches!(mark, Mark::Patch(_) | Mark::Hatched) {
        canvas.frame(patch, Stroke::solid(INK, MINOR_WIDTH));
    }
}

/// `places` without those too close to the last to be told apart in print.
fn thinned(places: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::with_capacity(places.len());
    for (index, place) in places.iter().enumerate() {
        let far = kept.last().is_none_or(|last| (place.0 - last.0).hypot(place.1 - last.1) > 0.06);
        if far || index + 1 == places.len() {
            kept.push(*place);
        }
    }
    kept
}
