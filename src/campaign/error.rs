//! The errors of a campaign, and whether the request or the machine is the cause.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::count::{counted, ranges};
use crate::quantity::printable::printable;
use crate::run::RunError;
use crate::store::{StoreError, Unusable};
use crate::study::Faults;

/// A campaign that did not come to its results. Its blocks are kept, whatever the cause.
#[derive(Debug)]
pub enum CampaignError {
    /// A path was given that cannot be what it was given for.
    Path {
        /// The path.
        path: PathBuf,
        /// Why it cannot, and what is expected.
        fault: String,
    },
    /// The study has faults.
    Study(Faults),
    /// The study asks for no branches, no ramps and no boundaries.
    NoBranches,
    /// The study asks for the boundaries of its map, whose cases are not there.
    NoMap,
    /// The study has no case of this number.
    NoCase {
        /// The number.
        index: usize,
        /// Cases of the study, counted from 0.
        cases: usize,
    },
    /// A file that was given as one of results is none.
    NoResults(StoreError),
    /// A file is in the place of the results and cannot be read.
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: StoreError,
    },
    /// A file is in the place of the results and holds those of something else.
    OtherResults {
        /// The file.
        path: PathBuf,
        /// Whether this version of the program wrote it.
        same_program: bool,
    },
    /// The file holds branches or ramps of a study with another text, which would be lost.
    OtherBranches {
        /// The file.
        path: PathBuf,
    },
    /// The file in the place of the kept searches is none of this program.
    NoSearches {
        /// The file.
        path: PathBuf,
    },
    /// The file of kept searches is of another study, other results or another program.
    OtherSearches {
        /// The file.
        path: PathBuf,
        /// What it is.
        what: &'static str,
    },
    /// What was asked of a trade-off has faults.
    TradeOff {
        /// The file of results.
        path: PathBuf,
        /// Every fault, a sentence each.
        faults: Vec<String>,
    },
    /// A file is where a folder is needed.
    NoFolder {
        /// The folder.
        folder: PathBuf,
        /// The file.
        file: PathBuf,
    },
    /// The system refuses to write at the path of the results.
    Refused {
        /// The folder of the results.
        folder: PathBuf,
        /// What it refused.
        refused: &'static str,
        /// What it said.
        said: io::Error,
    },
    /// Blocks are missing that are to be joined.
    Missing {
        /// Their folder.
        folder: PathBuf,
        /// Each by its number and file, and why it cannot be used.
        blocks: Vec<(usize, PathBuf, Unusable)>,
    },
    /// A block is there and cannot be read.
    Block {
        /// Its file.
        file: PathBuf,
        /// Why not.
        why: Unusable,
    },
    /// A block that was computed could not be kept.
    NotKept {
        /// Why not.
        error: StoreError,
        /// Blocks that are done, and all, of the task.
        blocks: [usize; 2],
        /// Their folder.
        folder: PathBuf,
    },
    /// What is on the disk could not be used.
    Store(StoreError),
    /// The computation could not be started.
    Run(RunError),
    /// Records could not be packed to find their size.
    Packing(io::Error),
    /// The listener asked to stop.
    Stopped,
}

/// What an error comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// A mistake in what was asked.
    Request,
    /// A fault of the machine: its disk, its memory, its processor.
    Machine,
    /// The listener asked to stop.
    Listener,
}

impl CampaignError {
    /// A path that cannot be what it was given for.
    pub(super) fn of_path(path: &Path, fault: impl Into<String>) -> CampaignError {
        CampaignError::Path { path: path.to_owned(), fault: fault.into() }
    }

    /// What it comes from.
    pub fn cause(&self) -> Cause {
        use StoreError::{Busy, Changed, Held, InUse, NoBlocks, NoPlace, Occupied};
        match self {
            CampaignError::Path { .. }
            | CampaignError::Study(_)
            | CampaignError::NoBranches
            | CampaignError::NoMap
            | CampaignError::NoCase { .. }
            | CampaignError::NoResults(_)
            | CampaignError::Unreadable { .. }
            | CampaignError::OtherResults { .. }
            | CampaignError::OtherBranches { .. }
            | CampaignError::OtherSearches { .. }
            | CampaignError::NoSearches { .. }
            | CampaignError::TradeOff { .. }
            | CampaignError::NoFolder { .. }
            | CampaignError::Missing { .. }
            | CampaignError::Store(
                Busy { .. }
                | Changed { .. }
                | Held { .. }
                | InUse { .. }
                | NoBlocks { .. }
                | NoPlace { .. }
                | Occupied { .. },
            ) => Cause::Request,
            CampaignError::Refused { .. }
            | CampaignError::Block { .. }
            | CampaignError::NotKept { .. }
            | CampaignError::Store(_)
            | CampaignError::Run(_)
            | CampaignError::Packing(_) => Cause::Machine,
            CampaignError::Stopped => Cause::Listener,
        }
    }
}

