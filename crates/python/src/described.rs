//! What a model says of itself: its parameters, choices, coordinates and outputs by name, with their units.

use std::path::PathBuf;

use capsulemap::campaign;
use capsulemap::description::Description;
use capsulemap::experiment::{Column, Test, columns_of_motion};
use capsulemap::of::{default_model, model_called};
use capsulemap::quantity::Dimension;
use capsulemap::store;
use capsulemap::study::{Coordinate, named_system};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::failure;

/// The name of the system in a file or a text, and the tables of a study that say it.
///
/// Fails with all faults of the system at once.
#[pyfunction]
#[pyo3(signature = (*, path = None, text = ""))]
pub fn read_system(
    py: Python<'_>,
    path: Option<PathBuf>,
    text: &str,
) -> PyResult<(&'static str, &'static str)> {
    let model = match path {
        Some(path) => campaign::read_system(&path),
        None => named_system::model_of("the system", text)
            .map_err(Into::into)
            .and_then(|model| campaign::check_names("the system", model).map(|()| model)),
    };
    let model = model.map_err(|error| failure::of_campaign(py, error))?;
    Ok((model.name, model.equations.map_or("", |it| it.tables)))
}

/// What is known of the model with this name, of the system of these tables, or of the model of a file of results; of the usual model
/// without all of them.
///
/// `parameters`, `coordinates` and `columns` (of the recording of a motion): the unit of a number, none where it has no unit; `choices`:
/// what may be chosen; `outputs`: unit and meaning; `told`: value without one being given, if there is one, and meaning of each parameter.
#[pyfunction]
#[pyo3(signature = (*, model = None, tables = None, results = None))]
pub fn describe<'py>(
    py: Python<'py>,
    model: Option<&str>,
    tables: Option<&str>,
    results: Option<PathBuf>,
) -> PyResult<Bound<'py, PyDict>> {
    if let Some(path) = results {
        let file = py.detach(|| store::open(&path));
        return told(py, file.map_err(|error| failure::of_store(py, error))?.frame().model());
    }
    let found = match (model, tables) {
        (_, Some(tables)) => named_system::known(tables),
        // A study says which models are known.
        (Some(name), None) => Some(model_called(name).unwrap_or_else(default_model)),
        (None, None) => Some(default_model()),
    };
    let unknown = || failure::of_request(py, "there is no such system".to_owned());
    told(py, found.ok_or_else(unknown)?)
}

fn told<'py>(py: Python<'py>, model: &'static Description) -> PyResult<Bound<'py, PyDict>> {
    let [parameters, told] = [PyDict::new(py), PyDict::new(py)];
    for parameter in model.parameters() {
        let (name, usual) = (parameter.symbol(), parameter.default_value());
        parameters.set_item(name, unit(parameter.dimension()))?;
        told.set_item(name, ((!usual.is_nan()).then_some(usual), parameter.meaning()))?;
    }
    let coordinates = PyDict::new(py);
    for coordinate in Coordinate::all(model) {
        if !matches!(coordinate, Coordinate::Parameter(_)) {
            coordinates.set_item(coordinate.name(), unit(coordinate.dimension()))?;
        }
    }
    let choices = PyDict::new(py);
    for choice in model.choices {
        choices.set_item(choice.name, choice.options.to_vec())?;
    }
    let outputs = PyDict::new(py);
    for output in model.outputs() {
        outputs.set_item(output.name(), (output.unit(), output.meaning()))?;
    }
    let all = PyDict::new(py);
    all.set_item("name", model.name)?;
    all.set_item("columns", columns(py, &columns_of_motion(model))?)?;
    all.set_item("parameters", parameters)?;
    all.set_item("told", told)?;
    all.set_item("coordinates", coordinates)?;
    all.set_item("choices", choices)?;
    all.set_item("outputs", outputs)?;
    Ok(all)
}

/// The units of the columns of the recordings that identify constants of a rig, by the names of the tests.
#[pyfunction]
pub fn tests(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let tests = PyDict::new(py);
    for test in Test::ALL {
        tests.set_item(test.name(), columns(py, &test.columns())?)?;
    }
    Ok(tests)
}

fn columns<'py>(py: Python<'py>, all: &[Column]) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    for column in all {
        columns.set_item(column.name, unit(column.dimension))?;
    }
    Ok(columns)
}

/// The unit of a quantity; none of a plain number.
fn unit(dimension: Dimension) -> Option<&'static str> {
    (dimension != Dimension::Number).then(|| dimension.unit())
}
