//! Shares of the starts that lead to each attractor, as bands along a parameter.

use std::collections::BTreeSet;

use ndarray::ArrayD;
use plotters::style::RGBColor;

use super::attractor_colours::Colours;
use super::axis::AxisRequest;
use super::canvas::{Canvas, Drawn, Stroke};
use super::cells::Cells;
use super::error::FigureError;
use super::header::{self, Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::known_attractors::{KnownAttractors, millimetres};
use super::page::{PageRequest, PanelRequest, letter};
use super::panel::{Panel, Pointing};
use super::plane::cells;
use super::quantity::Quantity;
use super::raster::{Fill, Raster};
use super::scale::{Scale, finite_range};
use super::style::{CURVE_WIDTH, INK, UNDECIDED};
use super::text::Text;
use super::ticks::significant;
use super::view::View;
use crate::description::Description;
use crate::store::catalogue::{
    ATTRACTOR, ATTRACTOR_AXIS, ATTRACTOR_INTEGRITY_ERROR, ATTRACTOR_INTEGRITY_FACTOR,
    ATTRACTOR_KIND, ATTRACTOR_MINIMAL_CRITICAL_SHOCK, ATTRACTOR_PERIOD, ATTRACTOR_SHARE,
    ATTRACTOR_SHARE_ERROR, Entry, starts,
};
use crate::study::{Coordinate, Drawing};

/// Height of the frame [pt].
const HEIGHT: f64 = 130.0;
/// Height of the frame of the room of the basins [pt].
const ROOM_HEIGHT: f64 = 95.0;
/// Rows in which the bands are drawn: finer than a pixel.
const ROWS: usize = 1 << 14;
/// A share below this is rounding.
const NOTHING: f64 = 1e-9;

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What bands read: the shares, and what the attractors are.
fn reads(_: &Drawing, model: &'static Description) -> Names {
    Names::of([ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR, ATTRACTOR_KIND, ATTRACTOR_PERIOD])
        .and([ATTRACTOR_MINIMAL_CRITICAL_SHOCK, ATTRACTOR_INTEGRITY_FACTOR])
        .and([ATTRACTOR_INTEGRITY_ERROR])
        .and([ATTRACTOR, Entry::of_output(model.main_output())])
}

/// Draws the bands that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let Some(along) = parameter(view) else {
        let why = "shares lie along the one parameter of a study whose other axes are starts";
        return Err(view.unfit(why));
    };
    let bands = Bands::of(view, along)?;
    let room = Room::of(view, along)?;
    let panels = if room.is_some() { 2 } else { 1 };
    let x = AxisRequest::new(view.quantity(along), bands.cells.scale);
    let upper = PanelRequest {
        x: AxisRequest { labelled: panels == 1, numbered: panels == 1, ..x.clone() },
        y: AxisRequest::new(view.quantity(ATTRACTOR_SHARE.name), Scale::of_axis(&[0.0, 100.0])),
        header: Header {
            note: Some(bands.note()),
            legend: bands.legend(),
            letter: letter(0, panels),
        },
    };
    let mut page = PageRequest::of_one(view.drawing, upper, HEIGHT, Pointing::Outward);
    if let Some(room) = &room {
        page.rows.push(vec![room.request(view, x, letter(1, panels))]);
        page.heights.push(ROOM_HEIGHT);
    }
    let (mut canvas, panels) = page.lay_out();
    for (row, panel) in panels.iter().flatten().enumerate() {
        match &room {
            Some(room) if row == 1 => room.draw(&mut canvas, panel, &bands.colours),
            _ => bands.draw(&mut canvas, panel),
        }
        panel.finish(&mut canvas);
    }
    Ok(canvas.finish(&format!("{} over {along}", ATTRACTOR_SHARE.name)))
}

/// The parameter along which attractors are numbered, where all other axes are coordinates of the start.
fn parameter<'a>(view: &View<'a>) -> Option<&'a str> {
    let along = view.dataset.attributes.get(ATTRACTOR_AXIS)?.as_str();
    let start_phase = Entry::of_coordinate(Coordinate::StartPhase);
    let mut of_starts = starts(view.model());
    of_starts.push(start_phase);
    let others: Vec<&str> = view.axes().into_iter().filter(|name| *name != along).collect();
    let is_start = others.iter().all(|name| of_starts.iter().any(|entry| entry.name == *name));
    (is_start && !others.is_empty()).then_some(along)
}

/// How much room the basins have along the parameter.
struct Room {
    /// The values of the parameter, in the units of the figure.
    values: Vec<f64>,
    /// For each attractor the minimal critical shock and the integrity factor at each value.
    numbers: Vec<[Vec<f64>; 2]>,
    /// The largest diagonal of a cell.
    error: f64,
}

