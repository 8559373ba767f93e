//! The optima of a trade-off: what marks them, and a table of their gains, prices and parameters.

use super::error::FigureError;
use super::header::Mark;
use super::optima_table::{Row, Table};
use super::quantity::Quantity;
use super::symbol::Symbol;
use super::text::Text;
use super::trade_off_fronts::{Front, marked};
use super::trade_off_motions::{Best, Motions, coordinates};
use super::view::View;
use crate::campaign::RefinedMotion;
use crate::store::catalogue::DIRECTION;
use crate::study::Coordinate;
use crate::tradeoff::{Candidate, GainAndCost};

/// Follows the name of an optimum that is no case.
pub const BETWEEN: &str = "\u{2217}";
/// Follows the name of an optimum whose search has not converged.
pub const OPEN: &str = "\u{2020}";

/// The text of a cell for one of some motions.
type Cell<'v> = Box<dyn Fn(&Motions<'_>, &Candidate) -> Text + 'v>;

/// A column of the table.
struct Column<'v> {
    /// What it holds, and the unit.
    heading: [Text; 2],
    cell: Cell<'v>,
}

/// The optima of each front and direction with their gains and prices, and what varies over the axes `free`.
pub fn table(
    view: &View<'_>,
    of: GainAndCost,
    free: &[&str],
    fronts: &[Front<'_>],
) -> Result<Table, FigureError> {
    let columns = columns(view, of, free)?;
    let mut table = Table::default();
    let each = fronts.iter().flat_map(|front| front.best.iter().map(move |best| (front, best)));
    for (front, best) in each {
        let motions = &front.motions;
        // Of symbols at one point the upper one is seen: a row tells all that its motion is best in.
        let mut rows: Vec<(Vec<Symbol>, &Candidate)> = Vec::new();
        for (symbol, motion) in marked(motions, best).into_iter().rev() {
            match rows.iter_mut().find(|it| it.1 == motion) {
                Some(row) => row.0.push(symbol),
                None => rows.push((vec![symbol], motion)),
            }
        }
        for (symbols, motion) in rows {
            let cells = columns.iter().map(|column| (column.cell)(motions, motion)).collect();
            let letter = front.letter.map_or(String::new(), |letter| format!(" ({letter})"));
            let name = Text::plain(&(name(&symbols, motions, best, motion) + &letter));
            table.rows.push(Row { mark: Mark::Symbol(symbols[0]), name, cells });
        }
    }
    table.headings = columns.into_iter().map(|column| column.heading).collect();
    Ok(table)
}

fn name(symbols: &[Symbol], motions: &Motions<'_>, best: &Best, motion: &Candidate) -> String {
    let refined = motions.refined(motion);
    let mean = if motions.is_periodic(motion) { "" } else { ", mean" };
    let between = if refined.is_some() { BETWEEN } else { "" };
    let open = if refined.is_some_and(RefinedMotion::is_open) { OPEN } else { "" };
    let words: Vec<&str> = symbols.iter().map(|it| it.words).collect();
    format!("{}, {}{mean}{between}{open}", words.join(" and "), best.direction.name())
}

fn columns<'v>(
    view: &'v View<'_>,
    of: GainAndCost,
    free: &'v [&'v str],
) -> Result<Vec<Column<'v>>, FigureError> {
    let [gain, price] = of.both().map(|it| view.quantity(it.name()));
    let called = if of.has_own_gain() { Text::plain("Speed") } else { gain.short_name() };
    let mut columns = vec![
        output(called, gain, |motion| motion.gain),
        output(price.short_name(), price, |motion| motion.price),
    ];
    for coordinate in coordinates(view, free) {
        let of_case = view.parameter(coordinate.name(), free)?.into_iter().collect();
        columns.push(parameter(view.quantity(coordinate.name()), coordinate, of_case));
    }
    columns.extend(free.contains(&DIRECTION.name).then(|| sweep(view, free)));
    Ok(columns)
}

/// The column of an output.
fn output<'v>(name: Text, quantity: Quantity, of: fn(&Candidate) -> f64) -> Column<'v> {
    let heading = [name, quantity.unit()];
    Column { heading, cell: Box::new(move |_, motion| quantity.rounded(of(motion))) }
}

/// The column of a coordinate that has these values at the cases.
fn parameter<'v>(quantity: Quantity, coordinate: Coordinate, of_case: Vec<f64>) -> Column<'v> {
    let heading = [quantity.short_name(), quantity.unit()];
    Column {
        heading,
        cell: Box::new(move |motions, motion| {
            quantity.rounded(motions.coordinate(motion, coordinate, &of_case))
        }),
    }
}

/// The column of the direction in which the starts of cases were inherited, which motions between them have none of.
fn sweep<'v>(view: &'v View<'_>, free: &'v [&'v str]) -> Column<'v> {
    let place = view.places_along(DIRECTION.name, free);
    Column {
        heading: [Text::default(), Text::plain("sweep")],
        cell: Box::new(move |motions, motion| match motions.refined(motion) {
            Some(_) => Text::default(),
            None => view.value_note(DIRECTION.name, place(motion.case)),
        }),
    }
}
