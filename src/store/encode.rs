//! Turns a dataset into an HDF5 file that netCDF-4 readers open with all its labels.
//!
//! A file that fits into memory is built there and handed out as bytes: HDF5 then never meets a full
//! disk, which it may report late or not at all.

use std::path::Path;

use hdf5::file::{FileAccessBuilder, LibraryVersion};
use hdf5::plist::file_create::LinkCreationOrder;
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset as Array, DatasetBuilder, File, H5Type, Hyperslab, Location};
use ndarray::{ArrayD, ArrayView1};

use super::attribute::{self, Attribute, TEXT_MEANING, attributes_of, constants, has_missing};
use super::catalogue::DIRECTION;
use super::element::Element;
use super::names::*;
use super::path::{self, auxiliary, paths};
use super::{Dataset, StoreError, Values, Variable, scale};

/// Chunks stay below HDF5's default cache, so that reading a slice unpacks each chunk once.
const CHUNK_BYTES: usize = 1 << 19;
/// Below this size the overhead of chunks outweighs what compression saves.
pub const COMPRESSED_FROM_BYTES: usize = 1 << 14;
/// Level of zlib: beyond it files hardly shrink and writing takes several times longer.
pub const COMPRESSION: u8 = 4;
/// Memory is claimed in steps of this size while the file grows.
const GROWTH_BYTES: usize = 1 << 20;

/// The coordinates of a file that is being written.
#[derive(Default)]
pub struct Scales {
    /// Those of its dimensions, in their order.
    of_dimensions: Vec<(String, Array)>,
    /// What varies along paths.
    paths: Vec<path::Path>,
}

/// The bytes of the file that holds `dataset`; `path` only names it in messages.
pub fn image(dataset: &Dataset, path: &Path) -> Result<Vec<u8>, StoreError> {
    // HDF5 takes two files in memory of one name for the same file, so there is one at a time.
    hdf5::sync::sync(|| {
        let file = blank(Path::new("capsulemap.nc"), |plist| {
            plist.core_options(GROWTH_BYTES, false);
        });
        let file = file.map_err(StoreError::encoding(path, "starting a file in memory"))?;
        drop(lay_out(&file, dataset, path)?);
        let image = file.flush().and_then(|()| scale::image(&file));
        image.map_err(StoreError::encoding(path, "completing the file"))
    })
}

/// Puts `dataset` into `file`; `path` only names it in messages.
pub fn lay_out(file: &File, dataset: &Dataset, path: &Path) -> Result<Scales, StoreError> {
    let mut scales = Scales { of_dimensions: Vec::new(), paths: paths(dataset) };
    for (name, coordinate) in &dataset.coordinates {
        let placed = put_coordinate(file, name, coordinate, scales.of_dimensions.len());
        let placed =
            placed.map_err(StoreError::encoding(path, format!("storing the coordinate {name}")))?;
        scales.of_dimensions.push((name.clone(), placed));
    }
    for (name, variable) in &dataset.variables {
        put_variable(file, name, variable, &scales)
            .map_err(StoreError::encoding(path, format!("storing the variable {name}")))?;
    }
    for (name, text) in &dataset.texts {
        put_text(file, name, text)
            .map_err(StoreError::encoding(path, format!("storing the text {name}")))?;
    }
    for (name, words) in &dataset.attributes {
        put_number_or_words(file, name, words)
            .map_err(StoreError::encoding(path, format!("storing the attribute {name}")))?;
    }
    // So that xarray does not spread them over the cases.
    let constants = constants(dataset);
    if !constants.is_empty() {
        put_attribute(file, COORDINATES, &constants.join(" "))
            .map_err(StoreError::encoding(path, format!("storing the attribute {COORDINATES}")))?;
    }
    Ok(scales)
}

