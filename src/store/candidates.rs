//! The cases of a file of results as the motions that a trade-off is between.

use std::collections::BTreeMap;

use super::case_table::{CaseTable, Column};
use super::catalogue::OUTCOME;
use super::constraint::{Condition, fulfils};
use super::{StoreError, Unread};
use crate::description::Output;
use crate::orbit::Outcome;
use crate::tradeoff::Candidate;

/// The motions of a file that take part in a trade-off.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidates {
    /// Those that take part, in the order of their cases.
    pub all: Vec<Candidate>,
    /// How many cases do not, by the reason in a few words.
    pub left_out: BTreeMap<String, usize>,
}

/// The cases that fulfil all of some conditions, with their speeds and what these cost by the output `of`. Chaotic and quasi-periodic
/// motions take part by their means; cases that failed, are undecided, inferred or missing, or lack a number, do not.
///
/// Fails if the file cannot be read or lacks the numbers.
pub fn candidates(
    table: &CaseTable<'_>,
    of: Output,
    conditions: &[Condition],
) -> Result<Candidates, Unread> {
    let speeds = column(table, table.model().speed())?;
    let prices = column(table, of)?;
    let metres =
        column(table, table.model().energy_per_distance()).unwrap_or_else(|_| unknown(table));
    let outcomes = table.column(OUTCOME.name)?.unwrap_or_else(|| unknown(table));
    let mut found = Candidates { all: Vec::new(), left_out: BTreeMap::new() };
    for case in 0..table.cases() {
        let (speed, price) = (speeds.values[case], prices.values[case]);
        let reason = match name(&outcomes, case) {
            name if !takes_part(name) => Some(name),
            _ if !(speed.is_finite() && price.is_finite()) => Some("without values"),
            _ if !fulfils(conditions, case) => Some("excluded by conditions"),
            _ => None,
        };
        match reason {
            Some(reason) => *found.left_out.entry(reason.to_owned()).or_default() += 1,
            None => {
                let energy_per_metre = metres.values[case];
                found.all.push(Candidate { case, speed, price, energy_per_metre });
            }
        }
    }
    Ok(found)
}

/// Whether motions of this outcome take part.
pub fn takes_part(outcome: &str) -> bool {
    [Outcome::Periodic, Outcome::Chaotic, Outcome::QuasiPeriodic]
        .iter()
        .any(|it| it.name() == outcome)
}

/// The name of the category of a case.
fn name(column: &Column, case: usize) -> &str {
    let code = column.values[case];
    let named = column.flags.iter().find(|(known, _)| *known as f64 == code);
    named.map_or("without outcome", |(_, name)| name)
}

/// An output of each case; what files of older versions and of fewer outputs lack is computed from others.
fn column(table: &CaseTable<'_>, output: Output) -> Result<Column, Unread> {
    if let Some(column) = table.column(output.name())? {
        return Ok(column);
    }
    let both = |a: &str, b: &str, of: fn(f64, f64) -> f64| -> Result<Option<Column>, StoreError> {
        let (Some(a), Some(b)) = (table.column(a)?, table.column(b)?) else { return Ok(None) };
        let values = a.values.iter().zip(&b.values).map(|(a, b)| of(*a, *b)).collect();
        Ok(Some(Column { values, ..a }))
    };
    let model = table.model();
    let (work, speed) = (model.work().name(), model.speed().name());
    let found = match (output, model.drive_frequency()) {
        (_, Some(omega)) if output == model.power() => {
            both(work, omega.symbol(), |work, omega| work * omega / std::f64::consts::TAU)?
        }
        (..) if output == model.energy_per_distance() => match column(table, model.power()) {
            Ok(power) => table.column(speed)?.map(|speeds| {
                let both = power.values.iter().zip(&speeds.values);
                let values = both.map(|(power, speed)| power / speed.abs()).collect();
                Column { values, ..power }
            }),
            Err(_) => None,
        },
        _ => None,
    };
    found.ok_or_else(|| Unread::Faults(vec![format!("the file has no `{}`", output.name())]))
}

/// A column of which nothing is known.
fn unknown(table: &CaseTable<'_>) -> Column {
    Column { values: vec![f64::NAN; table.cases()], unit: "1".to_owned(), flags: Vec::new() }
}
