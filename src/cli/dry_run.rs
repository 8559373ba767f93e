//! What a sweep would take: cases, time and room, foretold from a probe.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use super::words::{count, counted, estimated, size, time};
use super::{Failure, print};
use crate::store::packed_bytes;
use crate::sweep::{Estimate, Forecast, Machine, Study, has_attractors, run_blocks, spread};

/// The probe begins no more blocks after this time.
const PROBE: Duration = Duration::from_secs(5);

/// What the probe has found.
struct Probe {
    forecast: Forecast,
    blocks: usize,
    cases: usize,
    bytes: usize,
}

/// Computes a few blocks, spread over the study, and says what all would take. Writes nothing.
pub fn foretell(study: &Study, machine: Machine, output: &Path) -> Result<(), Failure> {
    let forecast = Forecast::new(study.cases());
    let found = Mutex::new(Probe { forecast, blocks: 0, cases: 0, bytes: 0 });
    let cycles = Mutex::new(0);
    let begun = Instant::now();
    let lock = || found.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let each = |record: &crate::sweep::Record| {
        *cycles.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) += record.orbit.cycles;
    };
    run_blocks(study, machine, &spread(study.blocks()), each, |_, records| {
        let cycles = records.iter().map(|record| record.orbit.cycles).sum();
        let bytes = packed_bytes(study, &records).unwrap_or(0);
        let mut probe = lock();
        probe.forecast.add(records.len(), cycles);
        probe.blocks += 1;
        probe.cases += records.len();
        probe.bytes += bytes;
        match begun.elapsed() < PROBE {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    })
    .map_err(Failure::machine)?;
    let took = begun.elapsed();
    let cycles = cycles.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    print(&words(study, machine, output, &lock(), (cycles, took)))
}

fn words(
    study: &Study,
    machine: Machine,
    output: &Path,
    probe: &Probe,
    (cycles, took): (u64, Duration),
) -> String {
    let (cases, blocks) = (count(study.cases()), counted(study.blocks(), "block"));
    let pace = took.as_secs_f64() / cycles as f64;
    let whole = probe.forecast.cycles();
    let whole = whole.map(|it| Estimate { value: it.value * pace, error: it.error * pace });
    let whole = whole.map_or("not known".to_owned(), estimated);
    let bytes = probe.bytes as f64 / probe.cases as f64 * study.cases() as f64;
    let threads = match machine.threads {
        Some(threads) => threads,
        None => std::thread::available_parallelism().map_or(1, usize::from),
    };
    let threads = counted(threads, "thread");
    let more = if has_attractors(study) { ", and more to search for attractors" } else { "" };
    format!(
        "{}\n  cases  {cases} in {blocks}\n  time   {whole} with {threads}{more}\n  \
         room   {} for the blocks, and as much again while they are joined\n  \
         foretold by {} in {}, computed in {}; nothing was written\n",
        output.display(),
        size(bytes),
        counted(probe.cases, "case"),
        counted(probe.blocks, "block"),
        time(took.as_secs_f64())
    )
}
