//! Datasets of Python as files of results, which every command takes.

use std::path::PathBuf;

use capsulemap::store::catalogue::{OUTCOME, STUDY_TEXT};
use capsulemap::store::{self, Dataset, Values, Variable, is_of_format};
use capsulemap::study::Study;
use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::failure;

/// What stands for the file of the study in messages.
const STUDY: &str = "the study of the dataset";

/// What is to be done in place of a part of the results.
const WHOLE: &str = "give all of the results, before anything is selected or dropped, and choose by arguments (`where`, `at`)";

/// Writes a dataset, a dictionary as [of_dataset](super::labelled::of_dataset) makes them, to the file of results at a path. Attributes of
/// variables that no file of results has are left out.
///
/// Fails with `StudyError` where it is no whole dataset of a study, and with `MachineError` where it cannot be written.
#[pyfunction]
pub fn write_results(py: Python<'_>, path: PathBuf, raw: &Bound<'_, PyDict>) -> PyResult<()> {
    let dataset = read(raw)?;
    check_whole(py, &dataset)?;
    let written = py.detach(|| store::write(&dataset, &path));
    written.map_err(|error| failure::of_store(py, error))
}

fn read(raw: &Bound<'_, PyDict>) -> PyResult<Dataset> {
    let mut dataset = Dataset::default();
    let attributes: Bound<'_, PyDict> = raw.as_any().get_item("attributes")?.extract()?;
    for (name, value) in attributes {
        let name: String = name.extract()?;
        if !is_of_format(&name) {
            dataset.attributes.insert(name, words(&value)?);
        }
    }
    let variables: Bound<'_, PyDict> = raw.as_any().get_item("variables")?.extract()?;
    for (name, parts) in variables {
        let name: String = name.extract()?;
        let (dimensions, values, own): (Vec<String>, Bound<'_, PyAny>, Bound<'_, PyDict>) =
            parts.extract()?;
        let is_text = values.getattr("dtype")?.getattr("kind")?.extract::<String>()? == "U";
        if dimensions.is_empty() && is_text {
            dataset.texts.insert(name, values.call_method0("item")?.extract()?);
            continue;
        }
        let flags = flags(&own)?;
        let values = match is_text {
            true => Values::integers(codes(&values, &flags)?),
            false => numbers(&values)?,
        };
        let word = |key| own.get_item(key)?.map(|it| it.extract()).transpose();
        let labels = [
            word("units")?.unwrap_or_else(|| "1".to_owned()),
            word("long_name")?.unwrap_or_default(),
        ];
        let is_coordinate = dimensions == [name.as_str()];
        let variable = Variable::labelled(dimensions, labels, values).with_flags(flags);
        match is_coordinate {
            true => dataset.coordinates.push((name, variable)),
            false => drop(dataset.variables.insert(name, variable)),
        }
    }
    Ok(dataset)
}

/// An attribute in words, of which numbers are as the library reads them.
fn words(value: &Bound<'_, PyAny>) -> PyResult<String> {
    if let Ok(words) = value.extract::<String>() {
        return Ok(words);
    }
    if let Ok(whole) = value.extract::<i64>() {
        return Ok(whole.to_string());
    }
    value.extract::<f64>().map_or_else(|_| value.str()?.extract(), |real| Ok(format!("{real:e}")))
}

/// The numbers of a category with their meanings; none of another variable.
fn flags(own: &Bound<'_, PyDict>) -> PyResult<Vec<(i64, String)>> {
    let (Some(values), Some(meanings)) =
        (own.get_item("flag_values")?, own.get_item("flag_meanings")?)
    else {
        return Ok(Vec::new());
    };
    let listed = values.call_method0("tolist")?;
    let values = listed.extract().or_else(|_| listed.extract().map(|it: i64| vec![it]))?;
    let meanings: String = meanings.extract()?;
    Ok(values.into_iter().zip(meanings.split(' ').map(str::to_owned)).collect())
}

/// The numbers of names of a category.
fn codes(names: &Bound<'_, PyAny>, flags: &[(i64, String)]) -> PyResult<Vec<i64>> {
    let names: Vec<String> = names.call_method0("tolist")?.extract()?;
    let code = |name: &String| flags.iter().find(|it| it.1 == *name).map(|it| it.0);
    // A name without a number is found as a difference from the study.
    Ok(names.iter().map(|name| code(name).unwrap_or(i64::MIN)).collect())
}

fn numbers(values: &Bound<'_, PyAny>) -> PyResult<Values> {
    let is_real = values.getattr("dtype")?.getattr("kind")?.extract::<String>()? == "f";
    let kind = if is_real { "float64" } else { "int64" };
    let values = values.call_method1("astype", (kind,))?;
    Ok(match is_real {
        true => Values::Real(values.cast::<PyArrayDyn<f64>>()?.to_owned_array()),
        false => Values::Integer(values.cast::<PyArrayDyn<i64>>()?.to_owned_array()),
    })
}

/// Refuses what is no dataset of this program, and one of which cases were taken away.
fn check_whole(py: Python<'_>, dataset: &Dataset) -> PyResult<()> {
    let refused = |told: String| Err(failure::of_request(py, told));
    let Some(text) = dataset.texts.get(STUDY_TEXT) else {
        return refused(format!(
            "the dataset has no variable `{STUDY_TEXT}`: it is none of this program, or not all of it"
        ));
    };
    let study = Study::parse(STUDY, text).map_err(|faults| failure::of_faults(py, faults))?;
    for (name, expected) in store::frame(&study).coordinates {
        let found = dataset.coordinate(&name).map(|it| &it.values);
        if found != Some(&expected.values) {
            let (has, of) = (found.map_or(1, |it| it.shape()[0]), expected.values.shape()[0]);
            return refused(format!(
                "the dataset has {has} of the {of} values along `{name}`; {WHOLE}"
            ));
        }
    }
    for (name, variable) in &dataset.variables {
        if !variable.flags.is_empty() && matches!(variable.values, Values::Real(_)) {
            return refused(format!("`{name}` of the dataset lacks values; {WHOLE}"));
        }
    }
    if !store::has_cases(dataset) && !store::has_branches(dataset) {
        return refused(format!("the dataset has no `{}`; {WHOLE}", OUTCOME.name));
    }
    Ok(())
}
