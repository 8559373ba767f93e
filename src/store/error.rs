//! What can go wrong when a dataset is kept or read back, said so that a person can act on it.

use crate::quantity::printable::printable;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// A dataset that could not be kept or read back.
#[derive(Debug)]
pub enum StoreError {
    /// The dataset breaks a rule of the format; nothing was written.
    Unfit {
        /// The file that was to be written.
        path: PathBuf,
        /// Every rule broken, one sentence each.
        faults: Vec<String>,
    },
    /// The operating system refused.
    System {
        /// The file concerned.
        path: PathBuf,
        /// What was being done.
        doing: &'static str,
        /// What the system said.
        said: io::Error,
    },
    /// The HDF5 library did not take the dataset.
    Encoding {
        /// The file that was to be written.
        path: PathBuf,
        /// What was being done.
        doing: String,
        /// What the library said.
        said: String,
    },
    /// The file is not laid out as this program lays it out, or is damaged.
    Decoding {
        /// The file concerned.
        path: PathBuf,
        /// What was being done.
        doing: String,
        /// What the library, or the reader, said.
        said: String,
    },
    /// The file shows no damage, but is not one of this program.
    Foreign {
        /// The file concerned.
        path: PathBuf,
        /// How that was seen.
        why: String,
    },
    /// The checksum at the end of the file does not fit the file.
    Damaged {
        /// The file concerned.
        path: PathBuf,
    },
    /// The file is not as it was when it was opened and checked.
    ChangedSince {
        /// The file concerned.
        path: PathBuf,
    },
    /// The blocks in a folder are of another study, or another program wrote them.
    Changed {
        /// The folder.
        folder: PathBuf,
        /// What has changed, a line each.
        changes: Vec<String>,
    },
    /// The folder for the blocks holds other things.
    Occupied {
        /// The folder.
        folder: PathBuf,
    },
    /// No blocks are in the folder, or it is not there.
    NoBlocks {
        /// The folder.
        folder: PathBuf,
    },
    /// Another run works on the same study.
    Busy {
        /// The folder of its blocks.
        folder: PathBuf,
    },
    /// What is at a path, or its name, lets no file be written there.
    NoPlace {
        /// The path.
        path: PathBuf,
        /// Why not, and what is expected.
        why: String,
    },
    /// Another process has the file open and adds to it.
    InUse {
        /// The file.
        path: PathBuf,
    },
    /// Another run has written in the same folder for so long that it is not waited for any more.
    Held {
        /// The folder.
        folder: PathBuf,
    },
    /// Another process has computed other numbers of the same block.
    Contradicted {
        /// The file of the block, which stays.
        path: PathBuf,
    },
    /// What was written does not read back as it was; the new file was discarded.
    Unequal {
        /// The file that was to be written.
        path: PathBuf,
        /// The first difference found.
        difference: String,
    },
}

/// Why something that was asked of a file was not found out.
#[derive(Debug)]
pub enum Unread {
    /// The file could not be read.
    Store(StoreError),
    /// What was asked has faults, a sentence each.
    Faults(Vec<String>),
}

impl StoreError {
    /// Makes what the system said a refusal, with the file and the step.
    pub(super) fn system(
        path: &Path,
        doing: &'static str,
    ) -> impl Fn(io::Error) -> StoreError + Copy {
        move |said| StoreError::System { path: path.to_owned(), doing, said }
    }

    /// Makes what HDF5 said a refusal to take something, with the file and the step.
    pub(super) fn encoding(
        path: &Path,
        doing: impl Into<String>,
    ) -> impl FnOnce(hdf5::Error) -> StoreError {
        move |said| StoreError::Encoding {
            path: path.to_owned(),
            doing: doing.into(),
            said: said.to_string(),
        }
    }

    /// Makes what HDF5 said a refusal to give something, with the file and the step.
    pub(super) fn decoding(
        path: &Path,
        doing: impl Into<String>,
    ) -> impl FnOnce(hdf5::Error) -> StoreError {
        move |said| StoreError::Decoding {
            path: path.to_owned(),
            doing: doing.into(),
            said: said.to_string(),
        }
    }

    /// The file or the folder concerned.
    fn place(&self) -> &Path {
        match self {
            StoreError::Unfit { path, .. }
            | StoreError::System { path, .. }
            | StoreError::Encoding { path, .. }
            | StoreError::Decoding { path, .. }
            | StoreError::Foreign { path, .. }
            | StoreError::Damaged { path }
            | StoreError::ChangedSince { path }
            | StoreError::NoPlace { path, .. }
            | StoreError::InUse { path }
            | StoreError::Contradicted { path }
            | StoreError::Unequal { path, .. } => path,
            StoreError::Changed { folder, .. }
            | StoreError::Occupied { folder }
            | StoreError::NoBlocks { folder }
            | StoreError::Busy { folder }
            | StoreError::Held { folder } => folder,
        }
    }

