//! Computes a few parts of a study for a short time, to estimate what all would take.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};

use super::error::CampaignError;
use super::report::{Event, Report, Reports};
use super::search_time::{PARTS, neighbours, search_seconds};
use crate::run::{
    CHECKED, Estimate, Forecast, Machine, Record, RunError, run_blocks, run_sample, run_tiles,
};
use crate::store::{RUN, file_bytes, numbers_of_case, packed_bytes, refined_file_bytes, storing};
use crate::study::{CaseSet, Direction, Refinement, Study, spread};

/// Records whose size is measured.
const WEIGHED: usize = 4096;
/// Runs that are computed together, which fill the lanes.
const RUNS_TOGETHER: usize = 4;
/// Numbers in the tiles of a refined study whose size in the file is measured, at most.
const NUMBERS: usize = 4_000_000;
/// The time after which neither a part nor a run is begun whose size is measured.
const SPREAD: Duration = Duration::from_secs(3);
/// Coarse cells along each side of a tile that is probed, by the number of axes of a refined grid.
const SIDES: [usize; 5] = [8, 4, 2, 1, 1];
/// So many times longer a probe of a refined study takes at most, of which nothing is known before a tile is done.
const PATIENCE: u32 = 12;

/// What a probe has found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Cases that it has computed.
    pub cases: usize,
    /// Blocks that it has begun, or tiles of a refined study, which are smaller than its blocks.
    pub blocks: usize,
    /// The time it took.
    pub time: Duration,
    /// Time that all cases would take on the same machine, to be computed and packed, and of those that are inferred a sample to
    /// be checked [s]; none if no case was done.
    pub seconds: Option<Estimate>,
    /// Time that the search for attractors would take after that [s]; none if there is none.
    pub searching: Option<Estimate>,
    /// Time that joining the blocks and writing the file would take after that [s]; NaN if no case was done.
    pub writing: f64,
    /// The most cases that are computed of a block: of a tile of a refined study those that it needs.
    pub most: usize,
    /// The most cases that were done at a time of blocks that were not.
    pub unfinished: usize,
    /// Size of all blocks [bytes]; NaN if no case was done.
    pub bytes: f64,
    /// Size of the file of results without attractors, curves of special points and optima [bytes]; NaN if no case, or no
    /// tile of a refined study, was done.
    pub file_bytes: f64,
}

/// What is sampled of a study: its blocks, or of one that is refined tiles that are much smaller than its blocks, of which
/// the first few would be most of the study.
struct Parts<'a> {
    study: &'a Study,
    tiles: Option<Refinement>,
}

impl Parts<'_> {
    fn of(study: &Study) -> Parts<'_> {
        let side = SIDES[study.shape().len().clamp(1, SIDES.len()) - 1];
        Parts { study, tiles: study.refinement().map(|it| it.with_tiles_of(side)) }
    }

    fn count(&self) -> usize {
        self.tiles.as_ref().map_or_else(|| self.study.blocks(), Refinement::tiles)
    }

    /// Number of cases of a part.
    fn count_cases(&self, part: usize) -> usize {
        match &self.tiles {
            None => self.study.cases_of_block(part),
            Some(tiles) => tiles.count(part),
        }
    }

    /// Runs all parts in an order that spreads them over the study, until one of the two says to stop.
    fn run(
        &self,
        machine: Machine,
        done: impl Fn(usize, &Record) -> ControlFlow<()> + Sync,
        finished: impl Fn(usize, Vec<Record>) -> ControlFlow<()> + Sync,
    ) -> Result<(), RunError> {
        let order = spread(self.count());
        match &self.tiles {
            None => run_blocks(self.study, machine, &order, None, done, finished),
            Some(tiles) => run_tiles(self.study, machine, tiles, &order, None, done, finished),
        }
    }

    /// Runs parts until about this time is over.
    fn run_for(
        &self,
        span: Duration,
        machine: Machine,
        reports: &Reports<'_>,
    ) -> Result<Found<'_>, CampaignError> {
        let begun = Instant::now();
        let found = Mutex::new(Found::nothing(self));
        self.run(
            machine,
            |part, record| {
                let cases = self.count_cases(part);
                reports.note(Event::Case { block: part, cases, record })?;
                let mut found = locked(&found);
                found.add(part, record);
                // Of a refined study the cases that it will have are known once a tile is done.
                let is_known = self.study.refine.is_none() || found.tiles_met > 0;
                match begun.elapsed() < if is_known { span } else { PATIENCE * span } {
                    true => ControlFlow::Continue(()),
                    false => ControlFlow::Break(()),
                }
            },
            |part, records| {
                locked(&found).keep_tile(part, records);
                ControlFlow::Continue(())
            },
        )?;
        Ok(found.into_inner().unwrap_or_else(|it| it.into_inner()))
    }
}

