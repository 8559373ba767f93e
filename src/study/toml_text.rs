//! Writes TOML line by line: keys, texts, numbers with all their digits, quantities in SI units.

use std::fmt::{Display, Write};

use crate::quantity::Dimension;

pub(super) use capsulemap_text::tables::of_string as text;

/// A document that is being written.
#[derive(Debug, Default)]
pub(super) struct Document(pub String);

impl Document {
    /// Adds a key with its value, which is valid TOML.
    pub fn put(&mut self, key: &str, value: impl Display) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{key} = {value}");
    }

    /// Begins a table.
    pub fn table(&mut self, name: &str) {
        let _ = writeln!(self.0, "\n[{name}]");
    }

    /// Begins a table of a list of tables.
    pub fn element(&mut self, name: &str) {
        let _ = writeln!(self.0, "\n[[{name}]]");
    }
}

/// A plain number with all its digits.
pub(super) fn number(value: f64) -> String {
    if value.is_nan() { "nan".to_owned() } else { format!("{value:?}") }
}

/// A quantity of `dimension`, of which `value` is given in SI.
pub(super) fn quantity(value: f64, dimension: Dimension) -> String {
    let plain = plain_quantity(value, dimension);
    if dimension == Dimension::Number { plain } else { text(&plain) }
}

/// The same without quotes.
pub(super) fn plain_quantity(value: f64, dimension: Dimension) -> String {
    match dimension {
        Dimension::Number => number(value),
        _ => format!("{value:?} {}", dimension.unit()),
    }
}

/// A list of values that are valid TOML.
pub(super) fn list(values: impl Iterator<Item = String>) -> String {
    format!("[{}]", values.collect::<Vec<_>>().join(", "))
}

/// A table within a line.
pub(super) fn inline(pairs: impl Iterator<Item = (String, String)>) -> String {
    let pairs: Vec<String> = pairs.map(|(key, value)| format!("{key} = {value}")).collect();
    format!("{{ {} }}", pairs.join(", "))
}
