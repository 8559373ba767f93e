//! Computes a few blocks of a study for a short time, to estimate what all would take.

use std::collections::BTreeSet;
use std::io;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::run::{Estimate, Forecast, Machine, Record, run_blocks};
use crate::store::packed_bytes;
use crate::study::{Study, spread};

use super::error::CampaignError;
use super::report::{Event, Report, Reports};

/// Records whose size is measured.
const WEIGHED: usize = 512;

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
    /// Size of all blocks [bytes]; NaN if no case was done.
    pub bytes: f64,
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
    let (blocks, records) = (BTreeSet::new(), Vec::new());
    let found = Mutex::new(Found { forecast, blocks, records, every: 1, met: 0 });
    let begun = Instant::now();
    let lock = || found.lock().unwrap_or_else(|it| it.into_inner());
    let each = |block: usize, record: &Record| {
        let cases = study.cases_of_block(block);
        reports.note(Event::Case { block, cases, record })?;
        lock().add(block, (study.refine.is_none()).then_some(cases), record);
        match begun.elapsed() < span {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    };
    let whole = |block: usize, records: Vec<Record>| {
        if study.refine.is_some() {
            let cycles = records.iter().map(|record| record.orbit.cycles).sum();
            lock().forecast.complete(block, study.cases_of_block(block), cycles);
        }
        ControlFlow::Continue(())
    };
    run_blocks(study, machine, &spread(study.blocks()), each, whole)?;
    reports.check()?;
    let time = begun.elapsed();
    let found = found.into_inner().unwrap_or_else(|it| it.into_inner());
    found.estimate(study, time).map_err(CampaignError::Packing)
}

impl Found {
    /// Notes a record of a block of so many cases; without their number it does not count as one of them.
    fn add(&mut self, block: usize, cases: Option<usize>, record: &Record) {
        if let Some(cases) = cases {
            self.forecast.add(block, cases, (1, record.orbit.cycles));
        }
        self.blocks.insert(block);
        if self.met.is_multiple_of(self.every) {
            self.records.push(record.clone());
        }
        self.met += 1;
        // The first cases of all chains are not like the others.
        if self.records.len() > 2 * WEIGHED {
            let mut kept = 0..;
            self.records.retain(|_| kept.next().is_some_and(|it: usize| it.is_multiple_of(2)));
            self.every *= 2;
        }
    }

    /// The estimate for all cases.
    fn estimate(&self, study: &Study, time: Duration) -> io::Result<Probe> {
        let (cases, cycles) = self.forecast.done();
        let pace = time.as_secs_f64() / cycles as f64;
        let scaled = |it: Estimate| Estimate { value: it.value * pace, error: it.error * pace };
        let seconds = self.forecast.cycles().map(scaled);
        let weighed = packed_bytes(study, &self.records)? as f64 / self.records.len() as f64;
        // Of a refined study fewer are kept than there are.
        let kept = if study.refine.is_some() { self.met as f64 / cases as f64 } else { 1.0 };
        let bytes = weighed * kept * study.cases() as f64;
        Ok(Probe { cases, blocks: self.blocks.len(), time, seconds, bytes })
    }
}
