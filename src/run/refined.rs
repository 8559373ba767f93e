//! Runs a refined study: tile by tile, and then what one tile shows of its neighbours.

use std::ops::ControlFlow;
use std::sync::Mutex;

use super::cases::{Chains, Choice, Rayon, Record, RunError, check, known_orbits, pool, run_on};
use super::infer::{are_alike, label};
use super::map_point::MapPoint;
use super::{FinalMotion, FinalMotions, Machine, final_motion};
use crate::attractor::{Label, Table};
use crate::description::Section;
use crate::model::{Known, Motions, Setting};
use crate::study::{Refine, Refinement, Refining, Study};

/// Tiles that are refined together: enough that their cases fill the lanes, and all that is lost by a kill.
pub const TILES_TOGETHER: usize = 16;

/// Of tiles that are chosen one by one, others choose too: no more than this part of those left is taken at a time.
const PART: usize = 4;

/// Runs those `tiles` of a refined study, each named once, on `machine` that are `chosen`; of its own `refinement` they are its blocks.
///
/// Tells `done` of each record with the number of its block, and hands the records that a tile has needed, those on the whole
/// of its boundary among them, to `finished`; until one of the two says to stop. Which cases a tile needs depends on the study
/// alone.
pub fn run_tiles(
    study: &Study,
    machine: Machine,
    refinement: &Refinement,
    tiles: &[usize],
    chosen: Choice<'_>,
    done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
    finished: impl Fn(usize, Vec<Record>) -> ControlFlow<()> + Sync,
) -> Result<(), RunError> {
    check(machine)?;
    let runner = Runner::new(study, machine)?;
    let mut left = tiles;
    while !left.is_empty() {
        let together;
        (together, left) = next_tiles(left, chosen);
        if runner.run(refinement, &together, &done, &finished).is_break() {
            break;
        }
    }
    Ok(())
}

/// The next of some tiles that are refined together, and those that are left.
fn next_tiles<'a>(tiles: &'a [usize], chosen: Choice<'_>) -> (Vec<usize>, &'a [usize]) {
    let Some(choose) = chosen else {
        let (next, left) = tiles.split_at(tiles.len().min(TILES_TOGETHER));
        return (next.to_vec(), left);
    };
    let most = tiles.len().div_ceil(PART).min(TILES_TOGETHER);
    let (mut next, mut left) = (Vec::new(), tiles);
    while next.len() < most
        && let Some((&tile, others)) = left.split_first()
    {
        left = others;
        next.extend(choose(tile).then_some(tile));
    }
    (next, left)
}

/// Computes what the tiles of a refined basin lack, as what crosses their boundaries shows, from the `final_motions` of the
/// cases that have been computed.
pub fn complete_basin(
    study: &Study,
    final_motions: &FinalMotions,
    machine: Machine,
) -> Result<Vec<Record>, RunError> {
    check(machine)?;
    let motions: Vec<(usize, FinalMotion)> = final_motions.known().collect();
    Ok(Runner::new(study, machine)?.complete_basin(&motions))
}

/// Computes what the tiles of a refined map lack, as what crosses their boundaries shows, from what is `known` of the cases that
/// have been computed.
pub fn complete_map(
    study: &Study,
    known: &[(usize, MapPoint)],
    machine: Machine,
) -> Result<Vec<Record>, RunError> {
    check(machine)?;
    Ok(Runner::new(study, machine)?.complete_map(known))
}

/// The records of some cases of a refined study, in the order of their indices.
pub(super) fn computed(
    study: &Study,
    cases: &[usize],
    machine: Machine,
) -> Result<Vec<Record>, RunError> {
    check(machine)?;
    let cases: Vec<(usize, usize)> = cases.iter().map(|&case| (case, 0)).collect();
    Ok(Runner::new(study, machine)?.compute(&cases, |_, _| ControlFlow::Continue(())))
}

/// What computes the cases of a study on demand.
struct Runner<'a> {
    study: &'a Study,
    machine: Machine,
    pool: rayon::ThreadPool,
    setting: Setting,
    known: Option<Known>,
}

/// How the cases that have been computed are told apart.
trait Sorting: Sync {
    /// What is told of a case.
    type Label: Send + Sync;

    /// Whether two cases are alike.
    const ALIKE: fn(&Self::Label, &Self::Label) -> bool;

    /// The labels of some records.
    fn labels(&mut self, runner: &Runner<'_>, records: &[Record]) -> Vec<Self::Label>;
}

/// By the attractors of those that have been met.
#[derive(Default)]
struct ByAttractor(Table<Section>);

impl ByAttractor {
    fn of(&mut self, runner: &Runner<'_>, motions: &[(usize, FinalMotion)]) -> Vec<Label> {
        let before = self.0.of_case.len();
        let at = &|place: usize| (motions[place].0, Some(motions[place].1));
        let motions = Motions { count: motions.len(), at };
        let (model, protocol) = (runner.study.model(), &runner.study.protocol);
        runner.pool.install(|| {
            model.extend_table(&mut self.0, &runner.setting, motions, protocol, &Rayon);
        });
        self.0.of_case[before..].iter().map(|attractor| label(*attractor)).collect()
    }
}

impl Sorting for ByAttractor {
    type Label = Label;
    const ALIKE: fn(&Label, &Label) -> bool = are_alike;

