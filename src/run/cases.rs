//! The parallel run: chains of cases over all cores, in any order, to the same records.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};

use rayon::prelude::*;

use crate::attractor::Executor;
use crate::description::State;
use crate::flow::stop;
use crate::lane::Instructions;
use crate::model::{CaseQueue, Known, Model, Unfinished};
use crate::motion::{Case, Orbit};
use crate::orbit::{Machine, Outcome, STACK};
use crate::study::Study;
use crate::study::grid::Chain;

/// Starts that are followed to the end before others, as they tell the attractors.
const SAMPLE: usize = 256;
/// A study must have so many times as many cases to profit.
const WORTHWHILE: usize = 4;

/// What came of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Index of the case in its study.
    pub index: usize,
    /// Where it started: as the study says, or where its neighbour settled.
    pub start: State,
    /// Phase of the drive there [rad].
    pub start_phase: f64,
    /// What it settled to.
    pub orbit: Orbit,
}

/// Runs every case of `study` on `machine`, also of one that is to be refined, and hands each record to `keep`, which is called from any
/// thread and in any order.
pub fn run(study: &Study, machine: Machine, keep: impl Fn(Record) + Sync) -> Result<(), RunError> {
    let chains = Chains { count: study.chains(), at: &|place| Some((0, place)) };
    run_chains(study, machine, chains, |_, record| {
        keep(record);
        ControlFlow::Continue(())
    })
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
    let chains = Chains { count: chains.len(), at: &|place| Some((0, chains[place])) };
    run_chains(study, machine, chains, |_, record| {
        done();
        records.lock().expect("no thread has panicked").push(record);
        ControlFlow::Continue(())
    })?;
    let mut records = records.into_inner().expect("no thread has panicked");
    records.sort_by_key(|record: &Record| record.index);
    Ok(records)
}

/// Which of the blocks are run: none means all, otherwise each is asked for once, before its first case, by its number.
pub type Choice<'a> = Option<&'a (dyn Fn(usize) -> bool + Sync)>;

/// Some chains of a study, in the order in which they are begun.
#[derive(Clone, Copy)]
pub(super) struct Chains<'a> {
    /// How many.
    pub(super) count: usize,
    /// The block of the chain at a place, and its own number; none if it is not to be run.
    pub(super) at: &'a (dyn Fn(usize) -> Option<(usize, usize)> + Sync),
}

/// Runs some chains of `study` on `machine`, and hands each record to `keep` with the number of the block, until that says to
/// stop.
///
/// Every thread fills its lanes from one queue of chains until it is empty; the last cases, too few to fill
/// a vector, are followed one by one, by whichever thread is done with its lanes. A case depends on its own
/// parameters and start, or on its predecessor in its chain, alone.
pub(super) fn run_chains(
    study: &Study,
    machine: Machine,
    chains: Chains<'_>,
    keep: impl Fn(usize, Record) -> ControlFlow<()> + Sync,
) -> Result<(), RunError> {
    check(machine)?;
    let pool = pool(machine.threads)?;
    let known = known_orbits(study, machine);
    run_on(&pool, study, machine, chains, known.as_ref(), &keep);
    Ok(())
}

/// Fails if the processor lacks the instructions that are asked for.
pub(super) fn check(machine: Machine) -> Result<(), RunError> {
    match machine.instructions.filter(|it| !it.is_available()) {
        Some(missing) => Err(RunError(format!("the processor has no {}", missing.name()))),
        None => Ok(()),
    }
}

