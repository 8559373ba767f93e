//! Conditions on the numbers of cases, as a person writes them: `peak_contact_force < 30 N and outcome = periodic`.

use crate::capsule::Dimension;
use crate::study::document::unknown;
use crate::study::parse_quantity;

use super::case_table::{CaseTable, Column};
use super::{StoreError, Unread};

/// How a number is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Comparison {
    Less,
    AtMost,
    More,
    AtLeast,
    Equal,
    Unequal,
}

/// Each by its signs, those that begin like others first.
const SIGNS: [(&str, Comparison); 7] = [
    ("<=", Comparison::AtMost),
    (">=", Comparison::AtLeast),
    ("!=", Comparison::Unequal),
    ("==", Comparison::Equal),
    ("<", Comparison::Less),
    (">", Comparison::More),
    ("=", Comparison::Equal),
];

impl Comparison {
    /// Whether it is so; of what is not known it is not.
    fn holds(self, value: f64, limit: f64) -> bool {
        match self {
            Comparison::Less => value < limit,
            Comparison::AtMost => value <= limit,
            Comparison::More => value > limit,
            Comparison::AtLeast => value >= limit,
            Comparison::Equal => value == limit,
            Comparison::Unequal => value != limit && !value.is_nan(),
        }
    }
}

/// Which cases fulfil all of some conditions joined by `and`; a case that lacks the number does not.
///
/// Fails with all faults of the text, or if the file cannot be read.
pub fn fulfilled(table: &CaseTable<'_>, text: &str) -> Result<Vec<bool>, Unread> {
    let mut fulfilled = vec![true; table.cases()];
    let mut faults = Vec::new();
    for part in text.split(" and ") {
        match condition(table, part.trim()) {
            Ok((column, comparison, limit)) => {
                let both = fulfilled.iter_mut().zip(&column.values);
                both.for_each(|(all, value)| *all &= comparison.holds(*value, limit));
            }
            Err(Unread::Store(error)) => return Err(Unread::Store(error)),
            Err(Unread::Faults(found)) => faults.extend(found),
        }
    }
    if faults.is_empty() { Ok(fulfilled) } else { Err(Unread::Faults(faults)) }
}

/// One condition: the numbers that are compared, how, and with what.
fn condition(table: &CaseTable<'_>, text: &str) -> Result<(Column, Comparison, f64), Unread> {
    let fault = |message: String| Unread::Faults(vec![format!("\"{text}\": {message}")]);
    let sign = text.find(['<', '>', '!', '=']).and_then(|at| {
        let found = SIGNS.iter().find(|(sign, _)| text[at..].starts_with(sign));
        found.map(|(sign, comparison)| (at, sign.len(), *comparison))
    });
    let Some((at, length, comparison)) = sign else {
        let expected = "expected a name, one of < <= > >= = !=, and a value, joined by `and`";
        return Err(fault(expected.to_owned()));
    };
    let (name, limit) = (text[..at].trim(), text[at + length..].trim());
    let Some(column) = table.column(name)? else {
        let names = table.names();
        return Err(fault(unknown("number of a case", name, names.iter().map(String::as_str))));
    };
    if !column.flags.is_empty() {
        let named = column.flags.iter().find(|(_, flag)| flag == limit).map(|(code, _)| *code);
        let names = column.flags.iter().map(|(_, flag)| flag.as_str());
        return match named {
            Some(code) => Ok((column, comparison, code as f64)),
            None => Err(fault(unknown("category", limit, names))),
        };
    }
    let limit = quantity(limit, &column.unit).map_err(fault)?;
    Ok((column, comparison, limit))
}

/// A quantity with a unit of the dimension of `unit`, in SI; a plain number is in SI already.
pub fn quantity(text: &str, unit: &str) -> Result<f64, String> {
    if let Ok(value) = text.trim().parse::<f64>() {
        return Ok(value);
    }
    let has_unit = |dimension: &Dimension| dimension.unit() == unit;
    let dimension = Dimension::ALL.into_iter().find(has_unit).unwrap_or(Dimension::Number);
    parse_quantity(text, dimension)
}

impl From<StoreError> for Unread {
    fn from(error: StoreError) -> Self {
        Unread::Store(error)
    }
}
