//! What the search for attractors needs of the cases of a study, small enough to be held for millions.

use crate::attractor;
use crate::capsule::{Orbit, State};
use crate::study::Study;

use super::Record;

/// What a case has settled to.
pub type FinalMotion = attractor::FinalMotion<3>;

/// The summary of a case that settled to `orbit`.
pub fn final_motion(orbit: &Orbit) -> FinalMotion {
    let State { r, y1, y2, .. } = orbit.end;
    let (period, certificate) = (orbit.period as u32, &orbit.certificate);
    let (residual, multipliers) = (certificate.residual, &certificate.multipliers);
    attractor::FinalMotion::new(orbit.outcome, period, [r, y1, y2], residual, multipliers)
}

/// The summaries of the cases of a study by index; none for a case without a record.
pub fn final_motions(study: &Study, records: &[Record]) -> Vec<Option<FinalMotion>> {
    let mut final_motions = vec![None; study.cases()];
    for record in records {
        final_motions[record.index] = Some(final_motion(&record.orbit));
    }
    final_motions
}
