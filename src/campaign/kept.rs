//! An older file at the path of the results, and whether it may be replaced.

use std::path::Path;

use crate::store::catalogue::STUDY_TEXT;
use crate::store::schema::FINGERPRINT;
use crate::store::{self, Archive, Dataset, has_branches, provenance};
use crate::study::Study;

use super::error::CampaignError;

/// A file of results of the cases of a study, by this version of the program.
#[derive(Debug)]
pub struct Kept {
    /// The file.
    pub archive: Archive,
    /// Whether the text of its study is the same; else its cases are, and titles, figures and branches may
    /// differ.
    pub same_text: bool,
}

/// The file `output`, if it holds results of the cases of this study by this version of the program; another
/// file is refused, or ignored where it may be overwritten.
pub(super) fn kept(
    output: &Path,
    study: &Study,
    overwrite: bool,
) -> Result<Option<Kept>, CampaignError> {
    if !output.exists() {
        return Ok(None);
    }
    let path = output.to_owned();
    let archive = match store::open(output) {
        Ok(archive) => archive,
        Err(_) if overwrite => return Ok(None),
        Err(error) => return Err(CampaignError::Unreadable { path, error }),
    };
    let frame = archive.frame();
    let same_program = provenance::is_ours(&frame.attributes);
    let same_text = frame.texts.get(STUDY_TEXT) == Some(&study.text);
    let same_cases = frame.attributes.get(FINGERPRINT) == Some(&study.fingerprint());
    match same_program && (same_text || same_cases) {
        true => Ok(Some(Kept { archive, same_text })),
        false if overwrite => Ok(None),
        false => Err(CampaignError::OtherResults { path, same_program }),
    }
}

/// Refuses a file at `path` whose branches are of a study with another text, unless they may be overwritten.
pub(super) fn check_branches(
    older: Option<&Kept>,
    path: &Path,
    overwrite: bool,
) -> Result<(), CampaignError> {
    match older {
        Some(Kept { archive, same_text: false }) if has_branches(archive.frame()) && !overwrite => {
            Err(CampaignError::OtherBranches { path: path.to_owned() })
        }
        _ => Ok(()),
    }
}

/// The branches that a file of results holds beside which cases are to be put, if they are of this study.
pub(super) fn branches_of(older: Option<&Kept>) -> Result<Option<Dataset>, CampaignError> {
    match older {
        Some(Kept { archive, same_text: true }) => Ok(Some(archive.branches()?)),
        _ => Ok(None),
    }
}
