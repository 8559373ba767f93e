//! The parallel run: chains of cases over all cores, in any order, to the same records.

use rayon::prelude::*;

use crate::model::State;
use crate::orbit::{Orbit, Outcome, settle};

use super::Study;

/// What came of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Index of the case in its study.
    pub index: usize,
    /// Where it started: as the study says, or where its neighbour settled.
    pub start: State<f64>,
    /// What it settled to.
    pub orbit: Orbit,
}

/// Runs every case of `study` on `threads` threads (all cores for none) and hands each record to
/// `keep`, which is called from any thread and in any order.
///
/// The records do not depend on the number of threads, nor on the order: a case depends on its own
/// parameters and start, or on its predecessor in its chain, alone.
pub fn run(
    study: &Study,
    threads: Option<usize>,
    keep: impl Fn(Record) + Sync,
) -> Result<(), RunError> {
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build().map_err(|error| RunError(error.to_string()))?;
    pool.install(|| {
        study.chains().into_par_iter().with_max_len(1).for_each(|chain| {
            run_chain(study, &chain, &keep);
        });
    });
    Ok(())
}

fn run_chain(study: &Study, chain: &[usize], keep: &impl Fn(Record)) {
    let mut settled = None;
    for &index in chain {
        let case = study.case(index);
        let start = settled.unwrap_or(case.start);
        let orbit = settle(&case.parameters, case.phase, start, &study.protocol);
        if study.follow.is_some() {
            // After a failure the next case starts afresh.
            let usable = orbit.outcome != Outcome::Failed;
            settled = usable.then_some(State { x2: case.start.x2, ..orbit.end });
        }
        keep(Record { index, start, orbit });
    }
}

/// The threads could not be started.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunError(String);

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the worker threads could not be started: {}", self.0)
    }
}

impl std::error::Error for RunError {}
