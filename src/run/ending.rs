//! What the search for attractors needs of the cases of a study, small enough to be held for millions.

use crate::attractor::Summary;
use crate::capsule::{Orbit, State};
use crate::study::Study;

use super::Record;

/// What a case has settled to.
pub type Ending = Summary<3>;

/// The summary of a case that settled to `orbit`.
pub fn ending(orbit: &Orbit) -> Ending {
    let State { r, y1, y2, .. } = orbit.end;
    let (period, certificate) = (orbit.period as u32, &orbit.certificate);
    let (residual, multipliers) = (certificate.residual, &certificate.multipliers);
    Summary::new(orbit.outcome, period, [r, y1, y2], residual, multipliers)
}

/// The summaries of the cases of a study by index; none for a case without a record.
pub fn endings(study: &Study, records: &[Record]) -> Vec<Option<Ending>> {
    let mut endings = vec![None; study.cases()];
    for record in records {
        endings[record.index] = Some(ending(&record.orbit));
    }
    endings
}
