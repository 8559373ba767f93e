//! Blocks: a study cut into pieces that are computed, kept and done again each as a whole.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Mutex;

use super::run::{Machine, Record, RunError, run_chains};
use super::study::Study;

/// A block has this many cases, or those of one group of chains if they are more.
const CASES: usize = 512;

impl Study {
    /// Number of blocks. How a study is cut depends on the study alone, never on the machine, so that every
    /// machine and every later run means the same by a block's number.
    pub fn blocks(&self) -> usize {
        self.chains().div_ceil(self.chains_per_block())
    }

    /// The chains of block `number`.
    pub fn block(&self, number: usize) -> Range<usize> {
        let size = self.chains_per_block();
        number * size..((number + 1) * size).min(self.chains())
    }

    /// The cases of block `number`, in the order of their indices.
    pub fn block_cases(&self, number: usize) -> Vec<usize> {
        let mut cases: Vec<usize> =
            self.block(number).flat_map(|chain| self.chain(chain)).collect();
        cases.sort_unstable();
        cases
    }

    /// Chains of every block but the last, which may have fewer.
    fn chains_per_block(&self) -> usize {
        self.chains_of_group() * (CASES / self.cases_of_group()).max(1)
    }
}

/// Runs the `blocks` of a study, each named once, on `machine`, and hands the records of each, in the order
/// of their indices, to `finished` when the last of them is done; from any thread, and in any order.
///
/// Threads go on to the next block before the last cases of one are done, so that their lanes stay full: as
/// many blocks are unfinished at a time as hold slow cases, and a few more.
pub fn run_blocks(
    study: &Study,
    machine: Machine,
    blocks: &[usize],
    finished: impl Fn(usize, Vec<Record>) + Sync,
) -> Result<(), RunError> {
    let mut ends = Vec::with_capacity(blocks.len());
    for &block in blocks {
        ends.push(ends.last().unwrap_or(&0) + study.block(block).len());
    }
    let chains = |place: usize| {
        let at = ends.partition_point(|end| *end <= place);
        (blocks[at], study.block(blocks[at]).end - (ends[at] - place))
    };
    let unfinished: Mutex<BTreeMap<usize, Vec<Record>>> = Mutex::default();
    let keep = |block: usize, record: Record| {
        if let Some(mut records) = whole(study, &unfinished, block, record) {
            records.sort_by_key(|record| record.index);
            finished(block, records);
        }
    };
    run_chains(study, machine, (ends.last().copied().unwrap_or(0), &chains), keep)
}

/// All records of a block, if this was the last that it lacked.
fn whole(
    study: &Study,
    unfinished: &Mutex<BTreeMap<usize, Vec<Record>>>,
    block: usize,
    record: Record,
) -> Option<Vec<Record>> {
    let groups = study.block(block).len() / study.chains_of_group();
    let mut unfinished = unfinished.lock().expect("no thread has panicked");
    let records = unfinished.entry(block).or_default();
    records.push(record);
    if records.len() < groups * study.cases_of_group() {
        return None;
    }
    unfinished.remove(&block)
}
