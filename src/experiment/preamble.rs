//! What the lines before the rows of a recording's file say of its samples: how far apart they are, and in which units.

use super::cells::{number, size_of_unit};
use super::recording::Column;
use super::table_lines::{Line, cells, name_and_unit};
use crate::quantity::{Dimension, parse_quantity};

/// What instruments call the time between two samples, in lower case.
const INTERVALS: [&str; 15] = [
    "sample interval",
    "sampling interval",
    "sample period",
    "sampling period",
    "sampling time",
    "sampling cycle",
    "time increment",
    "x increment",
    "xincrement",
    "increment",
    "delta_x",
    "delta t",
    "dt",
    "abtastintervall",
    "abtastzeit",
];
/// What they call the rate of samples.
const RATES: [&str; 8] = [
    "sample rate",
    "sampling rate",
    "sample frequency",
    "sampling frequency",
    "scan rate",
    "abtastrate",
    "messrate",
    "abtastfrequenz",
];
/// Units of rates with their sizes [1/s].
const PER_SECOND: [(&str, f64); 9] = [
    ("hz", 1.0),
    ("khz", 1e3),
    ("mhz", 1e6),
    ("s/s", 1.0),
    ("ks/s", 1e3),
    ("sa/s", 1.0),
    ("ksa/s", 1e3),
    ("1/s", 1.0),
    ("samples/s", 1.0),
];
/// Labels of lines of units, in lower case.
const UNITS: [&str; 6] =
    ["y_unit_label", "vertical units", "unit", "units", "einheit", "einheiten"];

/// A time between two samples that a file says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Said {
    /// The time [s].
    pub interval: f64,
    /// What the file calls it.
    pub label: String,
    /// The byte of its line.
    pub at: usize,
}

/// The times between two samples that these lines say.
pub(super) fn intervals(lines: &[Line<'_>], delimiter: u8) -> Vec<Said> {
    let mut all = Vec::new();
    for (place, line) in lines.iter().enumerate() {
        let row = cells(line.text.trim_start_matches('#'), delimiter);
        let below = lines.get(place + 1).map_or_else(Vec::new, |it| cells(it.text, delimiter));
        for (i, cell) in row.iter().enumerate() {
            let (label, behind) = match cell.split_once([':', '=']) {
                Some((label, value)) if !value.trim().is_empty() => (label, value.trim()),
                _ => (cell.trim_end_matches([':', '=']), ""),
            };
            let next = [behind, row.get(i + 1).map_or("", String::as_str)];
            let under = below.get(i).map_or("", String::as_str);
            let value = next.into_iter().find(|it| !it.is_empty()).unwrap_or("");
            let unit_behind = row.get(i + 2).map_or("", String::as_str);
            let found = interval(label, value, unit_behind).or_else(|| interval(label, under, ""));
            if let Some(interval) = found {
                all.push(Said { interval, label: label.trim().to_owned(), at: line.at });
            }
        }
    }
    all
}

/// The time that a label with a value stands for, if it is one of samples.
fn interval(label: &str, value: &str, unit_behind: &str) -> Option<f64> {
    let (name, unit_of_label, _) = name_and_unit(label.trim());
    let name = name.to_lowercase();
    let is_rate = RATES.contains(&name.as_str());
    if !is_rate && !INTERVALS.contains(&name.as_str()) {
        return None;
    }
    let found = match number(value) {
        Some(value) => {
            let units = [unit_of_label, unit_behind];
            let size = units.into_iter().find_map(|it| size(it, is_rate)).unwrap_or(1.0);
            value * size
        }
        None if is_rate => {
            let (amount, unit) = value.split_once(char::is_whitespace)?;
            number(amount)? * size(unit.trim(), true)?
        }
        None => parse_quantity(&value.replacen(',', ".", 1), Dimension::Time).ok()?,
    };
    let interval = if is_rate { 1.0 / found } else { found };
    (interval.is_finite() && interval > 0.0).then_some(interval)
}

/// The size of a unit of a rate, or of a time.
fn size(unit: &str, is_rate: bool) -> Option<f64> {
    if unit.is_empty() {
        return None;
    }
    let lower = unit.to_lowercase();
    match is_rate {
        true => PER_SECOND.iter().find(|it| it.0 == lower).map(|it| it.1),
        false => size_of_unit(unit, Dimension::Time),
    }
}

/// The size of the unit of a column at this place, as a line before the header has it.
pub(super) fn unit_of(
    lines: &[Line<'_>],
    delimiter: u8,
    column: Column,
    place: usize,
) -> Option<f64> {
    for line in lines {
        let row = cells(line.text.trim_start_matches('#'), delimiter);
        let label =
            row.first().map_or_else(String::new, |it| it.trim_end_matches(':').to_lowercase());
        let is_of_times = column.is_times() && column.dimension == Dimension::Time;
        if is_of_times && label == "x_dimension" && row.iter().skip(1).any(|it| it == "Time") {
            return Some(1.0);
        }
        let cell = match (is_of_times, label.as_str()) {
            (true, "horizontal units") => row.get(1),
            (_, label) if UNITS.contains(&label) => row.get(place),
            _ => None,
        };
        let Some(cell) = cell.filter(|it| !it.is_empty()) else { continue };
        if let Some(size) = size_of_unit(cell, column.dimension) {
            return Some(size);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::table_lines::first_lines;

    #[test]
    fn intervals_are_read_as_instruments_write_them() {
        for (text, delimiter, expected) in [
            ("Sample Interval,4.0e-06,,-0.005", b',', 4e-6),
            ("Sampling rate (kHz);2,5", b';', 4e-4),
            ("# Sample rate: 1000 Hz", b',', 1e-3),
            ("Abtastrate\t50\tHz", b'\t', 0.02),
            ("Abtastzeit=0,5 ms", b';', 5e-4),
            ("Delta_X\t0.001000\t0.001000", b'\t', 1e-3),
            ("X,CH1,Start,Increment\nSequence,Volt,-6e-03,1.0e-05", b',', 1e-5),
        ] {
            let found = intervals(&first_lines(text, 9), delimiter);
            assert_eq!(found.len(), 1, "{text}: {found:?}");
            assert!((found[0].interval / expected - 1.0).abs() < 1e-12, "{text}: {found:?}");
        }
        assert!(intervals(&first_lines("Sample,4\nRate;5 Hz\nSample rate;x", 9), b',').is_empty());
    }
}
