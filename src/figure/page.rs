//! The page of a figure: panels in rows and columns, with exactly the room their labels need.

use super::axis::{Along, Axis, AxisRequest};
use super::canvas::{Anchor, Canvas, Rect};
use super::panel::{Header, Panel, Pointing, label_rows, tick_room};
use super::style::{
    BORDER, HEADER, LABEL_GAP, LABEL_SIZE, PANEL_GAP, POINTS_PER_MM, SMALL_SIZE, TITLE_SIZE, WIDTHS,
};
use super::text::{Text, wrap};

/// What a panel is to show.
pub struct PanelRequest {
    /// The abscissa.
    pub x: AxisRequest,
    /// The ordinate.
    pub y: AxisRequest,
    /// What stands above it.
    pub header: Header,
}

/// What a page is to hold.
pub struct PageRequest {
    /// Heading.
    pub title: Option<String>,
    /// Width [mm].
    pub width_mm: f64,
    /// Height of each row's frames [pt].
    pub heights: Vec<f64>,
    /// Panels, row by row; a last row may be shorter.
    pub rows: Vec<Vec<PanelRequest>>,
    /// Room on the right, for a colour bar or a legend [pt].
    pub right_room: f64,
    /// Where ticks point.
    pub pointing: Pointing,
}

/// Room for a label, from its baseline to the border [pt].
const DESCENT: f64 = 0.28 * LABEL_SIZE;

impl PageRequest {
    /// Lays the page out: an empty canvas and the panels in their places.
    pub fn lay_out(mut self) -> (Canvas, Vec<Vec<Panel>>) {
        let width = self.width_mm.clamp(WIDTHS.0, WIDTHS.1) * POINTS_PER_MM;
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(1).max(1);
        let title = self.title_lines(width);
        let lefts = self.left_rooms(columns);
        let ends = self.right_ends();
        let taken: f64 = lefts.iter().sum::<f64>() + PANEL_GAP * (columns - 1) as f64;
        let inner = width - 2.0 * BORDER - taken - self.right_room - ends;
        let frame_width = (inner / columns as f64).max(20.0);
        let mut top = BORDER + title.len() as f64 * 1.25 * TITLE_SIZE;
        let mut panels = Vec::new();
        for (row, height) in std::mem::take(&mut self.rows).into_iter().zip(&self.heights) {
            let above = if row.iter().any(has_header) { HEADER } else { 0.5 * SMALL_SIZE };
            let below = row.iter().map(|request| self.bottom_room(request)).fold(0.0, f64::max);
            let mut left = BORDER;
            let mut placed = Vec::new();
            for (column, request) in row.into_iter().enumerate() {
                left += lefts[column];
                let frame = Rect {
                    left,
                    top: top + above,
                    right: left + frame_width,
                    bottom: top + above + height,
                };
                placed.push(self.place(request, frame));
                left += frame_width + PANEL_GAP;
            }
            panels.push(placed);
            top += above + height + below;
        }
        let mut canvas = Canvas::new(width, top + BORDER - 1.0);
        for (line, words) in title.iter().enumerate() {
            let baseline = BORDER + (line as f64 + 0.8) * 1.25 * TITLE_SIZE;
            let text = Text::plain(words);
            canvas.text(&text, (width / 2.0, baseline), TITLE_SIZE, Anchor::Middle);
        }
        (canvas, panels)
    }

    fn title_lines(&self, width: f64) -> Vec<String> {
        let words = self.title.as_deref().unwrap_or("");
        wrap(words, width - 2.0 * BORDER, TITLE_SIZE)
    }

    /// Room for numbers and labels left of each column.
    fn left_rooms(&self, columns: usize) -> Vec<f64> {
        let mut rooms = vec![0.0; columns];
        for (row, height) in self.rows.iter().zip(&self.heights) {
            for (room, request) in rooms.iter_mut().zip(row) {
                *room = f64::max(*room, self.left_room(request, *height));
            }
        }
        rooms
    }

    fn left_room(&self, request: &PanelRequest, height: f64) -> f64 {
        let axis = Axis::new(&request.y, Along::Up, height);
        let lines = label_rows(&axis, height) as f64;
        let label = if axis.labelled { (1.15 * lines - 0.15) * LABEL_SIZE } else { 0.0 };
        self.label_distance(&axis) + label * 0.8
    }

    /// Distance between a frame and the baseline of its ordinate's label.
    fn label_distance(&self, axis: &Axis) -> f64 {
        let numbers = if axis.numbered { axis.widest + LABEL_GAP } else { 0.0 };
        tick_room(self.pointing) + numbers + if axis.labelled { DESCENT } else { 0.0 }
    }

    /// Room for the part of the last number that reaches beyond the frame.
    fn right_ends(&self) -> f64 {
        let last = self.rows.iter().filter_map(|row| row.last());
        let half = |request: &PanelRequest| {
            let axis = Axis::new(&request.x, Along::Across, 150.0);
            if axis.numbered { axis.widest / 2.0 } else { 0.0 }
        };
        if self.right_room > 0.0 { 0.0 } else { last.map(half).fold(2.0, f64::max) }
    }

    fn bottom_room(&self, request: &PanelRequest) -> f64 {
        let numbers = if request.x.numbered { SMALL_SIZE } else { 0.0 };
        let label = if request.x.labelled { LABEL_GAP + LABEL_SIZE } else { 0.0 };
        match (request.x.numbered, request.x.labelled) {
            (false, false) => 0.0,
            _ => tick_room(self.pointing) + numbers + label + 1.0,
        }
    }

    fn place(&self, request: PanelRequest, frame: Rect) -> Panel {
        let x = Axis::new(&request.x, Along::Across, frame.width());
        let y = Axis::new(&request.y, Along::Up, frame.height());
        let label_distance = self.label_distance(&y);
        let PanelRequest { header, .. } = request;
        Panel { frame, x, y, label_distance, pointing: self.pointing, header }
    }
}

fn has_header(request: &PanelRequest) -> bool {
    let Header { letter, note, legend } = &request.header;
    letter.is_some() || note.is_some() || !legend.is_empty()
}

/// The letter of panel number `index`, where there are `count` of them.
pub fn letter(index: usize, count: usize) -> Option<char> {
    (count > 1).then(|| char::from(b'a' + (index % 26) as u8))
}
