//! What a sweep would take: cases, time and room, foretold from a probe.

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use super::words::{count, counted, estimated, size, time};
use super::{Failure, print};
use crate::run::{Estimate, Forecast, Machine, Record, has_attractors, run_blocks};
use crate::store::packed_bytes;
use crate::study::{Study, spread};

/// The probe ends after this time, with what has been begun.
const PROBE: Duration = Duration::from_secs(5);
/// So many records are looked at for the room that they take.
const WEIGHED: usize = 512;

/// What the probe has found.
struct Probe {
    forecast: Forecast,
    /// Blocks that it has begun.
    blocks: BTreeSet<usize>,
    /// Some of the records.
    records: Vec<Record>,
}

/// Computes a few blocks, spread over the study, and says what all would take. Writes nothing.
pub fn foretell(study: &Study, machine: Machine, output: &Path) -> Result<(), Failure> {
    let forecast = Forecast::new(study.cases());
    let probe = Mutex::new(Probe { forecast, blocks: BTreeSet::new(), records: Vec::new() });
    let lock = || probe.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let begun = Instant::now();
    let each = |block: usize, record: &Record| {
        let mut probe = lock();
        probe.forecast.add(block, study.cases_of_block(block), (1, record.orbit.cycles));
        probe.blocks.insert(block);
        if probe.records.len() < WEIGHED {
            probe.records.push(record.clone());
        }
        match begun.elapsed() < PROBE {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    };
    let go_on = |_, _| ControlFlow::Continue(());
    run_blocks(study, machine, &spread(study.blocks()), each, go_on).map_err(Failure::machine)?;
    let took = begun.elapsed();
    print(&words(study, machine, output, &lock(), took).map_err(Failure::machine)?)
}

fn words(
    study: &Study,
    machine: Machine,
    output: &Path,
    probe: &Probe,
    took: Duration,
) -> std::io::Result<String> {
    let (cases, blocks) = (count(study.cases()), counted(study.blocks(), "block"));
    let (done, cycles) = probe.forecast.done();
    let pace = took.as_secs_f64() / cycles as f64;
    let whole = probe.forecast.cycles();
    let whole = whole.map(|it| Estimate { value: it.value * pace, error: it.error * pace });
    let whole = whole.map_or("not known".to_owned(), estimated);
    let weighed = packed_bytes(study, &probe.records)? as f64 / probe.records.len() as f64;
    let bytes = weighed * study.cases() as f64;
    let threads = match machine.threads {
        Some(threads) => threads,
        None => std::thread::available_parallelism().map_or(1, usize::from),
    };
    let threads = counted(threads, "thread");
    let more = if has_attractors(study) { ", and more to search for attractors" } else { "" };
    Ok(format!(
        "{}\n  cases  {cases} in {blocks}\n  time   {whole} with {threads}{more}\n  \
         room   {} for the blocks, and as much again while they are joined\n  \
         foretold by {} in {}, computed in {}; nothing was written\n",
        output.display(),
        size(bytes),
        counted(done, "case"),
        counted(probe.blocks.len(), "block"),
        time(took.as_secs_f64())
    ))
}
