//! The program's library for Python: studies as text, their computation in memory, and files of results.
//!
//! The package `capsulemap` in `python/` wraps this module, and nothing here is meant to be called by anyone else. No rule of a
//! study and nothing of a motion is known here: texts go to the library, and its datasets go to Python.

mod described;
mod failure;
mod job;
mod labelled;
mod partial;
mod saved;
mod simulation;
mod study;
mod threads;

use pyo3::prelude::*;

/// The functions and classes behind the package `capsulemap`.
#[pymodule]
mod _capsulemap {
    use std::ffi::OsString;
    use std::path::PathBuf;

    use pyo3::prelude::*;
    use pyo3::types::PyDict;

    use super::failure;
    use super::labelled::of_dataset;
    use capsulemap::store;

    #[pymodule_export]
    use super::described::{describe, read_system, tests};
    #[pymodule_export]
    use super::job::Job;
    #[pymodule_export]
    use super::partial::Partial;
    #[pymodule_export]
    use super::saved::write_results;
    #[pymodule_export]
    use super::study::Study;
    #[pymodule_export]
    use super::threads::{set_threads, threads};

    /// Tells the library the commit that it is built from, as the command line does.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        store::provenance::built_from(capsulemap_commit::commit!());
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    /// The dataset in the file of results at a path, as a dictionary.
    ///
    /// Fails with `StudyError` where the file is none of this program, and with `MachineError` where it cannot be read.
    #[pyfunction]
    fn read_results(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
        let read = py.detach(|| store::open(&path)?.dataset(|_, _| true));
        of_dataset(py, read.map_err(|error| failure::of_store(py, error))?)
    }

    /// Runs the command line on these words, of which the first names the program; returns the exit code.
    #[pyfunction]
    fn command_line(py: Python<'_>, words: Vec<OsString>) -> u8 {
        py.detach(|| capsulemap::cli::run(capsulemap_commit::commit!(), words))
    }
}
