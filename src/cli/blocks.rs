//! Computes the blocks of a study that are not there yet, each kept on disk as soon as it is done.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use super::block_progress::BlockProgress;
use super::stop::say_when_stopped;
use super::task::Task;
use super::words::count;
use super::{Failure, tell};
use crate::run::{Machine, run_blocks};
use crate::store::{BlockFolder, Blocks, Company, Unusable};
use crate::study::{Study, spread};

/// The folder of the blocks that will be joined to the file `output`.
pub fn block_path(output: &Path) -> PathBuf {
    output.with_extension("blocks")
}

/// What a run has added.
pub struct Added {
    /// Cases that were computed now.
    pub cases: usize,
    /// The time they took.
    pub time: Duration,
}

/// Enters the folder of the blocks of `study`.
pub fn enter(
    output: &Path,
    study: &Study,
    company: Company,
    replace: bool,
) -> Result<BlockFolder, Failure> {
    use crate::store::StoreError::{Busy, Changed, Occupied};
    BlockFolder::enter(&block_path(output), study, company, replace).map_err(|error| match error {
        Busy { .. } | Changed { .. } | Occupied { .. } => Failure::request(error),
        _ => Failure::machine(error),
    })
}

/// Removes the blocks of `study` that a run has left which was stopped after it had joined them.
pub fn clear_away(output: &Path, study: &Study) -> Result<(), Failure> {
    if !BlockFolder::is_begun(&block_path(output)) {
        return Ok(());
    }
    match BlockFolder::enter(&block_path(output), study, Company::Alone, false) {
        Ok(joined) => joined.remove().map_err(Failure::machine),
        // They are somebody else's.
        Err(_) => Ok(()),
    }
}

/// Computes the blocks of a task that are missing in `folder`.
pub fn compute(
    study: &Study,
    machine: Machine,
    folder: &BlockFolder,
    task: Task,
) -> Result<Added, Failure> {
    let part = task.part(spread(study.blocks()));
    let cases = |blocks: &[usize]| blocks.iter().map(|&it| study.cases_of_block(it)).sum();
    let total = [part.len(), cases(&part)];
    let found = Blocks::open(folder, study, part.iter().copied());
    let kept = found.summaries();
    let left: Vec<usize> = found.missing.iter().map(|(number, _)| *number).collect();
    survey(folder, &found, total[0])?;
    if left.is_empty() {
        return Ok(Added { cases: 0, time: Duration::ZERO });
    }
    let progress = Arc::new(BlockProgress::new(total, &kept));
    let (watched, place) = (Arc::clone(&progress), folder.path().display().to_string());
    let word = move || {
        let (done, all) = (count(watched.blocks_done()), count(total[0]));
        format!(
            "{done} of {all} blocks are done and kept in {place}; the same command goes on from there"
        )
    };
    say_when_stopped(word.clone())?;
    let trouble = Mutex::new(None);
    let each = |block: usize, record: &_| {
        progress.case(block, study.cases_of_block(block), record);
        ControlFlow::Continue(())
    };
    run_blocks(study, machine, &left, each, |block, records| {
        match folder.keep(study, block, &records) {
            Ok(summary) => {
                progress.block(&summary);
                ControlFlow::Continue(())
            }
            Err(error) => {
                trouble.lock().unwrap_or_else(|it| it.into_inner()).get_or_insert(error);
                ControlFlow::Break(())
            }
        }
    })
    .map_err(Failure::machine)?;
    let time = progress.finish();
    match trouble.into_inner().unwrap_or_else(|it| it.into_inner()) {
        Some(error) => Err(Failure::machine(format!("{error}\ncapsulemap: {}", word()))),
        None => Ok(Added { cases: cases(&left), time }),
    }
}

/// Tells which blocks are there, and which of them cannot be trusted.
fn survey(folder: &BlockFolder, found: &Blocks<'_>, all: usize) -> Result<(), Failure> {
    for (number, why) in &found.missing {
        let shown = folder.file(*number).display().to_string();
        match why {
            Unusable::Missing => {}
            Unusable::Torn | Unusable::Foreign(_) => {
                tell(&format!("{shown}: {why}; it is computed again"));
            }
            Unusable::Refused(_) => {
                let advice = "make it readable or remove it, and run again";
                return Err(Failure::machine(format!("{shown}: {why}; {advice}")));
            }
        }
    }
    let kept = all - found.missing.len();
    if kept > 0 {
        let shown = folder.path().display();
        tell(&format!("{shown}: {} of {} blocks are done and kept", count(kept), count(all)));
    }
    Ok(())
}
