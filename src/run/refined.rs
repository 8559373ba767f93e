//! Runs a refined study: tile by tile, and then what one tile shows of its neighbours.

use std::ops::ControlFlow;
use std::sync::Mutex;

use crate::attractor::{Label, Table};
use crate::capsule::{AsPrinted, CapsuleSystem, Filippov, Reading, Switching};
use crate::study::{Refinement, Refining, Study};

use super::cases::{Known, Rayon, Record, RunError, check, known_orbits, pool, run_as, spread};
use super::infer::{are_alike, label};
use super::leads::Leads;
use super::{Attractors, FinalMotion, FinalMotions, Machine, final_motion};

/// Tiles that are refined together: enough that their cases fill the lanes, and all that is lost by a kill.
pub const TILES_TOGETHER: usize = 16;

/// Runs the `blocks` of a refined study, which are tiles, each named once, on `machine`.
///
/// Tells `done` of each record with the number of its block, and hands the records that a tile has needed, those on the whole
/// of its boundary among them, to `finished`; until one of the two says to stop. Which cases a tile needs depends on the study
/// alone.
pub(super) fn run_refined(
    study: &Study,
    machine: Machine,
    blocks: &[usize],
    done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
    finished: impl Fn(usize, Vec<Record>) -> ControlFlow<()> + Sync,
) -> Result<(), RunError> {
    check(machine)?;
    match study.base.switching {
        Switching::Filippov => Runner::<Filippov>::new(study, machine)?.run(blocks, done, finished),
        Switching::AsPrinted => {
            Runner::<AsPrinted>::new(study, machine)?.run(blocks, done, finished)
        }
    }
    Ok(())
}

/// Computes what the tiles of a refined study lack, as what crosses their boundaries shows, from the `final_motions` of the
/// cases that have been computed.
pub fn complete_refinement(
    study: &Study,
    final_motions: &FinalMotions,
    machine: Machine,
) -> Result<Vec<Record>, RunError> {
    let Some(refinement) = study.refinement() else { return Ok(Vec::new()) };
    check(machine)?;
    Ok(match study.base.switching {
        Switching::Filippov => {
            Runner::<Filippov>::new(study, machine)?.complete(&refinement, final_motions)
        }
        Switching::AsPrinted => {
            Runner::<AsPrinted>::new(study, machine)?.complete(&refinement, final_motions)
        }
    })
}

/// How many starts of a sample of those that are inferred lead to another attractor, or to none that is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InferredSample {
    /// Starts of the sample.
    pub starts: usize,
    /// Those that do not lead where it was inferred.
    pub elsewhere: usize,
}

/// Starts of the sample.
const SAMPLE: usize = 1000;

/// Computes a sample of the starts whose attractors are inferred, spread evenly over the grid; none where none is.
pub fn check_inferred(
    study: &Study,
    attractors: &Attractors,
    final_motions: &FinalMotions,
    machine: Machine,
) -> Result<Option<InferredSample>, RunError> {
    let cases = study.cases();
    let is_inferred =
        |case: &usize| attractors.of_case[*case].is_some() && final_motions.get(*case).is_none();
    let places = (0..cases.min(64 * SAMPLE)).map(|place| spread(place, cases));
    let mut sample: Vec<usize> = places.filter(is_inferred).take(SAMPLE).collect();
    sample.sort_unstable();
    sample.dedup();
    if sample.is_empty() {
        return Ok(None);
    }
    let elsewhere = match study.base.switching {
        Switching::Filippov => {
            Runner::<Filippov>::new(study, machine)?.elsewhere(&sample, attractors)
        }
        Switching::AsPrinted => {
            Runner::<AsPrinted>::new(study, machine)?.elsewhere(&sample, attractors)
        }
    };
    Ok(Some(InferredSample { starts: sample.len(), elsewhere }))
}

/// What computes the cases of a study on demand.
struct Runner<'a, R: Reading> {
    study: &'a Study,
    machine: Machine,
    pool: rayon::ThreadPool,
    system: CapsuleSystem<R>,
    known: Known<R>,
}

/// Some cases that are refined together, as far as they have been computed.
struct Set {
    refining: Refining<Label>,
    table: Table<3>,
    records: Vec<Record>,
}

impl Set {
    fn new(refining: Refining<Label>) -> Set {
        Set { refining, table: Table::default(), records: Vec::new() }
    }
}

impl<'a, R: Reading> Runner<'a, R> {
    fn new(study: &'a Study, machine: Machine) -> Result<Self, RunError> {
        let known = known_orbits::<R>(study, machine);
        let system = study.case(0).read::<R>().system;
        Ok(Runner { study, machine, pool: pool(machine.threads)?, system, known })
    }