/// An empty file, without times, so that the same dataset gives the same bytes.
pub fn blank(path: &Path, place: impl Fn(&mut FileAccessBuilder)) -> hdf5::Result<File> {
    let file = File::with_options()
        .with_fcpl(|plist| {
            // netCDF-4 shows variables in the order of creation, and asks for it to append.
            plist.obj_track_times(false).link_creation_order(LinkCreationOrder::Indexed)
        })
        .with_fapl(|plist| {
            place(plist);
            // Version 1.8 is the newest layout that every reader in use understands.
            plist.libver_bounds(LibraryVersion::Earliest, LibraryVersion::V18)
        })
        .create(path)?;
    put_attribute(&file, CONVENTIONS, CONVENTIONS_FOLLOWED)?;
    put_attribute(&file, FORMAT, FORMAT_WRITTEN)?;
    Ok(file)
}

fn put_coordinate(
    file: &File,
    name: &str,
    coordinate: &Variable,
    position: usize,
) -> hdf5::Result<Array> {
    let array = match name == DIRECTION.name {
        true => put_names(file, name, coordinate)?,
        false => put_labelled(file, name, coordinate)?,
    };
    scale::declare(&array, name)?;
    array.new_attr::<i32>().create(DIMENSION_ID)?.write_scalar(&(position as i32))?;
    Ok(array)
}

/// A category as the names of its values, by which xarray selects; the flags tell their numbers.
fn put_names(file: &File, name: &str, category: &Variable) -> hdf5::Result<Array> {
    let mut words = Vec::new();
    for word in category.names() {
        let word = word.ok_or_else(|| format!("{name} has a value without a name"))?;
        words.push(string(word)?);
    }
    let array = file.new_dataset_builder().with_data(ArrayView1::from(&words)).create(name)?;
    label(&array, category, Element::of(category, category.values.range()))?;
    Ok(array)
}

fn put_variable(file: &File, name: &str, variable: &Variable, scales: &Scales) -> hdf5::Result<()> {
    let array = put_labelled(file, name, variable)?;
    let element = Element::of(variable, variable.values.range());
    attach(&array, name, variable, element, scales)
}

/// Names the coordinates of a variable, and the number that stands for a missing one.
pub fn attach(
    array: &Array,
    name: &str,
    variable: &Variable,
    element: Element,
    scales: &Scales,
) -> hdf5::Result<()> {
    if has_missing(name, element) {
        element.put_fill_value(array)?;
    }
    let mut positions = Vec::new();
    for (dimension, along) in variable.dimensions.iter().enumerate() {
        let position = scales.of_dimensions.iter().position(|(scale, _)| scale == along);
        let position = position.ok_or_else(|| format!("no coordinate is called {along}"))?;
        scale::attach(array, &scales.of_dimensions[position].1, dimension)?;
        positions.push(position as i32);
    }
    if !positions.is_empty() {
        array.new_attr_builder().with_data(&positions).create(DIMENSION_IDS)?;
    }
    let auxiliary = auxiliary(&scales.paths, name, &variable.dimensions);
    if !auxiliary.is_empty() {
        put_attribute(array, COORDINATES, &auxiliary)?;
    }
    Ok(())
}

/// The numbers with their unit, meaning and flags.
fn put_labelled(file: &File, name: &str, variable: &Variable) -> hdf5::Result<Array> {
    let shape = variable.values.shape();
    let element = Element::of(variable, variable.values.range());
    let array = element.create(file, name, shape)?;
    element.write(&array, &variable.values, None)?;
    label(&array, variable, element)?;
    Ok(array)
}

/// Adds the unit, the meaning and the flags of a variable.
pub fn label(array: &Array, variable: &Variable, element: Element) -> hdf5::Result<()> {
    for (name, attribute) in attributes_of(variable) {
        match (attribute, element) {
            (Attribute::Words(words), _) => put_attribute(array, name, &words)?,
            (Attribute::Flags(all), Element::Byte) => put_flag_values(array, &all, |it| it as i8)?,
            (Attribute::Flags(all), Element::Int) => put_flag_values(array, &all, |it| it as i32)?,
            (Attribute::Flags(all), _) => put_flag_values(array, &all, |it| it)?,
            (Attribute::Whole(_) | Attribute::Real(_), _) => {}
        }
    }
    Ok(())
}

/// The integers that a category takes, in the type of the category, as CF asks.
fn put_flag_values<T: H5Type>(
    array: &Array,
    values: &[i64],
    narrow: impl Fn(i64) -> T,
) -> hdf5::Result<()> {
    let values: Vec<T> = values.iter().map(|value| narrow(*value)).collect();
    array.new_attr_builder().with_data(ArrayView1::from(&values)).create(FLAG_VALUES)?;
    Ok(())
}

