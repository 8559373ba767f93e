//! What figures are drawn from: results, and motions found between their cases.

use crate::campaign::RefinedMotion;
use crate::store::dataset::Dataset;

/// What figures are drawn from.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// Results.
    pub dataset: &'a Dataset,
    /// Motions that were found between their cases.
    pub refined: &'a [RefinedMotion],
}

impl<'a> From<&'a Dataset> for Shown<'a> {
    fn from(dataset: &'a Dataset) -> Self {
        Shown { dataset, refined: &[] }
    }
}
