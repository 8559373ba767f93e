//! Numbers in the cells of a recording's file, with one decimal mark in the whole file.

use crate::quantity::Dimension;
use crate::quantity::printable::excerpt;
use crate::quantity::units::unit;

/// Words for units of time, as instruments write them, with their sizes [s].
const WORDS_OF_TIME: [(&str, f64); 9] = [
    ("second", 1.0),
    ("seconds", 1.0),
    ("sec", 1.0),
    ("sekunde", 1.0),
    ("sekunden", 1.0),
    ("millisecond", 1e-3),
    ("milliseconds", 1e-3),
    ("msec", 1e-3),
    ("millisekunden", 1e-3),
];

/// Why a cell holds no finite number, by which faults are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wrong {
    /// A number with another decimal mark than those before it.
    OtherMark,
    /// A decimal comma where commas separate cells.
    Comma,
    /// Points and commas in one number.
    Thousands,
    /// A clock time.
    Clock,
    /// A number that is too large for SI units.
    TooLarge,
    /// An infinite number.
    Infinite,
    /// Something else.
    NoNumber,
}

/// The numbers of a file.
#[derive(Debug)]
pub(super) struct Numbers {
    /// What separates the cells.
    pub delimiter: u8,
    /// The decimal mark of the first number that has one, and the byte of its row.
    pub mark: Option<(char, u64)>,
}

impl Numbers {
    /// The number in a cell of the row at this byte, times the size of its unit; none where the cell is empty or holds NaN.
    pub fn read(&mut self, cell: &str, size: f64, at: u64) -> Result<Option<f64>, Wrong> {
        if cell.is_empty() {
            return Ok(None);
        }
        let (value, mark) = match cell.parse::<f64>() {
            Ok(value) => (value, cell.contains('.').then_some('.')),
            Err(_) => (with_comma(cell).ok_or_else(|| wrong(cell))?, Some(',')),
        };
        if let Some(mark) = mark {
            if mark == ',' && self.delimiter == b',' {
                return Err(Wrong::Comma);
            }
            match self.mark {
                Some((before, _)) if before != mark => return Err(Wrong::OtherMark),
                Some(_) => {}
                None => self.mark = Some((mark, at)),
            }
        }
        match value * size {
            _ if value.is_nan() => Ok(None),
            scaled if scaled.is_finite() => Ok(Some(scaled)),
            _ if value.is_finite() => Err(Wrong::TooLarge),
            _ => Err(Wrong::Infinite),
        }
    }

    /// What is wrong with a cell; `line` is that of the first number with a decimal mark.
    pub fn told(&self, cell: &str, wrong: Wrong, line: Option<u64>) -> String {
        let shown = excerpt(cell);
        match wrong {
            Wrong::OtherMark => {
                let [own, other] = match self.mark {
                    Some((',', _)) => ["point", "comma"],
                    _ => ["comma", "point"],
                };
                let line = line.map_or_else(String::new, |it| format!(" in line {it}"));
                format!(
                    "\"{shown}\" has a decimal {own}, but numbers{line} have a decimal {other}; a file has one decimal mark"
                )
            }
            Wrong::Comma => format!(
                "\"{shown}\" has a decimal comma, and commas separate the cells; expected a decimal point, or ; or tabs between the cells"
            ),
            Wrong::Thousands => {
                format!("\"{shown}\" separates thousands; export the numbers without that")
            }
            Wrong::Clock => format!(
                "\"{shown}\" is a time of day; expected a number; where samples are equally spaced, --interval \"1 ms\" stands for the times"
            ),
            Wrong::TooLarge => format!("\"{shown}\" is too large for SI units"),
            Wrong::Infinite => format!("\"{shown}\" is not a finite number; leave the cell empty"),
            Wrong::NoNumber => format!("\"{shown}\" is not a number"),
        }
    }
}

/// Whether a cell holds a number, with either decimal mark.
pub(super) fn is_number(cell: &str) -> bool {
    number(cell).is_some()
}

/// A number with either decimal mark.
pub(super) fn number(cell: &str) -> Option<f64> {
    cell.parse::<f64>().ok().or_else(|| with_comma(cell))
}

/// A number with a decimal comma.
fn with_comma(cell: &str) -> Option<f64> {
    let is_one = cell.bytes().filter(|it| *it == b',').count() == 1 && !cell.contains('.');
    if is_one { cell.replace(',', ".").parse().ok() } else { None }
}

fn wrong(cell: &str) -> Wrong {
    let digits = cell.bytes().all(|it| it.is_ascii_digit() || b".,+-'".contains(&it));
    let clock = cell.bytes().filter(|it| *it == b':').count() >= 1
        && cell.bytes().any(|it| it.is_ascii_digit());
    match (digits && cell.bytes().any(|it| it.is_ascii_digit()), clock) {
        (true, _) if cell.contains([',', '\'']) => Wrong::Thousands,
        (_, true) => Wrong::Clock,
        _ => Wrong::NoNumber,
    }
}

/// The size in SI of a unit that a header names.
pub(super) fn size_of_unit(text: &str, dimension: Dimension) -> Option<f64> {
    // As texts of oscillators write a plain number.
    let text = if dimension == Dimension::Number && text == "1" { "" } else { text };
    if let Some((_, size)) = unit(text, dimension) {
        return Some(size);
    }
    let lower = text.to_lowercase();
    let known = WORDS_OF_TIME.iter().find(|it| dimension == Dimension::Time && it.0 == lower);
    known.map(|it| it.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_one_decimal_mark() {
        let mut numbers = Numbers { delimiter: b';', mark: None };
        assert_eq!(numbers.read("12", 1.0, 0), Ok(Some(12.0)));
        assert_eq!(numbers.read("-1,5E-03", 1.0, 7), Ok(Some(-1.5e-3)));
        assert_eq!(numbers.read("1.5", 1.0, 9), Err(Wrong::OtherMark));
        assert!(numbers.told("1.5", Wrong::OtherMark, Some(2)).contains("in line 2"));
        for (cell, why) in [
            ("1.234,5", Wrong::Thousands),
            ("1,234,567", Wrong::Thousands),
            ("12:30:01,5", Wrong::Clock),
            ("1e400", Wrong::Infinite),
            ("-inf", Wrong::Infinite),
            ("one", Wrong::NoNumber),
        ] {
            assert_eq!(numbers.read(cell, 1.0, 0), Err(why), "{cell}");
        }
        assert_eq!(numbers.read("1e308", 60.0, 0), Err(Wrong::TooLarge));
        for cell in ["", "NaN", "nan", "-NaN"] {
            assert_eq!(numbers.read(cell, 1.0, 0), Ok(None), "{cell}");
        }
        let mut numbers = Numbers { delimiter: b',', mark: None };
        assert_eq!(numbers.read("1,5", 1.0, 0), Err(Wrong::Comma));
        assert_eq!(numbers.read("1.5", 1e-3, 0), Ok(Some(1.5e-3)));
    }
}