    fn run(
        &self,
        blocks: &[usize],
        done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
        finished: impl Fn(usize, Vec<Record>) -> ControlFlow<()>,
    ) {
        let Some(refinement) = self.study.refinement() else { return };
        for numbers in blocks.chunks(TILES_TOGETHER) {
            let tile = |&number| Set::new(Refining::tile(&refinement, number, are_alike));
            let mut tiles: Vec<Set> = numbers.iter().map(tile).collect();
            if self.refine(&mut tiles, |place, record| done(numbers[place], record)).is_break() {
                return;
            }
            for (&number, mut tile) in numbers.iter().zip(tiles) {
                tile.records.sort_by_key(|record| record.index);
                if finished(number, tile.records).is_break() {
                    return;
                }
            }
        }
    }

    fn complete(&self, refinement: &Refinement, final_motions: &FinalMotions) -> Vec<Record> {
        let mut whole = Set::new(Refining::whole(refinement, are_alike));
        let motions: Vec<(usize, FinalMotion)> = final_motions.known().collect();
        self.sort(&mut whole, &motions);
        let mut all = [whole];
        // Nobody asks to stop.
        let _ = self.refine(&mut all, |_, _| ControlFlow::Continue(()));
        let [Set { mut records, .. }] = all;
        records.sort_by_key(|record| record.index);
        records
    }

    /// How many of some cases do not lead to the attractor that they have.
    fn elsewhere(&self, cases: &[usize], attractors: &Attractors) -> usize {
        let known = (0..).zip(&attractors.of_starts).collect();
        let leads = Leads::new(self.system.clone(), (&self.study.protocol, self.machine), known);
        let cases: Vec<(usize, usize)> = cases.iter().map(|&case| (case, 0)).collect();
        let records = self.compute(&cases, |_, _| ControlFlow::Continue(()));
        let goes_elsewhere = |record: &&Record| {
            let number = leads.number(&final_motion(&record.orbit));
            number != attractors.of_case[record.index]
        };
        records.iter().filter(goes_elsewhere).count()
    }

    /// Computes what some sets of cases need, round by round, until none needs any more, or `done`, which is told of each
    /// record with the place of the first set that wants it, says to stop.
    fn refine(
        &self,
        sets: &mut [Set],
        done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
    ) -> ControlFlow<()> {
        loop {
            let wanted: Vec<Vec<usize>> =
                self.pool.install(|| sets.iter().map(|set| set.refining.wanted()).collect());
            let mut all: Vec<(usize, usize)> = Vec::new();
            for (place, cases) in wanted.iter().enumerate() {
                all.extend(cases.iter().map(|&case| (case, place)));
            }
            all.sort_unstable();
            all.dedup_by_key(|(case, _)| *case);
            if all.is_empty() {
                return ControlFlow::Continue(());
            }
            let records = self.compute(&all, &done);
            if records.len() < all.len() {
                return ControlFlow::Break(());
            }
            for (set, wanted) in sets.iter_mut().zip(&wanted) {
                let place = |case| all.partition_point(|(other, _)| *other < case);
                let own = wanted.iter().map(|&case| records[place(case)].clone());
                let own: Vec<Record> = own.collect();
                let motions: Vec<(usize, FinalMotion)> =
                    own.iter().map(|it| (it.index, final_motion(&it.orbit))).collect();
                self.sort(set, &motions);
                set.records.extend(own);
            }
        }
    }

    /// The records of some cases, each with the place that `done` is told, in the order of their indices.
    fn compute(
        &self,
        cases: &[(usize, usize)],
        done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
    ) -> Vec<Record> {
        let records = Mutex::new(Vec::with_capacity(cases.len()));
        let keep = |place: usize, record: Record| {
            let told = done(place, &record);
            records.lock().expect("no thread has panicked").push(record);
            told
        };
        let chains = |at: usize| (cases[at].1, cases[at].0);
        let (study, machine, known) = (self.study, self.machine, self.known.clone());
        run_as::<R>(study, machine, (cases.len(), &chains), (&self.pool, known), &keep);
        let mut records = records.into_inner().expect("no thread has panicked");
        records.sort_by_key(|record: &Record| record.index);
        records
    }

    /// Notes which attractors some cases of a set lead to.
    fn sort(&self, set: &mut Set, motions: &[(usize, FinalMotion)]) {
        let before = set.table.of_case.len();
        let motion = |place: usize| (motions[place].0, Some(motions[place].1));
        let (system, protocol) = (&self.system, &self.study.protocol);
        self.pool.install(|| set.table.extend(motions.len(), motion, system, protocol, &Rayon));
        for ((case, _), attractor) in motions.iter().zip(&set.table.of_case[before..]) {
            set.refining.note(*case, label(*attractor));
        }
    }
}
