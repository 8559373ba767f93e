//! What is done of a study that is computed in memory.

use std::sync::Arc;

use capsulemap::campaign::{InMemory, Moment};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use super::failure;
use super::labelled::{array, element, labels_of, of_dataset, type_name};

/// The cases of a study that were done at a moment. Numbers are put together as they are asked for.
#[pyclass(frozen)]
pub struct Partial {
    study: Arc<InMemory>,
    moment: Moment,
}

impl Partial {
    /// What was done at a moment of the computation of a study.
    pub fn new(study: Arc<InMemory>, moment: Moment) -> Partial {
        Partial { study, moment }
    }
}

#[pymethods]
impl Partial {
    /// All but the variables over the cases, as a dictionary.
    fn frame<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frame = py.detach(|| self.study.at(&self.moment).frame());
        of_dataset(py, frame)
    }

    /// The variables over the cases: name, dimensions, shape, type and attributes of each.
    #[expect(clippy::type_complexity)]
    fn labels<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<
        Vec<(String, Bound<'py, PyTuple>, Bound<'py, PyTuple>, &'static str, Bound<'py, PyDict>)>,
    > {
        let labels = py.detach(|| self.study.at(&self.moment).labels());
        let told = labels.into_iter().map(|it| {
            let own = labels_of(py, &it.name, &it.label, it.element)?;
            let dimensions = PyTuple::new(py, &it.label.dimensions)?;
            let shape = PyTuple::new(py, &it.shape)?;
            Ok((it.name, dimensions, shape, type_name(it.element), own))
        });
        told.collect()
    }

    /// The numbers of a variable over the cases: NaN, 0 or the outcome `missing` of those that were not done.
    fn numbers<'py>(&self, py: Python<'py>, name: String) -> PyResult<Bound<'py, PyAny>> {
        let found = py.detach(|| self.study.at(&self.moment).variable(&name));
        match found.map_err(|error| failure::of_campaign(py, error))? {
            Some(variable) => {
                let element = element(&variable);
                Ok(array(py, variable.values, element))
            }
            None => Err(failure::of_request(py, format!("there is no variable `{name}`"))),
        }
    }
}
