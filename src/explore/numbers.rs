//! How a report writes numbers and units.

use crate::study::Coordinate;

/// The unit of a coordinate.
pub fn unit(coordinate: Coordinate) -> &'static str {
    coordinate.dimension().unit()
}

/// A number with six digits that count.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (5 - value.abs().log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{value:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A number of percent with three decimals.
pub fn percent(value: f64) -> String {
    // No zero has a sign.
    let rounded = (value * 1e3).round() / 1e3 + 0.0;
    format!("{rounded:.3}")
}
