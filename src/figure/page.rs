//! The page of a figure: panels in rows and columns, with exactly the room their labels need.

use std::collections::BTreeSet;

use super::axis::{Along, Axis, AxisRequest};
use super::canvas::{Anchor, Canvas};
use super::caption::Caption;
use super::data::Data;
use super::geometry::Rect;
use super::header::{Header, Mark};
use super::panel::{Panel, Pointing, tick_room};
use super::quantity::Quantity;
use super::style::{
    BORDER, LABEL_GAP, LABEL_SIZE, ONE_COLUMN, PANEL_GAP, POINTS_PER_MM, SMALL_SIZE, TITLE_SIZE,
    TWO_COLUMNS,
};
use super::text::Text;
use crate::study::{Drawing, Size};

/// What a panel is to show.
#[derive(Clone)]
pub struct PanelRequest {
    /// The abscissa.
    pub x: AxisRequest,
    /// The ordinate.
    pub y: AxisRequest,
    /// What stands above it.
    pub header: Header,
}

/// Room beside frames, given their height [pt].
pub type Room<'a> = &'a dyn Fn(f64) -> f64;

/// No room at all.
pub const NO_ROOM: Room<'static> = &|_| 0.0;

/// What a page is to hold.
pub struct PageRequest<'a> {
    /// The figure, which sets its heading and its size.
    pub drawing: &'a Drawing,
    /// Width if the figure sets none [mm].
    pub width_mm: f64,
    /// Height of each row's frames, if the figure sets none, else relative to each other [pt].
    pub heights: Vec<f64>,
    /// Panels, row by row; a last row may be shorter.
    pub rows: Vec<Vec<PanelRequest>>,
    /// Room right of each column, for a colour bar or a legend, given the height of its frames.
    pub column_room: Room<'a>,
    /// Room on the right of all columns, for a colour bar or a legend that is theirs, given the height of all rows.
    pub right_room: Room<'a>,
    /// Room below all panels [pt].
    pub bottom_room: f64,
    /// Where ticks point.
    pub pointing: Pointing,
}

/// Where the parts of a page stand.
struct Arrangement {
    /// Width and height of the page [pt].
    size: [f64; 2],
    /// The lines of the heading.
    title: Vec<Text>,
    /// The frame of each panel with the distance of the ordinate's label from it.
    frames: Vec<Vec<(Rect, f64)>>,
}

/// Room left of a column of frames [pt].
#[derive(Clone, Default)]
struct LeftRoom {
    /// For ticks and numbers, up to the baseline of the label.
    numbers: f64,
    /// For the lines of the label above that baseline.
    label: f64,
}

/// Panels side by side in rows of so many; a last row may be shorter.
pub fn in_rows(panels: Vec<PanelRequest>, columns: usize) -> Vec<Vec<PanelRequest>> {
    let mut rows: Vec<Vec<PanelRequest>> = Vec::new();
    for panel in panels {
        match rows.last_mut().filter(|row| row.len() < columns) {
            Some(row) => row.push(panel),
            None => rows.push(vec![panel]),
        }
    }
    rows
}

/// Distance between lines of the heading [pt].
const TITLE_LINE: f64 = 1.25 * TITLE_SIZE;
/// Room for a label, from its baseline to the border [pt].
const DESCENT: f64 = 0.28 * LABEL_SIZE;
/// Steps in which frames are brought to the height that a figure sets.
const STEPS_OF_HEIGHT: usize = 4;

/// Frames are no lower than this [pt].
const LEAST_FRAME: f64 = 20.0;

