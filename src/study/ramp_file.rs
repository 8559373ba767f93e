//! The ramps of a study file: which keys they have, what they mean and what is allowed.

use super::branch_file::{Surroundings, read_name, read_own_start, read_parameter, read_place};
use super::document::{Entry, Table};
use super::ramp::{Beginning, Ramp};
use crate::description::Parameter;
use crate::quantity::units::{expectation, parse_quantity};

/// Parts of a cycle unless another number is given: the error of the motion falls with its square.
const USUAL_PARTS: u32 = 32;

/// More parts than this are shorter than the steps of the integrator.
const MOST_PARTS: u64 = 1024;

/// More cycles than this are taken for a slip of the pen; each is a row of the results.
const MOST_CYCLES: f64 = 1e6;

/// The ramps of a study.
pub(super) fn read_ramps(top: &Table<'_, '_>, study: &Surroundings<'_>) -> Vec<Ramp> {
    let mut ramps: Vec<Ramp> = Vec::new();
    let Some(list) = top.entry("ramps") else { return ramps };
    if !top.model().has_drive() {
        let name = top.model().name;
        list.fault(format!("the model {name} has no drive, whose cycles a ramp is counted in"));
    }
    for table in list.list().iter().filter_map(Entry::table) {
        let name = read_name(&table, "a name for the ramp");
        if let Some(twice) = table.entry("name").filter(|_| ramps.iter().any(|it| it.name == name))
        {
            twice.fault(format!("a second ramp \"{name}\""));
        }
        let ramp = read_ramp(&table, study);
        table.finish();
        ramps.extend(ramp.map(|ramp| Ramp { name, ..ramp }));
    }
    ramps
}

/// A ramp without its name; none where what it needs is missing, which is noted as a fault.
fn read_ramp(table: &Table<'_, '_>, study: &Surroundings<'_>) -> Option<Ramp> {
    let along = read_parameter(table, "along", study, "the parameter that changes");
    // Known keys where the parameter is not, too.
    ["from", "to", "rate"].into_iter().for_each(|key| drop(table.entry(key)));
    let ends = along.map(|along| ["from", "to"].map(|key| read_end(table, key, along)));
    let rate = along.and_then(|along| read_rate(table, along));
    let place = read_place(table, table.table("at").as_ref(), study, &[], along);
    let start = read_own_start(table, study);
    let begins = table.entry("begins").and_then(|it| it.one_of("beginning", &Beginning::NAMES));
    let parts = table.entry("parts").and_then(|entry| entry.whole(1, MOST_PARTS));
    let ([from, to], rate, mut parameters) = (ends?, rate?, place?);
    let (from, to) = (from?, to?);
    if from == to {
        table.entry("to")?.fault("the ramp would end where it begins");
        return None;
    }
    let along = along?;
    parameters = parameters.with_part(along);
    parameters[along] = from;
    let ramp = Ramp {
        name: String::new(),
        along,
        ends: [from, to],
        rate,
        parameters,
        start: start.state,
        start_phase: start.start_phase,
        section_phase: start.section_phase,
        begins: begins.unwrap_or(Beginning::Settled),
        parts: parts.map_or(USUAL_PARTS, |parts| parts as u32),
    };
    check_length(table, &ramp);
    Some(ramp)
}

/// The value that `key` gives the parameter where the ramp begins or ends.
fn read_end(table: &Table<'_, '_>, key: &str, parameter: Parameter) -> Option<f64> {
    let Some(entry) = table.entry(key) else {
        table.missing(key, &format!("a value of the {}", parameter.meaning()));
        return None;
    };
    entry.allowed_quantity(parameter.dimension(), parameter.allowed())
}

/// How much the parameter changes in a second.
fn read_rate(table: &Table<'_, '_>, parameter: Parameter) -> Option<f64> {
    let expected = format!(
        "the change of the {} in a time, in magnitude: {} per s or per min, as \"0.1 {}/s\"",
        parameter.meaning(),
        expectation(parameter.dimension()),
        parameter.dimension().unit()
    );
    let Some(entry) = table.entry("rate") else {
        table.missing("rate", &expected);
        return None;
    };
    let text = entry.text()?;
    let rate = per_second(text, |text| parse_quantity(text, parameter.dimension()).ok());
    match rate {
        Some(rate) if rate > 0.0 && rate.is_finite() => Some(rate),
        Some(rate) => {
            entry.fault(format!(
                "{rate} must be above zero; the ramp falls where `to` is below `from`"
            ));
            None
        }
        None => {
            entry.fault(format!("\"{text}\" must be {expected}"));
            None
        }
    }
}

/// A quantity over a second or a minute, of which `quantity` reads what stands before the last slash.
fn per_second(text: &str, quantity: impl Fn(&str) -> Option<f64>) -> Option<f64> {
    let text = text.trim_end();
    for (suffix, left, seconds) in [
        ("/min", "", 60.0),
        ("/s^2", "/s", 1.0),
        ("/s2", "/s", 1.0),
        ("/s²", "/s", 1.0),
        ("/s", "", 1.0),
    ] {
        if let Some(before) = text.strip_suffix(suffix) {
            return Some(quantity(&format!("{before}{left}"))? / seconds);
        }
    }
    None
}

/// Refuses a ramp that lasts longer than results are kept of.
fn check_length(table: &Table<'_, '_>, ramp: &Ramp) {
    let Some(cycles) = ramp.most_cycles().filter(|cycles| *cycles > MOST_CYCLES) else { return };
    if let Some(entry) = table.entry("rate") {
        entry.fault(format!(
            "the ramp would last about {cycles:.1e} cycles; at most {MOST_CYCLES:e} are followed"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::Dimension;

    fn rate(text: &str, dimension: Dimension) -> Option<f64> {
        per_second(text, |text| parse_quantity(text, dimension).ok())
    }

    #[test]
    fn rates_are_quantities_over_a_time() {
        let frequency = Dimension::AngularFrequency;
        assert_eq!(rate("0.5 rad/s^2", frequency), Some(0.5));
        assert_eq!(rate("0.5 rad/s²", frequency), Some(0.5));
        assert_eq!(rate("0.5 rad/s/s", frequency), Some(0.5));
        assert_eq!(rate("1 Hz/s", frequency), Some(2.0 * std::f64::consts::PI));
        assert_eq!(rate("30 rpm/min", frequency), Some(std::f64::consts::PI / 60.0));
        assert_eq!(rate("0.1 N/s", Dimension::Force), Some(0.1));
        assert_eq!(rate("0.1/s", Dimension::Number), Some(0.1));
        assert_eq!(rate("2 mm/s", Dimension::Length), Some(2e-3));
        for refused in ["0.5 rad/s", "0.5", "0.5 N/s", "fast"] {
            assert_eq!(rate(refused, frequency), None, "{refused}");
        }
    }
}