/// The state of a probe.
struct Found<'a> {
    parts: &'a Parts<'a>,
    forecast: Forecast,
    /// Cases that are done of the blocks or tiles that have been begun.
    begun: BTreeMap<usize, usize>,
    /// Cases that are done of blocks that are not, and the most of them at a time.
    unfinished: [usize; 2],
    /// Cases that have been computed, and their cycles; of tiles also those on their boundary, which belong to others.
    computed: (usize, u64),
    /// Those of the cases met that are weighed, one in so `every` many.
    records: Vec<Record>,
    every: usize,
    /// Those of the tiles of a refined study that are weighed, one in so `every_tile` many: their cases, and the records of
    /// those computed.
    tiles: Vec<(Vec<usize>, Vec<Record>)>,
    every_tile: usize,
    tiles_met: usize,
    /// Cases of the tiles that are done which had to be computed.
    needed: usize,
}

/// Computes parts of `study`, spread over it, for about `span`, and searches for the attractors of a few; writes nothing but
/// to a folder for temporary files, which is removed.
///
/// Method: the time that cases take goes with their cycles, see [`Forecast`]; that of the search for attractors is measured
/// on parts of the study; those of packing and of writing on files with a sample of the cases, see [`storing`].
///
/// Fails if the computation cannot be started.
pub fn probe(
    study: &Study,
    machine: Machine,
    span: Duration,
    report: &Report<'_>,
) -> Result<Probe, CampaignError> {
    let reports = Reports::new(report);
    let parts = Parts::of(study);
    let begun = Instant::now();
    let mut found = parts.run_for(span, machine, &reports)?;
    reports.check()?;
    let time = begun.elapsed();
    if study.refine.is_none() && found.computed.0 < study.cases() {
        found.records = match study.inherit() {
            Some(_) => spread_cases(study, machine)?,
            None => spread_runs(study, machine)?,
        };
    }
    let searching = search_seconds(study, machine, span)?;
    reports.check()?;
    found.estimate(machine, time, searching)
}

/// Cases of a study whose starts are not inherited, in runs of neighbours that lie spread over it: of what a probe has done when
/// its time is over, those that take long are missing, whose histories are compressed least.
fn spread_runs(study: &Study, machine: Machine) -> Result<Vec<Record>, CampaignError> {
    let begun = Instant::now();
    let mut records = Vec::new();
    for runs in spread(study.cases().div_ceil(RUN)).chunks(RUNS_TOGETHER) {
        if begun.elapsed() > SPREAD || records.len() >= WEIGHED {
            break;
        }
        let cases: Vec<usize> =
            runs.iter().flat_map(|run| run * RUN..((run + 1) * RUN).min(study.cases())).collect();
        records.extend(run_sample(study, machine, &cases, || ())?);
    }
    Ok(records)
}

/// Cases of chains that lie spread over a study whose starts are inherited: what a probe has computed of the chains is
/// only where they begin, and the motions there may be simpler.
///
/// Each chain runs along a part of its axis, and only its second half is taken, in which the start of the study is
/// forgotten. Records are numbered in the order of the parts.
fn spread_cases(study: &Study, machine: Machine) -> Result<Vec<Record>, CampaignError> {
    let (CaseSet::Grid(grid), Some(inherit)) = (&study.case_set, study.inherit()) else {
        return Ok(Vec::new());
    };
    let places = grid.axes[inherit.axis].places();
    let length = neighbours(places, 0).len();
    let parts = if length < places { PARTS } else { 1 };
    let begun = Instant::now();
    let mut records: Vec<Record> = Vec::new();
    for number in 0..parts {
        if begun.elapsed() > SPREAD {
            break;
        }
        let mut grid = grid.clone();
        let some: Vec<usize> = neighbours(places, number).collect();
        grid.axes[inherit.axis].keep(&some);
        let part = Study { case_set: CaseSet::Grid(grid), ..study.clone() };
        let shape = part.shape();
        let spacing: usize = shape[inherit.axis + 1..].iter().product();
        let count = (WEIGHED / parts / length).max(1);
        let chains = spread(part.chains());
        let chains = &chains[..chains.len().min(2 * count)];
        for record in run_sample(&part, machine, chains, || ())? {
            let place = record.index / spacing % length;
            let direction = inherit.directions[record.index % inherit.directions.len()];
            let is_late = match direction {
                Direction::Upward => 2 * place >= length,
                Direction::Downward => 2 * place < length,
                Direction::Afresh => true,
            };
            if is_late {
                records.push(Record { index: records.len(), ..record });
            }
        }
    }
    Ok(records)
}

fn locked<'m, 'a>(found: &'m Mutex<Found<'a>>) -> MutexGuard<'m, Found<'a>> {
    found.lock().unwrap_or_else(|it| it.into_inner())
}

/// Whether a case is weighed, where one run in so many is.
fn is_weighed(index: usize, every: usize) -> bool {
    (index / RUN).is_multiple_of(every)
}

