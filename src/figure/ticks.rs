//! The round numbers that are marked along an axis, and how numbers are written.

use super::scale::Scale;

/// A mark with a number.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Where it stands.
    pub value: f64,
    /// The number, as markup; empty where there is no room for one.
    pub label: String,
}

/// The marks of an axis, and what its numbers leave out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ticks {
    /// Marks with numbers.
    pub major: Vec<Tick>,
    /// Values of the small marks between them.
    pub minor: Vec<f64>,
    /// Power of ten that multiplies the numbers.
    pub exponent: i32,
    /// Value that is subtracted from the numbers, as text; empty if none is.
    pub offset: String,
}

impl Ticks {
    /// The values of the marks with numbers.
    pub fn numbered(&self) -> Vec<f64> {
        self.major.iter().map(|tick| tick.value).collect()
    }
}

/// Whole multiples of `step` on the scale.
fn multiples(scale: &Scale, step: f64) -> Vec<i64> {
    let first = (scale.low / step - 1e-6).ceil() as i64;
    let last = (scale.high / step + 1e-6).floor() as i64;
    (first..=last).collect()
}

/// Linear marks whose numbers are `digit` times 10^`power` apart; with so many decimals, if they tell the numbers apart.
pub fn linear_ticks(scale: &Scale, digit: i64, power: i32, wanted: Option<usize>) -> Option<Ticks> {
    let step = digit as f64 * 10f64.powi(power);
    if !step.is_normal() {
        return None;
    }
    let Notation { base, exponent, offset } = Notation::of(scale, power);
    let needed = (exponent - power).max(0) as usize;
    if wanted.is_some_and(|wanted| wanted < needed) {
        return None;
    }
    let decimals = wanted.unwrap_or(needed);
    let major = multiples(scale, step)
        .into_iter()
        .map(|count| {
            // From whole numbers, so that no rounding of the step adds up.
            let value = (count * digit) as f64 * 10f64.powi(power);
            let shown = (value - base) * 10f64.powi(-exponent);
            Tick { value, label: number(shown, decimals) }
        })
        .collect();
    let minor_parts = if digit == 2 { 4 } else { 5 };
    let minor_step = step / f64::from(minor_parts);
    let minor = multiples(scale, minor_step)
        .into_iter()
        .filter(|count| count % i64::from(minor_parts) != 0)
        .map(|count| count as f64 * minor_step)
        .collect();
    Some(Ticks { major, minor, exponent, offset })
}

/// What the numbers of a linear axis leave out, and its label tells.
struct Notation {
    /// What is subtracted from them.
    base: f64,
    /// The power of ten that multiplies them.
    exponent: i32,
    /// The base as text; empty if it is zero.
    offset: String,
}

impl Notation {
    /// The notation that is shortest for numbers whose last digit counts 10^`power`.
    fn of(scale: &Scale, power: i32) -> Notation {
        let size = scale.low.abs().max(scale.high.abs());
        // A number with more than five digits that change little: the common part moves to the label.
        let span = 10f64.powi((scale.high - scale.low).log10().floor() as i32 + 1);
        let base = if size > 2e4 * (scale.high - scale.low) {
            ((scale.low + scale.high) / 2.0 / span).round() * span
        } else {
            0.0
        };
        let largest = (scale.low - base).abs().max((scale.high - base).abs());
        let magnitude = largest.log10().floor() as i32;
        // Powers of ten go to the label where the numbers would be long without.
        let short = (-3..=4).contains(&magnitude) && power >= -4;
        let exponent = if short { 0 } else { magnitude.div_euclid(3) * 3 };
        let decimals = (-(span.log10().round() as i32)).max(0) as usize;
        let offset = if base == 0.0 { String::new() } else { trimmed(&number(base, decimals)) };
        Notation { base, exponent, offset }
    }
}

/// Numbers of a decade that are marked, from many to few.
pub const DIGITS: [&[i32]; 3] = [&[1, 2, 5], &[1, 3], &[1]];

/// Logarithmic marks: numbers at these `digits` of every `every` decades, small marks at the others.
pub fn log_ticks(scale: &Scale, digits: &[i32], every: i32) -> Ticks {
    let (low, high) = (scale.low.log10(), scale.high.log10());
    let is_plain = low > -2.5 && high < 3.5;
    let mut ticks = Ticks::default();
    for decade in low.floor() as i32..=high.ceil() as i32 {
        let is_marked = decade.rem_euclid(every) == 0;
        ticks.add_decade(scale, decade, 1.0, if is_marked { digits } else { &[] }, is_plain);
    }
    ticks
}

/// Marks of a symmetrically logarithmic scale: zero, and decades on both sides from `width` on.
pub fn symmetric_ticks(scale: &Scale, width: f64, digits: &[i32], every: i32) -> Ticks {
    let size = scale.low.abs().max(scale.high.abs());
    let (first, last) = (width.log10().ceil() as i32, size.log10().floor() as i32);
    let is_plain = first >= -2 && last <= 3;
    let mut ticks = Ticks::default();
    for decade in first..=last {
        // The largest decade is marked in any case.
        let digits = if (last - decade).rem_euclid(every) == 0 { digits } else { &[] };
        for sign in [-1.0, 1.0] {
            ticks.add_decade(scale, decade, sign, digits, is_plain);
        }
    }
    if scale.holds(0.0) {
        ticks.major.push(Tick { value: 0.0, label: "0".to_owned() });
    }
    ticks.major.sort_by(|a, b| a.value.total_cmp(&b.value));
    ticks
}

impl Ticks {
    /// Adds the marks of a decade of one sign, with numbers at these digits.
    fn add_decade(
        &mut self,
        scale: &Scale,
        decade: i32,
        sign: f64,
        digits: &[i32],
        is_plain: bool,
    ) {
        for digit in 1..10 {
            let value = sign * f64::from(digit) * 10f64.powi(decade);
            if !scale.holds(value) {
                continue;
            }
            if !digits.contains(&digit) {
                self.minor.push(value);
                continue;
            }
            let minus = if sign < 0.0 { "\u{2212}" } else { "" };
            let label = match (is_plain, digit) {
                (true, _) => short(value),
                (false, 1) => format!("{minus}{}", power_of_ten(decade)),
                (false, _) => format!("{minus}{digit} × {}", power_of_ten(decade)),
            };
            self.major.push(Tick { value, label });
        }
    }
}

/// 10 to the power `exponent`, as markup.
pub fn power_of_ten(exponent: i32) -> String {
    format!("10^{{{}}}", exponent.to_string().replace('-', "\u{2212}"))
}

/// `value` with a fixed number of decimals and a true minus sign.
pub fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let is_zero = text.chars().all(|c| matches!(c, '0' | '.' | '-'));
    let digits = text.trim_start_matches('-');
    if text.starts_with('-') && !is_zero { format!("\u{2212}{digits}") } else { digits.to_string() }
}

/// `value` in its shortest form with at most five digits, as markup.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..=5).contains(&magnitude) {
        let mantissa = trimmed(&number(value / 10f64.powi(magnitude), 4));
        return format!("{mantissa} × {}", power_of_ten(magnitude));
    }
    trimmed(&number(value, (4 - magnitude).max(0) as usize))
}

/// `value` with so many digits that count, as markup; zero as "0".
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    number(value, (digits - 1 - magnitude).max(0) as usize)
}

/// `value` with four digits that count, without zeros at its end, as markup.
pub fn rounded(value: f64) -> String {
    trimmed(&significant(value, 4))
}

/// A decimal number without the zeros at its end.
fn trimmed(number: &str) -> String {
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => number.to_string(),
    }
}
