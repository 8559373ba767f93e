//! The parallel run: chains of cases over all cores, in any order, to the same records.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::capsule::{State, Switching};
use crate::lane::Instructions;
use crate::orbit::{Case, Orbit, Outcome, Queue, Underway, settle_case, settle_side_by_side};

use crate::study::Study;
use crate::study::grid::Chain;

/// What came of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Index of the case in its study.
    pub index: usize,
    /// Where it started: as the study says, or where its neighbour settled.
    pub start: State<f64>,
    /// Phase of the drive there [rad].
    pub start_phase: f64,
    /// What it settled to.
    pub orbit: Orbit,
}

/// What a study is run on; its records do not depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Machine {
    /// Number of threads; all cores for none.
    pub threads: Option<usize>,
    /// By which each thread moves its cases; those that suit their number for none.
    pub instructions: Option<Instructions>,
}

/// Runs every case of `study` on `machine` and hands each record to `keep`, which is called from any
/// thread and in any order.
pub fn run(study: &Study, machine: Machine, keep: impl Fn(Record) + Sync) -> Result<(), RunError> {
    let keep = |_, record| {
        keep(record);
        ControlFlow::Continue(())
    };
    run_chains(study, machine, (study.chains(), &|place| (0, place)), keep)
}

/// Runs some chains of `study`, each named once, on `machine`; calls `done` after each case, and returns the
/// records in the order of their indices.
pub fn run_sample(
    study: &Study,
    machine: Machine,
    chains: &[usize],
    done: impl Fn() + Sync,
) -> Result<Vec<Record>, RunError> {
    let records = Mutex::new(Vec::new());
    let keep = |_, record| {
        done();
        records.lock().expect("no thread has panicked").push(record);
        ControlFlow::Continue(())
    };
    run_chains(study, machine, (chains.len(), &|place| (0, chains[place])), keep)?;
    let mut records = records.into_inner().expect("no thread has panicked");
    records.sort_by_key(|record: &Record| record.index);
    Ok(records)
}

