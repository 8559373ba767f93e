//! A legend below all panels, as a caption stands: that of a page which would take more than two lines above them.

use super::canvas::Canvas;
use super::header::{
    Entry, HEADER_LINE, broken, draw_entries, entry_width, in_lines, legend_width,
};
use super::style::{BORDER, SMALL_SIZE};

/// A legend of up to so many widths of the page stands above its panel.
const MOST_ABOVE: f64 = 1.6;
/// No entry above a panel, which is narrower than the page, takes more than so much of its width.
const WIDEST_ABOVE: f64 = 0.75;
/// Distance from the panels to the first line [pt].
const GAP: f64 = 5.0;

/// The entries of a legend below the panels; none where it stands above them.
#[derive(Default)]
pub struct Caption {
    entries: Vec<Entry>,
}

impl Caption {
    /// Takes the legend of a page off its panel, where just one has entries and it is long for a page of this inner width [pt].
    pub fn taken_from<'l>(
        legends: impl Iterator<Item = &'l mut Vec<Entry>>,
        width: f64,
    ) -> Caption {
        let mut legends: Vec<&mut Vec<Entry>> = legends.filter(|it| !it.is_empty()).collect();
        match &mut legends[..] {
            [only] if legend_width(only) > MOST_ABOVE * width || is_wide(only, width) => {
                Caption { entries: broken(std::mem::take(only), width) }
            }
            _ => Caption::default(),
        }
    }

    /// Room on a page of this inner width [pt].
    pub fn room(&self, width: f64) -> f64 {
        match in_lines(&self.entries, width).len() {
            0 => 0.0,
            lines => GAP + lines as f64 * HEADER_LINE,
        }
    }

    /// Draws it at the lower end of a page of this size [pt].
    pub fn draw(&self, canvas: &mut Canvas, [width, height]: [f64; 2]) {
        let lines = in_lines(&self.entries, width - 2.0 * BORDER);
        for (line, entries) in lines.iter().rev().enumerate() {
            let baseline = height - BORDER - 0.3 * SMALL_SIZE - line as f64 * HEADER_LINE;
            draw_entries(canvas, entries, (BORDER, baseline));
        }
    }
}

/// Whether an entry is too wide to stand above a panel of a page of this inner width [pt].
fn is_wide(legend: &[Entry], width: f64) -> bool {
    legend.iter().any(|entry| entry_width(entry) > WIDEST_ABOVE * width)
}
