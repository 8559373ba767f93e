//! The folder in which the finished blocks of a study are kept until they are joined.
//!
//! Beside the blocks lie `begun.toml`, the study of the first run in the folder, `begun.json`, the fingerprint of
//! that study and the program, and `lock`, which every run in the folder holds. Each block file names its study and
//! program; the lock prevents other runs from removing unfinished files.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::block_content::{columns, summary};
use super::block_file::{self, BlockFile, Head, Summary, Unusable, Written};
use super::file::{self, discard_unfinished_in, put};
use super::lock::{Lock, Tried, try_lock};
use super::{StoreError, provenance};
use crate::orbit::Outcome;
use crate::run::Record;
use crate::study::Study;

/// The fingerprint of the study and the program of the first run.
const BEGUN: &str = "begun.json";
/// The study of the first run.
const STUDY: &str = "begun.toml";
/// Held by every run in the folder.
const LOCK: &str = "lock";
/// What the names of claims begin with.
const CLAIM: &str = "claim-";
/// How often a lock is tried that another process holds, perhaps only to test whether it is held.
const TRIES: u32 = 10;
/// Time between two tries.
const PAUSE: Duration = Duration::from_millis(100);
/// What is done when the blocks of a file that is complete are removed.
const REMOVING: &str = "removing the joined blocks";
/// Lines that are shown of a change of the study.
const LINES_SHOWN: usize = 6;

/// Which other runs may use a folder at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Company {
    /// None.
    Alone,
    /// Other tasks of the same study.
    Tasks,
    /// All: the folder is only read.
    Anybody,
}

