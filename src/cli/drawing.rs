//! Draws the figures of a study: those for which there is all that they show, or all without a value.

use clap::ValueEnum;

use super::failure::Failure;
use super::terminal::notify;
use crate::campaign::{KeptFront, KeptSearches, searches_path, study_of};
use crate::figure::{
    FigureError, Files, Format, Measured, Needs, Place, Shown, draw, gain_of, needs, variables,
};
use crate::quantity::printable::printable;
use crate::store::{Archive, Dataset, StoreError, has_branches, has_cases};
use crate::study::{Drawing, Study};

/// Formats on the command line.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum FormatChoice {
    /// Pixels.
    Png,
    /// Vectors for the web.
    Svg,
    /// Vectors for a paper.
    Pdf,
}

impl From<FormatChoice> for Format {
    fn from(choice: FormatChoice) -> Format {
        match choice {
            FormatChoice::Png => Format::Png,
            FormatChoice::Svg => Format::Svg,
            FormatChoice::Pdf => Format::Pdf,
        }
    }
}

/// The formats chosen, each once.
pub fn formats(choices: &[FormatChoice]) -> Vec<Format> {
    let mut formats: Vec<Format> = Vec::new();
    for format in choices.iter().copied().map(Format::from) {
        if !formats.contains(&format) {
            formats.push(format);
        }
    }
    formats
}

/// Draws those figures of a study for which there is all that they show.
pub fn draw_from(archive: &Archive, study: &Study, place: &Place<'_>) -> Result<(), Failure> {
    draw_each(archive, &ready(archive.into(), study), None, place)
}

/// Draws figures, each from no more of the results than it shows, with measured points if there are any.
pub fn draw_each(
    archive: &Archive,
    drawings: &[Drawing],
    measured: Option<&Measured>,
    place: &Place<'_>,
) -> Result<(), Failure> {
    let mut failures = Vec::new();
    for drawing in drawings {
        let shown = variables(drawing, archive.frame().model());
        let dataset = archive.labelled(|name| shown.contains(name)).map_err(Failure::machine)?;
        let refined =
            if drawing.kind.keys().between { refined(archive, drawing)? } else { Vec::new() };
        let shown = Shown { dataset: &dataset, refined: &refined, measured };
        failures.extend(draw_all(shown, std::slice::from_ref(drawing), place).err());
    }
    Failure::all(failures).map_or(Ok(()), Err)
}

/// What refinements for the gain of a figure have found between the cases of a file.
fn refined(archive: &Archive, drawing: &Drawing) -> Result<Vec<KeptFront>, Failure> {
    let path = searches_path(archive.path());
    let gain = gain_of(drawing, archive.frame().model()).filter(|_| path.exists());
    let Some(gain) = gain else { return Ok(Vec::new()) };
    let study = study_of(archive, archive.path())?;
    match KeptSearches::read(archive, &study) {
        Ok(kept) => {
            kept.damage(archive).iter().for_each(|it| notify(it));
            Ok(kept.fronts(archive, gain)?)
        }
        Err(error) => {
            notify(&format!("{error}; they are not shown"));
            Ok(Vec::new())
        }
    }
}

/// Draws the figures from results without a single value, so that a mistake in one of them is
/// reported before a long run and not after it.
pub fn rehearse(empty: &Dataset, study: &Study, place: &Place<'_>) -> Result<(), Failure> {
    let mut ready = study.drawings.clone();
    ready.retain(|it| waits_for(it, study, empty.into()).is_none());
    for drawing in &ready {
        place.check(&drawing.name, drawing.data).map_err(failure)?;
    }
    // In no format at all, nothing is written.
    draw_all(empty.into(), &ready, &Place { formats: &[], ..*place })
}

/// Draws each figure and prints its files; one that cannot be drawn does not prevent the others.
fn draw_all(shown: Shown<'_>, drawings: &[Drawing], place: &Place<'_>) -> Result<(), Failure> {
    let mut failures = Vec::new();
    for drawing in drawings {
        match draw(shown, drawing, place) {
            Ok(Files { paths, .. }) if paths.is_empty() => {}
            Ok(Files { paths, notes }) => {
                let names: Vec<String> =
                    paths.iter().map(|path| printable(path).to_string()).collect();
                notify(&names.join(" "));
                for note in notes {
                    notify(&format!("  figure `{}`: {note}", drawing.name));
                }
            }
            Err(error) => failures.push(failure(error)),
        }
    }
    Failure::all(failures).map_or(Ok(()), Err)
}

fn failure(error: FigureError) -> Failure {
    match error {
        FigureError::Missing { .. } | FigureError::Unfit { .. } | FigureError::Glyph { .. } => {
            Failure::request(error)
        }
        FigureError::Write { source: StoreError::NoPlace { .. }, .. } => Failure::request(error),
        FigureError::Occupied { .. } => Failure::request(format!(
            "{error}; move it, choose another place, or replace it with --overwrite"
        )),
        FigureError::Render { .. } | FigureError::Write { .. } => Failure::machine(error),
    }
}

/// What a file of results holds.
#[derive(Debug, Clone, Copy)]
struct Holds {
    cases: bool,
    branches: bool,
}

impl From<&Dataset> for Holds {
    fn from(dataset: &Dataset) -> Self {
        Holds { cases: has_cases(dataset), branches: has_branches(dataset) }
    }
}

impl From<&Archive> for Holds {
    fn from(archive: &Archive) -> Self {
        Holds { cases: archive.has_cases(), branches: has_branches(archive.frame()) }
    }
}

/// The figures of a study for which there is all that they show; the others are reported with what
/// they wait for.
fn ready(holds: Holds, study: &Study) -> Vec<Drawing> {
    let mut ready = Vec::new();
    for drawing in &study.drawings {
        match waits_for(drawing, study, holds) {
            None => ready.push(drawing.clone()),
            Some(command) => {
                notify(&format!("figure `{}`: waits for `capsulemap {command}`", drawing.name));
            }
        }
    }
    ready
}

/// The command that finds what a figure shows and is not there.
fn waits_for(drawing: &Drawing, study: &Study, holds: Holds) -> Option<&'static str> {
    let Holds { cases, branches } = holds;
    match needs(drawing.kind) {
        Needs::Branches => (!branches).then_some("continue"),
        Needs::CasesOrBranches if shows_branches_alone(drawing, study) => {
            (!branches).then_some("continue")
        }
        Needs::CasesOrBranches => (!cases && !branches).then_some("sweep"),
        Needs::Cases => (!cases && branches).then_some("sweep"),
    }
}

/// Whether the abscissa of a figure is a parameter of a branch or a ramp of the study that no case varies.
fn shows_branches_alone(drawing: &Drawing, study: &Study) -> bool {
    let Some(x) = drawing.x.as_deref() else { return false };
    let is_varied = study.case_set.varied().iter().any(|it| it.name() == x);
    let of_branches = study.branches.iter().map(|branch| branch.along);
    let mut beside = of_branches.chain(study.ramps.iter().map(|ramp| ramp.along));
    !is_varied && beside.any(|along| along.symbol() == x)
}
