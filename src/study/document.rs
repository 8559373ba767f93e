//! Reads a TOML document key by key and collects every fault with its line.

use std::cell::RefCell;
use std::fmt;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub use super::unknown_name::{nearest, unknown, unknown_of};
use crate::description::Description;
use crate::quantity::printable::one_line;
use crate::quantity::units::{expectation, parse_in};
use crate::quantity::{Allowed, Dimension};

/// Characters of a line that are shown at most.
const LONGEST_SHOWN: usize = 80;

/// One thing wrong in a document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Line, counted from 1; none where something is missing.
    pub line: Option<usize>,
    /// The key, as a path ("axes[2].from").
    pub key: String,
    /// What is wrong and what is allowed.
    pub message: String,
}

/// Everything wrong in a document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Faults {
    /// The document's file.
    pub file: String,
    /// The faults, in order of lines.
    pub faults: Vec<Fault>,
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.faults.len() == 1 { "fault" } else { "faults" };
        write!(f, "{}: {} {plural}", one_line(&self.file), self.faults.len())?;
        for Fault { line, key, message } in &self.faults {
            write!(f, "\n  ")?;
            if let Some(line) = line {
                write!(f, "line {line}: ")?;
            }
            if !key.is_empty() {
                write!(f, "{}: ", one_line(key))?;
            }
            f.write_str(&one_line(message))?;
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}

/// Where faults are collected while a document is read.
#[derive(Debug)]
pub struct Reader<'a> {
    text: &'a str,
    /// The model that the document is about.
    model: &'static Description,
    faults: RefCell<Vec<Fault>>,
}

impl<'a> Reader<'a> {
    /// Nothing wrong yet in a document about a model.
    pub fn new(text: &'a str, model: &'static Description) -> Self {
        Reader { text, model, faults: RefCell::default() }
    }

    /// Notes a fault at a byte of the text, if it has a place.
    pub fn fault(&self, at: Option<usize>, key: impl Into<String>, message: impl Into<String>) {
        let line = at.map(|at| self.text[..at].matches('\n').count() + 1);
        self.faults.borrow_mut().push(Fault { line, key: key.into(), message: message.into() });
    }

    /// Notes a fault of the syntax with the line it stands in, the first of each line only.
    pub fn syntax(&self, error: &toml::de::Error) {
        let span = error.span().map(|span| span.start.min(self.text.len()));
        let at = span.or_else(|| self.first_line_with(error.message()));
        let line = at.and_then(|at| self.text.get(..at)).map(|before| before.matches('\n').count());
        if self.faults.borrow().iter().any(|it| it.line == line.map(|line| line + 1)) {
            return;
        }
        let found = line.and_then(|line| self.text.lines().nth(line)).map_or("", str::trim);
        let shown: String = found.chars().take(LONGEST_SHOWN).collect();
        let more = if shown.len() < found.len() { " ..." } else { "" };
        let found = if found.is_empty() { String::new() } else { format!(", in: {shown}{more}") };
        self.fault(at, "", format!("{}{found}", error.message()));
    }

    /// Where the first line begins with which the text gives a fault of the syntax that has no place of its own.
    fn first_line_with(&self, message: &str) -> Option<usize> {
        let ends: Vec<usize> = self
            .text
            .split_inclusive('\n')
            .scan(0, |end, line| {
                *end += line.len();
                Some(*end)
            })
            .collect();
        let line = ends.partition_point(|&end| {
            let (_, errors) = DeTable::parse_recoverable(&self.text[..end]);
            errors.iter().all(|error| error.message() != message)
        });
        (line < ends.len()).then(|| if line == 0 { 0 } else { ends[line - 1] })
    }

    /// Notes a fault with the line that it has.
    pub fn note(&self, fault: Fault) {
        self.faults.borrow_mut().push(fault);
    }

    /// The faults in order of lines.
    pub fn faults(self, file: &str) -> Faults {
        let mut faults = self.faults.into_inner();
        faults.sort_by_key(|fault| fault.line);
        Faults { file: file.to_owned(), faults }
    }

    /// An error if anything was wrong.
    pub fn finish(self, file: &str) -> Result<(), Faults> {
        let faults = self.faults(file);
        if faults.faults.is_empty() { Ok(()) } else { Err(faults) }
    }
}