impl Room {
    /// That of results which tell it.
    fn of(view: &View<'_>, along: &str) -> Result<Option<Room>, FigureError> {
        let measures = [ATTRACTOR_MINIMAL_CRITICAL_SHOCK, ATTRACTOR_INTEGRITY_FACTOR];
        if view.dataset.variable(measures[0].name).is_none() {
            return Ok(None);
        }
        let factor = view.quantity(along).factor;
        let values = view.axis_values(along)?.iter().map(|value| value * factor).collect();
        let [shock, ball] =
            measures.map(|entry| view.take(entry.name, &[along]).map(|it| columns(&it)));
        let numbers = shock?.into_iter().zip(ball?).map(|(shock, ball)| [shock, ball]).collect();
        let errors = view.column(ATTRACTOR_INTEGRITY_ERROR);
        let error = errors.into_iter().filter(|it| it.is_finite()).fold(0.0, f64::max);
        Ok(Some(Room { values, numbers, error }))
    }

    fn request(&self, view: &View<'_>, x: AxisRequest, letter: Option<char>) -> PanelRequest {
        let all = self.numbers.iter().flatten().flatten().copied();
        let all: Vec<f64> = all.chain([0.0]).collect();
        let (quantity, unit) = distance(view);
        let note = format!("the balls may be smaller by {}{unit}", significant(self.error, 2));
        let y = AxisRequest::around(quantity, &all, 0.06);
        let legend = [("largest ball inside", false), ("minimal critical shock", true)]
            .map(|(name, dashed)| (Mark::Line(stroke(INK, dashed)), Text::plain(name)));
        let header = Header { note: Some(Text::plain(&note)), legend: legend.to_vec(), letter };
        PanelRequest { x, y, header }
    }

    /// A line for each measure of each attractor, in the attractor's colour.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, colours: &Colours) {
        for (number, [shock, ball]) in self.numbers.iter().enumerate() {
            for (measure, dashed) in [(ball, false), (shock, true)] {
                let line: Vec<(f64, f64)> =
                    self.values.iter().copied().zip(measure.iter().copied()).collect();
                panel.curve(canvas, &line, stroke(colours.colour(number), dashed));
                let name = if dashed { "minimal critical shock" } else { "largest ball inside" };
                let series = format!("{name}, attractor {number}");
                panel.record(canvas, &series, line);
            }
        }
    }
}

fn stroke(colour: RGBColor, dashed: bool) -> Stroke {
    if dashed { Stroke::dashed(colour, CURVE_WIDTH) } else { Stroke::solid(colour, CURVE_WIDTH) }
}

/// The columns of a table.
fn columns(table: &ArrayD<f64>) -> Vec<Vec<f64>> {
    let width = table.shape().last().copied().unwrap_or(0);
    (0..width).map(|at| table.iter().copied().skip(at).step_by(width).collect()).collect()
}

/// The rows of a table over the values of the parameter; empty ones where no start leads to a known attractor.
fn rows(view: &View<'_>, name: &str, along: &str) -> Result<Vec<Vec<f64>>, FigureError> {
    if view.dataset.variable(name).is_none() {
        return Ok(vec![Vec::new(); view.coordinate_values(along).len()]);
    }
    let numbers = view.take(name, &[along])?;
    let width = numbers.shape().last().copied().unwrap_or(1).max(1);
    let numbers: Vec<f64> = numbers.into_iter().collect();
    Ok(numbers.chunks(width).map(<[f64]>::to_vec).collect())
}

/// The speeds of cases, with the numbers of the attractors that they lead to.
struct Speeds {
    attractors: Vec<f64>,
    speeds: Vec<f64>,
}

impl Speeds {
    /// Those of the results; empty where the model has no speed.
    fn of(view: &View<'_>) -> Speeds {
        match view.model().has_trade_off() {
            true => Speeds {
                attractors: view.column(ATTRACTOR),
                speeds: view.column(Entry::of_output(view.model().speed())),
            },
            false => Speeds { attractors: Vec::new(), speeds: Vec::new() },
        }
    }

    /// The range of the speeds of all cases that lead to an attractor, if it is known.
    fn told(&self, number: usize) -> Option<String> {
        let cases = self.attractors.iter().zip(&self.speeds);
        let ours = cases.filter(|(attractor, _)| **attractor == number as f64);
        let (low, high) = finite_range(ours.map(|(_, speed)| *speed))?;
        let (low, high) = (millimetres(low), millimetres(high));
        Some(if low == high { format!("{low} mm/s") } else { format!("{low} to {high} mm/s") })
    }
}

