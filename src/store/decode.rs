//! Turns a file on disk back into the dataset it was made of, trusting nothing that it says.

use std::path::Path;

use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{Dataset as Array, File, Location};

use super::names::*;
use super::{Dataset, StoreError, Values, Variable};

/// zlib cannot shrink further than this, so a file that claims more is damaged.
const LARGEST_COMPRESSION: u64 = 1100;

/// The dataset in the file at `path`.
pub fn dataset(path: &Path) -> Result<Dataset, StoreError> {
    let failed = |doing: String| move |said| StoreError::decoding(path, doing, said);
    let file = File::open(path).map_err(failed("opening the file".into()))?;
    check_format(&file, path)?;
    let mut dataset = Dataset::default();
    let mut numbered = Vec::new();
    let mut waiting = Vec::new();
    let arrays = file.datasets().map_err(failed("listing the variables".into()))?;
    for array in arrays {
        let name = array.name().trim_start_matches('/').to_owned();
        let found = found(&array, &file, &name);
        match found.map_err(failed(format!("reading {name}")))? {
            Found::Text(text) => drop(dataset.texts.insert(name, text)),
            Found::Coordinate(id, variable) => numbered.push((id, (name, variable))),
            Found::Variable(ids, variable) => waiting.push((name, ids, variable)),
        }
    }
    numbered.sort_by_key(|(id, _)| *id);
    dataset.coordinates = numbered.into_iter().map(|(_, coordinate)| coordinate).collect();
    for (name, ids, mut variable) in waiting {
        variable.dimensions = dimensions(&dataset, &ids, &variable.values)
            .map_err(failed(format!("reading {name}")))?;
        dataset.variables.insert(name, variable);
    }
    dataset.attributes = attributes(&file).map_err(failed("reading the attributes".into()))?;
    Ok(dataset)
}

/// What a name in the file stands for; the numbers are positions among the coordinates.
enum Found {
    Text(String),
    Coordinate(i32, Variable),
    Variable(Vec<i32>, Variable),
}

fn check_format(file: &File, path: &Path) -> Result<(), StoreError> {
    let foreign = |why: String| StoreError::Foreign { path: path.to_owned(), why };
    let format =
        words(file, FORMAT).map_err(|_| foreign(format!("it has no attribute {FORMAT}")))?;
    if format != FORMAT_WRITTEN {
        return Err(foreign(format!(
            "its layout is {format:?} and this version reads {FORMAT_WRITTEN:?}"
        )));
    }
    Ok(())
}

fn found(array: &Array, file: &File, name: &str) -> hdf5::Result<Found> {
    if let TypeDescriptor::VarLenUnicode = array.dtype()?.to_descriptor()? {
        return Ok(Found::Text(text(array.read_scalar::<VarLenUnicode>()?)?));
    }
    let mut variable = Variable {
        dimensions: Vec::new(),
        unit: words(array, UNITS)?,
        long_name: words(array, LONG_NAME)?,
        values: values(array, file)?,
        flags: flags(array)?,
    };
    if has(array, DIMENSION_ID)? {
        variable.dimensions.push(name.to_owned());
        return Ok(Found::Coordinate(array.attr(DIMENSION_ID)?.read_scalar()?, variable));
    }
    let ids = match has(array, DIMENSION_IDS)? {
        true => array.attr(DIMENSION_IDS)?.read_raw()?,
        false => Vec::new(),
    };
    Ok(Found::Variable(ids, variable))
}

fn values(array: &Array, file: &File) -> hdf5::Result<Values> {
    let elements = array.shape().iter().fold(1_u64, |size, n| size.saturating_mul(*n as u64));
    if elements / LARGEST_COMPRESSION > file.size() {
        return Err(format!("it claims {elements} numbers, more than the file can hold").into());
    }
    match array.dtype()?.to_descriptor()? {
        TypeDescriptor::Float(_) => Ok(Values::Real(array.read_dyn()?)),
        TypeDescriptor::Integer(_) => Ok(Values::Integer(array.read_dyn()?)),
        other => Err(format!("its type is {other}, neither a number nor a text").into()),
    }
}

fn flags(array: &Array) -> hdf5::Result<Vec<(i64, String)>> {
    if !has(array, FLAG_VALUES)? {
        return Ok(Vec::new());
    }
    let values = array.attr(FLAG_VALUES)?.read_raw::<i64>()?;
    let meanings = words(array, FLAG_MEANINGS)?;
    let meanings: Vec<&str> = meanings.split(' ').collect();
    if values.len() != meanings.len() {
        let (values, meanings) = (values.len(), meanings.len());
        return Err(format!("{values} flags with {meanings} meanings").into());
    }
    Ok(values.into_iter().zip(meanings.into_iter().map(String::from)).collect())
}

/// The names of a variable's dimensions, checked against the lengths of those coordinates.
fn dimensions(dataset: &Dataset, ids: &[i32], values: &Values) -> hdf5::Result<Vec<String>> {
    let lengths = values.shape();
    if lengths.len() != ids.len() {
        return Err(format!("{} dimensions, {} of them named", lengths.len(), ids.len()).into());
    }
    let mut names = Vec::new();
    for (id, length) in ids.iter().zip(lengths) {
        let coordinate = usize::try_from(*id).ok().and_then(|id| dataset.coordinates.get(id));
        match coordinate {
            Some((name, axis)) if axis.values.shape() == [*length] => names.push(name.clone()),
            _ => return Err(format!("no coordinate {id} of length {length}").into()),
        }
    }
    Ok(names)
}

fn attributes(file: &File) -> hdf5::Result<std::collections::BTreeMap<String, String>> {
    let names = file.attr_names()?.into_iter();
    names
        .filter(|name| name != CONVENTIONS && name != FORMAT)
        .map(|name| words(file, &name).map(|words| (name, words)))
        .collect()
}

fn has(place: &Location, name: &str) -> hdf5::Result<bool> {
    Ok(place.attr_names()?.iter().any(|present| present == name))
}

fn words(place: &Location, name: &str) -> hdf5::Result<String> {
    text(place.attr(name)?.read_scalar::<VarLenUnicode>()?)
}

/// A damaged file may hold any bytes, so they are checked to be text.
fn text(string: VarLenUnicode) -> hdf5::Result<String> {
    let text = std::str::from_utf8(string.as_bytes());
    Ok(text.map_err(|_| "a text is not valid UTF-8")?.to_owned())
}
