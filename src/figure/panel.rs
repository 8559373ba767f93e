//! A panel: a frame with ticks, numbers and labels, and what stands above it.

use plotters::style::WHITE;

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Reading, Stroke};
use super::data::Value;
use super::geometry::{Point, Rect};
use super::header::Header;
use super::scale::Spacing;
use super::style::{
    CURVE_WIDTH, FAINT_INK, FRAME_WIDTH, INK, LABEL_GAP, LABEL_SIZE, LINE_HEIGHT, MAJOR_LENGTH,
    MINOR_LENGTH, MINOR_WIDTH, SMALL_SIZE, TICK_GAP,
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

/// A panel with its place on the page.
pub struct Panel {
    /// Which panel of its page it is, from 1.
    pub number: usize,
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
    /// Words that stand in it, with their places in the units of its axes.
    pub texts: Vec<(Text, (f64, f64))>,
}

impl Panel {
    /// The place of a value on the page.
    pub fn place(&self, x: f64, y: f64) -> Point {
        (
            self.frame.left + self.x.scale.share(x) * self.frame.width(),
            self.frame.bottom - self.y.scale.share(y) * self.frame.height(),
        )
    }

    /// Notes points that are drawn, where the data of the figure are to be told.
    pub fn record(
        &self,
        canvas: &mut Canvas,
        series: &str,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) {
        self.record_values(canvas, series, points.into_iter().map(|at| (at, Value::None)));
    }

    /// Notes points or cells with what they show.
    pub fn record_values(
        &self,
        canvas: &mut Canvas,
        series: &str,
        rows: impl IntoIterator<Item = ((f64, f64), Value)>,
    ) {
        if let Some(data) = &mut canvas.data {
            data.add(self.number, series, rows.into_iter());
        }
    }

    /// Whether a value lies inside the frame.
    pub fn holds(&self, x: f64, y: f64) -> bool {
        self.x.scale.holds(x) && self.y.scale.holds(y)
    }

    /// The places of those values on the page that lie inside the frame.
    pub fn places(&self, values: &[(f64, f64)]) -> Vec<Point> {
        let inside = values.iter().filter(|(x, y)| self.holds(*x, *y));
        inside.map(|(x, y)| self.place(*x, *y)).collect()
    }

    /// A curve, broken where values are missing.
    pub fn curve(&self, canvas: &mut Canvas, values: &[(f64, f64)], stroke: Stroke) {
        canvas.clipped(self.frame, |canvas| {
            let places: Vec<Point> = values.iter().map(|(x, y)| self.place(*x, *y)).collect();
            for places in places.split(|(x, y)| !x.is_finite() || !y.is_finite()) {
                match places {
                    [] => {}
                    [alone] => canvas.discs(&[(*alone, stroke.colour)], CURVE_WIDTH),
                    places => canvas.line(&thinned(places), stroke),
                }
            }
        });
    }

    /// A thin line at zero, where both signs occur along the ordinate.
    pub fn mark_zero(&self, canvas: &mut Canvas) {
        // The margin alone does not make values of both signs.
        let inside = (0.06..0.94).contains(&self.y.scale.share(0.0));
        if self.y.scale.spacing != Spacing::Log && inside && !self.y.empty {
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
        for (words, (x, y)) in &self.texts {
            self.draw_words(canvas, words, self.place(*x, *y));
        }
        self.draw_ticks(canvas);
        canvas.frame(self.frame, Stroke::solid(INK, FRAME_WIDTH));
        self.draw_numbers(canvas);
        self.draw_labels(canvas);
        self.header.draw(canvas, self.frame);
    }

    /// Words around a place, moved into the frame, on white, so that they can be read over any colour.
    fn draw_words(&self, canvas: &mut Canvas, words: &Text, (x, y): Point) {
        let [across, up] = [words.width(SMALL_SIZE) / 2.0 + 1.5, 0.58 * SMALL_SIZE];
        let Rect { left, right, top, bottom } = self.frame;
        let x = x.min(right - across - MAJOR_LENGTH).max(left + across + MAJOR_LENGTH);
        let y = y.min(bottom - up - MAJOR_LENGTH).max(top + up + MAJOR_LENGTH);
        canvas
            .fill(Rect { left: x - across, top: y - up, right: x + across, bottom: y + up }, WHITE);
        canvas.text(words, (x, y + 0.27 * SMALL_SIZE), SMALL_SIZE, Anchor::Middle);
    }

    fn draw_ticks(&self, canvas: &mut Canvas) {
        let (x, y) = (self.x.ticks.numbered(), self.y.ticks.numbered());
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
        let middle = (self.frame.left + self.frame.right) / 2.0;
        let numbers = if self.x.numbered { SMALL_SIZE + LABEL_GAP } else { 0.0 };
        let mut baseline = self.frame.bottom + self.tick_room() + numbers + 0.75 * LABEL_SIZE;
        for line in &self.x.label {
            canvas.text(line, (middle, baseline), LABEL_SIZE, Anchor::Middle);
            baseline += LINE_HEIGHT * LABEL_SIZE;
        }
        let lines = self.y.label.len().max(1) as f64 - 1.0;
        let first = self.frame.left - self.label_distance - lines * LINE_HEIGHT * LABEL_SIZE;
        draw_upward(canvas, &self.y, self.frame, first);
    }
}

/// Distance between a frame and its numbers [pt].
pub fn tick_room(pointing: Pointing) -> f64 {
    match pointing {
        Pointing::Inward => TICK_GAP,
        Pointing::Outward => TICK_GAP + MAJOR_LENGTH - 1.0,
    }
}

/// The lines of an upright axis' label beside `frame`, the first with its baseline at `first`.
pub fn draw_upward(canvas: &mut Canvas, axis: &Axis, frame: Rect, first: f64) {
    let middle = (frame.top + frame.bottom) / 2.0;
    for (line, text) in axis.label.iter().enumerate() {
        let at = (first + line as f64 * LINE_HEIGHT * LABEL_SIZE, middle);
        canvas.label(text, at, LABEL_SIZE, Anchor::Middle, Reading::Upward, INK);
    }
}

/// `places` with at most four points in each column narrower than print can show: where the path
/// enters it and leaves it, and its highest and lowest point.
fn thinned(places: &[Point]) -> Vec<Point> {
    let mut kept = Vec::new();
    for group in places.chunk_by(|a, b| (a.0 / 0.1).floor() == (b.0 / 0.1).floor()) {
        let all = 0..group.len();
        let lowest = all.clone().min_by(|a, b| group[*a].1.total_cmp(&group[*b].1));
        let highest = all.max_by(|a, b| group[*a].1.total_cmp(&group[*b].1));
        let mut chosen = vec![0, group.len() - 1];
        chosen.extend(lowest.into_iter().chain(highest));
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen.into_iter().map(|index| group[index]));
    }
    kept
}
