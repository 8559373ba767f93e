//! Runs the blocks of a study, and hands over each as a whole.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Mutex, OnceLock};

use super::cases::{Chains, Choice, Record, RunError, run_chains};
use super::refined::run_tiles;
use crate::orbit::Machine;
use crate::study::Study;

/// Runs those `blocks` of a study, each named once, on `machine` that are `chosen`. Tells `done` of each record with the number of its block, and
/// hands the records of a block, in the order of their indices, to `finished` when the last of them is done; from any thread,
/// in any order, and until one of the two says to stop. Of a refined study a block is a tile, and has the records of the cases
/// that had to be computed.
///
/// Threads go on to the next block before the last cases of one are done, so that their lanes stay full: as
/// many blocks are unfinished at a time as hold slow cases, and a few more.
pub fn run_blocks(
    study: &Study,
    machine: Machine,
    blocks: &[usize],
    chosen: Choice<'_>,
    done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
    finished: impl Fn(usize, Vec<Record>) -> ControlFlow<()> + Sync,
) -> Result<(), RunError> {
    if let Some(refinement) = study.refinement() {
        return run_tiles(study, machine, &refinement, blocks, chosen, done, finished);
    }
    let mut ends = Vec::with_capacity(blocks.len());
    for &block in blocks {
        ends.push(ends.last().unwrap_or(&0) + study.block(block).len());
    }
    let answers: Vec<OnceLock<bool>> = blocks.iter().map(|_| OnceLock::new()).collect();
    let at = &|place: usize| {
        let at = ends.partition_point(|end| *end <= place);
        // Threads that want other cases of the block wait for the answer.
        let is_chosen = *answers[at].get_or_init(|| chosen.is_none_or(|choose| choose(blocks[at])));
        is_chosen.then(|| (blocks[at], study.block(blocks[at]).end - (ends[at] - place)))
    };
    let unfinished: Mutex<BTreeMap<usize, Vec<Record>>> = Mutex::default();
    let count = ends.last().copied().unwrap_or(0);
    run_chains(study, machine, Chains { count, at }, |block, record| {
        done(block, &record)?;
        let Some(mut records) = whole(study, &unfinished, block, record) else {
            return ControlFlow::Continue(());
        };
        records.sort_by_key(|record| record.index);
        finished(block, records)
    })
}

/// All records of a block, if this was the last that it lacked.
fn whole(
    study: &Study,
    unfinished: &Mutex<BTreeMap<usize, Vec<Record>>>,
    block: usize,
    record: Record,
) -> Option<Vec<Record>> {
    let mut unfinished = unfinished.lock().expect("no thread has panicked");
    let records = unfinished.entry(block).or_default();
    records.push(record);
    if records.len() < study.cases_of_block(block) {
        return None;
    }
    unfinished.remove(&block)
}
