//! The page of a figure: panels in rows and columns, with exactly the room their labels need.

use super::axis::{Along, Axis, AxisRequest};
use super::canvas::{Anchor, Canvas};
use super::geometry::Rect;
use super::header::Header;
use super::panel::{Panel, Pointing, tick_room};
use super::style::{
    BORDER, LABEL_GAP, LABEL_SIZE, ONE_COLUMN, PANEL_GAP, POINTS_PER_MM, SMALL_SIZE, TITLE_SIZE,
    WIDTHS,
};
use super::text::Text;
use crate::study::Drawing;

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
    /// Room right of each column, for a colour bar or a legend [pt].
    pub column_room: f64,
    /// Room on the right of all columns, for a colour bar or a legend that is theirs [pt].
    pub right_room: f64,
    /// Room below all panels [pt].
    pub bottom_room: f64,
    /// Where ticks point.
    pub pointing: Pointing,
}

/// Room left of a column of frames [pt].
#[derive(Clone, Default)]
struct LeftRoom {
    /// For ticks and numbers, up to the baseline of the label.
    numbers: f64,
    /// For the lines of the label above that baseline.
    label: f64,
}

/// Distance between lines of the heading [pt].
const TITLE_LINE: f64 = 1.25 * TITLE_SIZE;
/// Room for a label, from its baseline to the border [pt].
const DESCENT: f64 = 0.28 * LABEL_SIZE;

impl PageRequest {
    /// A page of one panel whose frame has this height [pt], of the width of a column unless the request says another.
    pub fn of_one(drawing: &Drawing, panel: PanelRequest, height: f64, pointing: Pointing) -> Self {
        PageRequest {
            title: drawing.title.clone(),
            width_mm: drawing.width_mm.unwrap_or(ONE_COLUMN),
            heights: vec![height],
            rows: vec![vec![panel]],
            column_room: 0.0,
            right_room: 0.0,
            bottom_room: 0.0,
            pointing,
        }
    }

    /// Lays the page out: an empty canvas and the panels in their places.
    pub fn lay_out(mut self) -> (Canvas, Vec<Vec<Panel>>) {
        let width = self.width_mm.clamp(WIDTHS.0, WIDTHS.1) * POINTS_PER_MM;
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(1).max(1);
        let title = self.title_lines(width);
        let lefts = self.left_rooms(columns);
        let ends = self.right_ends();
        let taken: f64 = lefts.iter().map(|room| room.numbers + room.label).sum::<f64>()
            + PANEL_GAP * (columns - 1) as f64
            + self.column_room * columns as f64
            + self.right_room;
        let inner = width - 2.0 * BORDER - taken - ends;
        let frame_width = (inner / columns as f64).max(20.0);
        let mut top = BORDER + title.len() as f64 * TITLE_LINE;
        let mut panels = Vec::new();
        for (row, height) in std::mem::take(&mut self.rows).into_iter().zip(&self.heights) {
            let above = row.iter().map(|it| it.header.room(frame_width)).fold(0.0, f64::max);
            let mut below: f64 = 0.0;
            let mut left = BORDER;
            let mut placed = Vec::new();
            for (request, room) in row.into_iter().zip(&lefts) {
                left += room.numbers + room.label;
                let (right, top) = (left + frame_width, top + above);
                let frame = Rect { left, top, right, bottom: top + height };
                let panel = self.place(request, frame, room.numbers);
                below = below.max(self.bottom_room(&panel));
                placed.push(panel);
                left = right + self.column_room + PANEL_GAP;
            }
            panels.push(placed);
            top += above + height + below;
        }
        let mut canvas = Canvas::new(width, top + self.bottom_room + BORDER - 1.0);
        for (line, words) in title.iter().enumerate() {
            let baseline = BORDER + (line as f64 + 0.8) * TITLE_LINE;
            canvas.text(words, (width / 2.0, baseline), TITLE_SIZE, Anchor::Middle);
        }
        (canvas, panels)
    }

    fn title_lines(&self, width: f64) -> Vec<Text> {
        let title = Text::plain(self.title.as_deref().unwrap_or(""));
        title.wrapped(width - 2.0 * BORDER, TITLE_SIZE)
    }

    /// Room left of each column.
    fn left_rooms(&self, columns: usize) -> Vec<LeftRoom> {
        let mut rooms = vec![LeftRoom::default(); columns];
        for (row, height) in self.rows.iter().zip(&self.heights) {
            for (room, request) in rooms.iter_mut().zip(row) {
                let axis = Axis::new(&request.y, Along::Up, *height);
                room.numbers = room.numbers.max(self.numbers_room(&axis));
                room.label = room.label.max(axis.label_room() - DESCENT);
            }
        }
        rooms
    }

    /// Distance between a frame and the nearest baseline of its ordinate's label.
    fn numbers_room(&self, axis: &Axis) -> f64 {
        let numbers = if axis.numbered { axis.widest + LABEL_GAP } else { 0.0 };
        tick_room(self.pointing) + numbers + if axis.label.is_empty() { 0.0 } else { DESCENT }
    }

    /// Room for the part of the last number that reaches beyond the frame.
    fn right_ends(&self) -> f64 {
        let last = self.rows.iter().filter_map(|row| row.last());
        let half = |request: &PanelRequest| {
            let axis = Axis::new(&request.x, Along::Across, 150.0);
            if axis.numbered { axis.widest / 2.0 } else { 0.0 }
        };
        if self.right_room + self.column_room > 0.0 {
            0.0
        } else {
            last.map(half).fold(2.0, f64::max)
        }
    }

    fn bottom_room(&self, panel: &Panel) -> f64 {
        let numbers = if panel.x.numbered { SMALL_SIZE } else { 0.0 };
        let gap = if panel.x.label.is_empty() { 0.0 } else { LABEL_GAP };
        match panel.x.numbered || !panel.x.label.is_empty() {
            false => 0.0,
            true => tick_room(self.pointing) + numbers + gap + panel.x.label_room(),
        }
    }

    fn place(&self, request: PanelRequest, frame: Rect, label_distance: f64) -> Panel {
        let x = Axis::new(&request.x, Along::Across, frame.width());
        let y = Axis::new(&request.y, Along::Up, frame.height());
        let PanelRequest { header, .. } = request;
        Panel { frame, x, y, label_distance, pointing: self.pointing, header }
    }
}

/// The letter of panel number `index`, where there are `count` of them.
pub fn letter(index: usize, count: usize) -> Option<char> {
    (count > 1).then(|| char::from(b'a' + (index % 26) as u8))
}
