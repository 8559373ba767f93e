//! Writes a dataset whose largest variables are given slab by slab, so that it need not fit into memory.

use std::fs::File;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;

use hdf5::Dataset as Array;
use tempfile::NamedTempFile;

use super::decode::{Archive, hyperslab};
use super::element::Element;
use super::encode::{self, Scales};
use super::faults::faults;
use super::file::{folder, temporary};
use super::plain::place;
use super::slab::{MOST_NUMBERS, Slab, slabs};
use super::{Dataset, StoreError, Values, Variable, checksum, difference, file};

/// What HDF5 may write beside the numbers of a slab [bytes].
const BESIDE: u64 = 1 << 20;

/// A variable that is given slab by slab.
pub struct Column {
    /// Its name.
    pub name: String,
    /// Dimensions, unit, meaning and flags, and of the values the kind.
    pub label: Variable,
    /// Its shape: the axes of the study, then what each case has several of.
    pub shape: Vec<usize>,
    /// How many of its dimensions are axes of the study.
    pub axes: usize,
    /// The least and the greatest of its numbers, if they are integers and there are any.
    pub range: Option<[i64; 2]>,
}

/// Keeps `frame` and the `columns` in the file at `path`, replacing an older one
/// only by a complete new one; `numbers` gives what a slab has of a column, and `done` is called after each and
/// may break off, which leaves nothing behind.
///
/// The new file is written under a temporary name. Before each slab its disk space is reserved, as HDF5 may not
/// report a full disk; at the end every slab is read back and compared by its checksum.
pub fn write(
    frame: &Dataset,
    columns: &[Column],
    path: &Path,
    numbers: impl Fn(&Column, &Slab) -> Result<Values, StoreError>,
    done: impl Fn() -> ControlFlow<()>,
) -> Result<ControlFlow<()>, StoreError> {
    let faults = faults(frame);
    if !faults.is_empty() {
        return Err(StoreError::Unfit { path: path.to_owned(), faults });
    }
    let path = &place(path)?;
    let mut temporary =
        temporary(path, folder(path)).map_err(StoreError::system(path, "starting a new file"))?;
    let file = encode::blank(temporary.path(), |_| ())
        .map_err(StoreError::encoding(path, "starting a new file"))?;
    make_room(path, frame_bytes(frame))?;
    let scales = encode::lay_out(&file, frame, path)?;
    let mut sums = Vec::new();
    for column in columns {
        let array = begin(&file, column, &scales)
            .map_err(StoreError::encoding(path, format!("storing {}", column.name)))?;
        for slab in column.slabs() {
            let values = numbers(column, &slab)?;
            sums.push(checksum(&values));
            make_room(path, column.bytes_of(&values))?;
            let part = hyperslab(&slab, &column.shape);
            let put = column.element().write(&array, &values, part).and_then(|()| file.flush());
            put.map_err(StoreError::encoding(path, "storing a part of a variable"))?;
            if done().is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
    }
    drop(scales);
    file.close().map_err(StoreError::encoding(path, "completing the file"))?;
    complete(&mut temporary, path)?;
    check(&temporary, frame, columns, &sums, path)?;
    file::name(temporary, path).map(ControlFlow::Continue)
}

/// Adds the checksum to a file that is written, and forces the file to the disk.
fn complete(temporary: &mut NamedTempFile, path: &Path) -> Result<(), StoreError> {
    checksum::include_in(temporary.as_file_mut())
        .map_err(StoreError::system(path, "adding the checksum"))?;
    let synced = temporary.as_file().sync_all();
    synced.map_err(StoreError::system(path, "forcing the file to the disk"))
}

impl Column {
    /// The type of its numbers in the file.
    pub fn element(&self) -> Element {
        Element::of(&self.label, self.range)
    }

    /// Bytes of some of its numbers in the file.
    fn bytes_of(&self, values: &Values) -> u64 {
        (self.element().bytes() * values.shape().iter().product::<usize>()) as u64
    }

    /// The slabs of which its range is that of all numbers; none if they are reals.
    pub fn slabs_of_integers(&self) -> Vec<Slab> {
        match self.label.values {
            Values::Integer(_) => self.slabs(),
            Values::Real(_) => Vec::new(),
        }
    }

    /// The slabs in which it is written, none of which shares a chunk with another.
    fn slabs(&self) -> Vec<Slab> {
        let axes = self.axes;
        let width = self.shape[axes..].iter().product::<usize>().max(1);
        let chunk = encode::chunk_shape(&self.shape, self.element().bytes());
        slabs(&self.shape[..axes], &chunk[..axes], (MOST_NUMBERS / width).max(1))
    }
}

/// Pieces of all columns together.
pub fn count_slabs(columns: &[Column]) -> usize {
    columns.iter().map(|column| column.slabs().len()).sum()
}

fn begin(file: &hdf5::File, column: &Column, scales: &Scales) -> hdf5::Result<Array> {
    let array = column.element().create(file, &column.name, &column.shape)?;
    encode::label(&array, &column.label, column.element())?;
    encode::attach(&array, &column.name, &column.label, column.element(), scales)?;
    Ok(array)
}

/// Bytes that the numbers and texts of a dataset take at most.
fn frame_bytes(frame: &Dataset) -> u64 {
    let variables = frame.coordinates.iter().map(|(_, it)| it).chain(frame.variables.values());
    let numbers: usize = variables.map(|it| it.values.shape().iter().product::<usize>()).sum();
    let texts: usize = frame.texts.values().map(String::len).sum();
    (size_of::<f64>() * numbers + texts) as u64
}

/// Checks that so many bytes of numbers can be written beside `path`, with what HDF5 may add, on systems that can say so.
fn make_room(path: &Path, bytes: u64) -> Result<(), StoreError> {
    try_room(path, BESIDE + bytes).map_err(StoreError::system(path, "making room for the results"))
}

/// Writes so many bytes beside `path` and removes them.
fn try_room(path: &Path, bytes: u64) -> io::Result<()> {
    let file = temporary(path, folder(path))?;
    #[cfg(unix)]
    {
        use rustix::fs::{FallocateFlags, fallocate};
        use rustix::io::Errno;
        match fallocate(file.as_file(), FallocateFlags::empty(), 0, bytes) {
            Err(Errno::NOSYS | Errno::OPNOTSUPP | Errno::INVAL) | Ok(()) => {}
            Err(said) => return Err(said.into()),
        }
    }
    #[cfg(not(unix))]
    let _ = bytes;
    file.close()
}

/// The checksum of numbers in their order.
fn checksum(values: &Values) -> u32 {
    match values {
        Values::Real(reals) => checksum_of(reals.iter().map(|it| it.to_bits().to_le_bytes())),
        Values::Integer(integers) => checksum_of(integers.iter().map(|it| it.to_le_bytes())),
    }
}

/// The checksum of the bytes of numbers, of which many are taken at a time.
fn checksum_of(numbers: impl Iterator<Item = [u8; 8]>) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    let mut bytes = Vec::with_capacity(1 << 16);
    for number in numbers {
        bytes.extend_from_slice(&number);
        if bytes.len() >= 1 << 16 {
            sum.update(&bytes);
            bytes.clear();
        }
    }
    sum.update(&bytes);
    sum.finalize()
}

