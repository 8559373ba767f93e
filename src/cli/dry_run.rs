//! What a sweep would take: cases, time and disk space, estimated from a probe.

use std::path::Path;
use std::time::Duration;

use super::failure::Failure;
use super::readable::{count, counted, estimated, size, time};
use super::terminal::print;
use crate::campaign::{Probe, memory, probe, silent};
use crate::figure::variables;
use crate::run::{Machine, has_attractors};
use crate::store;
use crate::study::Study;

/// Figures that take less memory are not mentioned [bytes].
const SMALL: f64 = 1e7;
/// The probe ends after this time, with what has been begun.
const PROBE: Duration = Duration::from_secs(5);

/// Computes a few blocks, spread over the study, and says what all would take. Writes nothing.
pub fn estimate(study: &Study, machine: Machine, output: &Path) -> Result<(), Failure> {
    let probe = probe(study, machine, PROBE, &silent)?;
    print(&text(study, machine, output, &probe))
}

fn text(study: &Study, machine: Machine, output: &Path, probe: &Probe) -> String {
    let (cases, blocks) = (count(study.cases()), counted(study.blocks(), "block"));
    let memory = memory(study, count_threads(machine));
    let [computing, joining] = [memory.computing, memory.joining].map(size);
    let whole = probe.seconds.map_or("not known".to_owned(), estimated);
    let threads = counted(count_threads(machine), "thread");
    let more = if has_attractors(study) { ", and more to search for attractors" } else { "" };
    let figures = figures(study).map_or(String::new(), |it| format!(", {} for a figure", size(it)));
    format!(
        "{}\n  cases  {cases} in {blocks}\n  time   {whole} with {threads}{more}\n  \
         room   {} for the blocks, and as much again while they are joined\n  \
         memory about {computing} while cases are computed, {joining} while they are joined{figures}\n  \
         estimated from {} in {}, computed in {}; nothing was written\n",
        output.display(),
        size(probe.bytes),
        counted(probe.cases, "case"),
        counted(probe.blocks, "block"),
        time(probe.time.as_secs_f64())
    )
}

/// Threads that compute.
fn count_threads(machine: Machine) -> usize {
    let all = || std::thread::available_parallelism().map_or(1, usize::from);
    machine.threads.unwrap_or_else(all)
}

/// The most memory that a figure of the study takes, which holds the variables that it shows [bytes]; none if that is
/// nothing beside the program.
fn figures(study: &Study) -> Option<f64> {
    let of_case = store::numbers_of_case(study);
    let numbers = |name: &str| of_case.get(name).copied().unwrap_or(0) as f64;
    let bytes = study.drawings.iter().map(|drawing| {
        let shown = variables(drawing);
        shown.iter().map(|name| numbers(name)).sum::<f64>() * study.cases() as f64 * 8.0
    });
    bytes.max_by(f64::total_cmp).filter(|&bytes| bytes > SMALL)
}
