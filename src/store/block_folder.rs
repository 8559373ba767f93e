//! The folder in which the finished blocks of a study are kept until they are joined.
//!
//! Beside the blocks lie `study.toml`, the study as it was when the first was begun, `begun.json`, which
//! tells it and the program from others, and `lock`, which whoever works there holds.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::orbit::Outcome;
use crate::sweep::{Record, Study};

use super::file::{discard_unfinished_in, sync_folder, temporary};
use super::shard::{self, Column, Head, Numbers, Shard, Summary, Unusable};
use super::{StoreError, Values, provenance, schema};

/// What the folder was begun with.
const BEGUN: &str = "begun.json";
/// The study as it was then.
const STUDY: &str = "study.toml";
/// Held by whoever works in the folder.
const LOCK: &str = "lock";
/// Lines that are shown of a change of the study.
const LINES_SHOWN: usize = 6;

/// Where a case started, which may be where its neighbour settled: columns of a block only.
pub(super) const START: [&str; 3] = ["start_r", "start_y1", "start_y2"];
/// Where it ended.
pub(super) const END: [&str; 3] = ["end_r", "end_y1", "end_y2"];
/// How far the section of a periodic orbit is from repeating.
pub(super) const RESIDUAL: &str = "residual";

/// Who else may work in a folder at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Company {
    /// Nobody.
    Alone,
    /// Other tasks of the same study.
    Tasks,
    /// Anybody: the folder is only looked at.
    Anybody,
}

/// A folder of blocks that belong to one study and were made by this program.
#[derive(Debug)]
pub struct BlockFolder {
    path: PathBuf,
    fingerprint: String,
    /// Its lock ends with it.
    _lock: Option<File>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Begun {
    fingerprint: String,
    source: String,
    commit: String,
}

impl BlockFolder {
    /// Opens the folder at `path` for the blocks of `study`, and begins it if it is not there and `company`
    /// is to work in it. Blocks of another study or by another program are refused, or given up if they
    /// are to be `replaced`.
    pub fn enter(
        path: &Path,
        study: &Study,
        company: Company,
        replace: bool,
    ) -> Result<BlockFolder, StoreError> {
        let failed = |doing| move |said| StoreError::system(path, doing, said);
        if company != Company::Anybody {
            fs::create_dir_all(path).map_err(failed("making the folder of the blocks"))?;
        }
        let lock = lock(path, company)?;
        let program = provenance::attributes();
        let [source, commit] = ["source", "commit"].map(|key| program[key].clone());
        let now = Begun { fingerprint: study.fingerprint(), source, commit };
        let folder = BlockFolder {
            path: path.to_owned(),
            fingerprint: now.fingerprint.clone(),
            _lock: lock,
        };
        let changes = folder.changes(&now, study)?;
        match changes {
            Some(changes) if changes.is_empty() => {}
            Some(changes) if !replace => {
                return Err(StoreError::Changed { folder: path.to_owned(), changes });
            }
            None if company == Company::Anybody => {
                let said = io::ErrorKind::NotFound.into();
                return Err(StoreError::system(path, "looking for blocks", said));
            }
            _ => folder.begin(&now, study).map_err(failed("beginning the folder of the blocks"))?,
        }
        if company == Company::Alone {
            discard_unfinished_in(path, "block-")
                .map_err(failed("clearing away unfinished blocks"))?;
        }
        Ok(folder)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether anybody works in the folder at `path`.
    pub fn is_busy(path: &Path) -> bool {
        let lock = File::open(path.join(LOCK));
        lock.is_ok_and(|lock| matches!(lock.try_lock(), Err(TryLockError::WouldBlock)))
    }

    /// What has changed since the folder was begun, in words; none if it was not.
    fn changes(&self, now: &Begun, study: &Study) -> Result<Option<Vec<String>>, StoreError> {
        let path = self.path.join(BEGUN);
        let begun = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(said) => return Err(StoreError::system(&path, "reading", said)),
        };
        let Ok(begun) = serde_json::from_slice::<Begun>(&begun) else {
            return Err(StoreError::Damaged { path });
        };
        let mut changes = Vec::new();
        if (&begun.source, &begun.commit) != (&now.source, &now.commit) {
            changes.push(format!(
                "the blocks were made by {} (commit {}), this is {} (commit {})",
                begun.source, begun.commit, now.source, now.commit
            ));
        }
        if begun.fingerprint != now.fingerprint {
            let older = fs::read_to_string(self.path.join(STUDY)).unwrap_or_default();
            changes.push("the study has changed:".to_owned());
            changes.extend(changed_lines(&older, &study.text));
        }
        Ok(Some(changes))
    }

    /// Gives up all blocks and notes for what the folder is.
    fn begin(&self, now: &Begun, study: &Study) -> io::Result<()> {
        for entry in fs::read_dir(&self.path)? {
            let path = entry?.path();
            if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("block-")) {
                fs::remove_file(path)?;
            }
        }
        self.put(STUDY, study.text.as_bytes())?;
        self.put(BEGUN, &serde_json::to_vec_pretty(now)?)?;
        sync_folder(&self.path)
    }

