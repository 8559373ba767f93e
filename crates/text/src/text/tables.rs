//! The table `system` of a text written anew, by itself: what files of results and studies that are written keep of it.

use std::fmt::Write;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::text::entries::Value;

/// Tables that have their own heading.
const WITH_HEADING: [&str; 4] = ["parameters", "definitions", "rates", "outputs"];
/// Tables whose tables have their own headings.
const OF_TABLES: [&str; 3] = ["switch", "friction", "pulse"];

/// The table `system` of a text, in the order of the text and without comments; empty where there is none.
pub(crate) fn system_alone(text: &str) -> String {
    let (document, _) = DeTable::parse_recoverable(text);
    let system = document.get_ref().get("system").and_then(|it| it.get_ref().as_table());
    let mut alone = String::new();
    if let Some(system) = system {
        write_system(&mut alone, text, system);
    }
    alone
}

/// A table within another, with its heading, in the order of the text and without comments; empty where there is none.
pub(crate) fn table_alone(text: &str, heading: &str, within: &DeTable<'_>, key: &str) -> String {
    let mut alone = String::new();
    if let Some(table) = within.get(key).and_then(|it| it.get_ref().as_table()) {
        write_table(&mut alone, text, heading, table);
    }
    alone
}

fn write_system(alone: &mut String, text: &str, system: &DeTable<'_>) {
    alone.push_str("[system]\n");
    let entries = in_order(system);
    let has_heading = |it: &&(&str, &Value<'_>)| {
        [&WITH_HEADING[..], &OF_TABLES[..], &["events"]].concat().contains(&it.0)
    };
    for (key, value) in entries.iter().filter(|it| !has_heading(it)) {
        put(alone, text, key, value);
    }
    for (key, value) in entries.iter().filter(has_heading) {
        match value.get_ref() {
            DeValue::Array(events) => {
                for it in events.iter().filter_map(|it| it.get_ref().as_table()) {
                    write_table(alone, text, &format!("[[system.{key}]]"), it);
                }
            }
            DeValue::Table(table) if OF_TABLES.contains(key) => {
                for (name, it) in in_order(table) {
                    if let Some(it) = it.get_ref().as_table() {
                        write_table(alone, text, &format!("[system.{key}.{}]", quoted(name)), it);
                    }
                }
            }
            DeValue::Table(table) => {
                write_table(alone, text, &format!("[system.{key}]"), table);
            }
            _ => {}
        }
    }
}

/// The entries of a table in the order of the text.
fn in_order<'t, 'a>(table: &'t DeTable<'a>) -> Vec<(&'t str, &'t Value<'a>)> {
    let mut entries: Vec<_> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries.into_iter().map(|(key, value)| (&**key.get_ref(), value)).collect()
}

fn write_table(alone: &mut String, text: &str, heading: &str, table: &DeTable<'_>) {
    let _ = write!(alone, "\n{heading}\n");
    for (key, value) in in_order(table) {
        put(alone, text, key, value);
    }
}

/// Writes a key with its value in a line.
fn put(alone: &mut String, text: &str, key: &str, value: &Value<'_>) {
    let _ = writeln!(alone, "{} = {}", quoted(key), inline(text, value));
}

/// A value in a line.
fn inline(text: &str, value: &Value<'_>) -> String {
    match value.get_ref() {
        DeValue::Table(table) => {
            let entries = in_order(table).into_iter();
            let entries =
                entries.map(|(key, it)| format!("{} = {}", quoted(key), inline(text, it)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
        DeValue::Array(items) => {
            let items = items.iter().map(|it: &Spanned<DeValue<'_>>| inline(text, it));
            format!("[{}]", items.collect::<Vec<_>>().join(", "))
        }
        DeValue::String(characters) => of_string(characters),
        _ => text[value.span()].to_owned(),
    }
}

/// A string in quotes, as TOML has it.
pub fn of_string(characters: &str) -> String {
    let mut string = String::from("\"");
    for it in characters.chars() {
        match it {
            '"' | '\\' => string.extend(['\\', it]),
            it if it.is_control() => {
                let _ = write!(string, "\\U{:08X}", u32::from(it));
            }
            it => string.push(it),
        }
    }
    string.push('"');
    string
}

/// A key, in quotes where it needs them.
fn quoted(key: &str) -> String {
    let is_bare = |it: char| it.is_ascii_alphanumeric() || "_-".contains(it);
    match !key.is_empty() && key.chars().all(is_bare) {
        true => key.to_owned(),
        false => of_string(key),
    }
}
