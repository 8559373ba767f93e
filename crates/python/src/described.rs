//! What a model says of itself: its parameters, choices, coordinates and outputs by name, with their units.

use std::path::PathBuf;

use capsulemap::campaign;
use capsulemap::description::Description;
use capsulemap::of::{default_model, model_called};
use capsulemap::quantity::Dimension;
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

/// What is known of the model with this name, or of the system of these tables; of the usual model without both.
///
/// `parameters` and `coordinates`: the unit of a number, none where it has no unit; `choices`: what may be chosen; `outputs`: unit and
/// meaning.
#[pyfunction]
#[pyo3(signature = (*, model = None, tables = None))]
pub fn describe<'py>(
    py: Python<'py>,
    model: Option<&str>,
    tables: Option<&str>,
) -> PyResult<Bound<'py, PyDict>> {
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
    let parameters = PyDict::new(py);
    for parameter in model.parameters() {
        parameters.set_item(parameter.symbol(), unit(parameter.dimension()))?;
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
    all.set_item("parameters", parameters)?;
    all.set_item("coordinates", coordinates)?;
    all.set_item("choices", choices)?;
    all.set_item("outputs", outputs)?;
    Ok(all)
}

/// The unit of a quantity; none of a plain number.
fn unit(dimension: Dimension) -> Option<&'static str> {
    (dimension != Dimension::Number).then(|| dimension.unit())
}
