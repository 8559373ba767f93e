//! The library's errors as exceptions of the package.

use capsulemap::campaign::{CampaignError, Cause};
use capsulemap::store::StoreError;
use capsulemap::study::{Fault, Faults};
use pyo3::prelude::*;

/// Where the exceptions are defined.
const MODULE: &str = "capsulemap._errors";

/// A fault as Python has it: its line, if it has one, its key and what is wrong.
type Told = (Option<usize>, String, String);

/// An error of the library: `StudyError` for a mistake in what was asked, `MachineError` for a fault of the machine.
pub fn of_campaign(py: Python<'_>, error: CampaignError) -> PyErr {
    let told = error.to_string();
    match (error.cause(), error) {
        (_, CampaignError::Study(faults)) => of_faults(py, faults),
        (_, CampaignError::TradeOff { faults, .. }) => {
            let faults = faults.into_iter().map(|it| (None, String::new(), it)).collect();
            request(py, told, faults)
        }
        (Cause::Request, _) => request(py, told.clone(), vec![(None, String::new(), told)]),
        (Cause::Machine | Cause::Listener, _) => machine(py, told),
    }
}

/// An error of a file of results.
pub fn of_store(py: Python<'_>, error: StoreError) -> PyErr {
    match error {
        StoreError::Foreign { .. } | StoreError::NoPlace { .. } => {
            let told = error.to_string();
            request(py, told.clone(), vec![(None, String::new(), told)])
        }
        error => of_campaign(py, error.into()),
    }
}

/// The faults of a study, all at once.
pub fn of_faults(py: Python<'_>, faults: Faults) -> PyErr {
    let told = faults.to_string();
    let each = faults.faults.into_iter().map(|Fault { line, key, message }| (line, key, message));
    request(py, told, each.collect())
}

/// A mistake in what was asked, in one sentence.
pub fn of_request(py: Python<'_>, told: String) -> PyErr {
    request(py, told.clone(), vec![(None, String::new(), told)])
}

/// A fault of the machine.
pub fn machine(py: Python<'_>, told: String) -> PyErr {
    let raised = py.import(MODULE).and_then(|it| it.getattr("MachineError")?.call1((told,)));
    raised.map_or_else(|error| error, PyErr::from_value)
}

fn request(py: Python<'_>, told: String, faults: Vec<Told>) -> PyErr {
    let raised = py.import(MODULE).and_then(|it| it.getattr("_study_error")?.call1((told, faults)));
    raised.map_or_else(|error| error, PyErr::from_value)
}
