//! Clears away what runs have left that were killed.

use std::path::Path;

use crate::store::{self, BlockFolder, Company};
use crate::study::Study;

use super::error::CampaignError;
use super::report::Reports;
use super::result_file::{block_path, partial_path};

/// Removes what runs have left that were stopped while they wrote the file, or a part of it, and the blocks of `study`
/// that a run has left which was stopped after it had joined them.
pub(super) fn clear_away(
    output: &Path,
    study: &Study,
    reports: &Reports<'_>,
) -> Result<(), CampaignError> {
    let held = store::hold(output, |folder| reports.wait(folder))?;
    store::discard_unfinished(output)?;
    store::discard_unfinished(&partial_path(output))?;
    drop(held);
    let path = block_path(output);
    if !BlockFolder::is_begun(&path) {
        // A run was killed before it removed the empty folder, or a network disk kept files there that others had open.
        let _ = std::fs::remove_dir(&path);
        return Ok(());
    }
    match BlockFolder::enter(&path, study, Company::Alone, false) {
        Ok(joined) => Ok(joined.remove()?),
        // They belong to another run.
        Err(_) => Ok(()),
    }
}
