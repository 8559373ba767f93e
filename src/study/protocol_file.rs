//! What the study file says of how cases are followed and judged: the keys of `[protocol]` and `[history]`.

use super::document::Table;
use crate::description::Description;
use crate::orbit::exponent::BATCHES;
use crate::orbit::{Exponents, HistorySpan, Protocol};
use crate::quantity::Dimension;

/// Most points kept of a case, cycles of its history and samples of a cycle.
const MOST_POINTS: u64 = 1_000_000;

/// Longest period that can be looked for, as every section point within it is remembered.
const LONGEST_PERIOD: u64 = 100_000;

/// Reads `[protocol]` and `[history]`.
pub(super) fn read_protocol(top: &Table<'_, '_>) -> Protocol {
    let mut protocol = match top.table("protocol") {
        Some(table) => read_settling(table, top.model()),
        None => Protocol::default(),
    };
    if let Some(history) = top.entry("history").filter(|_| !top.model().keeps_histories()) {
        let name = top.model().name;
        history.fault(format!(
            "no histories are kept of motions of the model {name}: its cycles are none of a drive"
        ));
    }
    protocol.history = top.table("history").map(read_history);
    protocol
}

/// Reads `[protocol]`.
fn read_settling(table: Table<'_, '_>, model: &'static Description) -> Protocol {
    let usual = Protocol::default().tolerance;
    let mut protocol = Protocol::with_tolerance(read_tolerance(&table, "tolerance", usual));
    protocol.recurrence = read_tolerance(&table, "recurrence", protocol.recurrence);
    for (key, value) in [
        ("max_cycles", &mut protocol.max_cycles),
        ("max_steps", &mut protocol.max_steps),
        ("measured_cycles", &mut protocol.measured_cycles),
    ] {
        *value = read_whole(&table, key, 1, u64::MAX).unwrap_or(*value);
    }
    read_exponent(&table, &mut protocol);
    read_exponents(&table, model, &mut protocol);
    read_mean_error(&table, model, &mut protocol);
    let max_period = read_whole(&table, "max_period", 1, LONGEST_PERIOD);
    protocol.max_period = max_period.map_or(protocol.max_period, |it| it as usize);
    let accelerate = table.entry("accelerate").and_then(|entry| entry.truth());
    protocol.accelerate = accelerate.unwrap_or(protocol.accelerate);
    for (key, value) in
        [("points", &mut protocol.points), ("impact_points", &mut protocol.impact_points)]
    {
        *value = read_whole(&table, key, 0, MOST_POINTS).map_or(*value, |it| it as usize);
    }
    table.finish();
    protocol
}

/// A tolerance, `usual` where none is given that is allowed.
fn read_tolerance(table: &Table<'_, '_>, key: &str, usual: f64) -> f64 {
    let Some(entry) = table.entry(key) else { return usual };
    match entry.quantity(Dimension::Number) {
        Some(given) if Protocol::TOLERANCES.contains(&given) => given,
        Some(given) => {
            entry.fault(format!("{given} must lie between 1e-15 and 1e-3"));
            usual
        }
        None => usual,
    }
}

fn read_whole(table: &Table<'_, '_>, key: &str, least: u64, most: u64) -> Option<u64> {
    table.entry(key)?.whole(least, most)
}

/// Reads which exponents are computed.
fn read_exponents(table: &Table<'_, '_>, model: &'static Description, protocol: &mut Protocol) {
    let Some(entry) = table.entry("exponents") else { return };
    match entry.one_of("choice of exponents", &Exponents::NAMES) {
        Some(Exponents::All) if model.roles.spectrum.is_none() => {
            entry.fault(format!("the model {} tells the largest exponent only", model.name));
        }
        Some(Exponents::All) if protocol.exponent_cycles == 0 => {
            entry.fault("exponent_cycles = 0 leaves all exponents out");
        }
        given => protocol.exponents = given.unwrap_or(protocol.exponents),
    }
}

/// Reads how well the mean gain of a motion that does not repeat is to be known.
fn read_mean_error(table: &Table<'_, '_>, model: &'static Description, protocol: &mut Protocol) {
    let Some(entry) = table.entry("mean_error") else { return };
    let Some(given) = entry.quantity(Dimension::Number) else { return };
    let [least, most] = [Protocol::MEAN_ERRORS.start(), Protocol::MEAN_ERRORS.end()];
    if model.roles.gain_error.is_none() {
        let name = model.name;
        entry.fault(format!(
            "nothing drifts in the model {name} whose mean rate could be known better"
        ));
    } else if Protocol::MEAN_ERRORS.contains(&given) {
        protocol.mean_error = Some(given);
    } else {
        entry.fault(format!("{given} must lie between {least} and {most}"));
    }
}

/// Reads how exponents are measured.
fn read_exponent(table: &Table<'_, '_>, protocol: &mut Protocol) {
    let cycles = read_whole(table, "exponent_cycles", 0, MOST_POINTS);
    protocol.exponent_cycles = cycles.unwrap_or(protocol.exponent_cycles);
    if (1..BATCHES as u64).contains(&protocol.exponent_cycles)
        && let Some(entry) = table.entry("exponent_cycles")
    {
        let given = protocol.exponent_cycles;
        entry.fault(format!("{given} are too few for an exponent; {BATCHES} or more, or 0"));
    }
    if let Some(entry) = table.entry("exponent_error")
        && let Some(given) = entry.quantity(Dimension::Number)
    {
        let [least, most] = [Protocol::EXPONENT_ERRORS.start(), Protocol::EXPONENT_ERRORS.end()];
        match Protocol::EXPONENT_ERRORS.contains(&given) {
            true => protocol.exponent_error = given,
            false => entry.fault(format!("{given} must lie between {least} and {most}")),
        }
    }
}

/// Reads `[history]`.
fn read_history(table: Table<'_, '_>) -> HistorySpan {
    let cycles = read_whole(&table, "cycles", 1, MOST_POINTS).map_or(5, |it| it as u32);
    let per_cycle = read_whole(&table, "samples_per_cycle", 1, MOST_POINTS);
    let per_cycle = per_cycle.map_or(400, |it| it as u32);
    let begins = [("start", true), ("attractor", false)];
    let from = table.entry("from").and_then(|entry| entry.one_of("beginning", &begins));
    table.finish();
    HistorySpan { cycles, per_cycle, from_start: from.unwrap_or(false) }
}