    /// Writes what is wrong.
    fn write_fault(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StoreError::Unfit { faults, .. } => {
                write!(f, "the dataset cannot be stored:")?;
                faults.iter().try_for_each(|fault| write!(f, "\n  {fault}"))
            }
            StoreError::System { doing, said, .. } => write!(f, "{doing}: {said}"),
            StoreError::Encoding { doing, said, .. } | StoreError::Decoding { doing, said, .. } => {
                write!(f, "{doing}: {said}")
            }
            StoreError::Foreign { why, .. } => write!(f, "not a result of capsulemap: {why}"),
            StoreError::Damaged { .. } => f.write_str(
                "the file has changed since it was written, its checksum does not fit",
            ),
            StoreError::ChangedSince { .. } => f.write_str(
                "the file has changed since it was opened and checked, and nothing more is read from it",
            ),
            StoreError::Changed { folder, changes } => write_changes(f, folder, changes),
            StoreError::Occupied { .. } => {
                f.write_str("is where the blocks of this study go, and holds other things")
            }
            StoreError::NoBlocks { .. } => f.write_str("no blocks of this study are there"),
            StoreError::Busy { .. } => f.write_str("another run computes this study now"),
            StoreError::NoPlace { why, .. } => f.write_str(why),
            StoreError::InUse { .. } => f.write_str("another process adds to it now"),
            StoreError::Held { .. } => {
                f.write_str("another run has been writing results there for ten minutes")
            }
            StoreError::Contradicted { .. } => f.write_str(
                "another process has computed other numbers of this block than this one, which must not be",
            ),
            StoreError::Unequal { difference, .. } => {
                write!(f, "what was written does not read back the same: {difference}")
            }
        }
    }

    /// What a person can do; none where the fault says it.
    fn advice(&self) -> Option<&'static str> {
        Some(match self {
            StoreError::Unfit { .. } | StoreError::Changed { .. } | StoreError::NoPlace { .. } => {
                return None;
            }
            StoreError::System { said, .. } => remedy(said.kind()),
            StoreError::Encoding { .. } => {
                "nothing was written: free some memory and run again, and report it if it happens \
                 twice (on a network disk without locks set HDF5_USE_FILE_LOCKING=FALSE)"
            }
            StoreError::Decoding { .. } => {
                "the file may be cut short, damaged or changed by another program: restore a copy \
                 or make it again (on a network disk without locks set \
                 HDF5_USE_FILE_LOCKING=FALSE)"
            }
            StoreError::Foreign { .. } => "give a file that capsulemap wrote",
            StoreError::Damaged { .. } => "restore a copy or make it again",
            StoreError::ChangedSince { .. } => "open it anew when no other program writes to it",
            StoreError::Occupied { .. } => "move them, or choose another place",
            StoreError::NoBlocks { .. } => "compute them first",
            StoreError::Busy { .. } | StoreError::InUse { .. } => {
                "wait for it, or stop it and run again (what it has finished is kept)"
            }
            StoreError::Held { .. } => "run again when it is done (what is finished is kept)",
            StoreError::Contradicted { .. } => {
                "one of the machines computes wrongly: run `capsulemap verify` with a file of results on each"
            }
            StoreError::Unequal { .. } => {
                "the new file was discarded and an older one kept: check the disk and run again"
            }
        })
    }
}

impl fmt::Display for StoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", printable(self.place()))?;
        self.write_fault(f)?;
        self.advice().map_or(Ok(()), |advice| write!(f, "; {advice}"))
    }
}

impl std::error::Error for StoreError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            StoreError::System { said, .. } => Some(said),
            _ => None,
        }
    }
}

/// Writes what has changed since the blocks in a folder were begun, and what a person can do.
fn write_changes(f: &mut fmt::Formatter<'_>, folder: &Path, changes: &[String]) -> fmt::Result {
    write!(f, "holds blocks of another run: ")?;
    changes.iter().try_for_each(|change| writeln!(f, "{change}"))?;
    write!(
        f,
        "they are kept, and not mixed with others: go back to the study and program that they \
         belong to (the study is in {}), choose another place, or delete them",
        printable(&folder.join("begun.toml"))
    )
}

/// What a person can do about a refusal of the system.
fn remedy(kind: io::ErrorKind) -> &'static str {
    match kind {
        io::ErrorKind::NotFound => "check the path, and that its folder exists",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a place that you may use, or ask for the right to it"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space and run again; an older file under that name is untouched"
        }
        io::ErrorKind::IsADirectory | io::ErrorKind::DirectoryNotEmpty => {
            "a folder has that name: choose another name"
        }
        // What this program itself finds there.
        io::ErrorKind::Other => "move it elsewhere, or choose another name",
        _ => "check the disk and the path, then run again",
    }
}
