//! Studies from text, and what Python asks of them.

use std::path::PathBuf;
use std::sync::Arc;

use capsulemap::campaign::{InMemory, OnDisk, Wanted, check_names, check_paths, read_study};
use capsulemap::study::{self, Fault, Faults};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::failure;
use super::job::{Job, Work};
use super::simulation::simulated;
use super::threads::machine;

/// A study that obeys all rules.
#[pyclass(frozen)]
pub struct Study(Arc<study::Study>);

#[pymethods]
impl Study {
    /// The study that a text says; `name` stands for its file in messages.
    ///
    /// Fails with all faults of the text at once.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str) -> PyResult<Study> {
        let study = study::Study::parse(name, text);
        let study = study.map_err(|faults| failure::of_faults(py, faults))?;
        Study::named(py, study, name)
    }

    /// The study that a text says which was put together from arguments: the faults tell no lines.
    #[staticmethod]
    fn built(py: Python<'_>, text: &str, name: &str) -> PyResult<Study> {
        let study = study::Study::parse(name, text).map_err(without_lines);
        let study = study.map_err(|faults| failure::of_faults(py, faults))?;
        Study::named(py, study, name)
    }

    /// The study in a file, with what it names beside it.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Study> {
        let study = py.detach(|| read_study(&path));
        let study = study.map_err(|error| failure::of_campaign(py, error))?;
        Ok(Study(Arc::new(study)))
    }

    /// Its text, which results keep.
    #[getter]
    fn text(&self) -> &str {
        &self.0.text
    }

    /// What was taken where the text leaves it open, and what has no effect, in sentences.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        let of_values =
            self.0.remarks_on_values().into_iter().chain(self.0.varied_without_effect());
        self.0.remarks.iter().cloned().chain(of_values).collect()
    }

    /// Number of values along each dimension of its results, by their names, slowest first.
    #[getter]
    fn sizes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let sizes = PyDict::new(py);
        for (name, length) in self.0.dimensions().into_iter().zip(self.0.shape()) {
            sizes.set_item(name, length)?;
        }
        Ok(sizes)
    }

    /// How many branches it asks for.
    #[getter]
    fn branches(&self) -> usize {
        self.0.branches.len()
    }

    /// Whether it asks for branches, ramps or the boundaries of its map.
    #[getter]
    fn has_more_than_cases(&self) -> bool {
        self.0.has_more_than_cases()
    }

    /// Begins to compute its cases, its branches, or both: in memory, or into a file where one is given.
    #[pyo3(signature = (cases, branches, file = None, overwrite = false))]
    fn begin(
        &self,
        py: Python<'_>,
        cases: bool,
        branches: bool,
        file: Option<PathBuf>,
        overwrite: bool,
    ) -> PyResult<Job> {
        let study = (*self.0).clone();
        let work = match file {
            None => Work::InMemory(Arc::new(InMemory::new(study, machine()))),
            Some(file) => Work::OnDisk(Box::new(OnDisk::new(study, file, machine(), overwrite))),
        };
        Job::begin(py, work, Wanted { cases, branches })
    }

    /// The first case from its start over so many cycles, as a dictionary: its sections and events.
    fn simulate<'py>(&self, py: Python<'py>, cycles: u64) -> PyResult<Bound<'py, PyDict>> {
        simulated(py, self.0.clone(), cycles)
    }
}

impl Study {
    fn named(py: Python<'_>, study: study::Study, name: &str) -> PyResult<Study> {
        let model = study.base.model();
        let checked = check_names(name, model).and_then(|()| check_paths(name, &study));
        checked.map_err(|error| failure::of_campaign(py, error))?;
        Ok(Study(Arc::new(study)))
    }
}

fn without_lines(faults: Faults) -> Faults {
    let each = faults.faults.into_iter().map(|it| Fault { line: None, ..it });
    Faults { file: faults.file, faults: each.collect() }
}