/// Runs chains on the threads of a pool, see [`run_chains`]; the orbits of the study that are `known` end the cases that reach them.
pub(super) fn run_on(
    pool: &rayon::ThreadPool,
    study: &Study,
    machine: Machine,
    chains: Chains<'_>,
    known: Option<&Known>,
    keep: &(impl Fn(usize, Record) -> ControlFlow<()> + Sync),
) {
    let (taken, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    let share = chains.count.div_ceil(pool.current_num_threads());
    let instructions = machine.instructions_for(share);
    let last_cases = Mutex::default();
    pool.broadcast(|_| {
        let (model, links) = (study.model(), BTreeMap::new());
        let (taken, stopped) = (&taken, &stopped);
        let worker = Worker { study, model, chains, taken, stopped, share, keep, links, known };
        worker.work(instructions, &last_cases);
    });
}

/// The orbits that a sample of the starts leads to, with their neighbourhoods, where all cases have the same parameters
/// and enough of them profit; the sample depends on the study alone.
pub(super) fn known_orbits(study: &Study, machine: Machine) -> Option<Known> {
    let cases = study.cases();
    let wanted = study.early_decision && study.case_set.varies_starts_alone();
    if !wanted || cases < WORTHWHILE * SAMPLE {
        return None;
    }
    let sample: Vec<Case> = (0..SAMPLE).map(|place| study.case(spread(place, cases))).collect();
    study.model().known_orbits(&sample, &study.protocol, machine)
}

/// One of so many cases by its place in a sample that is spread evenly over all axes: multiples of the golden section, as equal
/// steps could be those of an axis.
pub(super) fn spread(place: usize, cases: usize) -> usize {
    let fraction = (place as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    ((u128::from(fraction) * cases as u128) >> 64) as usize
}

/// So many worker threads; one per core for none.
pub(super) fn pool(threads: Option<usize>) -> Result<rayon::ThreadPool, RunError> {
    let stop = stop::current();
    let mut builder = rayon::ThreadPoolBuilder::new()
        .stack_size(STACK)
        .start_handler(move |_| stop::obey(stop.clone()));
    if let Some(threads) = threads {
        builder = builder.num_threads(threads);
    }
    builder
        .build()
        .map_err(|error| RunError(format!("the worker threads could not be started: {error}")))
}

/// The results of `each` for so many numbers, in their order, computed on so many threads, all cores for none.
///
/// Fails if the threads cannot be started.
pub fn on_all_threads<T: Send>(
    threads: Option<usize>,
    count: usize,
    each: impl Fn(usize) -> T + Sync,
) -> Result<Vec<T>, RunError> {
    let pool = pool(threads)?;
    Ok(pool.install(|| (0..count).into_par_iter().with_max_len(1).map(&each).collect()))
}

/// The threads of the pool in which it is used.
pub(super) struct Rayon;

/// A thread takes so many numbers of a range at least: fewer are not worth sharing out.
const SHARE: usize = 16;

impl Executor for Rayon {
    fn each(&self, count: usize, each: &(dyn Fn(usize) + Sync)) {
        (0..count).into_par_iter().with_min_len(SHARE).for_each(each);
    }
}

/// A case of a chain: its index and start, and those that follow it.
struct Link {
    block: usize,
    index: usize,
    start: State,
    start_phase: f64,
    rest: Chain,
}

/// A case that has left the lanes unfinished, with what follows it.
type Left = (Link, Box<dyn Unfinished>);

fn locked(last: &Mutex<Vec<Left>>) -> MutexGuard<'_, Vec<Left>> {
    last.lock().expect("no thread has panicked")
}

/// A thread with its part of the queue.
struct Worker<'a, K> {
    study: &'a Study,
    model: &'a dyn Model,
    /// All chains.
    chains: Chains<'a>,
    /// Chains that have been taken by any thread.
    taken: &'a AtomicUsize,
    /// Whether nothing more is to be begun.
    stopped: &'a AtomicBool,
    /// Chains that this thread may still begin with, so that a few are not all in the lanes of one.
    share: usize,
    keep: &'a K,
    /// The cases in its lanes, by their index.
    links: BTreeMap<usize, Link>,
    known: Option<&'a Known>,
}

impl<K: Fn(usize, Record) -> ControlFlow<()>> CaseQueue for Worker<'_, K> {
    fn next(&mut self, done: Option<(usize, Orbit)>) -> Option<(usize, Case)> {
        let next = match done {
            Some((index, orbit)) => {
                let link = self.links.remove(&index).expect("the case was in a lane");
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
        let (block, number) = loop {
            let place = self.taken.fetch_add(1, Ordering::Relaxed);
            if place >= self.chains.count || self.stopped.load(Ordering::Relaxed) {
                return None;
            }
            if let Some(chain) = (self.chains.at)(place) {
                break chain;
            }
        };
        self.depart(block, self.study.chain(number), None)
    }

    /// Keeps the record of a case and yields the next of its chain.
    fn follow(&self, link: Link, orbit: Orbit) -> Option<(Link, Case)> {
        let Link { block, index, start, start_phase, rest } = link;
        // After a failure the next case starts afresh.
        let settled = (orbit.outcome != Outcome::Failed).then(|| orbit.end.clone());
        if (self.keep)(block, Record { index, start, start_phase, orbit }).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        self.depart(block, rest, settled)
    }

    fn depart(&self, block: usize, mut chain: Chain, from: Option<State>) -> Option<(Link, Case)> {
        if self.stopped.load(Ordering::Relaxed) {
            return None;
        }
        let index = chain.next()?;
        let mut case = self.study.case(index);
        if let Some(from) = from {
            // A case that settled was left on its section.
            case.start = from.drifted_as(&case.start);
            case.start_phase = case.section_phase;
        }
        let (start, start_phase) = (case.start.clone(), case.start_phase);
        Some((Link { block, index, start, start_phase, rest: chain }, case))
    }

    /// Settles cases in lanes, and then the last ones of all threads by themselves.
    fn work(mut self, instructions: Instructions, last: &Mutex<Vec<Left>>) {
        let (model, protocol, known) = (self.model, &self.study.protocol, self.known);
        let left = model.settle_queue(instructions, protocol, known, &mut self);
        locked(last).extend(left.into_iter().map(|case| self.part_with(case)));
        loop {
            // In a statement of its own, so that the lock is free again.
            let case = locked(last).pop();
            let Some((link, case)) = case else { break };
            if self.stopped.load(Ordering::Relaxed) {
                break;
            }
            self.finish_chain(link, case.finish(protocol));
        }
    }

    /// A case that leaves the lanes unfinished, with what follows it.
    fn part_with(&mut self, case: Box<dyn Unfinished>) -> Left {
        let link = self.links.remove(&case.number()).expect("the case was in a lane");
        (link, case)
    }

    /// Settles all that follow a case, one by one.
    fn finish_chain(&self, mut link: Link, mut orbit: Orbit) {
        while let Some((next, case)) = self.follow(link, orbit) {
            link = next;
            orbit = self.model.settle(&case, &self.study.protocol, self.known);
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
