//! What figures are drawn from: results, motions found between their cases, and measured points.

use crate::campaign::KeptFront;
use crate::store::dataset::Dataset;

/// What figures are drawn from.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    /// Results.
    pub dataset: &'a Dataset,
    /// What was found between their cases, apart by the conditions that were kept.
    pub refined: &'a [KeptFront],
    /// Points that were measured.
    pub measured: Option<&'a Measured>,
}

impl<'a> From<&'a Dataset> for Shown<'a> {
    fn from(dataset: &'a Dataset) -> Self {
        Shown { dataset, refined: &[], measured: None }
    }
}

/// Points that were measured: a column for each quantity, by its name in files of results, all as long as each other [SI]; with `_error`
/// behind its name how far its values may be off.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// The columns.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Measured {
    /// The column called `name`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns.iter().find(|it| it.0 == name).map(|it| it.1.as_slice())
    }
}
