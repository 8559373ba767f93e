//! A table below the panels of a figure: a mark, what it stands for, and numbers in columns.

use super::canvas::{Anchor, Canvas, Stroke};
use super::header::{Mark, draw_mark};
use super::style::{BORDER, INK, MINOR_WIDTH, SMALL_SIZE};
use super::text::Text;

/// Distance between the baselines of lines [pt].
const LINE: f64 = 10.5;
/// Room for a mark [pt].
const MARK: f64 = 9.0;
/// Least distance between columns, at full size [pt].
const GAP: f64 = 7.0;
/// Room above the headings [pt].
const ABOVE: f64 = 6.0;
/// From a baseline to the rule below it [pt].
const RULE: f64 = 3.2;

/// A row.
pub struct Row {
    /// Its mark.
    pub mark: Mark,
    /// What it stands for.
    pub name: Text,
    /// Its numbers.
    pub cells: Vec<Text>,
}

/// Rows under headings.
#[derive(Default)]
pub struct Table {
    /// What each column of numbers holds, and its unit.
    pub headings: Vec<[Text; 2]>,
    /// The rows.
    pub rows: Vec<Row>,
}

impl Table {
    /// Room below the panels [pt].
    pub fn room(&self) -> f64 {
        if self.rows.is_empty() { 0.0 } else { ABOVE + (self.rows.len() + 2) as f64 * LINE + RULE }
    }

    /// Draws the table at the foot of a page; smaller than other text where that is needed to fit its width.
    pub fn draw_below(&self, canvas: &mut Canvas) {
        if self.rows.is_empty() {
            return;
        }
        let [page_width, page_height] = canvas.extent();
        let (left, top) = (BORDER, page_height - BORDER - self.room());
        let width = page_width - 2.0 * BORDER;
        let names = self.rows.iter().map(|row| row.name.width(SMALL_SIZE)).fold(0.0, f64::max);
        let columns: Vec<f64> = (0..self.headings.len()).map(|at| self.column_width(at)).collect();
        let gaps = self.headings.len() as f64 * GAP;
        let needed = MARK + names + columns.iter().sum::<f64>() + gaps;
        let size = SMALL_SIZE * (width / needed).min(1.0);
        let scale = size / SMALL_SIZE;
        let gap = GAP * scale + (width - needed * scale).max(0.0) / self.headings.len() as f64;
        let mut right = left + (MARK + names) * scale;
        let first = top + ABOVE + 0.8 * LINE;
        for (at, (headings, column)) in self.headings.iter().zip(&columns).enumerate() {
            right += gap + column * scale;
            for (line, heading) in headings.iter().enumerate() {
                canvas.text(heading, (right, below(first, line)), size, Anchor::End);
            }
            for (place, row) in self.rows.iter().enumerate() {
                let cell = row.cells.get(at).cloned().unwrap_or_default();
                canvas.text(&cell, (right, below(first, 2 + place) + RULE), size, Anchor::End);
            }
        }
        let rule = below(first, 1) + RULE;
        canvas.line(&[(left, rule), (right, rule)], Stroke::solid(INK, MINOR_WIDTH));
        for (place, row) in self.rows.iter().enumerate() {
            let baseline = below(first, 2 + place) + RULE;
            draw_mark(canvas, row.mark, (left, baseline - 0.3 * size));
            canvas.text(&row.name, (left + MARK * scale, baseline), size, Anchor::Start);
        }
    }

    fn column_width(&self, at: usize) -> f64 {
        let cells = self.rows.iter().filter_map(|row| row.cells.get(at));
        let widths = self.headings[at].iter().chain(cells).map(|text| text.width(SMALL_SIZE));
        widths.fold(0.0, f64::max)
    }
}

/// The baseline so many lines below the first.
fn below(first: f64, lines: usize) -> f64 {
    first + lines as f64 * LINE
}