/// Runs so many chains of `study` on `machine`, each given by its place as the number of its block and its
/// own, and hands each record to `keep` with the number of the block, until that says to stop.
///
/// Every thread fills its lanes from one queue of chains until it is empty; the last cases, too few to fill
/// a vector, are followed one by one, by whichever thread is done with its lanes. A case depends on its own
/// parameters and start, or on its predecessor in its chain, alone.
pub(super) fn run_chains(
    study: &Study,
    machine: Machine,
    (count, chains): (usize, Chains<'_>),
    keep: impl Fn(usize, Record) -> ControlFlow<()> + Sync,
) -> Result<(), RunError> {
    if let Some(missing) = machine.instructions.filter(|it| !it.is_available()) {
        return Err(RunError(format!("the processor has no {}", missing.name())));
    }
    let pool = pool(machine.threads)?;
    let (taken, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let last_cases = Mutex::new(Vec::new());
    let share = count.div_ceil(pool.current_num_threads());
    let instructions = machine.instructions.unwrap_or_else(|| Instructions::suited_to(share));
    pool.broadcast(|_| {
        let links = BTreeMap::new();
        let queue = (count, chains);
        let mut worker =
            Worker { study, queue, taken: &taken, stopped: &stopped, share, keep: &keep, links };
        match study.base.switching {
            Switching::AsPrinted => worker.settle_one_by_one(),
            Switching::Filippov => {
                let last = settle_side_by_side(instructions, &study.protocol, &mut worker);
                let lock = || last_cases.lock().expect("no thread has panicked");
                lock().extend(last.into_iter().map(|case| worker.part_with(case)));
                loop {
                    // In a statement of its own, so that the lock is free again.
                    let case = lock().pop();
                    let Some((link, case)) = case else { break };
                    if stopped.load(Ordering::Relaxed) {
                        break;
                    }
                    worker.finish_chain(link, case);
                }
            }
        }
    });
    Ok(())
}

/// So many worker threads; one per core for none.
pub(super) fn pool(threads: Option<usize>) -> Result<rayon::ThreadPool, RunError> {
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = threads {
        builder = builder.num_threads(threads);
    }
    let failed = |error| RunError(format!("the worker threads could not be started: {error}"));
    builder.build().map_err(failed)
}

/// The block and the number of the chain at each place of the queue.
pub(super) type Chains<'a> = &'a (dyn Fn(usize) -> (usize, usize) + Sync);

/// A case of a chain: its index and start, and those that follow it.
struct Link {
    block: usize,
    index: usize,
    start: State<f64>,
    start_phase: f64,
    rest: Chain,
}

/// A thread with its part of the queue.
struct Worker<'a, K> {
    study: &'a Study,
    /// The length of the queue and what is in it.
    queue: (usize, Chains<'a>),
    /// Chains that have been taken by any thread.
    taken: &'a AtomicUsize,
    /// Whether nothing more is to be begun.
    stopped: &'a AtomicBool,
    /// Chains that this thread may still begin with, so that a few are not all in the lanes of one.
    share: usize,
    keep: &'a K,
    /// The cases that are under way in its lanes, by their index.
    links: BTreeMap<usize, Link>,
}

impl<K: Fn(usize, Record) -> ControlFlow<()>> Queue for Worker<'_, K> {
    fn next(&mut self, done: Option<(usize, Orbit)>) -> Option<(usize, Case)> {
        let next = match done {
            Some((index, orbit)) => {
                let link = self.links.remove(&index).expect("the case was under way");
                self.follow(link, orbit).or_else(|| self.take())
            }
            None => {
                self.share = self.share.checked_sub(1)?;
                self.take()
            }
        };
        let (link, case) = next?;
        let index = link.index;
        self.links.insert(index, link);
        Some((index, case))
    }
}

impl<K: Fn(usize, Record) -> ControlFlow<()>> Worker<'_, K> {
    /// The first case of the next chain.
    fn take(&self) -> Option<(Link, Case)> {
        let place = self.taken.fetch_add(1, Ordering::Relaxed);
        let (count, chains) = self.queue;
        if place >= count {
            return None;
        }
        let (block, number) = chains(place);
        self.depart(block, self.study.chain(number), None)
    }

    /// Keeps the record of a case and yields the next of its chain.
    fn follow(
        &self,
        Link { block, index, start, start_phase, rest }: Link,
        orbit: Orbit,
    ) -> Option<(Link, Case)> {
        // After a failure the next case starts afresh.
        let settled = (orbit.outcome != Outcome::Failed).then_some(orbit.end);
        if (self.keep)(block, Record { index, start, start_phase, orbit }).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.depart(block, rest, settled)
    }

    fn depart(
        &self,
        block: usize,
        mut chain: Chain,
        from: Option<State<f64>>,
    ) -> Option<(Link, Case)> {
        if self.stopped.load(Ordering::Relaxed) {
            return None;
        }
        let index = chain.next()?;
        let mut case = self.study.case(index);
        if let Some(from) = from {
            // A case that settled was left on its section.
            case.start = State { x2: case.start.x2, ..from };
            case.start_phase = case.section_phase;
        }
        let (start, start_phase) = (case.start, case.start_phase);
        Some((Link { block, index, start, start_phase, rest: chain }, case))
    }

    /// A case that leaves the lanes unfinished, with what follows it.
    fn part_with(&mut self, case: Underway) -> (Link, Underway) {
        let link = self.links.remove(&case.number()).expect("the case was under way");
        (link, case)
    }

    /// Settles a case by itself, and all that follow it.
    fn finish_chain(&self, mut link: Link, case: Underway) {
        let protocol = &self.study.protocol;
        let (_, mut orbit) = case.finish(protocol);
        while let Some((next, case)) = self.follow(link, orbit) {
            link = next;
            (_, orbit) = Underway::new(link.index, case, protocol).finish(protocol);
        }
    }

    fn settle_one_by_one(&mut self) {
        let mut case = self.next(None);
        while let Some((index, started)) = case {
            let orbit = settle_case(&started, &self.study.protocol);
            case = self.next(Some((index, orbit)));
        }
    }
}

/// Why a study could not be run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunError(String);

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for RunError {}
