//! What figures are drawn from: results, motions found between their cases, and measured points.

use super::measured::Measured;
use crate::campaign::RefinedMotion;
use crate::store::dataset::Dataset;

/// What figures are drawn from.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// Results.
    pub dataset: &'a Dataset,
    /// Motions that were found between their cases.
    pub refined: &'a [RefinedMotion],
    /// Points that were measured.
    pub measured: Option<&'a Measured>,
}

impl<'a> From<&'a Dataset> for Shown<'a> {
    fn from(dataset: &'a Dataset) -> Self {
        Shown { dataset, refined: &[], measured: None }
    }
}
