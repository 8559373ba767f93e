//! What a campaign is asked: a study, the file of its results, and what to compute on; and what comes of it.

use std::path::{Path, PathBuf};
use std::time::Duration;

use super::beside::Beside;
use crate::run::Machine;
use crate::store::Archive;
use crate::study::Study;

use super::error::CampaignError;
use super::kept::{Kept, kept};

/// A study whose results go to one file.
#[derive(Debug, Clone, Copy)]
pub struct Campaign<'a> {
    /// What to compute.
    pub study: &'a Study,
    /// The file of the results; their blocks lie beside it until they are joined.
    pub output: &'a Path,
    /// What to compute on; the results do not depend on it.
    pub machine: Machine,
    /// Whether a file of another study under that name is replaced, and its blocks given up.
    pub overwrite: bool,
}

/// A file of results that is complete.
#[derive(Debug)]
pub struct Complete {
    /// Where it is.
    pub path: PathBuf,
    /// The file, open.
    pub archive: Archive,
}

/// What a run has come to.
#[derive(Debug)]
pub enum Done {
    /// All cases are in the file, whether it was there before or has been joined now.
    Complete(Complete),
    /// All cases are in the file, and another process has joined them there meanwhile.
    Elsewhere(Complete),
    /// The blocks of one of several tasks are in this folder.
    Shared(PathBuf),
}

/// What came of the branches and ramps of a study.
#[derive(Debug)]
pub enum BranchesDone {
    /// They were in the file already.
    Before(Complete),
    /// They have been continued and put into the file.
    Now {
        /// What came of them.
        found: Beside,
        /// The time that this took.
        time: Duration,
    },
}

impl<'a> Campaign<'a> {
    /// The campaign of `study` with its results in the file `output`, on all cores, which replaces no file of
    /// another study.
    pub fn new(study: &'a Study, output: &'a Path) -> Self {
        Campaign { study, output, machine: Machine::default(), overwrite: false }
    }

    /// The file in the place of the output, if it holds results of this study by this program.
    ///
    /// Fails if another file is there and is not to be overwritten.
    pub fn kept(&self) -> Result<Option<Kept>, CampaignError> {
        kept(self.output, self.study, self.overwrite)
    }
}