impl<'a> PageRequest<'a> {
    /// A page of one panel whose frame has this height [pt], of the width of a column unless the request says another.
    pub fn of_one(
        drawing: &'a Drawing,
        panel: PanelRequest,
        height: f64,
        pointing: Pointing,
    ) -> PageRequest<'a> {
        PageRequest {
            drawing,
            width_mm: ONE_COLUMN,
            heights: vec![height],
            rows: vec![vec![panel]],
            column_room: NO_ROOM,
            right_room: NO_ROOM,
            bottom_room: 0.0,
            pointing,
        }
    }

    /// A page of panels in rows, whose frames have this height [pt]; of the width of a column where none stand side by side,
    /// unless the request says another.
    pub fn of_rows(
        drawing: &'a Drawing,
        rows: Vec<Vec<PanelRequest>>,
        height: f64,
    ) -> PageRequest<'a> {
        PageRequest {
            drawing,
            width_mm: if rows.iter().any(|row| row.len() > 1) { TWO_COLUMNS } else { ONE_COLUMN },
            heights: vec![height; rows.len()],
            rows,
            column_room: NO_ROOM,
            right_room: NO_ROOM,
            bottom_room: 0.0,
            pointing: Pointing::Inward,
        }
    }

    /// Lays the page out: a canvas with the heading alone, and the panels in their places.
    pub fn lay_out(mut self) -> (Canvas, Vec<Vec<Panel>>) {
        if !self.drawing.legend {
            for request in self.rows.iter_mut().flatten() {
                // What is told without a mark is what the figure leaves out.
                request.header.legend.retain(|(mark, _)| *mark == Mark::Nothing);
            }
        }
        // Tables below the panels have their marks explained beside them.
        let inner = self.width() - 2.0 * BORDER;
        let caption = match self.bottom_room > 0.0 {
            true => Caption::default(),
            false => {
                let panels = self.rows.iter_mut().flatten();
                Caption::taken_from(panels.map(|it| &mut it.header.legend), inner)
            }
        };
        self.bottom_room += caption.room(inner);
        let wanted = self.drawing.height_mm.map(|height| height * POINTS_PER_MM);
        let Arrangement { size: [width, height], title, frames } = self.arrange_within(wanted);
        let mut canvas = Canvas::new(width, wanted.unwrap_or(height));
        if wanted.is_some_and(|wanted| (wanted - height).abs() > 0.5) {
            let least = (height / POINTS_PER_MM).ceil();
            canvas.unfit = Some(format!("its panels need a height of {least} mm at least"));
        }
        for (line, words) in title.iter().enumerate() {
            let baseline = BORDER + (line as f64 + 0.8) * TITLE_LINE;
            canvas.text(words, (width / 2.0, baseline), TITLE_SIZE, Anchor::Middle);
        }
        caption.draw(&mut canvas, [width, wanted.unwrap_or(height)]);
        let mut panels = self.place_panels(frames);
        self.keep_texts_inside(&mut canvas, &mut panels);
        canvas.data = self.drawing.data.then(|| data_of(&panels));
        (canvas, panels)
    }

    /// Finds a place for everything, with frames that fill a height, if one is wanted [pt].
    fn arrange_within(&mut self, wanted: Option<f64>) -> Arrangement {
        let mut arrangement = self.arrange();
        // Lower frames may need wider numbers and longer labels, so that their share is found in steps.
        for _ in 0..STEPS_OF_HEIGHT {
            let Some(wanted) = wanted else { break };
            let frames: f64 = self.heights.iter().sum();
            let factor = 1.0 + (wanted - arrangement.size[1]) / frames;
            self.heights.iter_mut().for_each(|it| *it = (*it * factor).max(LEAST_FRAME));
            arrangement = self.arrange();
        }
        arrangement
    }

    /// The panels that were asked for, in their frames, numbered from 1.
    fn place_panels(&mut self, frames: Vec<Vec<(Rect, f64)>>) -> Vec<Vec<Panel>> {
        let mut number = 0;
        let mut panels = Vec::new();
        for (row, frames) in std::mem::take(&mut self.rows).into_iter().zip(frames) {
            let mut placed = Vec::new();
            for (request, (frame, distance)) in row.into_iter().zip(frames) {
                number += 1;
                placed.push(self.place(request, number, frame, distance));
            }
            panels.push(placed);
        }
        panels
    }

    /// Leaves out words whose place is in no panel, and says so.
    fn keep_texts_inside(&self, canvas: &mut Canvas, panels: &mut [Vec<Panel>]) {
        let mut shown = BTreeSet::new();
        for panel in panels.iter_mut().flatten() {
            let mut texts = std::mem::take(&mut panel.texts);
            texts.retain(|(_, (x, y))| panel.holds(*x, *y));
            shown.extend(texts.iter().map(|(words, _)| words.content()));
            panel.texts = texts;
        }
        for words in self.drawing.texts.keys() {
            if !shown.contains(&Text::tex(words).content()) {
                canvas.notes.push(format!(
                    "the words \"{words}\" stand outside its panels and are left out"
                ));
            }
        }
    }

    /// Finds a place for everything.
    fn arrange(&self) -> Arrangement {
        let width = self.width();
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(1).max(1);
        let title = self.title_lines(width);
        let lefts = self.left_rooms(columns);
        let highest = self.heights.iter().copied().fold(0.0, f64::max);
        let beside = (self.column_room)(highest);
        let right_room = (self.right_room)(self.heights.iter().sum());
        let ends = if beside + right_room > 0.0 { 0.0 } else { self.right_ends() };
        let taken: f64 = lefts.iter().map(|room| room.numbers + room.label).sum::<f64>()
            + PANEL_GAP * (columns - 1) as f64
            + beside * columns as f64
            + right_room;
        let inner = width - 2.0 * BORDER - taken - ends;
        let frame_width = (inner / columns as f64).max(LEAST_FRAME);
        let mut top = BORDER + title.len() as f64 * TITLE_LINE;
        let mut frames = Vec::new();
        for (row, height) in self.rows.iter().zip(&self.heights) {
            let above = row.iter().map(|it| it.header.room(frame_width)).fold(0.0, f64::max);
            let below = row.iter().map(|it| self.bottom_room(it, frame_width)).fold(0.0, f64::max);
            let mut left = BORDER;
            let mut placed = Vec::new();
            for room in &lefts[..row.len()] {
                left += room.numbers + room.label;
                let (right, top) = (left + frame_width, top + above);
                placed.push((Rect { left, top, right, bottom: top + height }, room.numbers));
                left = right + beside + PANEL_GAP;
            }
            frames.push(placed);
            top += above + height + below;
        }
        Arrangement { size: [width, top + self.bottom_room + BORDER - 1.0], title, frames }
    }

    /// The width of the page [pt].
    fn width(&self) -> f64 {
        let wanted = self.drawing.width_mm.unwrap_or(self.width_mm);
        let (least, most) = Size::Width.range();
        wanted.clamp(least, most) * POINTS_PER_MM
    }

    fn title_lines(&self, width: f64) -> Vec<Text> {
        let title = Text::tex(self.drawing.title.as_deref().unwrap_or(""));
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
        let halves = last.map(|request| {
            let axis = Axis::new(&request.x, Along::Across, 150.0);
            if axis.numbered { axis.widest / 2.0 } else { 0.0 }
        });
        halves.fold(2.0, f64::max)
    }

    /// Room below a frame of this width.
    fn bottom_room(&self, request: &PanelRequest, width: f64) -> f64 {
        let axis = Axis::new(&request.x, Along::Across, width);
        let numbers = if axis.numbered { SMALL_SIZE } else { 0.0 };
        let gap = if axis.label.is_empty() { 0.0 } else { LABEL_GAP };
        match axis.numbered || !axis.label.is_empty() {
            false => 0.0,
            true => tick_room(self.pointing) + numbers + gap + axis.label_room(),
        }
    }

    /// The words that stand in a panel with these quantities, with their places.
    fn texts(&self, x: &Quantity, y: &Quantity) -> Vec<(Text, (f64, f64))> {
        let texts = self.drawing.texts.iter().filter_map(|(words, at)| {
            let [x, y] = [x, y].map(|of| Some(at.get(&of.key)? * of.factor));
            Some((Text::tex(words), (x?, y?)))
        });
        texts.collect()
    }

    fn place(
        &self,
        request: PanelRequest,
        number: usize,
        frame: Rect,
        label_distance: f64,
    ) -> Panel {
        let x = Axis::new(&request.x, Along::Across, frame.width());
        let y = Axis::new(&request.y, Along::Up, frame.height());
        let texts = self.texts(&request.x.quantity, &request.y.quantity);
        let PanelRequest { header, .. } = request;
        let pointing = self.pointing;
        Panel { number, frame, x, y, label_distance, pointing, header, texts }
    }
}

/// The data of a figure, with its panels and nothing in them yet.
fn data_of(panels: &[Vec<Panel>]) -> Data {
    let mut data = Data::default();
    for Panel { x, y, header, .. } in panels.iter().flatten() {
        let heading = header.note.as_ref().map(Text::content).unwrap_or_default();
        data.add_panel(&heading, [x.name.clone(), y.name.clone()]);
    }
    data
}

/// The letter of panel number `index`, where there are `count` of them.
pub fn letter(index: usize, count: usize) -> Option<char> {
    (count > 1).then(|| char::from(b'a' + (index % 26) as u8))
}