/// A folder of blocks of one study that this program wrote.
#[derive(Debug)]
pub struct BlockFolder {
    path: PathBuf,
    fingerprint: String,
    /// The lock, which ends with it.
    lock: Option<File>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Begun {
    fingerprint: String,
    /// Program, time and machine.
    #[serde(rename = "made")]
    provenance: BTreeMap<String, String>,
}

impl BlockFolder {
    /// Opens the folder at `path` for the blocks of `study`, and creates it if it is not there and `company`
    /// allows to write in it. Blocks of another study or by another program are refused, or removed with `replace`.
    pub fn enter(
        path: &Path,
        study: &Study,
        company: Company,
        replace: bool,
    ) -> Result<BlockFolder, StoreError> {
        let only_reads = company == Company::Anybody;
        let holds_others = !only_reads
            && holds_others(path).map_err(StoreError::system(path, "looking for blocks"))?;
        // In a folder of others not even a lock is left.
        if holds_others && !Self::is_begun(path) {
            return Err(StoreError::Occupied { folder: path.to_owned() });
        }
        let lock = if only_reads { None } else { lock(path, company)? };
        let now = Begun { fingerprint: study.fingerprint(), provenance: provenance::attributes() };
        let folder =
            BlockFolder { path: path.to_owned(), fingerprint: now.fingerprint.clone(), lock };
        match folder.changes(&now, study)? {
            Some(changes) if changes.is_empty() => {}
            Some(changes) if !replace => {
                return Err(StoreError::Changed { folder: path.to_owned(), changes });
            }
            None if only_reads => {
                // What says that the folder is begun may be lost.
                if !(0..study.blocks()).any(|number| folder.head(number).is_ok()) {
                    return Err(StoreError::NoBlocks { folder: path.to_owned() });
                }
            }
            None if holds_others => {
                return Err(StoreError::Occupied { folder: path.to_owned() });
            }
            _ => folder.begin(&now, study)?,
        }
        if company == Company::Alone {
            discard_unfinished_in(path, |of, _| is_own(of))
                .and_then(|()| discard_claims(path))
                .map_err(StoreError::system(path, "clearing away unfinished blocks"))?;
        }
        Ok(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether blocks have been begun in the folder at `path`, or have been and were not removed to the end.
    pub fn is_begun(path: &Path) -> bool {
        [BEGUN, LOCK].iter().any(|name| path.join(name).is_file())
    }

    /// Whether a run uses the folder at `path`.
    pub fn is_busy(path: &Path) -> bool {
        let lock = File::options().read(true).write(true).open(path.join(LOCK));
        lock.is_ok_and(|lock| matches!(try_lock(&lock, Lock::Exclusive), Ok(Tried::Busy)))
    }

    /// What has changed since the folder was begun, as text; none if it was not.
    fn changes(&self, now: &Begun, study: &Study) -> Result<Option<Vec<String>>, StoreError> {
        let path = self.path.join(BEGUN);
        let begun = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            Err(said) => return Err(StoreError::system(&path, "reading")(said)),
        };
        // If it is lost or cannot be read, the heads of the blocks decide.
        let Ok(begun) = serde_json::from_slice::<Begun>(&begun) else {
            return Ok(self.foreign_blocks(study));
        };
        let mut changes = Vec::new();
        if !provenance::is_ours(&begun.provenance) {
            let [older, now] = [&begun.provenance, &now.provenance].map(provenance::program);
            changes.push(format!("the blocks were made by {older}, this is {now}"));
        }
        if begun.fingerprint != now.fingerprint {
            let older = fs::read_to_string(self.path.join(STUDY)).unwrap_or_default();
            changes.push("the study has changed:".to_owned());
            changes.extend(changed_lines(&older, &study.text));
        }
        Ok(Some(changes))
    }

    /// What tells blocks of another study or program from those of this one; none where there are none.
    fn foreign_blocks(&self, study: &Study) -> Option<Vec<String>> {
        let older = fs::read_to_string(self.path.join(STUDY)).unwrap_or_default();
        (0..study.blocks()).any(|number| self.is_foreign(number)).then(|| {
            let said =
                format!("{BEGUN} is lost, and blocks are there of another study or program:");
            std::iter::once(said).chain(changed_lines(&older, &study.text)).collect()
        })
    }

    fn is_foreign(&self, block: usize) -> bool {
        matches!(self.head(block), Err(Unusable::Foreign(_)))
    }

    /// Writes study and fingerprint, and removes the blocks of other studies.
    fn begin(&self, now: &Begun, study: &Study) -> Result<(), StoreError> {
        let failed = StoreError::system(&self.path, "beginning the folder of the blocks");
        for number in (0..study.blocks()).filter(|number| self.is_foreign(*number)) {
            remove_if_there(&self.file(number)).map_err(failed)?;
        }
        let begun = serde_json::to_vec_pretty(now).map_err(io::Error::from).map_err(failed)?;
        put(&self.path.join(STUDY), study.text.as_bytes())?;
        put(&self.path.join(BEGUN), &begun)
    }

    /// The file of a block.
    pub fn file(&self, block: usize) -> PathBuf {
        block_file::path(&self.path, block)
    }

    /// A block, after a check of its checksum.
    pub fn open(&self, block: usize) -> Result<BlockFile, Unusable> {
        block_file::open(&self.path, &self.fingerprint, block)
    }

    /// The head of a block; its numbers are not read.
    pub fn head(&self, block: usize) -> Result<Head, Unusable> {
        block_file::read_head_of(&self.path, &self.fingerprint, block)
    }

    /// The file of the claim on a block.
    pub fn claim(&self, block: usize) -> PathBuf {
        self.path.join(format!("{CLAIM}{block:07}"))
    }

    /// The file of the claim on the join of all blocks.
    pub fn claim_on_join(&self) -> PathBuf {
        self.path.join(format!("{CLAIM}join"))
    }

    /// Writes the records of block `number`, completely or not at all; a usable block that is there stays. Returns their summary.
    pub fn keep(
        &self,
        study: &Study,
        number: usize,
        records: &[Record],
    ) -> Result<(Summary, Written), StoreError> {
        let summary = summary(study, number, records);
        let columns = columns(study, records);
        let written = block_file::write(&self.path, &self.fingerprint, summary.clone(), &columns)?;
        Ok((summary, written))
    }

    /// Copies a block from another folder, completely or not at all.
    pub fn copy(&self, other: &BlockFolder, number: usize) -> Result<(), StoreError> {
        let file = other.file(number);
        let bytes = fs::read(&file).map_err(StoreError::system(&file, "reading"))?;
        put(&self.file(number), &bytes)
    }

    /// Removes all blocks, and the folder with them unless it holds other files or is linked to from its place.
    ///
    /// What says that the folder is one of blocks goes last, so that a later run finds what is left and removes it.
    pub fn remove(mut self) -> Result<(), StoreError> {
        let entries = fs::read_dir(&self.path).map_err(StoreError::system(&self.path, REMOVING))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if is_own(&name) && ![LOCK, BEGUN].contains(&&*name) {
                remove_joined(&path)?;
            }
        }
        remove_joined(&self.path.join(BEGUN))?;
        // A network disk does not remove a file that is open.
        drop(self.lock.take());
        remove_joined(&self.path.join(LOCK))?;
        if self.path.is_symlink() {
            return Ok(());
        }
        match fs::remove_dir(&self.path) {
            Err(said) if said.kind() != io::ErrorKind::DirectoryNotEmpty => {
                Err(StoreError::system(&self.path, REMOVING)(said))
            }
            _ => Ok(()),
        }
    }
}

/// Removes the claims of processes that were killed; to be called by who is alone in the folder.
fn discard_claims(path: &Path) -> io::Result<()> {
    for entry in fs::read_dir(path)? {
        let entry = entry?;
        if is_claim(&entry.file_name().to_string_lossy()) {
            remove_if_there(&entry.path())?;
        }
    }
    Ok(())
}

/// Whether anything is in a folder that is not of this program.
fn holds_others(path: &Path) -> io::Result<bool> {
    let entries = match fs::read_dir(path) {
        Err(said) if said.kind() == io::ErrorKind::NotFound => return Ok(false),
        entries => entries?,
    };
    let mut others = false;
    for entry in entries {
        others |= !is_own(&entry?.file_name().to_string_lossy());
    }
    Ok(others)
}

/// Whether a file in a folder of blocks, by its name, is one of this program, finished or not.
fn is_own(name: &str) -> bool {
    is_finished(name) || file::unfinished(name).is_some_and(is_finished)
}

fn is_finished(name: &str) -> bool {
    [BEGUN, STUDY, LOCK].contains(&name) || block_file::is_block(name) || is_claim(name)
}

/// Whether a file of this name is a claim on a block or on the join.
fn is_claim(name: &str) -> bool {
    let of = name.strip_prefix(CLAIM);
    of.is_some_and(|of| of == "join" || block_file::is_block(&format!("block-{of}")))
}

fn remove_joined(path: &Path) -> Result<(), StoreError> {
    remove_if_there(path).map_err(StoreError::system(path, REMOVING))
}

/// Removes a file; another task may have done so already.
fn remove_if_there(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(said) if said.kind() == io::ErrorKind::NotFound => Ok(()),
        done => done,
    }
}

