//! Quantities as people write them ("18.96 kN/m", "12.4 Hz"), turned into SI.

use std::f64::consts::PI;

use super::Dimension;

/// The units of a dimension with their size in SI, the commonest first.
fn units(dimension: Dimension) -> Vec<(&'static str, f64)> {
    if let Dimension::Other(unit) = dimension {
        return vec![(unit, 1.0)];
    }
    known_units(dimension).to_vec()
}

/// The units of a dimension that is known by name.
fn known_units(dimension: Dimension) -> &'static [(&'static str, f64)] {
    match dimension {
        Dimension::Mass => &[("kg", 1.0), ("g", 1e-3), ("mg", 1e-6)],
        Dimension::Stiffness => {
            &[("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6), ("N/mm", 1e3), ("N/cm", 1e2)]
        }
        Dimension::CubicStiffness => &[("N/m3", 1.0), ("kN/m3", 1e3), ("N/mm3", 1e9)],
        Dimension::Damping => &[("N s/m", 1.0), ("kg/s", 1.0), ("N s/mm", 1e3), ("kN s/m", 1e3)],
        Dimension::QuadraticDamping => &[("N s2/m2", 1.0), ("kg/m", 1.0)],
        Dimension::Length => &[
            ("m", 1.0),
            ("mm", 1e-3),
            ("cm", 1e-2),
            ("um", 1e-6),
            ("in", 0.0254),
            ("pt", 0.0254 / 72.0),
        ],
        Dimension::Force => &[("N", 1.0), ("mN", 1e-3), ("kN", 1e3)],
        Dimension::AngularFrequency => &[
            ("rad/s", 1.0),
            ("Hz", 2.0 * PI),
            ("kHz", 2e3 * PI),
            ("rpm", PI / 30.0),
            ("rad/sec", 1.0),
        ],
        Dimension::Velocity => &[("m/s", 1.0), ("mm/s", 1e-3), ("cm/s", 1e-2), ("um/s", 1e-6)],
        Dimension::Acceleration => &[("m/s2", 1.0), ("mm/s2", 1e-3)],
        Dimension::Angle => &[("rad", 1.0), ("deg", PI / 180.0)],
        Dimension::Energy => &[("J", 1.0), ("mJ", 1e-3), ("uJ", 1e-6)],
        Dimension::Power => &[("W", 1.0), ("mW", 1e-3), ("uW", 1e-6)],
        Dimension::EnergyPerLength => &[("J/m", 1.0), ("mJ/m", 1e-3), ("mJ/mm", 1.0)],
        Dimension::Rate => &[("1/s", 1.0)],
        Dimension::Time => &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("min", 60.0)],
        Dimension::Current => &[("A", 1.0), ("mA", 1e-3)],
        Dimension::ForcePerCurrent => &[("N/A", 1.0)],
        Dimension::Number => &[("", 1.0), ("%", 1e-2)],
        Dimension::Other(_) => &[],
    }
}

/// What a dimension is called.
fn name(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Mass => "a mass",
        Dimension::Stiffness => "a stiffness",
        Dimension::CubicStiffness => "a cubic stiffness",
        Dimension::Damping => "a damping",
        Dimension::QuadraticDamping => "a quadratic damping",
        Dimension::Length => "a length",
        Dimension::Force => "a force",
        Dimension::AngularFrequency => "a frequency",
        Dimension::Velocity => "a velocity",
        Dimension::Acceleration => "an acceleration",
        Dimension::Angle => "an angle",
        Dimension::Energy => "an energy",
        Dimension::Power => "a power",
        Dimension::EnergyPerLength => "an energy per length",
        Dimension::Rate => "a rate",
        Dimension::Time => "a time",
        Dimension::Current => "an electric current",
        Dimension::ForcePerCurrent => "a force per current",
        Dimension::Number => "a plain number",
        Dimension::Other(_) => "a quantity",
    }
}

/// The unit of a dimension that `text` names, with its size in SI.
pub fn unit(text: &str, dimension: Dimension) -> Option<(&'static str, f64)> {
    units(dimension).into_iter().find(|(known, _)| plain(known) == plain(text))
}