impl fmt::Display for CampaignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CampaignError::Path { path, fault } => write!(f, "{}: {fault}", printable(path)),
            CampaignError::Study(faults) => faults.fmt(f),
            CampaignError::NoBranches => {
                f.write_str("the study asks for no [[branches]], no [[ramps]] and no boundaries of a [map]")
            }
            CampaignError::NoMap => f.write_str(
                "the boundaries of the map are those of its cases, which are not there; `capsulemap sweep` computes them",
            ),
            CampaignError::NoCase { index, cases } => {
                let cases = counted(*cases, "case");
                write!(f, "there is no case {index}: the study has {cases}, counted from 0")
            }
            CampaignError::NoResults(error) | CampaignError::Store(error) => error.fmt(f),
            CampaignError::Unreadable { path, error } => {
                write!(f, "{error}\n{} is kept", printable(path))
            }
            CampaignError::OtherResults { path, same_program } => {
                let other = if *same_program { "study" } else { "version of the program or study" };
                write!(f, "{}: holds results of another {other}", printable(path))
            }
            CampaignError::OtherBranches { path } => {
                write!(
                    f,
                    "{}: holds branches or ramps of a study with another text",
                    printable(path)
                )
            }
            CampaignError::NoSearches { path } => {
                let path = printable(path);
                write!(
                    f,
                    "{path}: holds something else than searches of this program, whose place it is"
                )
            }
            CampaignError::OtherSearches { path, what } => {
                write!(
                    f,
                    "{}: holds {what}, not searches of these results by this program",
                    printable(path)
                )
            }
            CampaignError::TradeOff { path, faults } => {
                let faults: Vec<String> =
                    faults.iter().map(|fault| format!("{}: {fault}", printable(path))).collect();
                f.write_str(&faults.join("\n"))
            }
            CampaignError::NoFolder { folder, file } => {
                let (folder, file) = (printable(folder), printable(file));
                write!(f, "{folder}: {file} is a file, not a folder")
            }
            CampaignError::Refused { folder, refused, said } => {
                write!(f, "{}: {refused}: {said}", printable(folder))
            }
            CampaignError::Missing { folder, blocks } => {
                write_missing(f, &printable(folder).to_string(), blocks)
            }
            CampaignError::Block { file, why } => {
                let advice = "make it readable or remove it, and run again";
                write!(f, "{}: {why}; {advice}", printable(file))
            }
            CampaignError::NotKept { error, .. } => error.fmt(f),
            CampaignError::Run(error) => error.fmt(f),
            CampaignError::Packing(said) => said.fmt(f),
            CampaignError::Stopped => f.write_str("stopped as asked; what is done is kept"),
        }
    }
}

/// Which blocks are missing, by number, and why those that are there cannot be used.
fn write_missing(
    f: &mut fmt::Formatter<'_>,
    folder: &str,
    blocks: &[(usize, PathBuf, Unusable)],
) -> fmt::Result {
    let numbers = ranges(blocks.iter().map(|(number, ..)| *number));
    write!(f, "{folder}: {} missing: {numbers}", counted(blocks.len(), "block"))?;
    for (_, file, why) in blocks.iter().filter(|(.., why)| !matches!(why, Unusable::Missing)) {
        write!(f, "\n{}: {why}", printable(file))?;
    }
    Ok(())
}

impl std::error::Error for CampaignError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            CampaignError::Study(faults) => Some(faults),
            CampaignError::NoResults(error)
            | CampaignError::Unreadable { error, .. }
            | CampaignError::NotKept { error, .. }
            | CampaignError::Store(error) => Some(error),
            CampaignError::Refused { said, .. } | CampaignError::Packing(said) => Some(said),
            CampaignError::Run(error) => Some(error),
            _ => None,
        }
    }
}

impl From<StoreError> for CampaignError {
    fn from(error: StoreError) -> Self {
        CampaignError::Store(error)
    }
}

impl From<RunError> for CampaignError {
    fn from(error: RunError) -> Self {
        CampaignError::Run(error)
    }
}

impl From<Faults> for CampaignError {
    fn from(faults: Faults) -> Self {
        CampaignError::Study(faults)
    }
}
