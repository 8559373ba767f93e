//! How thoroughly a fit to recorded histories is searched for.

use super::course::Weights;
use super::free_parameter::Free;
use super::history::{History, groups};
use super::least_squares::{Loss, Search};

/// A search ends where the sum of squares changes by less than this share.
const CONVERGED: f64 = 1e-9;
/// Evaluations of the model per parameter and start.
const PATIENCE: usize = 20;

/// How a fit to motion is searched for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// How residuals are weighed.
    pub loss: Loss,
    /// What they are divided by.
    pub weights: Weights,
    /// Starts within the bounds, the first at the values that the recordings have.
    pub starts: usize,
    /// Threads to use.
    pub threads: usize,
}

/// How the best unknowns of some courses are searched for.
pub(super) fn search<H: History>(courses: &[H], free: &[Free], effort: &Effort) -> Search {
    let of_starts = courses.iter().flat_map(History::bounds);
    Search {
        bounds: free.iter().map(|it| it.bounds).chain(of_starts).collect(),
        loss: effort.loss,
        groups: groups(courses),
        patience: PATIENCE,
        tolerance: CONVERGED,
    }
}
