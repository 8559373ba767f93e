//! Shares of the starts that lead to each attractor, as bands along a parameter.

use std::collections::BTreeSet;

use super::axis::AxisRequest;
use super::basin::{band, column, millimetres, motion, undecided};
use super::canvas::{Canvas, Drawn};
use super::cells::Cells;
use super::error::FigureError;
use super::header::{Header, Mark};
use super::kind::{Kind, Names, Needs};
use super::page::{PageRequest, PanelRequest};
use super::panel::{Panel, Pointing};
use super::plane::cells;
use super::raster::{Fill, Raster};
use super::scale::{Scale, finite_range};
use super::text::Text;
use super::ticks::significant;

use super::view::View;
use crate::capsule::Output;
use crate::store::catalogue::{
    ATTRACTOR, ATTRACTOR_AXIS, ATTRACTOR_KIND, ATTRACTOR_PERIOD, ATTRACTOR_SHARE,
    ATTRACTOR_SHARE_ERROR, Entry, starts,
};
use crate::study::{Coordinate, Drawing};

/// Height of the frame [pt].
const HEIGHT: f64 = 130.0;
/// Rows in which the bands are drawn: finer than a pixel.
const ROWS: usize = 1 << 14;
/// A share below this is rounding.
const NOTHING: f64 = 1e-9;

/// The speed of each case.
const SPEED: Entry = Entry::of_output(Output::ProgressionSpeed);

/// The kind of figure.
pub const KIND: Kind = Kind { needs: Needs::Cases, reads, draw };

/// What bands read: the shares, and what the attractors are.
fn reads(_: &Drawing) -> Names {
    Names::of([ATTRACTOR_SHARE, ATTRACTOR_SHARE_ERROR, ATTRACTOR_KIND, ATTRACTOR_PERIOD])
        .and([ATTRACTOR, SPEED])
}

/// Draws the bands that `view` asks for.
fn draw(view: &View<'_>) -> Result<Drawn, FigureError> {
    let axis = view.dataset.attributes.get(ATTRACTOR_AXIS).map(String::as_str);
    let of_starts = [&starts()[..], &[Entry::of_coordinate(Coordinate::StartPhase)]].concat();
    let is_start = |name: &&str| of_starts.iter().any(|entry| entry.name == *name);
    let along = axis.filter(|axis| {
        let mut others = view.axes().into_iter().filter(|name| name != axis).peekable();
        others.peek().is_some() && others.all(|name| is_start(&name))
    });
    let Some(along) = along else {
        let why = "shares lie along the one parameter of a study whose other axes are starts";
        return Err(view.unfit(why));
    };
    let bands = Bands::of(view, along)?;
    let cells = cells(view, along)?;
    let panel = PanelRequest {
        x: AxisRequest::new(view.quantity(along), cells.scale),
        y: AxisRequest::new(view.quantity(ATTRACTOR_SHARE.name), Scale::of_axis(&[0.0, 100.0])),
        header: Header { note: Some(bands.note()), legend: bands.legend(view), letter: None },
    };
    let page = PageRequest::of_one(view.drawing, panel, HEIGHT, Pointing::Outward);
    let (mut canvas, panels) = page.lay_out();
    for panel in panels.iter().flatten() {
        bands.draw(&mut canvas, panel, &cells);
        panel.finish(&mut canvas);
    }
    Ok(canvas.finish(&view.about(&[ATTRACTOR_SHARE.name.to_owned()], &[along])))
}

/// The range of the speeds of all cases that lead to an attractor, where the results have them.
fn speeds(view: &View<'_>, number: usize) -> Option<String> {
    let (labels, speeds) = (column(view, ATTRACTOR), column(view, SPEED));
    let ours = labels.iter().zip(&speeds).filter(|(label, _)| **label == number as f64);
    let (low, high) = finite_range(ours.map(|(_, speed)| *speed))?;
    let (low, high) = (millimetres(low), millimetres(high));
    Some(if low == high { format!("{low} mm/s") } else { format!("{low} to {high} mm/s") })
}

/// The shares at each value of the parameter.
struct Bands {
    /// One row for each value, an element for each attractor.
    shares: Vec<Vec<f64>>,
    /// The largest standard error.
    error: f64,
}

impl Bands {
    fn of(view: &View<'_>, along: &str) -> Result<Bands, FigureError> {
        let rows = |name: &str| -> Result<Vec<Vec<f64>>, FigureError> {
            if view.dataset.variable(name).is_none() {
                // No start leads to a known attractor.
                return Ok(vec![Vec::new(); view.coordinate_values(along).len()]);
            }
            let numbers = view.take(name, &[along])?;
            let width = numbers.shape().last().copied().unwrap_or(1).max(1);
            let numbers: Vec<f64> = numbers.into_iter().collect();
            Ok(numbers.chunks(width).map(<[f64]>::to_vec).collect())
        };
        let errors = rows(ATTRACTOR_SHARE_ERROR.name)?;
        let error = errors.into_iter().flatten().filter(|it| it.is_finite()).fold(0.0, f64::max);
        Ok(Bands { shares: rows(ATTRACTOR_SHARE.name)?, error })
    }

    /// How well the shares are known.
    fn note(&self) -> Text {
        Text::plain(&format!("standard error at most {} %", significant(100.0 * self.error, 2)))
    }

    /// The attractors with what they are, and starts that lead to none.
    fn legend(&self, view: &View<'_>) -> Vec<(Mark, Text)> {
        let count = self.shares.first().map_or(0, Vec::len);
        let (kinds, periods) = (column(view, ATTRACTOR_KIND), column(view, ATTRACTOR_PERIOD));
        let entry = |number: usize| {
            // What it is where starts lead to it.
            let there = |(at, shares): (usize, &Vec<f64>)| {
                (shares[number] > 0.0).then_some(at * count + number)
            };
            let places = self.shares.iter().enumerate().filter_map(there);
            let of = |column: &[f64], place: usize| column.get(place).copied();
            let told = places.map(|place| motion(view, of(&kinds, place), of(&periods, place)));
            let told = told.collect::<BTreeSet<_>>().into_iter().chain(speeds(view, number));
            let told: Vec<String> = told.collect();
            let text = format!("attractor {}: {}", number + 1, told.join(", "));
            (Mark::Patch(band(number)), Text::plain(&text))
        };
        let mut legend: Vec<_> = (0..count).map(entry).collect();
        if self.shares.iter().any(|shares| 1.0 - shares.iter().sum::<f64>() > NOTHING) {
            legend.push((Mark::Patch(undecided()), Text::plain("attractor unknown")));
        }
        legend
    }

    /// Fills the cell of each value from below, attractor by attractor, and what is left as unknown.
    fn draw(&self, canvas: &mut Canvas, panel: &Panel, cells: &Cells) {
        let colour = |value: usize, row: usize| {
            let height = 1.0 - (row as f64 + 0.5) / ROWS as f64;
            let mut below = 0.0;
            let reaches = |share: &f64| {
                below += share;
                height < below
            };
            Fill::Plain(self.shares[value].iter().position(reaches).map_or(undecided(), band))
        };
        let row = |share: f64| (share * ROWS as f64) as usize;
        canvas.image(panel.frame, &Raster::cells(panel.frame, |x| cells.at(x), row, colour));
    }
}
