//! What a report is asked for.

use std::path::Path;

use crate::store::Archive;
use crate::tradeoff::GainAndCost;

/// What a report is made of.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The results.
    pub archive: &'a Archive,
    /// Their file, as commands name it.
    pub file: &'a Path,
    /// The outputs that should be large and small.
    pub of: GainAndCost,
}