    fn put(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        let path = self.path.join(name);
        let mut file = temporary(&path, &self.path)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        file.persist(&path)?;
        Ok(())
    }

    /// The file of a block.
    pub fn file(&self, block: usize) -> PathBuf {
        shard::path(&self.path, block)
    }

    /// A block, once every byte of it has been checked.
    pub fn open(&self, block: usize) -> Result<Shard, Unusable> {
        shard::open(&self.path, &self.fingerprint, block)
    }

    /// What a block says of itself, without a look at its numbers.
    pub fn glance(&self, block: usize) -> Result<Head, Unusable> {
        shard::glance(&self.path, &self.fingerprint, block)
    }

    /// Keeps the records of block `number`, whole or not at all; returns what it says of itself, and the
    /// bytes that it takes.
    pub fn keep(
        &self,
        study: &Study,
        number: usize,
        records: &[Record],
    ) -> Result<(Summary, u64), StoreError> {
        let summary = summary(number, records);
        let columns = columns(study, records);
        let bytes = shard::write(&self.path, &self.fingerprint, summary.clone(), &columns)?;
        Ok((summary, bytes))
    }

    /// Removes the folder with all blocks, once they are not needed any more.
    pub fn remove(self) -> Result<(), StoreError> {
        let failed = |said| StoreError::system(&self.path, "removing the joined blocks", said);
        fs::remove_dir_all(&self.path).map_err(failed)
    }
}

/// Bytes that a block of these records takes.
pub fn packed_bytes(study: &Study, records: &[Record]) -> io::Result<usize> {
    let image = shard::image(&study.fingerprint(), summary(0, records), &columns(study, records));
    image.map(|image| image.len())
}

/// Takes the lock of a folder; none where the file system has no locks, as blocks are whole without them.
fn lock(path: &Path, company: Company) -> Result<Option<File>, StoreError> {
    if company == Company::Anybody {
        return Ok(None);
    }
    let file = path.join(LOCK);
    let failed = |said| StoreError::system(&file, "taking the lock", said);
    let lock = File::options().create(true).append(true).open(&file).map_err(failed)?;
    let taken = match company {
        Company::Alone => lock.try_lock(),
        _ => lock.try_lock_shared(),
    };
    match taken {
        Ok(()) => Ok(Some(lock)),
        Err(TryLockError::WouldBlock) => Err(StoreError::Busy { folder: path.to_owned() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

/// A block in a few numbers.
fn summary(number: usize, records: &[Record]) -> Summary {
    let mut outcomes = BTreeMap::new();
    for record in records {
        *outcomes.entry(record.orbit.outcome.name().to_owned()).or_default() += 1;
    }
    let cycles = records.iter().map(|record| record.orbit.cycles).sum();
    Summary { number, cases: records.len(), outcomes, cycles }
}

/// What a block keeps of its cases: their variables, and what is needed to replay them and to find their
/// attractors.
fn columns(study: &Study, records: &[Record]) -> Vec<Column> {
    let variables = schema::columns(study, records).variables.into_iter();
    let mut columns: Vec<Column> = variables
        .map(|(name, variable)| {
            let numbers = match variable.values {
                Values::Real(reals) => Numbers::Real(reals.into_raw_vec_and_offset().0),
                Values::Integer(all) => Numbers::Integer(all.into_raw_vec_and_offset().0),
            };
            Column { name, numbers }
        })
        .collect();
    let mut add = |name: &str, of: fn(&Record) -> f64| {
        let numbers = Numbers::Real(records.iter().map(of).collect());
        columns.push(Column { name: name.to_owned(), numbers });
    };
    add(START[0], |it| it.start.r);
    add(START[1], |it| it.start.y1);
    add(START[2], |it| it.start.y2);
    add(END[0], |it| it.orbit.end.r);
    add(END[1], |it| it.orbit.end.y1);
    add(END[2], |it| it.orbit.end.y2);
    add(RESIDUAL, |it| it.orbit.certificate.residual);
    columns
}

/// The lines that only one of two texts has, those of the older first.
fn changed_lines(older: &str, newer: &str) -> Vec<String> {
    let only = |a: &str, b: &str, mark: &str| -> Vec<String> {
        let others: Vec<&str> = b.lines().map(str::trim).collect();
        let lines = a.lines().map(str::trim).filter(|line| !others.contains(line));
        lines.map(|line| format!("  {mark} {line}")).collect()
    };
    let mut lines = only(older, newer, "-");
    lines.extend(only(newer, older, "+"));
    let more = lines.len().saturating_sub(LINES_SHOWN);
    lines.truncate(LINES_SHOWN);
    lines.extend((more > 0).then(|| format!("  and {more} lines more")));
    lines
}

/// Cases by outcome in the order of the outcomes, those that occur.
pub fn by_outcome(summaries: &[Summary]) -> Vec<(Outcome, usize)> {
    let count = |outcome: Outcome| {
        let of = |it: &Summary| it.outcomes.get(outcome.name()).copied().unwrap_or(0);
        (outcome, summaries.iter().map(of).sum())
    };
    Outcome::ALL.iter().map(|&outcome| count(outcome)).filter(|(_, count)| *count > 0).collect()
}
