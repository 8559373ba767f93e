//! The cases of a file of results as the motions that a trade-off is between.

use std::collections::BTreeMap;

use super::case_table::{CaseTable, Column};
use super::catalogue::OUTCOME;
use super::constraint::{Condition, fulfils};
use super::{StoreError, Unread};
use crate::description::{Output, Parameter};
use crate::orbit::Outcome;
use crate::tradeoff::{Candidate, GainAndCost, cost_per_gain};

/// The motions of a file that take part in a trade-off.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidates {
    /// Those that take part, in the order of their cases.
    pub all: Vec<Candidate>,
    /// How many cases do not, by the reason in a few words.
    pub left_out: BTreeMap<String, usize>,
}

/// The cases that fulfil all of some conditions, with what they gain and cost by the outputs of `of`. Chaotic and quasi-periodic
/// motions take part by their means; cases that failed, are undecided, inferred or missing, or lack a number, do not.
///
/// Fails if the file cannot be read or lacks the numbers.
pub fn candidates(
    table: &CaseTable<'_>,
    of: GainAndCost,
    conditions: &[Condition],
) -> Result<Candidates, Unread> {
    let gains = column(table, of.gain)?;
    let prices = column(table, of.cost)?;
    let told = of.told_per_gain();
    let told = told.map(|it| column(table, it).unwrap_or_else(|_| unknown(table)));
    let outcomes = table.column(OUTCOME.name)?.unwrap_or_else(|| unknown(table));
    let mut found = Candidates { all: Vec::new(), left_out: BTreeMap::new() };
    for case in 0..table.cases() {
        let (gain, price) = (gains.values[case], prices.values[case]);
        let reason = match outcome_name(&outcomes, case) {
            name if !takes_part(name) => Some(name),
            _ if !(gain.is_finite() && price.is_finite()) => Some("without values"),
            _ if !fulfils(conditions, case) => Some("excluded by conditions"),
            _ => None,
        };
        match reason {
            Some(reason) => *found.left_out.entry(reason.to_owned()).or_default() += 1,
            None => {
                let told = told.as_ref().map(|it| it.values[case]);
                let per_gain = told.unwrap_or_else(|| cost_per_gain(gain, price));
                found.all.push(Candidate { case, gain, price, per_gain });
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

/// The name of the outcome of a case, by the column of outcomes.
pub fn outcome_name(outcomes: &Column, case: usize) -> &str {
    let code = outcomes.values[case];
    let named = outcomes.flags.iter().find(|(known, _)| *known as f64 == code);
    named.map_or("without outcome", |(_, name)| name)
}

/// An output of each case; of what a model gains, what files of older versions and of fewer outputs lack is computed from others.
fn column(table: &CaseTable<'_>, output: Output) -> Result<Column, Unread> {
    if let Some(column) = table.column(output.name())? {
        return Ok(column);
    }
    let found = if table.model().has_trade_off() { derived(table, output)? } else { None };
    found.ok_or_else(|| Unread::Faults(vec![format!("the file has no `{}`", output.name())]))
}

/// The power, or the energy per distance, from others; none of another output, or where these are not there.
fn derived(table: &CaseTable<'_>, output: Output) -> Result<Option<Column>, StoreError> {
    let model = table.model();
    match model.drive_frequency() {
        Some(omega) if output == model.power() => power(table, omega),
        _ if output == model.energy_per_distance() => energy_per_distance(table),
        _ => Ok(None),
    }
}

/// The power, from the work of a cycle and the frequency of the drive.
fn power(table: &CaseTable<'_>, omega: Parameter) -> Result<Option<Column>, StoreError> {
    let work = table.column(table.model().work().name())?;
    let frequencies = table.column(omega.symbol())?;
    let both = work.zip(frequencies);
    Ok(both.map(|(work, frequencies)| {
        combined(work, &frequencies, |work, omega| work * omega / std::f64::consts::TAU)
    }))
}

/// The energy per distance, from power and speed.
fn energy_per_distance(table: &CaseTable<'_>) -> Result<Option<Column>, StoreError> {
    let Ok(power) = column(table, table.model().power()) else { return Ok(None) };
    let speeds = table.column(table.model().speed().name())?;
    Ok(speeds.map(|speeds| combined(power, &speeds, |power, speed| power / speed.abs())))
}

/// A number of each case from those of two columns, under the labels of the first.
fn combined(first: Column, second: &Column, of: fn(f64, f64) -> f64) -> Column {
    let both = first.values.iter().zip(&second.values);
    Column { values: both.map(|(a, b)| of(*a, *b)).collect(), ..first }
}

/// A column of which nothing is known.
fn unknown(table: &CaseTable<'_>) -> Column {
    Column { values: vec![f64::NAN; table.cases()], unit: "1".to_owned(), flags: Vec::new() }
}
