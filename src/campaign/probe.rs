//! Computes a few blocks of a study for a short time, to estimate what all would take.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::run::{Estimate, Forecast, Machine, Record, run_blocks, run_sample};
use crate::store::{file_bytes, numbers_of_case, packed_bytes, refined_file_bytes};
use crate::study::{CaseSet, Direction, Study, spread};

use super::error::CampaignError;
use super::report::{Event, Report, Reports};

/// Records whose size is measured.
const WEIGHED: usize = 4096;
/// Records are kept in runs of so many neighbours, as equal numbers beside each other are compressed.
const RUN: usize = 128;
/// Numbers in the tiles of a refined study whose size in the file is measured, at most.
const NUMBERS: usize = 4_000_000;
/// Parts of the axis along which starts are inherited, the cases of each, and the time after which none is begun.
const PARTS: usize = 8;
const PART: usize = 16;
const SPREAD: Duration = Duration::from_secs(5);
/// So many times longer a probe of a refined study takes at most, of which nothing is known before a tile is done.
const PATIENCE: u32 = 12;

/// What a probe has found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Cases that it has computed.
    pub cases: usize,
    /// Blocks that it has begun.
    pub blocks: usize,
    /// The time it took.
    pub time: Duration,
    /// Time that all cases would take on the same machine [s]; none if no case was done.
    pub seconds: Option<Estimate>,
    /// The most cases that are computed of a block: of a tile of a refined study those that it has needed.
    pub most: usize,
    /// Size of all blocks [bytes]; NaN if no case was done.
    pub bytes: f64,
    /// Size of the file of results without attractors, curves of special points and optima [bytes]; NaN if no case, or no
    /// tile of a refined study, was done.
    pub file_bytes: f64,
}

/// The state of a probe.
struct Found {
    forecast: Forecast,
    /// Blocks that have been begun.
    blocks: BTreeSet<usize>,
    /// Those of the cases met that are weighed, one in so `every` many.
    records: Vec<Record>,
    every: usize,
    met: usize,
    /// Those of the tiles of a refined study that are weighed, one in so `every_tile` many: their cases, and the records of
    /// those computed.
    tiles: Vec<(Vec<usize>, Vec<Record>)>,
    every_tile: usize,
    tiles_met: usize,
    /// The most cases that a tile has needed.
    most: usize,
}

/// Computes blocks of `study`, spread over it, for about `span`, and writes nothing.
///
/// Fails if the computation cannot be started.
pub fn probe(
    study: &Study,
    machine: Machine,
    span: Duration,
    report: &Report<'_>,
) -> Result<Probe, CampaignError> {
    let reports = Reports::new(report);
    let forecast = Forecast::new(study.cases());
    let (blocks, records, tiles) = (BTreeSet::new(), Vec::new(), Vec::new());
    let found = Mutex::new(Found {
        forecast,
        blocks,
        records,
        every: 1,
        met: 0,
        tiles,
        every_tile: 1,
        tiles_met: 0,
        most: 0,
    });
    let begun = Instant::now();
    let lock = || found.lock().unwrap_or_else(|it| it.into_inner());
    let each = |block: usize, record: &Record| {
        let cases = study.cases_of_block(block);
        reports.note(Event::Case { block, cases, record })?;
        lock().add(block, (study.refine.is_none()).then_some(cases), record);
        // Of a refined study the cases that it will have are known once a tile is done.
        let is_known = study.refine.is_none() || lock().forecast.done().0 > 0;
        match begun.elapsed() < if is_known { span } else { PATIENCE * span } {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    };
    let whole = |block: usize, records: Vec<Record>| {
        if study.refine.is_some() {
            let cycles = records.iter().map(|record| record.orbit.cycles).sum();
            let mut found = lock();
            found.forecast.complete(block, study.cases_of_block(block), cycles);
            found.keep_tile(study, block, records);
        }
        ControlFlow::Continue(())
    };
    run_blocks(study, machine, &spread(study.blocks()), each, whole)?;
    reports.check()?;
    let time = begun.elapsed();
    let mut found = found.into_inner().unwrap_or_else(|it| it.into_inner());
    if study.inherit().is_some() && found.met < study.cases() {
        found.records = spread_cases(study, machine)?;
    }
    found.estimate(study, time)
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
    let values = &grid.axes[inherit.axis].values;
    let length = PART.min(values.len());
    let parts = if length < values.len() { PARTS } else { 1 };
    let begun = Instant::now();
    let mut records: Vec<Record> = Vec::new();
    for number in 0..parts {
        if begun.elapsed() > SPREAD {
            break;
        }
        let first = number * (values.len() - length) / (PARTS - 1);
        let mut grid = grid.clone();
        grid.axes[inherit.axis].values = values[first..first + length].to_vec();
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

impl Found {
    /// Notes a record of a block of so many cases; without their number it does not count as one of them.
    fn add(&mut self, block: usize, cases: Option<usize>, record: &Record) {
        if let Some(cases) = cases {
            self.forecast.add(block, cases, (1, record.orbit.cycles));
        }
        self.blocks.insert(block);
        let is_kept = |every: usize, index: usize| (index / RUN).is_multiple_of(every);
        if is_kept(self.every, record.index) {
            self.records.push(record.clone());
        }
        self.met += 1;
        // The first cases of all chains are not like the others.
        if self.records.len() > 2 * WEIGHED {
            self.every *= 2;
            self.records.retain(|record| is_kept(self.every, record.index));
        }
    }

    /// Notes a tile that is done.
    fn keep_tile(&mut self, study: &Study, tile: usize, records: Vec<Record>) {
        self.most = self.most.max(records.len());
        if self.tiles_met.is_multiple_of(self.every_tile) {
            self.tiles.push((study.block_cases(tile), records));
        }
        self.tiles_met += 1;
        let of_case: usize = numbers_of_case(study).values().sum();
        let cases = |tiles: &[(Vec<usize>, Vec<Record>)]| -> usize {
            tiles.iter().map(|(cases, _)| cases.len()).sum()
        };
        // The first tiles that are done are not like the others.
        while self.tiles.len() > 1 && cases(&self.tiles) * of_case > NUMBERS {
            let mut kept = 0..;
            self.tiles.retain(|_| kept.next().is_some_and(|it: usize| it.is_multiple_of(2)));
            self.every_tile *= 2;
        }
    }

    /// The estimate for all cases.
    fn estimate(mut self, study: &Study, time: Duration) -> Result<Probe, CampaignError> {
        let (cases, cycles) = self.forecast.done();
        let pace = time.as_secs_f64() / cycles as f64;
        let scaled = |it: Estimate| Estimate { value: it.value * pace, error: it.error * pace };
        let seconds = self.forecast.cycles().map(scaled);
        self.records.sort_by_key(|record| record.index);
        self.records.dedup_by_key(|record| record.index);
        let packed = packed_bytes(study, &self.records).map_err(CampaignError::Packing)?;
        let weighed = packed as f64 / self.records.len() as f64;
        // Of a refined study fewer are kept than there are.
        let kept = if study.refine.is_some() { self.met as f64 / cases as f64 } else { 1.0 };
        let bytes = weighed * kept * study.cases() as f64;
        let file_bytes = match study.refine {
            None => file_bytes(study, &self.records)?,
            Some(_) => refined_file_bytes(study, &self.tiles, kept)?,
        };
        let sizes = (0..study.blocks()).map(|block| study.cases_of_block(block));
        let most = if self.most > 0 { self.most } else { sizes.max().unwrap_or(0) };
        let blocks = self.blocks.len();
        Ok(Probe { cases, blocks, time, seconds, most, bytes, file_bytes })
    }
}