/// What is expected where a quantity of `dimension` stands, with its units.
pub fn expectation(dimension: Dimension) -> String {
    if dimension == Dimension::Number {
        return "a plain number".to_owned();
    }
    let units: Vec<&str> = units(dimension).into_iter().map(|(unit, _)| unit).collect();
    format!("{} in {}", name(dimension), units.join(", "))
}

/// The value in SI of a quantity such as "18.96 kN/m"; the error says what is wrong and expected.
///
/// A missing unit is an error unless the dimension is a plain number. Blanks, `^`, `*` and the dot of
/// a product do not matter; `µ` is `u`, and a raised 2 is 2.
pub fn parse_quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    parse_in(text, dimension, 1.0)
}

/// As [`parse_quantity`], but in a unit of another size than that of SI, which is read without rounding.
pub fn parse_in(text: &str, dimension: Dimension, unit_size: f64) -> Result<f64, String> {
    let (number, its_unit) = split(text);
    let expected = expectation(dimension);
    let Ok(value) = number.parse::<f64>() else {
        return Err(format!("\"{text}\" does not begin with a number; expected {expected}"));
    };
    if let Some(meant) = with_point(text, dimension) {
        return Err(format!("\"{text}\" has a decimal comma; is \"{meant}\" meant?"));
    }
    let its_unit = plain(its_unit);
    if let Some((_, size)) = unit(&its_unit, dimension) {
        return Ok(value * (size / unit_size));
    }
    let mut dimensions = Dimension::ALL.into_iter();
    let found = match dimensions.find(|&other| unit(&its_unit, other).is_some()) {
        Some(Dimension::Number) if its_unit.is_empty() => "has no unit".to_owned(),
        Some(other) => format!("is {}", name(other)),
        None => format!("has the unknown unit \"{its_unit}\""),
    };
    Err(format!("\"{text}\" {found}; expected {expected}"))
}

/// The quantity with a point where it has a comma within its number, if it is one of `dimension` then.
fn with_point(text: &str, dimension: Dimension) -> Option<String> {
    let (before, after) = text.split_once(',')?;
    let is_within = before.ends_with(|c: char| c.is_ascii_digit())
        && after.starts_with(|c: char| c.is_ascii_digit());
    let meant = format!("{before}.{after}");
    (is_within && parse_quantity(&meant, dimension).is_ok()).then_some(meant)
}

/// The number at the head of `text`, and the rest.
fn split(text: &str) -> (&str, &str) {
    let text = text.trim();
    let longest = (0..=text.len())
        .rev()
        .filter(|&end| text.is_char_boundary(end))
        .find(|&end| text[..end].trim_end().parse::<f64>().is_ok())
        .unwrap_or(0);
    (text[..longest].trim_end(), &text[longest..])
}

/// The dimension whose unit in SI this is; what only this unit tells where there is none.
pub fn dimension_of(unit: &'static str) -> Dimension {
    let known = Dimension::ALL.into_iter().find(|it| plain(it.unit()) == plain(unit));
    known.unwrap_or(Dimension::Other(unit))
}

/// A unit without what does not matter in it.
fn plain(unit: &str) -> String {
    unit.chars()
        .filter(|c| !c.is_whitespace() && !"*^·⋅".contains(*c))
        .map(|c| match c {
            'µ' | 'μ' => 'u',
            '²' => '2',
            other => other,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decimal_comma_is_told_where_a_point_would_do() {
        let told = |text: &str| parse_quantity(text, Dimension::Length).expect_err("no quantity");
        assert_eq!(told("1,5 mm"), "\"1,5 mm\" has a decimal comma; is \"1.5 mm\" meant?");
        for text in ["1,5 N", "1, 5 mm", "1,000,000 mm", ",5 mm"] {
            assert!(told(text).contains("expected a length in m"), "{}", told(text));
        }
        assert_eq!(parse_quantity("1.5 mm", Dimension::Length), Ok(1.5e-3));
    }
}
