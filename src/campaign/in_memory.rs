//! A small study computed in memory, without a file.

use crate::run::{self, Machine, Record, has_attractors};
use crate::store::{self, Dataset, add_attractors};
use crate::study::Study;

use super::error::CampaignError;

/// The results of `study` as its file would hold them, from the records of all of its cases, in the order of their indices.
///
/// Fails if the threads cannot be started.
pub fn results_in_memory(
    study: &Study,
    records: &[Record],
    machine: Machine,
) -> Result<Dataset, CampaignError> {
    let mut results = store::dataset(study, records);
    if has_attractors(study) {
        let motions = run::final_motions(study, records);
        let attractors = run::attractors(study, &motions, machine, || ())?;
        let table = run::attractor_table(study, &attractors, &motions, machine)?;
        add_attractors(&mut results, study, &attractors, &table);
    }
    Ok(results)
}
