//! The numbers that a file of results has of its cases, one for each: what varies, what is held, and what they have settled to.

use super::catalogue::{Flags, OUTCOME};
use super::{Archive, StoreError, Variable};
use crate::description::Description;
use crate::study::Coordinate;

/// The cases of a file of results.
#[derive(Debug)]
pub struct CaseTable<'a> {
    archive: &'a Archive,
    /// The dimensions over which the cases lie, slowest first, with their lengths.
    dimensions: Vec<(String, usize)>,
}

/// One number for each case, in the order of the cases.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// The numbers; categories by their codes.
    pub values: Vec<f64>,
    /// Their unit; "1" where there is none.
    pub unit: String,
    /// The categories by their codes; empty where there are none.
    pub flags: Flags,
}

impl<'a> CaseTable<'a> {
    /// The model whose cases they are.
    pub fn model(&self) -> &'static Description {
        self.archive.frame().model()
    }

    /// The cases of `archive`; none where it has no cases. Fails if the file cannot be read.
    pub fn of(archive: &'a Archive) -> Result<Option<CaseTable<'a>>, StoreError> {
        let Some(outcomes) = archive.variable(OUTCOME.name)? else { return Ok(None) };
        let lengths = outcomes.values.shape().iter().copied();
        let dimensions = outcomes.dimensions.iter().cloned().zip(lengths).collect();
        Ok(Some(CaseTable { archive, dimensions }))
    }

    /// Number of cases.
    pub fn cases(&self) -> usize {
        self.dimensions.iter().map(|(_, length)| length).product()
    }

    /// The names of the dimensions over which the cases lie, slowest first.
    pub fn dimensions(&self) -> impl Iterator<Item = &str> {
        self.dimensions.iter().map(|(name, _)| name.as_str())
    }

    /// What there is one number of for each case, by name.
    pub fn names(&self) -> Vec<String> {
        let axes = self.dimensions.iter().map(|(name, _)| name.clone());
        let variables = self.archive.variables();
        let fitting = variables.filter(|(name, over)| {
            over.is_empty() || self.is_over_cases(over) || self.is_along_path(name, over)
        });
        axes.chain(fitting.map(|(name, _)| name.to_owned())).collect()
    }

    fn is_over_cases(&self, dimensions: &[String]) -> bool {
        dimensions.iter().eq(self.dimensions.iter().map(|(name, _)| name))
    }

    /// Whether a quantity varies along a path of the cases, over whose dimension alone it lies.
    fn is_along_path(&self, name: &str, dimensions: &[String]) -> bool {
        let is_own = |dimension: &String| self.dimensions.iter().any(|(own, _)| own == dimension);
        let model = self.archive.frame().model();
        matches!(dimensions, [one] if is_own(one))
            && Coordinate::all(model).any(|it| it.name() == name)
    }

    /// The values along one of the dimensions, each repeated for its cases.
    fn repeated(&self, along: usize, values: &[f64]) -> Vec<f64> {
        let inner: usize = self.dimensions[along + 1..].iter().map(|(_, it)| it).product();
        (0..self.cases()).map(|case| values[case / inner % values.len()]).collect()
    }

    /// The numbers called `name`, of an axis or a constant repeated for each case; none where there is not one for each.
    /// Fails if the file cannot be read.
    pub fn column(&self, name: &str) -> Result<Option<Column>, StoreError> {
        if let Some(axis) = self.dimensions.iter().position(|(axis, _)| axis == name) {
            let Some(variable) = self.archive.frame().coordinate(name) else { return Ok(None) };
            let values: Vec<f64> = variable.values.to_real().into_iter().collect();
            return Ok(Some(column(variable, self.repeated(axis, &values))));
        }
        let Some(variable) = self.archive.variable(name)? else { return Ok(None) };
        let values: Vec<f64> = variable.values.to_real().into_iter().collect();
        if self.is_over_cases(&variable.dimensions) {
            return Ok(Some(column(&variable, values)));
        }
        if self.is_along_path(name, &variable.dimensions) {
            let path = &variable.dimensions[0];
            let axis = self.dimensions.iter().position(|(own, _)| own == path);
            return Ok(axis.map(|axis| column(&variable, self.repeated(axis, &values))));
        }
        let is_constant = variable.dimensions.is_empty() && values.len() == 1;
        Ok(is_constant.then(|| column(&variable, vec![values[0]; self.cases()])))
    }
}

fn column(variable: &Variable, values: Vec<f64>) -> Column {
    Column { values, unit: variable.unit.clone(), flags: variable.flags.clone() }
}
