//! Blocks that are held in memory, and their cases as one dataset, as the file would hold them.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::block_file::{self, Unusable};
use super::element::Element;
use super::join::Blocks;
use super::slab::Slab;
use super::{Dataset, StoreError, Variable, schema};
use crate::run::{InferredCases, Record};
use crate::study::Study;

/// A variable over the cases without its numbers.
#[derive(Debug, Clone)]
pub struct CaseVariable {
    /// Its name.
    pub name: String,
    /// Dimensions, unit, meaning and flags.
    pub label: Variable,
    /// Its shape: the axes of the study, then what each case has several of.
    pub shape: Vec<usize>,
    /// The type of its numbers in the file.
    pub element: Element,
}

impl<'a> Blocks<'a> {
    /// The blocks of `study` of which [images](super::block_image) are held, by their numbers; those without one are missing. The
    /// records of cases in missing blocks come `beside` them.
    pub fn of_images(
        study: &'a Study,
        images: &BTreeMap<usize, Arc<[u8]>>,
        beside: Vec<Record>,
    ) -> Blocks<'a> {
        let (mut files, mut missing) = (Vec::new(), Vec::new());
        for number in 0..study.blocks() {
            let image = images.get(&number).ok_or(Unusable::Missing);
            match image.and_then(|image| block_file::of_image(image.clone())) {
                Ok(file) => files.push(file),
                Err(why) => missing.push((number, why)),
            }
        }
        Blocks { study, files, missing, between: beside, inferred: InferredCases::default() }
    }

    /// The variables over the cases without their numbers.
    pub fn labels(&self) -> Vec<CaseVariable> {
        let models = schema::columns(self.study, &self.between);
        let columns = models.variables.iter().map(|(name, it)| self.column(name, it, &models));
        let labels = columns.map(|it| {
            let element = it.element();
            CaseVariable { name: it.name, label: it.label, shape: it.shape, element }
        });
        labels.collect()
    }

    /// A variable over the cases with its numbers; none if there is none of this name.
    ///
    /// Fails if a block cannot be read.
    pub fn variable(&self, name: &str) -> Result<Option<Variable>, StoreError> {
        let models = schema::columns(self.study, &self.between);
        let Some(model) = models.variables.get(name) else { return Ok(None) };
        self.filled(name, model, &models).map(|(_, variable)| Some(variable))
    }

    /// The dataset with all variables over the cases beside what `frame` holds, which is that of the blocks and may have more.
    ///
    /// Fails if a block cannot be read.
    pub fn gather(&self, frame: Dataset) -> Result<Dataset, StoreError> {
        let models = schema::columns(self.study, &self.between);
        let mut dataset = frame;
        for (name, model) in &models.variables {
            dataset.variables.extend([self.filled(name, model, &models)?]);
        }
        Ok(dataset)
    }

    /// A variable with its numbers, of which the dataset of the records beside has the `model`.
    fn filled(
        &self,
        name: &str,
        model: &Variable,
        models: &Dataset,
    ) -> Result<(String, Variable), StoreError> {
        let column = self.column(name, model, models);
        let values = self.fill(&column, models, &Slab::whole(&self.study.shape()))?;
        Ok((column.name, Variable { values, ..column.label }))
    }
}