/// A table of the document, with the keys that have been asked for.
pub struct Table<'r, 'a> {
    reader: &'r Reader<'a>,
    path: String,
    /// Where it begins; none for the whole document.
    place: Option<usize>,
    table: &'r DeTable<'a>,
    asked: RefCell<Vec<String>>,
}

/// A value of the document with its place.
#[derive(Clone)]
pub struct Entry<'r, 'a> {
    reader: &'r Reader<'a>,
    /// The key, as a path.
    pub key: String,
    value: &'r Spanned<DeValue<'a>>,
}

impl<'r, 'a> Table<'r, 'a> {
    /// The whole document as a table.
    pub fn new(reader: &'r Reader<'a>, table: &'r DeTable<'a>) -> Self {
        Table { reader, path: String::new(), place: None, table, asked: RefCell::default() }
    }

    /// The model that the document is about.
    pub fn model(&self) -> &'static Description {
        self.reader.model
    }

    fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) }
    }

    /// The value of `key`, if it is there.
    pub fn entry(&self, key: &str) -> Option<Entry<'r, 'a>> {
        let mut asked = self.asked.borrow_mut();
        if !asked.iter().any(|known| known == key) {
            asked.push(key.to_owned());
        }
        let value = self.table.get(key)?;
        Some(Entry { reader: self.reader, key: self.path_of(key), value })
    }

    /// The value of a `key` that is accepted and is not named among the allowed keys.
    pub fn alias(&self, key: &str) -> Option<Entry<'r, 'a>> {
        if self.table.contains_key(key) { self.entry(key) } else { None }
    }

    /// Notes that `key` is missing.
    pub fn missing(&self, key: &str, expected: &str) {
        let message = format!("missing; expected {expected}");
        self.reader.fault(self.place, self.path_of(key), message);
    }

    /// Notes a fault with the line that it has.
    pub fn note(&self, fault: Fault) {
        self.reader.note(fault);
    }

    /// Reports what cannot be together with other values, at `key`.
    pub fn conflict(&self, key: &str, message: &str) {
        self.reader.fault(self.place, self.path_of(key), message);
    }

    /// The table under `key`.
    pub fn table(&self, key: &str) -> Option<Table<'r, 'a>> {
        self.entry(key)?.table()
    }

    /// Every key with its value.
    pub fn entries(&self) -> Vec<(String, Entry<'r, 'a>)> {
        let keys = self.table.keys().map(|key| key.get_ref().to_string());
        keys.filter_map(|key| self.entry(&key).map(|entry| (key, entry))).collect()
    }

    /// Notes every key that was not read.
    pub fn finish(self) {
        let asked = self.asked.borrow();
        for (key, _) in self.table.iter() {
            let name = key.get_ref();
            if !asked.iter().any(|known| known == name) {
                let known = asked.iter().map(String::as_str);
                let message = unknown_of(self.model(), "key", name, known);
                self.reader.fault(Some(key.span().start), self.path_of(name), message);
            }
        }
    }
}

impl<'r, 'a> Entry<'r, 'a> {
    /// Notes a fault of this value.
    pub fn fault(&self, message: impl Into<String>) {
        self.reader.fault(Some(self.value.span().start), self.key.clone(), message);
    }

    fn expected<T>(&self, found: Option<T>, what: &str) -> Option<T> {
        if found.is_none() {
            self.fault(format!("expected {what}, found {}", self.shown()));
        }
        found
    }

    /// The value as it stands in the document; of a list or a table only what it is.
    pub fn shown(&self) -> String {
        match self.value.get_ref() {
            DeValue::String(text) => format!("\"{text}\""),
            DeValue::Integer(number) => number.as_str().to_owned(),
            DeValue::Float(number) => number.as_str().to_owned(),
            DeValue::Boolean(truth) => truth.to_string(),
            DeValue::Datetime(time) => time.to_string(),
            other => format!("{} {}", article(other.type_str()), other.type_str()),
        }
    }

