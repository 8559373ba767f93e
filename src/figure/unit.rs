//! The units of quantities, as figures show them.

use crate::description::Description;
use crate::quantity::Dimension;
use crate::quantity::units::unit;
use crate::study::appearance::{NATURAL, dimension_of};

/// A unit as a figure shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct ShownUnit {
    /// The unit, with markup; empty where the symbol says it.
    pub unit: String,
    /// What follows the symbol, with markup.
    pub divisor: &'static str,
    /// Value shown per value in SI.
    pub factor: f64,
}

impl ShownUnit {
    /// The unit that is set for the quantity called `name`; `natural` tells the natural frequency where it does not vary [rad/s].
    ///
    /// # Errors
    ///
    /// Says what does not fit.
    pub fn of(
        name: &str,
        model: &'static Description,
        wanted: &str,
        natural: impl FnOnce() -> Option<f64>,
    ) -> Result<ShownUnit, String> {
        if wanted == NATURAL {
            let frequency = natural().ok_or_else(|| {
                format!("`unit` of {name}: {NATURAL} needs k1 and m1 that do not vary")
            })?;
            let divisor = "/√(*k*_{1}/*m*_{1})";
            return Ok(ShownUnit { unit: String::new(), divisor, factor: 1.0 / frequency });
        }
        let dimension = dimension_of(name, model)?;
        let (known, size) = unit(wanted, dimension)
            .ok_or_else(|| format!("`unit` of {name}: unknown unit \"{wanted}\""))?;
        let is_turns = dimension == Dimension::AngularFrequency && !known.starts_with("rad");
        let divisor = if is_turns { "/2π" } else { "" };
        Ok(ShownUnit { unit: spelled(known), divisor, factor: 1.0 / size })
    }
}

/// A unit of a study with its own letters, and with its powers raised.
fn spelled(unit: &str) -> String {
    let mut markup = String::new();
    let micro = unit.strip_prefix('u').map(|rest| format!("µ{rest}"));
    let mut before = ' ';
    for character in micro.as_deref().unwrap_or(unit).chars() {
        match character {
            '2' if before.is_alphabetic() => markup.push_str("^{2}"),
            other => markup.push(other),
        }
        before = character;
    }
    if unit == "deg" { "°".to_owned() } else { markup }
}

/// A unit as written in tables ("m/s^2"), with its powers raised.
pub fn raised(unit: &str) -> String {
    let mut markup = String::new();
    let mut characters = unit.chars().peekable();
    while let Some(character) = characters.next() {
        if character != '^' {
            markup.push(if character == '*' { '·' } else { character });
            continue;
        }
        markup.push_str("^{");
        while let Some(digit) = characters.next_if(|c| c.is_ascii_digit() || *c == '-') {
            markup.push(if digit == '-' { '−' } else { digit });
        }
        markup.push('}');
    }
    markup
}
