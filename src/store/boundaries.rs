//! The variables of the boundaries of a map in a file of results, beside those of its branches, whose tables hold the curves.

use super::catalogue::{
    BOUNDARY_PAIRS, BOUNDARY_STATE, BOUNDARY_STATE_NAME, BOUNDARY_TRIES, REQUEST_KIND,
};
use super::{Dataset, Values};
use crate::run::MapBoundaries;
use crate::study::Study;

/// Adds which of the requests are boundaries of the map of a study, and what is known of its pairs of neighbours.
pub fn add_boundaries(dataset: &mut Dataset, study: &Study, boundaries: &MapBoundaries) {
    let kinds = study.branches.iter().map(|_| 0).chain(boundaries.followed.iter().map(|_| 1));
    dataset.put_column(REQUEST_KIND, Values::integers(kinds.collect()));
    let states = boundaries.pairs.len();
    dataset.put_coordinate(BOUNDARY_STATE, Values::count(states));
    let names = Values::integers((0..states as i64).collect());
    dataset.put_column(BOUNDARY_STATE_NAME, names);
    let pairs = boundaries.pairs.iter().map(|count| *count as i64).collect();
    dataset.put_column(BOUNDARY_PAIRS, Values::integers(pairs));
    let tries = boundaries.tries.iter().map(|count| *count as i64).collect();
    dataset.put_column(BOUNDARY_TRIES, Values::integers(tries));
}
