//! What a sweep would take: cases, time and disk space, estimated from a probe.

use std::path::Path;
use std::time::Duration;

use super::failure::Failure;
use super::readable::{count, counted, estimated, size, time};
use super::terminal::print;
use crate::campaign::{Probe, probe, silent};
use crate::run::{Machine, has_attractors};
use crate::study::Study;

/// The probe ends after this time, with what has been begun.
const PROBE: Duration = Duration::from_secs(5);

/// Computes a few blocks, spread over the study, and says what all would take. Writes nothing.
pub fn estimate(study: &Study, machine: Machine, output: &Path) -> Result<(), Failure> {
    let probe = probe(study, machine, PROBE, &silent)?;
    print(&text(study, machine, output, &probe))
}

fn text(study: &Study, machine: Machine, output: &Path, probe: &Probe) -> String {
    let (cases, blocks) = (count(study.cases()), counted(study.blocks(), "block"));
    let whole = probe.seconds.map_or("not known".to_owned(), estimated);
    let threads = match machine.threads {
        Some(threads) => threads,
        None => std::thread::available_parallelism().map_or(1, usize::from),
    };
    let threads = counted(threads, "thread");
    let more = if has_attractors(study) { ", and more to search for attractors" } else { "" };
    format!(
        "{}\n  cases  {cases} in {blocks}\n  time   {whole} with {threads}{more}\n  \
         room   {} for the blocks, and as much again while they are joined\n  \
         estimated from {} in {}, computed in {}; nothing was written\n",
        output.display(),
        size(probe.bytes),
        counted(probe.cases, "case"),
        counted(probe.blocks, "block"),
        time(probe.time.as_secs_f64())
    )
}
