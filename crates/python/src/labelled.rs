//! The library's datasets as dictionaries of arrays with the attributes that the file has.

use capsulemap::store::catalogue::DIRECTION;
use capsulemap::store::{
    Attribute, Dataset, Element, TEXT_MEANING, Values, Variable, attributes_of, attributes_of_set,
    auxiliary, constants_beside_cases, has_missing, paths,
};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};

/// A dataset as `{"variables": {name: (dimensions, values, attributes)}, "attributes": {...}}`, as a reader of the file has it
/// before it decodes what is missing.
pub fn of_dataset(py: Python<'_>, dataset: Dataset) -> PyResult<Bound<'_, PyDict>> {
    let paths = paths(&dataset);
    let variables = PyDict::new(py);
    let attributes = PyDict::new(py);
    for (name, attribute) in attributes_of_set(&dataset) {
        attributes.set_item(name, value(py, attribute, Element::Long)?)?;
    }
    let constants = constants_beside_cases(&dataset);
    if !constants.is_empty() {
        attributes.set_item("coordinates", constants.join(" "))?;
    }
    for (name, text) in &dataset.texts {
        let own = PyDict::new(py);
        own.set_item("long_name", TEXT_MEANING)?;
        variables.set_item(name, (PyTuple::empty(py), text, own))?;
    }
    for (name, coordinate) in dataset.coordinates {
        let element = element(&coordinate);
        let own = labels(py, &coordinate, element)?;
        let dimensions = PyTuple::new(py, &coordinate.dimensions)?;
        let values = match name == DIRECTION.name {
            true => {
                let names = coordinate.names().into_iter().map(Option::unwrap_or_default);
                PyList::new(py, names.collect::<Vec<_>>())?.into_any()
            }
            false => array(py, coordinate.values, element),
        };
        variables.set_item(name, (dimensions, values, own))?;
    }
    for (name, variable) in dataset.variables {
        let element = element(&variable);
        let own = labels_of(py, &name, &variable, element)?;
        let auxiliary = auxiliary(&paths, &name, &variable.dimensions);
        if !auxiliary.is_empty() {
            own.set_item("coordinates", auxiliary)?;
        }
        let dimensions = PyTuple::new(py, &variable.dimensions)?;
        let values = array(py, variable.values, element);
        variables.set_item(name, (dimensions, values, own))?;
    }
    let both = PyDict::new(py);
    both.set_item("variables", variables)?;
    both.set_item("attributes", attributes)?;
    Ok(both)
}

/// The attributes of a variable that is no coordinate, the number that stands for a missing one among them.
pub fn labels_of<'py>(
    py: Python<'py>,
    name: &str,
    variable: &Variable,
    element: Element,
) -> PyResult<Bound<'py, PyDict>> {
    let own = labels(py, variable, element)?;
    if has_missing(name, element) {
        let missing = match element {
            Element::Real => PyArray1::from_slice(py, &[f64::NAN]).into_any(),
            Element::Byte => PyArray1::from_slice(py, &[0_i8]).into_any(),
            Element::Int => PyArray1::from_slice(py, &[0_i32]).into_any(),
            Element::Long => PyArray1::from_slice(py, &[0_i64]).into_any(),
        };
        own.set_item("_FillValue", missing.get_item(0)?)?;
    }
    Ok(own)
}

/// The numbers of a variable in the type that they have in the file.
pub fn array(py: Python<'_>, values: Values, element: Element) -> Bound<'_, PyAny> {
    match (values, element) {
        (Values::Real(reals), _) => reals.into_pyarray(py).into_any(),
        (Values::Integer(all), Element::Byte) => {
            all.mapv(|it| it as i8).into_pyarray(py).into_any()
        }
        (Values::Integer(all), Element::Int) => {
            all.mapv(|it| it as i32).into_pyarray(py).into_any()
        }
        (Values::Integer(all), _) => all.into_pyarray(py).into_any(),
    }
}

/// The type of the numbers of a variable in the file.
pub fn element(variable: &Variable) -> Element {
    Element::of(variable, variable.values.range())
}

/// The name of a type for arrays.
pub fn type_name(element: Element) -> &'static str {
    match element {
        Element::Real => "float64",
        Element::Byte => "int8",
        Element::Int => "int32",
        Element::Long => "int64",
    }
}

fn labels<'py>(
    py: Python<'py>,
    variable: &Variable,
    element: Element,
) -> PyResult<Bound<'py, PyDict>> {
    let own = PyDict::new(py);
    for (name, attribute) in attributes_of(variable) {
        own.set_item(name, value(py, attribute, element)?)?;
    }
    Ok(own)
}

/// An attribute, of which flags have the type of their variable.
fn value(py: Python<'_>, attribute: Attribute, element: Element) -> PyResult<Bound<'_, PyAny>> {
    Ok(match attribute {
        Attribute::Words(words) => words.into_pyobject(py)?.into_any(),
        Attribute::Whole(whole) => PyArray1::from_slice(py, &[whole]).get_item(0)?,
        Attribute::Real(real) => PyArray1::from_slice(py, &[real]).get_item(0)?,
        // As readers of a file have one flag alone.
        Attribute::Flags(flags) if flags.len() == 1 => {
            array(py, Values::integers(flags), element).get_item(0)?
        }
        Attribute::Flags(flags) => array(py, Values::integers(flags), element),
    })
}
