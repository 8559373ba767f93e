//! How a report writes numbers and units.

use crate::quantity::Quantity;
use crate::study::Coordinate;

/// Digits that count of a number.
const DIGITS: i32 = 6;
/// Numbers below this have an exponent.
const SMALL: f64 = 1e-4;
/// Labels that begin so are written with a capital within a sentence, too.
const PROPER: [&str; 5] = ["Lyapunov", "Floquet", "Stribeck", "Pareto", "Sobol"];

/// The unit of a coordinate as it is read; empty where it has none.
pub fn unit(coordinate: Coordinate) -> String {
    unit_text(coordinate.dimension().unit())
}

/// A unit with raised exponents, `m/s2` as m/s²; empty where it is that of a plain number.
pub fn unit_text(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut before = ' ';
    let raised = unit.chars().map(|character| {
        let is_exponent = before.is_alphabetic();
        before = character;
        match character {
            '2' if is_exponent => '²',
            '3' if is_exponent => '³',
            '4' if is_exponent => '⁴',
            other => other,
        }
    });
    raised.collect()
}

/// A name with its unit behind it, where it has one.
pub fn with_unit(name: &str, unit: &str) -> String {
    match unit_text(unit) {
        unit if unit.is_empty() => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}

/// A number with its unit behind it, where it has one.
pub fn measured(value: f64, unit: &str) -> String {
    match unit_text(unit) {
        unit if unit.is_empty() => number(value),
        unit => format!("{}\u{a0}{unit}", number(value)),
    }
}

/// What a quantity is called in a sentence: by the label of figures, or as studies name it.
pub fn called(quantity: Quantity) -> String {
    match quantity.shown.map(|it| it.label).filter(|it| !it.is_empty()) {
        Some(label) => lower(label),
        None => quantity.name.to_owned(),
    }
}

/// A label as it stands within a sentence.
pub fn lower(label: &str) -> String {
    if PROPER.iter().any(|name| label.starts_with(name)) {
        return label.to_owned();
    }
    let mut letters = label.chars();
    let first: String = letters.next().into_iter().flat_map(char::to_lowercase).collect();
    first + letters.as_str()
}

/// A number with six digits that count.
pub fn digits(value: f64) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    if value.abs() < SMALL {
        let text = format!("{value:.*e}", DIGITS as usize - 1);
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", without_zeros(digits));
    }
    let decimals = (DIGITS - 1 - value.abs().log10().floor() as i32).clamp(0, 12) as usize;
    format!("{value:.decimals$}")
}

/// A number with six digits that count, without zeros at its end.
pub fn number(value: f64) -> String {
    match digits(value) {
        text if text.contains('e') => text,
        text => without_zeros(&text).to_owned(),
    }
}

/// Decimals without zeros at their end.
fn without_zeros(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

/// A number of percent with three decimals.
pub fn percent(value: f64) -> String {
    // No zero has a sign.
    let rounded = (value * 1e3).round() / 1e3 + 0.0;
    format!("{rounded:.3}")
}

/// A text with a minus sign before each number that has a hyphen there; exponents keep theirs.
pub fn signed(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let written = letters.iter().enumerate().map(|(place, character)| {
        let is_first = place == 0 || matches!(letters[place - 1], ' ' | '\u{a0}' | '(');
        let is_number = letters.get(place + 1).is_some_and(char::is_ascii_digit);
        if *character == '-' && is_first && is_number { '\u{2212}' } else { *character }
    });
    written.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_units_are_set_as_in_print() {
        assert_eq!(
            ["N s2/m2", "m/s2", "1", "rad/s"].map(unit_text),
            ["N s²/m²", "m/s²", "", "rad/s"]
        );
        assert_eq!(
            signed("-1.5 1e-12 at -3 quasi-periodic x1-2"),
            "\u{2212}1.5 1e-12 at \u{2212}3 quasi-periodic x1-2"
        );
        assert_eq!(
            [digits(-2.5e-14), number(2e-5), lower("Lyapunov exponent")],
            ["-2.5e-14", "2e-5", "Lyapunov exponent"]
        );
        assert_eq!([digits(0.5), number(0.5), number(-1420.0)], ["0.500000", "0.5", "-1420"]);
    }
}
