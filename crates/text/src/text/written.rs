//! The TOML of a text, key by key, with the place of each value.

use std::cell::RefCell;
use std::ops::Range;

use strsim::damerau_levenshtein;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::text::expression::Misread;
use crate::text::fault::Fault;

/// Names this far from each other are taken for one that is misspelt.
const FARTHEST: usize = 3;

/// A text that is read, and what is wrong in it.
#[derive(Debug)]
pub struct Source<'a> {
    text: &'a str,
    faults: RefCell<Vec<Fault>>,
}

/// An expression before it is read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Its characters.
    pub characters: String,
    /// The byte of the text at which they begin.
    pub at: usize,
}

impl<'a> Source<'a> {
    /// A text of which nothing is known to be wrong.
    pub fn new(text: &'a str) -> Self {
        Source { text, faults: RefCell::default() }
    }

    /// Notes what is wrong at a byte of the text.
    pub fn fault(&self, at: usize, message: impl Into<String>) {
        let fault = Fault::at(self.text, at, message);
        let mut faults = self.faults.borrow_mut();
        if !faults.contains(&fault) {
            faults.push(fault);
        }
    }

    /// What is told of a byte of the text without being wrong.
    pub fn remark(&self, at: usize, message: impl Into<String>) -> Fault {
        Fault::at(self.text, at, message)
    }

    /// Notes what keeps characters from being an expression.
    pub fn misread(&self, it: Misread) {
        self.fault(it.at, it.message);
    }

    /// What is wrong, in order of lines.
    pub fn into_faults(self) -> Vec<Fault> {
        let mut faults = self.faults.into_inner();
        faults.sort_by_key(|it| (it.line, it.column));
        faults
    }

    /// Whether anything is.
    pub fn has_faults(&self) -> bool {
        !self.faults.borrow().is_empty()
    }

    /// The tables and values of the text, as far as its syntax holds.
    pub fn tables(&self) -> Spanned<DeTable<'a>> {
        let (table, errors) = DeTable::parse_recoverable(self.text);
        for error in errors {
            let at = error.span().map_or(self.text.len(), |it| it.start);
            self.fault(at, error.message());
        }
        table
    }

    /// The table that a value is.
    pub fn table<'t>(
        &self,
        value: &'t Spanned<DeValue<'a>>,
        what: &str,
    ) -> Option<&'t DeTable<'a>> {
        let table = value.get_ref().as_table();
        if table.is_none() {
            self.fault(value.span().start, format!("{what} must be a table"));
        }
        table
    }

    /// The string that a value is, with where its characters begin.
    pub fn string(&self, value: &Spanned<DeValue<'a>>, what: &str) -> Option<Written> {
        match value.get_ref() {
            DeValue::String(characters) => {
                let at = self.first_character(&value.span());
                Some(Written { characters: characters.to_string(), at })
            }
            _ => {
                self.fault(value.span().start, format!("{what} must be a string"));
                None
            }
        }
    }

    /// The expression that a value is: a string or a number.
    pub fn expression(&self, value: &Spanned<DeValue<'a>>, what: &str) -> Option<Written> {
        match value.get_ref() {
            DeValue::Integer(_) | DeValue::Float(_) => {
                let at = value.span().start;
                Some(Written { characters: self.text[value.span()].replace('_', ""), at })
            }
            DeValue::String(_) => self.string(value, what),
            _ => {
                let message = format!("{what} must be an expression in quotes, or a number");
                self.fault(value.span().start, message);
                None
            }
        }
    }

    /// The finite number that a value is.
    pub fn number(&self, value: &Spanned<DeValue<'a>>, what: &str) -> Option<f64> {
        let number = match value.get_ref() {
            DeValue::Integer(_) | DeValue::Float(_) => {
                self.text[value.span()].replace('_', "").parse().ok()
            }
            _ => None,
        };
        let finite = number.filter(|it: &f64| it.is_finite());
        if finite.is_none() {
            self.fault(value.span().start, format!("{what} must be a finite number"));
        }
        finite
    }

    /// Notes the keys of a table that have no meaning there.
    pub fn only(&self, table: &DeTable<'a>, place: &str, keys: &[&str]) {
        for key in table.keys() {
            let name: &str = key.get_ref();
            if !keys.contains(&name) {
                let message = format!("{place} has no key {name:?}{}", hint(name, keys));
                self.fault(key.span().start, message);
            }
        }
    }

    /// Where the characters of a string begin behind its quotes.
    fn first_character(&self, span: &Range<usize>) -> usize {
        let quotes = &self.text[span.clone()];
        let is_long = quotes.starts_with("\"\"\"") || quotes.starts_with("'''");
        span.start + if is_long { 3 } else { 1 }
    }
}

/// What else could have been meant by a name, and all that is allowed.
pub fn hint<'n>(
    name: &str,
    allowed: impl IntoIterator<Item = &'n (impl AsRef<str> + ?Sized + 'n)>,
) -> String {
    let allowed: Vec<&str> = allowed.into_iter().map(AsRef::as_ref).collect();
    let distance = |it: &&str| damerau_levenshtein(name, it);
    let nearest = allowed.iter().copied().min_by_key(distance);
    let near = nearest.filter(|it| distance(it) <= FARTHEST.min(name.chars().count() / 2));
    let meant = near.map_or(String::new(), |it| format!("; did you mean {it:?}?"));
    format!(
        "{meant} (allowed: {})",
        if allowed.is_empty() { "none".into() } else { allowed.join(", ") }
    )
}

/// Where a table begins, to tell of what it lacks.
pub fn place_of(table: &DeTable<'_>) -> usize {
    table.keys().map(|it| it.span().start).min().unwrap_or_default()
}