    /// The value as text.
    pub fn text(&self) -> Option<&'r str> {
        self.expected(self.value.get_ref().as_str(), "a text in quotes")
    }

    /// The value as a table.
    pub fn table(&self) -> Option<Table<'r, 'a>> {
        let table = self.expected(self.value.get_ref().as_table(), "a table")?;
        Some(Table {
            reader: self.reader,
            path: self.key.clone(),
            place: Some(self.value.span().start),
            table,
            asked: RefCell::default(),
        })
    }

    /// The value as a list.
    pub fn list(&self) -> Vec<Entry<'r, 'a>> {
        let list = self.expected(self.value.get_ref().as_array(), "a list").into_iter().flatten();
        list.enumerate()
            .map(|(i, value)| Entry {
                reader: self.reader,
                key: format!("{}[{}]", self.key, i + 1),
                value,
            })
            .collect()
    }

    /// The value as text, or the elements of a list as texts; a number is written out.
    pub fn parts(&self) -> Option<Vec<String>> {
        match self.is_list() {
            true => self.list().iter().map(Entry::text_or_number).collect(),
            false => Some(vec![self.text_or_number()?]),
        }
    }

    /// The value as text; a number is written out.
    fn text_or_number(&self) -> Option<String> {
        match self.number() {
            Some(number) => Some(number.to_string()),
            None => self.text().map(str::to_owned),
        }
    }

    /// Whether the value is a table.
    pub fn is_table(&self) -> bool {
        self.value.get_ref().is_table()
    }

    /// Whether the value is a list.
    pub fn is_list(&self) -> bool {
        self.value.get_ref().is_array()
    }

    /// The value as a plain number.
    fn number(&self) -> Option<f64> {
        match self.value.get_ref() {
            DeValue::Float(number) => number.as_str().parse().ok(),
            DeValue::Integer(number) => {
                i64::from_str_radix(number.as_str(), number.radix()).ok().map(|n| n as f64)
            }
            _ => None,
        }
    }

    /// The value as a whole number from `least` to `most`.
    pub fn whole(&self, least: u64, most: u64) -> Option<u64> {
        let upper = if most == u64::MAX { "or above".to_owned() } else { format!("to {most}") };
        let what = format!("a whole number, {least} {upper}");
        let DeValue::Integer(number) = self.value.get_ref() else {
            return self.expected(None, &what);
        };
        let whole = u64::from_str_radix(number.as_str(), number.radix()).ok();
        let whole = whole.filter(|n| (least..=most).contains(n));
        if whole.is_none() {
            self.fault(format!("expected {what}, found {}", number.as_str()));
        }
        whole
    }

    /// The value as `true` or `false`.
    pub fn truth(&self) -> Option<bool> {
        self.expected(self.value.get_ref().as_bool(), "true or false")
    }

    /// The value as a quantity of `dimension`, in SI.
    pub fn quantity(&self, dimension: Dimension) -> Option<f64> {
        self.quantity_in(dimension, 1.0)
    }

    /// The value as a quantity of `dimension`, in a unit of this size in SI.
    pub fn quantity_in(&self, dimension: Dimension, unit_size: f64) -> Option<f64> {
        if let Some(number) = self.number() {
            if dimension == Dimension::Number {
                return Some(number);
            }
            self.fault(format!("{number} has no unit; expected {}", expectation(dimension)));
            return None;
        }
        let what = format!("{} (as a text in quotes)", expectation(dimension));
        let text = self.expected(self.value.get_ref().as_str(), &what)?;
        parse_in(text, dimension, unit_size).map_err(|message| self.fault(message)).ok()
    }

    /// The value as a quantity of `dimension`, in SI, if it is allowed.
    pub fn allowed_quantity(&self, dimension: Dimension, allowed: Allowed) -> Option<f64> {
        let value = self.quantity(dimension)?;
        if !allowed.admits(value) {
            let unit = Some(dimension.unit()).filter(|&unit| unit != "1");
            let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
            self.fault(format!("{value}{unit} must be {allowed}"));
            return None;
        }
        Some(value)
    }

    /// The value as one of a few names.
    pub fn one_of<T: Copy>(&self, what: &str, choices: &[(&str, T)]) -> Option<T> {
        let text = self.text()?;
        let found = choices.iter().find(|(name, _)| *name == text).map(|&(_, value)| value);
        if found.is_none() {
            let known = choices.iter().map(|&(name, _)| name);
            self.fault(unknown_of(self.reader.model, what, text, known));
        }
        found
    }
}

fn article(noun: &str) -> &'static str {
    if noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }
}
