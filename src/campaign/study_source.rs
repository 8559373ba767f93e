//! Reads the study of a campaign, from its own file or from the file of its results.

use std::path::Path;

use super::error::CampaignError;
use crate::quantity::printable::printable;
use crate::store::catalogue::STUDY_TEXT;
use crate::store::{self, Archive, Pipes};
use crate::study::{Study, include};

/// The first bytes of an HDF5 file.
const HDF5: &[u8] = b"\x89HDF";

/// The study in the file at `path`.
///
/// A parameter file that it includes is looked for beside it; the text of the study then has its values.
///
/// Fails if a file cannot be read, is no plain file or is no text, and with all faults of the study at once. The study may be a
/// pipe that the shell has opened, a parameter file may not.
pub fn read_study(path: &Path) -> Result<Study, CampaignError> {
    let name = path.to_string_lossy();
    let own = text(path, Pipes::OfShell)?;
    let Some(file) = include::included(&own) else { return Ok(Study::parse(&name, &own)?) };
    let values = text(&store::folder(path).join(&file), Pipes::Refused)?;
    let whole = include::include(&own, &file, &values)
        .map_err(|fault| CampaignError::of_path(path, fault))?;
    Ok(Study::parse(&name, &whole.text).map_err(|faults| whole.as_written(faults))?)
}

/// The study in the file at `path`, which may be a file of results, too.
///
/// Fails as [`read_study`] does, or if the results cannot be read.
pub fn read_study_or_results(path: &Path) -> Result<Study, CampaignError> {
    let begins = store::open_input(path, Pipes::Refused).and_then(|(mut file, _)| {
        let mut first = [0; HDF5.len()];
        std::io::Read::read_exact(&mut file, &mut first).map(|()| first == HDF5)
    });
    match begins {
        Ok(true) => study_of(&store::open(path)?, path),
        _ => read_study(path),
    }
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
