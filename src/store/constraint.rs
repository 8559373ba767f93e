//! Conditions on the numbers of cases, as a person writes them: `peak_contact_force < 30 N and outcome = periodic`.

use super::case_table::{CaseTable, Column};
use super::catalogue::lasting;
use super::{StoreError, Unread};
use crate::quantity::units::dimension_of;
use crate::quantity::{Dimension, parse_quantity};
use crate::study::document::unknown;

/// How a number is compared with a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// It is less.
    Less,
    /// It is no more.
    AtMost,
    /// It is more.
    More,
    /// It is no less.
    AtLeast,
    /// It is the same.
    Equal,
    /// It is another.
    Unequal,
}

/// A condition on the numbers of cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// As it is written.
    pub text: String,
    /// What the numbers are called.
    pub name: String,
    /// The numbers.
    pub column: Column,
    /// How they are compared.
    pub comparison: Comparison,
    /// What they are compared with (SI, or the code of a category).
    pub limit: f64,
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

impl Condition {
    /// The code of a category of what it is on; not a number where it has none.
    pub fn code(&self, name: &str) -> f64 {
        let found = self.column.flags.iter().find(|(_, flag)| flag == name);
        found.map_or(f64::NAN, |(code, _)| *code as f64)
    }

    /// The condition in one form, which [`conditions`] reads again: name, sign, and the limit in SI or the name of a category.
    pub fn normal(&self) -> String {
        let Condition { name, column, comparison, limit, .. } = self;
        let sign = comparison.sign();
        let flag = column.flags.iter().find(|(code, _)| *code as f64 == *limit);
        match flag {
            Some((_, flag)) => format!("{name} {sign} {flag}"),
            None if column.unit == Dimension::Number.unit() => format!("{name} {sign} {limit:?}"),
            None => format!("{name} {sign} {limit:?} {}", column.unit),
        }
    }
}

impl Comparison {
    /// The sign in which it is written.
    pub fn sign(self) -> &'static str {
        let found = SIGNS.iter().rfind(|(_, comparison)| *comparison == self);
        found.map_or("", |(sign, _)| sign)
    }

    /// Whether it is so; of what is not known it is not.
    pub fn holds(self, value: f64, limit: f64) -> bool {
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

/// Conditions joined by `and`.
///
/// Fails with all faults of the text, or if the file cannot be read.
pub fn conditions(table: &CaseTable<'_>, text: &str) -> Result<Vec<Condition>, Unread> {
    let (mut conditions, mut faults) = (Vec::new(), Vec::new());
    for part in text.split(" and ") {
        match condition(table, part.trim()) {
            Ok(condition) => conditions.push(condition),
            Err(Unread::Store(error)) => return Err(Unread::Store(error)),
            Err(Unread::Faults(found)) => faults.extend(found),
        }
    }
    if faults.is_empty() { Ok(conditions) } else { Err(Unread::Faults(faults)) }
}

/// Whether a case fulfils all conditions; one that lacks a number does not.
pub fn fulfils(conditions: &[Condition], case: usize) -> bool {
    conditions.iter().all(|it| it.comparison.holds(it.column.values[case], it.limit))
}

/// One condition.
fn condition(table: &CaseTable<'_>, text: &str) -> Result<Condition, Unread> {
    let sign = text.find(['<', '>', '!', '=']).and_then(|at| {
        let found = SIGNS.iter().find(|(sign, _)| text[at..].starts_with(sign));
        found.map(|(sign, comparison)| (at, sign.len(), *comparison))
    });
    let Some((at, length, comparison)) = sign else {
        let expected = "expected a name, one of < <= > >= = !=, and a value, joined by `and`";
        return Err(fault(text, expected));
    };
    let (name, limit) = (text[..at].trim(), text[at + length..].trim());
    let Some(column) = table.column(name)? else {
        let names = table.names();
        let kind = "output or parameter of a case";
        return Err(fault(text, &unknown(kind, name, names.iter().map(String::as_str))));
    };
    let limit = match column.flags.as_slice() {
        [] => quantity(limit, &column.unit),
        flags => category(limit, flags),
    };
    let limit = limit.map_err(|message| fault(text, &message))?;
    Ok(Condition { text: text.to_owned(), name: name.to_owned(), column, comparison, limit })
}

fn fault(text: &str, message: &str) -> Unread {
    Unread::Faults(vec![format!("\"{text}\": {message}")])
}

/// The code of the category called `name`.
fn category(name: &str, flags: &[(i64, String)]) -> Result<f64, String> {
    let found = flags.iter().find(|(_, flag)| flag == name);
    let names = flags.iter().map(|(_, flag)| flag.as_str());
    found.map(|(code, _)| *code as f64).ok_or_else(|| unknown("category", name, names))
}

/// A quantity with a unit of the dimension of `unit`, in SI; a plain number is in SI already.
pub fn quantity(text: &str, unit: &str) -> Result<f64, String> {
    if let Ok(value) = text.trim().parse::<f64>() {
        return Ok(value);
    }
    parse_quantity(text, dimension_of(lasting(unit.to_owned())))
}

impl From<StoreError> for Unread {
    fn from(error: StoreError) -> Self {
        Unread::Store(error)
    }
}
