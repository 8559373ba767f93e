//! `capsulemap help`: the help of a command, a key of a study, an output, the units, or a page of the book.

use clap::{Args, Command};

use super::book::{self, OUTPUTS, Row};
use super::failure::Failure;
use super::terminal::print;
use crate::quantity::Dimension;
use crate::quantity::units::{expectation, unit};
use crate::study::document::nearest;

const EXAMPLES: &str = "\
study, output, unit and book without a name list what there is.

Examples:
  capsulemap help sweep
  capsulemap help study
  capsulemap help study refine
  capsulemap help study basin
  capsulemap help output power
  capsulemap help unit
  capsulemap help book systems";

/// Words of a table of the book are broken here.
const WIDTH: usize = 100;

/// Print the help of a command, or what the book says of keys of a study, outputs and units.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Help {
    /// A command; or study, output, unit or book, and a name.
    #[arg(value_name = "TOPIC")]
    topic: Vec<String>,
}

impl Help {
    /// Prints what is asked for of the program whose commands these are.
    pub fn run(self, mut program: Command) -> Result<(), Failure> {
        let words: Vec<&str> = self.topic.iter().map(String::as_str).collect();
        match words[..] {
            [] => print(&program.render_long_help().to_string()),
            ["study"] => print(&all_keys()),
            ["study", name] => print(&of_key(name)?),
            ["output"] => print(&all_outputs()),
            ["output", name] => print(&of_output(name)?),
            // All of them are few.
            ["unit"] => print(&units()),
            ["unit", name] => print(&of_unit(name)?),
            ["book"] => print(&contents()),
            ["book", name] => print(&of_page(name)?),
            [command] => match program.find_subcommand_mut(command) {
                Some(found) => {
                    let called = format!("capsulemap {}", found.get_name());
                    print(&found.clone().bin_name(called).render_long_help().to_string())
                }
                None => {
                    let commands = program.get_subcommands().map(Command::get_name);
                    let known = commands.chain(["study", "output", "unit", "book"]);
                    let allowed = "a command; study, output, unit or book and a name; answers to errors: capsulemap help book errors";
                    Err(unknown("topic", command, known, allowed))
                }
            },
            _ => Err(Failure::request(format!(
                "help of \"{}\": one topic at a time; capsulemap help help shows how",
                words.join(" ")
            ))),
        }
    }
}

/// The failure of a name that is not among those that are known.
fn unknown<'n>(
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'n str>,
    allowed: &str,
) -> Failure {
    let hint = match nearest(name, known) {
        Some(other) => format!("; did you mean \"{other}\"?"),
        None => String::new(),
    };
    Failure::request(format!("unknown {what} \"{name}\"{hint} (allowed: {allowed})"))
}

/// The tables of a study with their keys.
fn all_keys() -> String {
    let mut text = String::new();
    let mut heading = String::new();
    for row in keys() {
        if row.heading != heading {
            let gap = if heading.is_empty() { "" } else { "\n" };
            text.push_str(&format!("{gap}{}\n", row.heading));
            heading = row.heading;
        }
        text.push_str(&format!("  {}\n", row.names.join(", ")));
    }
    text + "\ncapsulemap help study KEY tells what a key means.\n"
}

/// The keys of a study.
fn keys() -> Vec<Row> {
    book::of_studies().flat_map(|page| page.rows("key")).collect()
}