impl Element {
    /// Names the number that stands for a missing one.
    fn put_fill_value(self, array: &Array) -> hdf5::Result<()> {
        match self {
            Element::Real => array.new_attr::<f64>().create(FILL_VALUE)?.write_scalar(&f64::NAN),
            Element::Byte => array.new_attr::<i8>().create(FILL_VALUE)?.write_scalar(&0),
            Element::Int => array.new_attr::<i32>().create(FILL_VALUE)?.write_scalar(&0),
            Element::Long => array.new_attr::<i64>().create(FILL_VALUE)?.write_scalar(&0),
        }
    }

    /// An array without its numbers.
    pub fn create(self, file: &File, name: &str, shape: &[usize]) -> hdf5::Result<Array> {
        let builder = file.new_dataset_builder();
        match self {
            Element::Real => create::<f64>(builder.fill_value(f64::NAN), name, shape),
            Element::Byte => create::<i8>(builder, name, shape),
            Element::Int => create::<i32>(builder, name, shape),
            Element::Long => create::<i64>(builder, name, shape),
        }
    }

    /// Writes numbers to an array, or to a part of it.
    pub fn write(
        self,
        array: &Array,
        values: &Values,
        part: Option<Hyperslab>,
    ) -> hdf5::Result<()> {
        match (self, values) {
            (Element::Real, Values::Real(reals)) => write(array, reals, part),
            (Element::Byte, Values::Integer(all)) => write(array, &all.mapv(|it| it as i8), part),
            (Element::Int, Values::Integer(all)) => write(array, &all.mapv(|it| it as i32), part),
            (Element::Long, Values::Integer(all)) => write(array, all, part),
            _ => Err("reals and integers are mixed".into()),
        }
    }
}

fn create<T: H5Type>(builder: DatasetBuilder, name: &str, shape: &[usize]) -> hdf5::Result<Array> {
    let bytes = shape.iter().product::<usize>() * size_of::<T>();
    let builder = if bytes >= COMPRESSED_FROM_BYTES {
        let chunked = builder.chunk(chunk_shape(shape, size_of::<T>()));
        // The file's own checksum serves this program; this one other readers, chunk by chunk.
        chunked.shuffle().deflate(COMPRESSION).fletcher32()
    } else {
        builder.no_chunk()
    };
    builder.empty::<T>().shape(shape).create(name)
}

fn write<T: H5Type + Clone>(
    array: &Array,
    values: &ArrayD<T>,
    part: Option<Hyperslab>,
) -> hdf5::Result<()> {
    let values = values.as_standard_layout();
    match part {
        Some(part) => array.write_slice(values.view(), part),
        None => array.write(values.view()),
    }
}

/// The whole array, halved along its longest side until a chunk fits.
pub fn chunk_shape(shape: &[usize], element: usize) -> Vec<usize> {
    let mut chunk = shape.to_vec();
    while chunk.iter().product::<usize>() * element > CHUNK_BYTES {
        if let Some(longest) = chunk.iter_mut().max() {
            *longest = longest.div_ceil(2);
        }
    }
    chunk
}

/// An attribute of the protocol as a number where it is one, any other as it is.
fn put_number_or_words(file: &File, name: &str, words: &str) -> hdf5::Result<()> {
    match attribute::number(name, words) {
        Attribute::Whole(whole) => file.new_attr::<i64>().create(name)?.write_scalar(&whole),
        Attribute::Real(real) => file.new_attr::<f64>().create(name)?.write_scalar(&real),
        _ => put_attribute(file, name, words),
    }
}

/// A string variable, which unlike an attribute may have any length.
fn put_text(file: &File, name: &str, text: &str) -> hdf5::Result<()> {
    let array = file.new_dataset::<VarLenUnicode>().create(name)?;
    array.write_scalar(&string(text)?)?;
    put_attribute(&array, LONG_NAME, TEXT_MEANING)
}

fn put_attribute(place: &Location, name: &str, words: &str) -> hdf5::Result<()> {
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
