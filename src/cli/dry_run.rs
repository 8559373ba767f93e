//! What a sweep would take: cases, time and disk space, estimated from a probe.

use std::collections::BTreeSet;
use std::time::Duration;

use super::failure::Failure;
use super::readable::{count, counted, estimated, size, time};
use super::terminal::print;
use crate::campaign::{BlockStatus, Campaign, Probe, Task, memory, probe, silent};
use crate::figure::variables;
use crate::quantity::printable::printable;
use crate::run::{Estimate, has_attractors};
use crate::store;
use crate::study::{Study, spread};

/// What a figure takes beside the numbers that it shows, with its fonts and its picture in points [bytes].
const DRAWING: f64 = 4e7;
/// The probe ends after this time, with what has been begun.
const PROBE: Duration = Duration::from_secs(5);

/// Computes a few blocks, spread over the study, and says what all that a task has to compute would take. Keeps nothing.
pub fn estimate(campaign: &Campaign<'_>, task: Task) -> Result<(), Failure> {
    let blocks = campaign.status()?.blocks.unwrap_or_default();
    let probe = probe(campaign.study, campaign.machine, PROBE, &silent)?;
    print(&text(campaign, task, &blocks, &probe))
}

fn text(campaign: &Campaign<'_>, task: Task, blocks: &BlockStatus, probe: &Probe) -> String {
    let Campaign { study, machine, output, .. } = *campaign;
    let share = task.share(spread(study.blocks()));
    let done: BTreeSet<usize> = blocks.done.iter().map(|it| it.number).collect();
    let undone: Vec<usize> = share.iter().copied().filter(|block| !done.contains(block)).collect();
    let in_blocks = |some: &[usize]| some.iter().map(|it| study.cases_of_block(*it)).sum::<usize>();
    // What is done takes neither time nor room any more; the probe is a sample of all blocks.
    let left = in_blocks(&undone) as f64 / study.cases() as f64;
    let of_task = match task.of {
        1 => String::new(),
        _ => format!(
            "  {task}: {} with {}; time and room of the blocks are its own\n",
            counted(share.len(), "block"),
            counted(in_blocks(&share), "case")
        ),
    };
    let done = match blocks.done.len() {
        0 => String::new(),
        done => format!(
            "  done   {} with {}; what follows is of the rest\n",
            counted(done, "block"),
            counted(blocks.cases(), "case")
        ),
    };
    let (cases, all) = (count(study.cases()), counted(study.blocks(), "block"));
    let memory = memory(study, machine.threads(), probe);
    let [computing, joining] = [memory.computing, memory.joining].map(size);
    let seconds = seconds(probe, left, machine.threads());
    let more = more_for(&beside_cases(study));
    let attractors = has_attractors(study).then_some("attractors").into_iter();
    let beside = more_for(&attractors.chain(beside_cases(study)).collect::<Vec<_>>());
    let figures =
        figures(study).map_or(String::new(), |it| format!(", {} more for a figure", size(it)));
    format!(
        "{}\n  cases  {cases} in {all}\n{of_task}{done}  time   {seconds}{more}\n  \
         room   {} for the blocks until they are joined, {} for the file{beside}\n  \
         memory about {computing} while cases are computed, {joining} while they are joined{figures}\n  \
         estimated from {} in {}, computed in {}; nothing was kept\n",
        printable(output),
        size_or_not(probe.bytes * left),
        size_or_not(probe.file_bytes),
        counted(probe.cases, "case"),
        counted(probe.blocks, if study.refine.is_some() { "tile" } else { "block" }),
        time(probe.time.as_secs_f64())
    )
}

/// What `capsulemap continue` adds to the results of a study.
fn beside_cases(study: &Study) -> Vec<&'static str> {
    let asked = [
        (!study.branches.is_empty(), "branches"),
        (!study.ramps.is_empty(), "ramps"),
        (study.boundaries.is_some(), "boundaries"),
    ];
    asked.into_iter().filter(|(is_asked, _)| *is_asked).map(|(_, name)| name).collect()
}

/// That more is needed for all of these, if there are any.
fn more_for(all: &[&str]) -> String {
    match all {
        [] => String::new(),
        [one] => format!(", and more for {one}"),
        [first @ .., last] => format!(", and more for {} and {last}", first.join(", ")),
    }
}

/// The time of what is `left` of the cases, as a part of all, and of what comes after them, in words.
fn seconds(probe: &Probe, left: f64, threads: usize) -> String {
    let threads = counted(threads, "thread");
    let Some(all) = probe.seconds else { return format!("not known with {threads}") };
    let cases = Estimate { value: all.value * left, error: all.error * left };
    let searching = probe.searching;
    let whole = cases.value + searching.map_or(0.0, |it| it.value) + probe.writing;
    let attractors = searching.map(|it| format!("{} to search for attractors, ", estimated(it)));
    format!(
        "about {} with {threads}: {} for the cases, {}{} to write the file",
        time(whole),
        estimated(cases),
        attractors.unwrap_or_default(),
        time(probe.writing)
    )
}

/// A size, where it is known.
fn size_or_not(bytes: f64) -> String {
    if bytes.is_finite() { size(bytes) } else { "size not known".to_owned() }
}

/// The most memory that a figure of the study takes, which holds the variables that it shows [bytes]; none if it has no figure.
fn figures(study: &Study) -> Option<f64> {
    let of_case = store::numbers_of_case(study);
    let bytes = study.drawings.iter().map(|drawing| {
        let shown = variables(drawing, study.base.model());
        let numbers = shown.iter().map(|name| of_case.get(name).copied().unwrap_or(0) as f64);
        numbers.sum::<f64>() * study.cases() as f64 * 8.0
    });
    bytes.max_by(f64::total_cmp).map(|bytes| bytes + DRAWING)
}
