//! The figures of a study are drawn before its cases are computed, without a value, so that a mistake in one is told before a long run.

use super::drawing::rehearse;
use super::failure::Failure;
use crate::figure::Place;
use crate::run::{AttractorTable, Attractors, has_attractors};
use crate::store::{self, Dataset};
use crate::study::Study;
use crate::study::layout::linked_axis;

/// More values on an axis than this are alike to every figure.
const MOST_VALUES: usize = 16;

/// Draws the figures of a study as if none of its cases had been computed yet.
///
/// Fails where one of them cannot be drawn of the results that the study will have.
pub fn rehearse_study(study: &Study, place: &Place<'_>) -> Result<(), Failure> {
    rehearse(&without_cases(study), study, place)
}

/// The results of a study of which no case is done, with no more values than figures look at, as each has
/// room for what its cases would have.
fn without_cases(study: &Study) -> Dataset {
    let mut small = study.clone();
    small.protocol.points = small.protocol.points.min(1);
    small.protocol.impact_points = small.protocol.impact_points.min(1);
    small.case_set.truncate(MOST_VALUES);
    if let Some(span) = &mut small.protocol.history {
        span.per_cycle = span.per_cycle.min(2);
    }
    let mut dataset = store::dataset(&small, &[]);
    if has_attractors(&small) {
        let (axis, of_case) = (linked_axis(&small), vec![None; small.cases()]);
        let unknown = Attractors { axis, of_case, ..Attractors::default() };
        store::add_attractors(&mut dataset, &small, &unknown, &AttractorTable::default());
    }
    dataset
}
