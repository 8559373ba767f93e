//! The system that a study gives as text: `system = "belt.toml"`, or a table `[system]`.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::document::{Fault, Faults, Table};
use crate::description::Description;
use crate::quantity::printable::one_line;

/// The key by which a study names the file of its system, or under which it has it.
pub const KEY: &str = "system";

/// The file of the system that a study names, if it names one; a text that is no TOML names none.
pub fn named_file(study: &str) -> Option<String> {
    let (document, _) = DeTable::parse_recoverable(study);
    match document.get_ref().get(KEY)?.get_ref() {
        DeValue::String(name) => Some(name.to_string()),
        _ => None,
    }
}

/// Whether a text says a system and nothing else.
pub fn is_alone(text: &str) -> bool {
    let (document, _) = DeTable::parse_recoverable(text);
    let is_table = document.get_ref().get(KEY).is_some_and(|it| it.get_ref().is_table());
    is_table && document.get_ref().len() == 1
}

/// The study with the system of the `file`, whose text is `system`, at its end; its own lines stay where they are.
///
/// # Errors
/// All that is wrong in the text of the system.
pub fn with_system(study: &str, file: &str, system: &str) -> Result<String, Faults> {
    if let Err(faults) = capsulemap_text::read(system) {
        let faults = faults.iter().map(of_text).collect();
        return Err(Faults { file: file.to_owned(), faults });
    }
    let mut is_named = false;
    let lines = study.lines().map(|line| {
        let after_key = line.trim_start().strip_prefix(KEY).map(str::trim_start);
        let names_file = !is_named && after_key.is_some_and(|it| it.starts_with('='));
        is_named |= names_file;
        if names_file { format!("# {line}\n") } else { format!("{line}\n") }
    });
    Ok(format!("{}\n# The system of {}\n{system}\n", lines.collect::<String>(), one_line(file)))
}

/// The model of the system in a text; `name` is the file's, for messages.
///
/// # Errors
/// All that is wrong in the system, or that there is none.
pub fn model_of(name: &str, text: &str) -> Result<&'static Description, Faults> {
    let model = capsulemap_text::model::model(text);
    model.map_err(|faults| Faults {
        file: name.to_owned(),
        faults: faults.iter().map(of_text).collect(),
    })
}

/// The model of the tables of a system; none where something in them is wrong.
pub fn known(tables: &str) -> Option<&'static Description> {
    capsulemap_text::model::of_tables(tables)
}

/// The model of the system that a study has; none where it has none, or one with faults.
pub(super) fn system_in(document: &DeTable<'_>, text: &str) -> Option<&'static Description> {
    let table = document.get(KEY).map(Spanned::get_ref)?;
    table.as_table().and_then(|_| capsulemap_text::model::model(text).ok())
}

/// Notes what is wrong in the system that a study has; returns whether it has none or one without faults.
pub(super) fn check_system(top: &Table<'_, '_>, text: &str) -> bool {
    let Some(entry) = top.entry(KEY) else { return true };
    if !entry.is_table() {
        entry.fault("must be the name of one file beside the study, as \"belt.toml\", or a table");
        return false;
    }
    match capsulemap_text::model::model(text) {
        Ok(_) => true,
        Err(faults) => {
            faults.iter().for_each(|fault| top.note(of_text(fault)));
            false
        }
    }
}

/// A fault of a text as one of a study.
fn of_text(fault: &capsulemap_text::Fault) -> Fault {
    let message = format!("column {}: {}", fault.column, fault.message);
    Fault { line: Some(fault.line), key: KEY.to_owned(), message }
}
