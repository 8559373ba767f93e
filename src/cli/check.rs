//! `capsulemap check`: what is wrong in a study or a system, or what follows from it.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use super::readable::counted;
use super::rehearsal::rehearse_study;
use super::terminal::print;
use crate::campaign::{is_system_alone, read_study, read_system};
use crate::description::Description;
use crate::figure::Place;
use crate::quantity::printable::printable;
use crate::study::{Coordinate, Study};

const EXAMPLES: &str = "\
Examples:
  capsulemap check studies/overview.toml
  capsulemap check systems/belt.toml";

/// Say what is wrong in a study or in the text of a system, and if nothing is, what follows from it.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Check {
    /// The study or the system, a TOML file.
    file: PathBuf,
}

impl Check {
    /// Carries the command out.
    pub fn run(&self) -> Result<(), Failure> {
        let mut text = String::new();
        let model = match is_system_alone(&self.file)? {
            true => read_system(&self.file)?,
            false => {
                let study = read_study(&self.file)?;
                // Where a figure exists already is no fault of the study.
                let place = Place { folder: Path::new("."), formats: &[], overwrite: true };
                let drawn = rehearse_study(&study, &place);
                drawn.map_err(|it| it.within(&printable(&self.file).to_string()))?;
                text.push_str(&of_study(&study));
                study.base.model()
            }
        };
        text.push_str(&of_model(model));
        let misfits = match model.equations {
            Some(_) => capsulemap_text::derived::misfits(model).len(),
            None => 0,
        };
        let heading = match misfits {
            0 => "no fault".to_owned(),
            count => format!("no fault, {} on units", counted(count, "note")),
        };
        print(&format!("{}: {heading}\n{text}", printable(&self.file)))
    }
}

/// What a study asks for.
fn of_study(study: &Study) -> String {
    let mut text = String::new();
    let notes = study.remarks.iter().cloned().chain(study.remarks_on_values());
    let notes = notes.chain(study.varied_without_effect()).chain(study.branches_without_effect());
    for note in notes {
        let _ = writeln!(text, "note: {note}");
    }
    let shape: Vec<String> = study.shape().iter().map(ToString::to_string).collect();
    let cases = counted(study.cases(), "case");
    let _ = writeln!(text, "{:<12}{cases} ({})", "asks for", shape.join(" x "));
    for path in study.axes().iter().filter(|axis| axis.path.is_some()) {
        let along: Vec<&str> = path.coordinates().map(Coordinate::name).collect();
        let places = counted(path.places(), "place");
        line(&mut text, "path", &format!("{} of {places}: {}", path.name(), along.join(", ")));
    }
    let outputs: Vec<&str> = study.outputs.iter().map(|it| it.name()).collect();
    line(&mut text, "outputs", &outputs.join(", "));
    for it in study.base.model().own_outputs() {
        line(&mut text, "own output", &format!("{} [{}]: {}", it.name(), it.unit(), it.meaning()));
    }
    let parameters = study.with_parts();
    if let Some(member) = (parameters.model().rules.member)(&parameters) {
        line(&mut text, "member", &member);
    }
    text
}

/// What a model is.
fn of_model(model: &'static Description) -> String {
    let mut text = String::new();
    line(&mut text, "model", model.name);
    if model.equations.is_none() {
        return text;
    }
    for (what, it) in capsulemap_text::derived::derived(model) {
        line(&mut text, what, &it);
    }
    text
}

/// A line, whose later ones are indented.
fn line(text: &mut String, what: &str, it: &str) {
    for (place, part) in it.lines().enumerate() {
        let _ = writeln!(text, "{:<12}{part}", if place == 0 { what } else { "" });
    }
}