/// What the book says of a key of a study, or of a table.
fn of_key(name: &str) -> Result<String, Failure> {
    let bare = name.trim_matches(|it| it == '[' || it == ']');
    let (table, key) = bare.split_once('.').map_or((None, bare), |(table, key)| (Some(table), key));
    let in_table = |row: &Row| table.is_none_or(|it| row.heading.contains(it));
    let found: Vec<Row> =
        keys().into_iter().filter(|row| row.names.contains(&key) && in_table(row)).collect();
    if !found.is_empty() {
        return Ok(found.iter().map(told).collect::<Vec<_>>().join("\n"));
    }
    match book::of_studies().find(|page| page.name == bare || page.name == format!("study/{bare}"))
    {
        Some(page) => Ok(page.plain()),
        None => {
            let keys = keys();
            let names = keys.iter().flat_map(|row| row.names.iter().copied());
            let tables = book::of_studies().map(|page| page.name.trim_start_matches("study/"));
            // Of a key with its table the key is compared.
            let meant = if table.is_some() { key } else { bare };
            let what = "key or table of a study";
            Err(unknown(what, meant, names.chain(tables), "capsulemap help study lists them"))
        }
    }
}

/// A row with what heads its cells, and the paragraphs that say more.
fn told(row: &Row) -> String {
    let mut text = format!("{}, of {}\n", row.names.join(", "), row.heading);
    for (head, cell) in &row.cells {
        text.push_str(&wrapped(&format!("{head}: {cell}")));
    }
    row.more.iter().for_each(|it| text.push_str(&wrapped(it)));
    text
}

/// A paragraph in lines, each indented.
fn wrapped(paragraph: &str) -> String {
    let mut text = String::new();
    let mut line = String::from(" ");
    for word in paragraph.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > WIDTH && line.len() > 1 {
            text.push_str(&line);
            text.push('\n');
            line = String::from(" ");
        }
        line.push(' ');
        line.push_str(word);
    }
    text + &line + "\n"
}

fn outputs() -> Vec<Row> {
    book::page(OUTPUTS).map_or(Vec::new(), |page| page.rows("output"))
}

/// The outputs with their units.
fn all_outputs() -> String {
    let mut text = String::new();
    for row in outputs() {
        let unit = row.cells.first().map_or("", |it| it.1.as_str());
        row.names.iter().for_each(|name| text.push_str(&format!("{name} [{unit}]\n")));
    }
    text + "\nThose of the capsule; capsulemap help output NAME tells how one is defined.\n"
}

/// How an output is defined.
fn of_output(name: &str) -> Result<String, Failure> {
    let outputs = outputs();
    let found: Vec<String> =
        outputs.iter().filter(|row| row.names.contains(&name)).map(told).collect();
    if !found.is_empty() {
        return Ok(found.join("\n"));
    }
    let known = outputs.iter().flat_map(|row| row.names.iter().copied());
    Err(unknown("output", name, known, "capsulemap help output lists those of the capsule"))
}

/// The units of each dimension.
fn units() -> String {
    let lines = Dimension::ALL.into_iter().map(|it| expectation(it) + "\n");
    lines.collect::<String>()
        + "\nQuantities are texts with their unit, as \"18.96 kN/m\"; powers may be written as s2 or s^2.\n"
}

/// The dimensions that have a unit, each with all of its units.
fn of_unit(name: &str) -> Result<String, Failure> {
    let of: Vec<Dimension> = Dimension::ALL
        .into_iter()
        .filter(|it| !name.is_empty() && unit(name, *it).is_some())
        .collect();
    match of.is_empty() {
        true => Err(Failure::request(format!(
            "unknown unit \"{name}\" (allowed: capsulemap help unit lists them)"
        ))),
        false => Ok(of.into_iter().map(|it| expectation(it) + "\n").collect()),
    }
}

/// The pages of the book.
fn contents() -> String {
    let widest = book::PAGES.iter().map(|it| it.name.len()).max().unwrap_or(0);
    let lines = book::PAGES.iter().map(|it| format!("{:widest$}  {}\n", it.name, it.title()));
    lines.collect()
}

fn of_page(name: &str) -> Result<String, Failure> {
    let page = book::page(name);
    page.map(book::Page::plain).ok_or_else(|| {
        let folders = book::PAGES.iter().map(|it| it.name);
        let known = folders.clone().filter_map(|it| it.rsplit('/').next()).chain(folders);
        unknown("page", name, known, "capsulemap help book lists them")
    })
}
