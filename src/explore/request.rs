//! What a report is asked for.

use std::path::Path;

use crate::description::Output;
use crate::store::Archive;

/// What a report is made of.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The results.
    pub archive: &'a Archive,
    /// Their file, as commands name it.
    pub file: &'a Path,
    /// The output that should be small.
    pub of: Output,
}
