//! A quantity that a model describes, and how figures show it.

use super::Dimension;

/// A quantity that a model describes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Its name in studies and files.
    pub name: &'static str,
    /// Its dimension, which has its unit in files.
    pub dimension: Dimension,
    /// What it is, in a phrase.
    pub meaning: &'static str,
    /// How figures show it; none where they show it as it is stored, called by its meaning.
    pub shown: Option<Shown>,
}

/// How figures show a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shown {
    /// Its name as text; empty where the symbol says it.
    pub label: &'static str,
    /// Its symbol, with markup: stars for italics, braces for scripts; empty where it has none.
    pub symbol: &'static str,
    /// The unit shown, with markup; empty where there is none.
    pub unit: &'static str,
    /// Value shown per value in SI.
    pub factor: f64,
}

/// A quantity that is shown by its name, in SI.
pub const fn words(label: &'static str, unit: &'static str) -> Option<Shown> {
    shown(label, "", unit, 1.0)
}

/// A quantity with its name, its symbol, the unit shown and its factor from SI.
pub const fn shown(
    label: &'static str,
    symbol: &'static str,
    unit: &'static str,
    factor: f64,
) -> Option<Shown> {
    Some(Shown { label, symbol, unit, factor })
}
