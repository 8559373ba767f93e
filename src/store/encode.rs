//! Turns a dataset into the bytes of an HDF5 file that netCDF-4 readers open with all its labels.
//!
//! The file is built in memory and handed out as bytes: HDF5 then never meets a full disk, which it
//! may report late or not at all, and everything that touches the disk is in one place.

use std::path::Path;

use hdf5::file::LibraryVersion;
use hdf5::plist::file_create::LinkCreationOrder;
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset as Array, DatasetBuilder, File, H5Type, Location};
use ndarray::{ArrayD, ArrayView1};

use super::names::*;
use super::{Dataset, StoreError, Values, Variable, scale};

/// Chunks stay below HDF5's default cache, so that reading a slice unpacks each chunk once.
const CHUNK_BYTES: usize = 1 << 19;
/// Below this size the overhead of chunks outweighs what compression saves.
const COMPRESSED_FROM_BYTES: usize = 1 << 14;
/// Level of zlib: beyond it files hardly shrink and writing takes several times longer.
const COMPRESSION: u8 = 4;
/// Memory is claimed in steps of this size while the file grows.
const GROWTH_BYTES: usize = 1 << 20;

/// The bytes of the file that holds `dataset`; `path` only names it in messages.
pub fn image(dataset: &Dataset, path: &Path) -> Result<Vec<u8>, StoreError> {
    // HDF5 takes two files in memory of one name for the same file, so there is one at a time.
    hdf5::sync::sync(|| lay_out(dataset, path))
}

fn lay_out(dataset: &Dataset, path: &Path) -> Result<Vec<u8>, StoreError> {
    let failed = |doing: String| move |said| StoreError::encoding(path, doing, said);
    let file = blank().map_err(failed("starting a file in memory".into()))?;
    let mut scales = Vec::new();
    for (name, coordinate) in &dataset.coordinates {
        let placed = put_coordinate(&file, name, coordinate, scales.len());
        scales.push((name, placed.map_err(failed(format!("storing the coordinate {name}")))?));
    }
    for (name, variable) in &dataset.variables {
        put_variable(&file, name, variable, &scales)
            .map_err(failed(format!("storing the variable {name}")))?;
    }
    for (name, text) in &dataset.texts {
        put_text(&file, name, text).map_err(failed(format!("storing the text {name}")))?;
    }
    for (name, words) in &dataset.attributes {
        put_words(&file, name, words).map_err(failed(format!("storing the attribute {name}")))?;
    }
    drop(scales);
    file.flush().and_then(|()| scale::image(&file)).map_err(failed("completing the file".into()))
}

/// An empty file in memory, without times, so that the same dataset gives the same bytes.
fn blank() -> hdf5::Result<File> {
    let file = File::with_options()
        .with_fcpl(|plist| {
            // netCDF-4 shows variables in the order of creation, and asks for it to append.
            plist.obj_track_times(false).link_creation_order(LinkCreationOrder::Indexed)
        })
        .with_fapl(|plist| {
            // Version 1.8 is the newest layout that every reader in use understands.
            plist
                .core_options(GROWTH_BYTES, false)
                .libver_bounds(LibraryVersion::Earliest, LibraryVersion::V18)
        })
        .create("capsulemap.nc")?;
    put_words(&file, CONVENTIONS, CONVENTIONS_FOLLOWED)?;
    put_words(&file, FORMAT, FORMAT_WRITTEN)?;
    Ok(file)
}

fn put_coordinate(
    file: &File,
    name: &str,
    coordinate: &Variable,
    position: usize,
) -> hdf5::Result<Array> {
    let array = put_labelled(file, name, coordinate)?;
    scale::declare(&array, name)?;
    array.new_attr::<i32>().create(DIMENSION_ID)?.write_scalar(&(position as i32))?;
    Ok(array)
}

fn put_variable(
    file: &File,
    name: &str,
    variable: &Variable,
    scales: &[(&String, Array)],
) -> hdf5::Result<()> {
    let array = put_labelled(file, name, variable)?;
    if let Values::Real(_) = variable.values {
        array.new_attr::<f64>().create(FILL_VALUE)?.write_scalar(&f64::NAN)?;
    }
    let mut positions = Vec::new();
    for (dimension, along) in variable.dimensions.iter().enumerate() {
        let position = scales.iter().position(|(scale, _)| *scale == along);
        let position = position.ok_or_else(|| format!("no coordinate is called {along}"))?;
        scale::attach(&array, &scales[position].1, dimension)?;
        positions.push(position as i32);
    }
    if !positions.is_empty() {
        array.new_attr_builder().with_data(&positions).create(DIMENSION_IDS)?;
    }
    Ok(())
}