/// Reads everything back and compares it with what was to be written.
fn check(
    temporary: &NamedTempFile<File>,
    frame: &Dataset,
    columns: &[Column],
    sums: &[u32],
    path: &Path,
) -> Result<(), StoreError> {
    match first_difference(temporary, frame, columns, sums)? {
        Some(difference) => Err(StoreError::Unequal { path: path.to_owned(), difference }),
        None => Ok(()),
    }
}

/// Where a file that was written differs from what was to be written, if it does.
fn first_difference(
    temporary: &NamedTempFile<File>,
    frame: &Dataset,
    columns: &[Column],
    sums: &[u32],
) -> Result<Option<String>, StoreError> {
    let archive = match file::open(temporary.path()) {
        Ok(archive) => archive,
        Err(refused) => return Ok(Some(refused.to_string())),
    };
    let kept = archive.dataset(|name, _| columns.iter().all(|column| column.name != name))?;
    let difference = difference(frame, &kept);
    if difference.is_some() {
        return Ok(difference);
    }
    let mut sums = sums.iter();
    for column in columns {
        for slab in column.slabs() {
            if !same(&archive, column, &slab, sums.next()) {
                return Ok(Some(format!("the values of {}", column.name)));
            }
        }
    }
    Ok(None)
}

/// Whether a slab reads back with its checksum and its labels.
fn same(archive: &Archive, column: &Column, slab: &Slab, sum: Option<&u32>) -> bool {
    let Ok(Some(kept)) = archive.slab(&column.name, slab) else { return false };
    let Variable { dimensions, unit, long_name, flags, values } = &kept;
    let label = &column.label;
    (dimensions, unit, long_name, flags)
        == (&label.dimensions, &label.unit, &label.long_name, &label.flags)
        && Some(&checksum(values)) == sum
}
