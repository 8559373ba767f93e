//! Parameter files that a study takes values from: `include = "rig.toml"`.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::Faults;
use super::named_model::model_in;
use crate::description::{Description, Parameter};
use crate::quantity::printable::one_line;

/// The key by which a study names its parameter file.
pub const KEY: &str = "include";

/// A study with the values of a parameter file in the place of its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Included {
    /// The text of the study, in which the values stand.
    pub text: String,
    /// The lines that were put in, counted from 1.
    lines: Range<usize>,
    /// The parameter file.
    file: String,
}

/// The parameter file that a study names, if it names one; a text that is no TOML names none.
pub fn included(text: &str) -> Option<String> {
    let (document, _) = DeTable::parse_recoverable(text);
    match document.get_ref().get(KEY)?.get_ref() {
        DeValue::String(name) => Some(name.to_string()),
        _ => None,
    }
}

/// The study with the parameters of the `file`, whose text is `parameters`, except those that it sets itself or varies.
///
/// Fails with what is wrong in the parameter file, which may include no other.
pub fn include(study: &str, file: &str, parameters: &str) -> Result<Included, String> {
    let shown = one_line(file);
    let (given, errors) = DeTable::parse_recoverable(parameters);
    if let Some(error) = errors.first() {
        let at = error.span().map_or(0, |span| span.start.min(parameters.len()));
        let line = line_of(parameters, at);
        return Err(format!("{shown}: line {line}: {}", error.message()));
    }
    if let Some((key, _)) = given.get_ref().get_key_value(KEY) {
        let line = line_of(parameters, key.span().start);
        return Err(format!(
            "{shown}: line {line}: {KEY}: a parameter file may include no other; put the values of that one here"
        ));
    }
    let Some(DeValue::Table(values)) = given.get_ref().get("parameters").map(Spanned::get_ref)
    else {
        return Err(format!("{shown}: has no table [parameters]"));
    };
    let (document, _) = DeTable::parse_recoverable(study);
    let document = document.get_ref();
    let model = model_in(document, study);
    let own = set_by(document);
    let mut lines = Vec::new();
    for (key, value) in values.iter() {
        let symbol = key.get_ref();
        let line = line_of(parameters, key.span().start);
        if model.parameter(symbol).is_none() {
            return Err(format!(
                "{shown}: line {line}: parameters.{}: is no parameter of the {}",
                one_line(symbol),
                model.name
            ));
        }
        if !is_settled(model, symbol, &own) {
            lines.push(format!("{symbol} = {} # from {shown}", &parameters[value.span()]));
        }
    }
    Ok(put_in(study, file, &lines))
}

/// Whether a study says itself what a parameter is: by its key, or by that of one of which either stands in place of the other.
fn is_settled(model: &'static Description, symbol: &str, own: &[String]) -> bool {
    own.iter().any(|key| {
        let [one, other] = [symbol, key].map(|it| model.parameter(it));
        let replaces = |one: Option<Parameter>, other| {
            one.and_then(Parameter::replaces).is_some_and(|it| Some(it) == other)
        };
        key == symbol || replaces(one, other) || replaces(other, one)
    })
}

/// The line of a byte of a text, counted from 1.
fn line_of(text: &str, at: usize) -> usize {
    text[..at].matches('\n').count() + 1
}

/// The parameters that a study sets or varies itself.
fn set_by(document: &DeTable<'_>) -> Vec<String> {
    let mut own: Vec<String> = Vec::new();
    if let Some(DeValue::Table(table)) = document.get("parameters").map(Spanned::get_ref) {
        own.extend(table.keys().map(|key| key.get_ref().to_string()));
    }
    let Some(DeValue::Array(axes)) = document.get("axes").map(Spanned::get_ref) else { return own };
    for axis in axes.iter() {
        let DeValue::Table(axis) = axis.get_ref() else { continue };
        if let Some(DeValue::String(name)) = axis.get("name").map(Spanned::get_ref) {
            own.push(name.to_string());
        }
    }
    own
}

/// The study with these lines in its table of parameters, and its `include` as a comment.
fn put_in(study: &str, file: &str, lines: &[String]) -> Included {
    let mut text: Vec<String> = Vec::new();
    let mut at = None;
    for line in study.lines() {
        let words = line.trim_start();
        let after_key = words.strip_prefix(KEY).map(str::trim_start);
        let names_file = at.is_none() && after_key.is_some_and(|it| it.starts_with('='));
        text.push(if names_file { format!("# {words}") } else { line.to_owned() });
        if words.starts_with("[parameters]") && at.is_none() {
            at = Some(text.len());
            text.extend(lines.iter().cloned());
        }
    }
    let begins = at.unwrap_or_else(|| {
        text.push("[parameters]".to_owned());
        text.extend(lines.iter().cloned());
        text.len() - lines.len()
    });
    let lines = begins + 1..begins + 1 + lines.len();
    Included { text: text.join("\n") + "\n", lines, file: file.to_owned() }
}

impl Included {
    /// Faults with the lines of the study as it was written; those of values that were taken from the file name it.
    pub fn as_written(&self, mut faults: Faults) -> Faults {
        for fault in &mut faults.faults {
            match fault.line {
                Some(line) if self.lines.contains(&line) => {
                    fault.line = None;
                    fault.message = format!("{} (in {})", fault.message, one_line(&self.file));
                }
                Some(line) if line >= self.lines.end => fault.line = Some(line - self.lines.len()),
                _ => {}
            }
        }
        faults
    }
}
