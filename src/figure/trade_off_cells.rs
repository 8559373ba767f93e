//! Gain and price of each cell of a map, and the fronts of these, for a screen that draws them itself.

use std::collections::BTreeMap;

use super::error::FigureError;
use super::outcome::NOT_YET;
use super::plane::Plane;
use super::shown::Shown;
use super::trade_off_fronts::Factors;
use super::trade_off_motions::{DIRECTIONS, Motions};
use super::trade_off_outputs::outputs;
use super::view::View;
use crate::study::Drawing;
use crate::tradeoff::Direction;

/// A quantity of a trade-off.
#[derive(Debug, Clone, PartialEq)]
pub struct TradeOffAxis {
    /// Its name in files.
    pub name: String,
    /// What it is, with its unit.
    pub label: String,
    /// The value of each cell in the unit shown, row by row from the least ordinate; NaN where the cell takes no part.
    pub values: Vec<f32>,
}

/// The trade-off of the cells of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct TradeOffCells {
    /// What the gain costs, and the gain.
    pub axes: [TradeOffAxis; 2],
    /// The cells of the front in each direction, by rising price.
    pub fronts: Vec<(Direction, Vec<usize>)>,
    /// How many cells take no part, by the reason.
    pub left_out: BTreeMap<String, usize>,
}

/// The trade-off of the cells of the map over the axes that `drawing` names, with the rules of the figure of a trade-off: what
/// is undecided, failed, missing or without numbers takes no part.
///
/// Fails as that figure does.
pub fn trade_off_cells<'a>(
    shown: impl Into<Shown<'a>>,
    drawing: &'a Drawing,
) -> Result<TradeOffCells, FigureError> {
    let view = View::new(shown.into(), drawing)?;
    let plane = Plane::of(&view, "a map")?;
    let free = plane.free();
    let of = outputs(&view)?;
    let motions = Motions::of(&view, of, &free, None)?;
    let cells = cells(&plane);
    let mut left_out = BTreeMap::new();
    if motions.left_out > 0 {
        left_out.insert("without values".to_owned(), motions.left_out);
    }
    if motions.not_yet > 0 {
        left_out.insert(NOT_YET.to_owned(), motions.not_yet);
    }
    let mut values = [vec![f32::NAN; plane.count()], vec![f32::NAN; plane.count()]];
    let factors = Factors::of(&view, of);
    for motion in motions.cases() {
        if !motions.counts(motion) {
            let outcome = motions.outcome(motion).unwrap_or("without outcome");
            *left_out.entry(outcome.to_owned()).or_default() += 1;
            continue;
        }
        let cell = cells[motion.case];
        let (price, gain) = factors.place(motion);
        (values[0][cell], values[1][cell]) = (price as f32, gain as f32);
    }
    let fronts = DIRECTIONS.into_iter().map(|direction| {
        let best = motions.best(direction);
        (direction, best.of_all.front.iter().map(|at| cells[motions.at(*at).case]).collect())
    });
    let [prices, gains] = values;
    let axes = [
        TradeOffAxis::of(&view, of.cost.name(), prices),
        TradeOffAxis::of(&view, of.gain.name(), gains),
    ];
    Ok(TradeOffCells { axes, fronts: fronts.collect(), left_out })
}

impl TradeOffAxis {
    /// The quantity of this name, with these values.
    fn of(view: &View<'_>, name: &str, values: Vec<f32>) -> TradeOffAxis {
        TradeOffAxis { name: name.to_owned(), label: view.quantity(name).told(), values }
    }
}

/// The cell of each case over the axes of a plane.
fn cells(plane: &Plane<'_>) -> Vec<usize> {
    let columns = plane.x.count();
    let mut cells = vec![0; plane.count()];
    for row in 0..plane.y.count() {
        for column in 0..columns {
            cells[plane.case(column, row)] = row * columns + column;
        }
    }
    cells
}