/// The numbers with their unit, meaning and flags.
fn put_labelled(file: &File, name: &str, variable: &Variable) -> hdf5::Result<Array> {
    let flags: Vec<i64> = variable.flags.iter().map(|(value, _)| *value).collect();
    let array = match &variable.values {
        Values::Real(reals) => put_array(file, name, reals, Some(f64::NAN))?,
        Values::Integer(integers) => {
            let fits = |low: i64, high: i64| {
                integers.iter().chain(&flags).all(|value| (low..=high).contains(value))
            };
            if !flags.is_empty() && fits(i8::MIN.into(), i8::MAX.into()) {
                put_integers(file, name, integers, &flags, |value| value as i8)?
            } else if fits(i32::MIN.into(), i32::MAX.into()) {
                put_integers(file, name, integers, &flags, |value| value as i32)?
            } else {
                put_integers(file, name, integers, &flags, |value| value)?
            }
        }
    };
    put_words(&array, UNITS, &variable.unit)?;
    put_words(&array, LONG_NAME, &variable.long_name)?;
    if !flags.is_empty() {
        let meanings: Vec<&str> = variable.flags.iter().map(|(_, text)| text.as_str()).collect();
        put_words(&array, FLAG_MEANINGS, &meanings.join(" "))?;
    }
    Ok(array)
}

/// Integers in the type that `narrow` gives, which their flags share as CF asks.
fn put_integers<T: H5Type + Clone>(
    file: &File,
    name: &str,
    integers: &ArrayD<i64>,
    flags: &[i64],
    narrow: impl Fn(i64) -> T,
) -> hdf5::Result<Array> {
    let array = put_array(file, name, &integers.mapv(&narrow), None)?;
    if !flags.is_empty() {
        let flags: Vec<T> = flags.iter().map(|value| narrow(*value)).collect();
        array.new_attr_builder().with_data(ArrayView1::from(&flags)).create(FLAG_VALUES)?;
    }
    Ok(array)
}

fn put_array<T: H5Type + Clone>(
    file: &File,
    name: &str,
    values: &ArrayD<T>,
    missing: Option<f64>,
) -> hdf5::Result<Array> {
    let mut builder = file.new_dataset_builder();
    if let Some(missing) = missing {
        builder = builder.fill_value(missing);
    }
    let shape = values.shape();
    builder = if values.len() * size_of::<T>() >= COMPRESSED_FROM_BYTES {
        builder.chunk(chunk_shape(shape, size_of::<T>())).shuffle().deflate(COMPRESSION)
    } else {
        builder.no_chunk()
    };
    write_array(builder, name, values)
}

fn write_array<T: H5Type + Clone>(
    builder: DatasetBuilder,
    name: &str,
    values: &ArrayD<T>,
) -> hdf5::Result<Array> {
    let values = values.as_standard_layout();
    builder.with_data(values.view()).create(name)
}

/// The whole array, halved along its longest side until a chunk fits.
fn chunk_shape(shape: &[usize], element: usize) -> Vec<usize> {
    let mut chunk = shape.to_vec();
    while chunk.iter().product::<usize>() * element > CHUNK_BYTES {
        if let Some(longest) = chunk.iter_mut().max() {
            *longest = longest.div_ceil(2);
        }
    }
    chunk
}

/// A string variable, which unlike an attribute may have any length.
fn put_text(file: &File, name: &str, text: &str) -> hdf5::Result<()> {
    let array = file.new_dataset::<VarLenUnicode>().create(name)?;
    array.write_scalar(&string(text)?)?;
    put_words(&array, LONG_NAME, "text kept beside the numbers")
}

fn put_words(place: &Location, name: &str, words: &str) -> hdf5::Result<()> {
    place.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&string(words)?)
}

fn string(words: &str) -> hdf5::Result<VarLenUnicode> {
    Ok(words.parse::<VarLenUnicode>().map_err(|error| error.to_string())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_fit_and_keep_whole_arrays_whole() {
        assert_eq!(chunk_shape(&[100, 20], 8), [100, 20]);
        assert_eq!(chunk_shape(&[1 << 20], 8), [1 << 16]);
        assert_eq!(chunk_shape(&[1000, 1000], 8), [250, 250]);
    }
}