/// Takes the lock of a folder, which is created if need be; none where the file system has no locks, as blocks
/// are written completely or not at all without them too.
fn lock(path: &Path, company: Company) -> Result<Option<File>, StoreError> {
    let file = path.join(LOCK);
    let failed = StoreError::system(&file, "taking the lock");
    for tried in 1.. {
        fs::create_dir_all(path)
            .map_err(StoreError::system(path, "making the folder of the blocks"))?;
        // On network disks a lock needs a file open for writing, and a shared lock one open for reading.
        let mut options = File::options();
        let opened = options.create(true).read(true).write(true).truncate(false).open(&file);
        let lock = match opened {
            Err(said) if said.kind() == io::ErrorKind::NotFound && tried < TRIES => continue,
            opened => opened.map_err(failed)?,
        };
        let kind = match company {
            Company::Alone => Lock::Exclusive,
            _ => Lock::Shared,
        };
        match try_lock(&lock, kind).map_err(failed)? {
            // The run that held it before may have removed the folder with the file that is locked now.
            Tried::Taken if file.exists() => return Ok(Some(lock)),
            Tried::Taken => {}
            Tried::Busy if tried == TRIES => break,
            Tried::Busy => sleep(PAUSE),
            Tried::Without => return Ok(None),
        }
    }
    Err(StoreError::Busy { folder: path.to_owned() })
}

/// The lines that only one of two texts has, those of the older first.
fn changed_lines(older: &str, newer: &str) -> Vec<String> {
    let mut lines = lines_without(newer, older, "-");
    lines.extend(lines_without(older, newer, "+"));
    let more = lines.len().saturating_sub(LINES_SHOWN);
    lines.truncate(LINES_SHOWN);
    lines.extend((more > 0).then(|| format!("  and {more} lines more")));
    if lines.is_empty() {
        lines.push("  lines have changed places".to_owned());
    }
    lines
}

/// The lines of a text that another lacks, each behind a mark.
fn lines_without(other: &str, text: &str, mark: &str) -> Vec<String> {
    let others: Vec<&str> = other.lines().map(str::trim).collect();
    let lines = text.lines().map(str::trim).filter(|line| !others.contains(line));
    lines.map(|line| format!("  {mark} {line}")).collect()
}

/// Cases by outcome in the order of the outcomes, those that occur.
pub fn by_outcome(summaries: &[Summary]) -> Vec<(Outcome, usize)> {
    let mut occurring = Vec::new();
    for outcome in Outcome::ALL {
        let count = summaries.iter().filter_map(|it| it.outcomes.get(outcome.name())).sum();
        if count > 0 {
            occurring.push((outcome, count));
        }
    }
    occurring
}
