//! Reads the study of a campaign, from its own file or from the file of its results.

use std::path::Path;

use super::error::CampaignError;
use crate::description::Description;
use crate::quantity::printable::printable;
use crate::store::catalogue::{CASE, OWN_TEXT, STUDY_TEXT, SYSTEM_TEXT, named, taken_twice};
use crate::store::{self, Archive, Pipes};
use crate::study::{Fault, Faults, Study, include, named_system, own_outputs};

/// The first bytes of an HDF5 file.
const HDF5: &[u8] = b"\x89HDF";

/// The study in the file at `path`.
///
/// A parameter file that it includes is looked for beside it, and the file of its system; the text of the study then has the values of
/// the one, and the other.
///
/// Fails if a file cannot be read, is no plain file or is no text, and with all faults of the study at once. The study may be a
/// pipe that the shell has opened, a parameter file may not.
pub fn read_study(path: &Path) -> Result<Study, CampaignError> {
    let name = path.to_string_lossy();
    let own = text(path, Pipes::OfShell)?;
    let own = with_named_system(own, path)?;
    let study = match include::included(&own) {
        Some(file) => with_values(&name, &own, &file, path)?,
        None => Study::parse(&name, &own)?,
    };
    check_names(&name, study.base.model())?;
    check_paths(&name, &study)?;
    Ok(study)
}

/// A study with the values of the parameter file that it includes.
fn with_values(name: &str, own: &str, file: &str, path: &Path) -> Result<Study, CampaignError> {
    let values = text(&store::folder(path).join(file), Pipes::Refused)?;
    let whole = include::include(own, file, &values)
        .map_err(|fault| CampaignError::of_path(path, fault))?;
    Ok(Study::parse(name, &whole.text).map_err(|faults| whole.as_written(faults))?)
}

/// Makes sure that a system, or a study for its own outputs, has no name for something which results have for something else.
///
/// Fails with every such name.
pub fn check_names(name: &str, model: &'static Description) -> Result<(), CampaignError> {
    let is_text = model.equations.is_some() || model.own.is_some();
    let taken = is_text.then(|| taken_twice(model)).into_iter().flatten();
    let of_text = taken_twice(model.without_own());
    let faults = taken.map(|taken| {
        let (key, what) = match of_text.contains(taken) {
            true => (named_system::KEY, "state, parameter or output"),
            false => (own_outputs::KEY, "own output"),
        };
        let message =
            format!("results would have two things called `{taken}`; call the {what} otherwise");
        Fault { line: None, key: key.to_owned(), message }
    });
    let faults: Vec<Fault> = faults.collect();
    match faults.is_empty() {
        true => Ok(()),
        false => Err(Faults { file: name.to_owned(), faults }.into()),
    }
}

/// Makes sure that no path of a study is called as something else that results have.
///
/// Fails with every such name.
pub fn check_paths(name: &str, study: &Study) -> Result<(), CampaignError> {
    let mut faults = Vec::new();
    for (place, axis) in study.axes().iter().enumerate() {
        let Some(path) = axis.path.as_deref() else { continue };
        let texts = [CASE, STUDY_TEXT, SYSTEM_TEXT, OWN_TEXT];
        if named(path, study.base.model()).is_some() || texts.contains(&path) {
            let message = format!(
                "\"{path}\" is the name of something else in results; a path has a name of its own"
            );
            faults.push(Fault { line: None, key: format!("axes[{}].name", place + 1), message });
        }
    }
    match faults.is_empty() {
        true => Ok(()),
        false => Err(Faults { file: name.to_owned(), faults }.into()),
    }
}

/// The study in the file at `path`, which may be a file of results, too.
///
/// Fails as [`read_study`] does, or if the results cannot be read.
pub fn read_study_or_results(path: &Path) -> Result<Study, CampaignError> {
    match is_results(path) {
        true => study_of(&store::open(path)?, path),
        false => read_study(path),
    }
}

/// The model of the system in the file at `path`: a text, a study that has one or names one beside it, or results of such a study.
///
/// Fails as [`read_study`] does, and where the file has no system.
pub fn read_system(path: &Path) -> Result<&'static Description, CampaignError> {
    let own = match is_results(path) {
        true => store::open(path)?.frame().texts.get(STUDY_TEXT).cloned().unwrap_or_default(),
        false => text(path, Pipes::Refused)?,
    };
    let name = path.to_string_lossy();
    let model = named_system::model_of(&name, &with_named_system(own, path)?)?;
    check_names(&name, model)?;
    Ok(model)
}

/// Whether a file says a system and nothing else; results do not.
///
/// Fails if the file cannot be read or is no text.
pub fn is_system_alone(path: &Path) -> Result<bool, CampaignError> {
    Ok(named_system::is_alone(&text(path, Pipes::Refused)?))
}

/// A study with the system that it names beside it.
fn with_named_system(own: String, path: &Path) -> Result<String, CampaignError> {
    let Some(file) = named_system::named_file(&own) else { return Ok(own) };
    let system = text(&store::folder(path).join(&file), Pipes::Refused)?;
    Ok(named_system::with_system(&own, &file, &system)?)
}

/// Whether a file is one of results.
fn is_results(path: &Path) -> bool {
    let begins = store::open_input(path, Pipes::Refused).and_then(|(mut file, _)| {
        let mut first = [0; HDF5.len()];
        std::io::Read::read_exact(&mut file, &mut first).map(|()| first == HDF5)
    });
    matches!(begins, Ok(true))
}

/// The text of a study file.
fn text(path: &Path, pipes: Pipes) -> Result<String, CampaignError> {
    let bytes = store::read_input(path, pipes)
        .map_err(|error| CampaignError::of_path(path, format!("cannot be read: {error}")))?;
    if bytes.starts_with(HDF5) {
        let fault = "is a file of results; give the study, a TOML file";
        return Err(CampaignError::of_path(path, fault));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = valid.iter().filter(|&&byte| byte == b'\n').count() + 1;
        CampaignError::of_path(path, format!("line {line}: is not text in UTF-8"))
    })
}

/// The study that the results in `archive`, the file at `path`, came from.
///
/// Fails if the text of the study, which the file holds, has faults for this version of the program.
pub fn study_of(archive: &Archive, path: &Path) -> Result<Study, CampaignError> {
    let text = archive.frame().texts.get(STUDY_TEXT).map_or("", String::as_str);
    Ok(Study::parse(&format!("the study in {}", printable(path)), text)?)
}