/// Cases that are computed of the largest block, where this share of all cases is computed.
fn most_of_block(study: &Study, share: f64) -> usize {
    let sizes = (0..study.blocks()).map(|block| study.cases_of_block(block));
    let largest = sizes.max().unwrap_or(0) as f64;
    if share.is_finite() { (share * largest).ceil() as usize } else { 0 }
}

impl<'a> Found<'a> {
    /// Nothing yet.
    fn nothing(parts: &'a Parts<'a>) -> Found<'a> {
        Found {
            parts,
            forecast: Forecast::new(parts.study.cases()),
            begun: BTreeMap::new(),
            unfinished: [0, 0],
            computed: (0, 0),
            records: Vec::new(),
            every: 1,
            tiles: Vec::new(),
            every_tile: 1,
            tiles_met: 0,
            needed: 0,
        }
    }

    /// Notes a record of a part.
    fn add(&mut self, part: usize, record: &Record) {
        let cycles = record.orbit.cycles;
        if self.parts.tiles.is_none() {
            self.forecast.add(part, self.parts.count_cases(part), 1, cycles);
        }
        let done = self.begun.entry(part).or_default();
        *done += 1;
        let [now, most] = &mut self.unfinished;
        *now += 1;
        *most = (*most).max(*now);
        if *done == self.parts.count_cases(part) {
            *now -= *done;
        }
        self.computed = (self.computed.0 + 1, self.computed.1 + cycles);
        if is_weighed(record.index, self.every) {
            self.records.push(record.clone());
        }
        // The first cases of all chains are not like the others.
        if self.records.len() > 2 * WEIGHED {
            self.every *= 2;
            self.records.retain(|record| is_weighed(record.index, self.every));
        }
    }

    /// Notes a tile of a refined study that is done; of any other study nothing.
    fn keep_tile(&mut self, tile: usize, records: Vec<Record>) {
        let Some(refinement) = &self.parts.tiles else { return };
        let cases = refinement.cases(tile);
        let own = records.iter().filter(|it| cases.binary_search(&it.index).is_ok());
        let (needed, cycles) =
            own.fold((0, 0), |(count, cycles), it| (count + 1, cycles + it.orbit.cycles));
        self.needed += needed;
        self.forecast.complete(tile, cases.len(), cycles);
        if self.tiles_met.is_multiple_of(self.every_tile) {
            self.tiles.push((cases, records));
        }
        self.tiles_met += 1;
        let of_case: usize = numbers_of_case(self.parts.study).values().sum();
        // The first tiles that are done are not like the others.
        while self.tiles.len() > 1 && self.cases_of_tiles() * of_case > NUMBERS {
            let mut kept = 0..;
            self.tiles.retain(|_| kept.next().is_some_and(|it: usize| it.is_multiple_of(2)));
            self.every_tile *= 2;
        }
    }

    /// Cases of the tiles that are weighed.
    fn cases_of_tiles(&self) -> usize {
        self.tiles.iter().map(|(cases, _)| cases.len()).sum()
    }

    /// Time that all cases take to be computed, of which this share is, and to be packed [s].
    fn seconds(&self, time: Duration, share: f64, packing: f64) -> Option<Estimate> {
        let (cases, cycles) = self.computed;
        let pace = time.as_secs_f64() / cycles as f64;
        let inferred = (1.0 - share) * self.parts.study.cases() as f64;
        let checking = inferred.min(CHECKED as f64) * time.as_secs_f64() / cases as f64;
        self.forecast.cycles().map(|cycles| Estimate {
            value: cycles.value * pace + packing + checking,
            error: cycles.error * pace,
        })
    }

    /// The estimate for all cases.
    fn estimate(
        mut self,
        machine: Machine,
        time: Duration,
        searching: Option<Estimate>,
    ) -> Result<Probe, CampaignError> {
        let study = self.parts.study;
        self.records.sort_by_key(|record| record.index);
        self.records.dedup_by_key(|record| record.index);
        // Of a refined study fewer cases are kept than there are.
        let kept = match self.parts.tiles {
            Some(_) => self.needed as f64 / self.forecast.done().0 as f64,
            None => 1.0,
        };
        let factor = kept * study.cases() as f64 / self.records.len() as f64;
        let packed = packed_bytes(study, &self.records).map_err(CampaignError::Packing)?;
        let storing = storing(study, &self.records, kept)?;
        let packing = storing.packing / machine.threads() as f64;
        let file_bytes = match study.refine {
            None => file_bytes(study, &self.records)?,
            Some(_) => refined_file_bytes(study, &self.tiles, kept)?,
        };
        Ok(Probe {
            cases: self.computed.0,
            blocks: self.begun.len(),
            time,
            seconds: self.seconds(time, kept, packing),
            searching,
            writing: storing.joining,
            most: most_of_block(study, kept),
            unfinished: self.unfinished[1],
            bytes: packed as f64 * factor,
            file_bytes,
        })
    }
}