    fn labels(&mut self, runner: &Runner<'_>, records: &[Record]) -> Vec<Label> {
        let motions: Vec<(usize, FinalMotion)> =
            records.iter().map(|it| (it.index, final_motion(&it.orbit))).collect();
        self.of(runner, &motions)
    }
}

/// By their periods and outputs.
#[derive(Default)]
struct ByOutputs;

impl Sorting for ByOutputs {
    type Label = MapPoint;
    const ALIKE: fn(&MapPoint, &MapPoint) -> bool = MapPoint::is_like;

    fn labels(&mut self, runner: &Runner<'_>, records: &[Record]) -> Vec<MapPoint> {
        records.iter().map(|record| MapPoint::of_record(runner.study, record)).collect()
    }
}

/// Some cases that are refined together, as far as they have been computed.
struct Set<S: Sorting> {
    refining: Refining<S::Label>,
    sorting: S,
    records: Vec<Record>,
}

impl<S: Sorting + Default> Set<S> {
    /// A tile of which no case has been computed.
    fn tile(refinement: &Refinement, number: usize) -> Self {
        let refining = Refining::tile(refinement, number, S::ALIKE);
        Set { refining, sorting: S::default(), records: Vec::new() }
    }
}

impl<'a> Runner<'a> {
    fn new(study: &'a Study, machine: Machine) -> Result<Self, RunError> {
        let known = known_orbits(study, machine);
        let setting = Setting::of(&study.case(0));
        Ok(Runner { study, machine, pool: pool(machine.threads)?, setting, known })
    }

    /// Refines some tiles together.
    fn run(
        &self,
        refinement: &Refinement,
        numbers: &[usize],
        done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
        finished: impl Fn(usize, Vec<Record>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        match self.study.refine {
            Some(Refine::Attractors) => {
                self.run_by::<ByAttractor>(refinement, numbers, done, finished)
            }
            Some(Refine::Outputs(_)) => {
                self.run_by::<ByOutputs>(refinement, numbers, done, finished)
            }
            None => ControlFlow::Continue(()),
        }
    }

    fn run_by<S: Sorting + Default>(
        &self,
        refinement: &Refinement,
        numbers: &[usize],
        done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
        finished: impl Fn(usize, Vec<Record>) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut tiles: Vec<Set<S>> =
            numbers.iter().map(|number| Set::tile(refinement, *number)).collect();
        self.refine(&mut tiles, |place, record| done(numbers[place], record))?;
        for (&number, mut tile) in numbers.iter().zip(tiles) {
            tile.records.sort_by_key(|record| record.index);
            finished(number, tile.records)?;
        }
        ControlFlow::Continue(())
    }

    fn complete_basin(&self, motions: &[(usize, FinalMotion)]) -> Vec<Record> {
        let mut sorting = ByAttractor::default();
        let labels = sorting.of(self, motions);
        let cases = motions.iter().map(|(case, _)| *case);
        self.complete(sorting, cases.zip(labels))
    }

    fn complete_map(&self, known: &[(usize, MapPoint)]) -> Vec<Record> {
        self.complete(ByOutputs, known.iter().cloned())
    }

    /// What the whole grid lacks, of which some cases are known.
    fn complete<S: Sorting>(
        &self,
        sorting: S,
        known: impl Iterator<Item = (usize, S::Label)>,
    ) -> Vec<Record> {
        let Some(refinement) = self.study.refinement() else { return Vec::new() };
        let mut refining = Refining::whole(&refinement, S::ALIKE);
        known.for_each(|(case, label)| refining.note(case, label));
        let mut all = [Set::<S> { refining, sorting, records: Vec::new() }];
        // Nobody asks to stop.
        let _ = self.refine(&mut all, |_, _| ControlFlow::Continue(()));
        let [Set { mut records, .. }] = all;
        records.sort_by_key(|record| record.index);
        records
    }

    /// Computes what some sets of cases need, round by round, until none needs any more, or `done`, which is told of each
    /// record with the place of the first set that wants it, says to stop.
    fn refine<S: Sorting>(
        &self,
        sets: &mut [Set<S>],
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
                let places =
                    wanted.iter().map(|case| all.partition_point(|(other, _)| other < case));
                let own: Vec<Record> = places.map(|place| records[place].clone()).collect();
                for (record, label) in own.iter().zip(set.sorting.labels(self, &own)) {
                    set.refining.note(record.index, label);
                }
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
        let chains =
            Chains { count: cases.len(), at: &|place| Some((cases[place].1, cases[place].0)) };
        let known = self.known.as_ref();
        run_on(&self.pool, self.study, self.machine, chains, known, &|place, record| {
            let told = done(place, &record);
            records.lock().expect("no thread has panicked").push(record);
            told
        });
        let mut records = records.into_inner().expect("no thread has panicked");
        records.sort_by_key(|record: &Record| record.index);
        records
    }
}