/// The shares at each value of the parameter.
struct Bands<'a> {
    /// The cells along the parameter.
    cells: Cells,
    /// One row for each value, an element for each attractor.
    shares: Vec<Vec<f64>>,
    /// The largest standard error.
    error: f64,
    /// Values of the axis at which starts are missing.
    incomplete: usize,
    /// What the results tell of the attractors: a row for each value, as the shares.
    attractors: KnownAttractors<'a>,
    speeds: Speeds,
    colours: Colours,
}

impl<'a> Bands<'a> {
    /// Those of the results along a parameter.
    fn of(view: &View<'a>, along: &str) -> Result<Bands<'a>, FigureError> {
        let errors = rows(view, ATTRACTOR_SHARE_ERROR.name, along)?;
        let shares = rows(view, ATTRACTOR_SHARE.name, along)?;
        let incomplete = shares.iter().zip(&errors).filter(|(shares, errors)| {
            shares.iter().zip(*errors).any(|(share, error)| share.is_finite() && error.is_nan())
        });
        let incomplete = incomplete.count();
        let error = errors.into_iter().flatten().filter(|it| it.is_finite()).fold(0.0, f64::max);
        Ok(Bands {
            cells: cells(view, along)?,
            shares,
            error,
            incomplete,
            attractors: KnownAttractors::along(view)?,
            speeds: Speeds::of(view),
            colours: Colours::of(view)?,
        })
    }

    /// How many attractors there are.
    fn count(&self) -> usize {
        self.shares.first().map_or(0, Vec::len)
    }

    /// How well the shares are known.
    fn note(&self) -> Text {
        let error = format!("standard error at most {} %", significant(100.0 * self.error, 2));
        Text::plain(&match self.incomplete {
            0 => error,
            1 => format!("{error}; at one value starts are missing"),
            several => format!("{error}; at {several} values starts are missing"),
        })
    }

    /// The attractors with what they are, and starts that lead to none.
    fn legend(&self) -> Vec<header::Entry> {
        let mut legend = Vec::new();
        for number in 0..self.count() {
            let text = format!("attractor {number}: {}", self.told(number).join(", "));
            legend.push((Mark::Patch(self.colours.band(number)), Text::plain(&text)));
        }
        if self.shares.iter().any(|shares| 1.0 - shares.iter().sum::<f64>() > NOTHING) {
            legend.push((Mark::Patch(UNDECIDED), Text::plain("attractor unknown")));
        }
        legend
    }

    /// What an attractor is where starts lead to it, and the range of its speeds.
    fn told(&self, number: usize) -> Vec<String> {
        let rows = self.shares.iter().enumerate().filter(|(_, shares)| shares[number] > 0.0);
        let motions = rows.map(|(row, _)| self.attractors.motion(row * self.count() + number));
        motions.collect::<BTreeSet<_>>().into_iter().chain(self.speeds.told(number)).collect()
    }

    /// The colour at a height of the column of a value, from below attractor by attractor, and then what is left as unknown.
    fn colour(&self, value: usize, height: f64) -> RGBColor {
        let mut below = 0.0;
        for (number, share) in self.shares[value].iter().enumerate() {
            below += share;
            if height < below {
                return self.colours.band(number);
            }
        }
        UNDECIDED
    }

    /// Fills the cell of each value.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel) {
        for number in 0..self.count() {
            let values =
                self.cells.values().enumerate().map(|(cell, value)| {
                    (value, 100.0 * self.shares[self.cells.place(cell)][number])
                });
            panel.record(canvas, &format!("attractor {number}"), values);
        }
        let raster = Raster::cells(
            panel.frame,
            |share| self.cells.under(&panel.x.scale, share),
            |share| (share * ROWS as f64) as usize,
            |value, row| Fill::Plain(self.colour(value, 1.0 - (row as f64 + 0.5) / ROWS as f64)),
        );
        canvas.image(panel.frame, &raster);
    }
}

/// A distance between section points, and its unit as words follow a number: the file has none where the model compares numbers.
fn distance(view: &View<'_>) -> (Quantity, String) {
    let quantity = view.quantity(ATTRACTOR_INTEGRITY_FACTOR.name);
    let stored = view.dataset.variable(ATTRACTOR_INTEGRITY_FACTOR.name);
    match stored.is_some_and(|it| it.unit == "1") {
        true => (Quantity::labelled("Distance to a boundary"), String::new()),
        false => {
            let unit = format!(" {}", quantity.unit().content());
            (quantity, unit)
        }
    }
}
