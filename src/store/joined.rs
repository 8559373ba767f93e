//! Writes a dataset whose largest variables are given slab by slab, so that it need not fit into memory.

use std::fs::File;
use std::io;
use std::ops::ControlFlow;
use std::path::Path;

use hdf5::Dataset as Array;
use tempfile::NamedTempFile;

use super::decode::{Archive, hyperslab};
use super::encode::{self, Element, Scales};
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
    /// The least and the greatest of its numbers, if they are integers and there are any.
    pub range: Option<[i64; 2]>,
}

/// Keeps `frame` and the `columns`, which have `axes` axes, in the file at `path`, replacing an older one
/// only by a complete new one; `numbers` gives what a slab has of a column, and `done` is called after each and
/// may break off, which leaves nothing behind.
///
/// The new file is written under a temporary name. Before each slab its disk space is reserved, as HDF5 may not
/// report a full disk; at the end every slab is read back and compared by its checksum.
pub fn write(
    frame: &Dataset,
    (columns, axes): (&[Column], usize),
    path: &Path,
    numbers: impl Fn(&Column, &Slab) -> Result<Values, StoreError>,
    done: impl Fn() -> ControlFlow<()>,
) -> Result<ControlFlow<()>, StoreError> {
    let faults = faults(frame);
    if !faults.is_empty() {
        return Err(StoreError::Unfit { path: path.to_owned(), faults });
    }
    let path = &place(path)?;
    let failed = |doing| move |said| StoreError::system(path, doing, said);
    let mut temporary = temporary(path, folder(path)).map_err(failed("starting a new file"))?;
    let encoding = |doing: &'static str| move |said| StoreError::encoding(path, doing, said);
    let file = encode::blank(temporary.path(), |_| ()).map_err(encoding("starting a new file"))?;
    make_room(path, BESIDE + frame_bytes(frame)).map_err(failed("making room for the results"))?;
    let scales = encode::lay_out(&file, frame, path)?;
    let mut sums = Vec::new();
    for column in columns {
        let array = begin(&file, column, &scales)
            .map_err(|said| StoreError::encoding(path, format!("storing {}", column.name), said))?;
        for slab in column.slabs(axes) {
            let values = numbers(column, &slab)?;
            sums.push(checksum(&values));
            let bytes = column.element().bytes() * values.shape().iter().product::<usize>();
            make_room(path, BESIDE + bytes as u64)
                .map_err(failed("making room for the results"))?;
            let put = column.element().write(&array, &values, hyperslab(&slab, &column.shape));
            put.and_then(|()| file.flush()).map_err(encoding("storing a part of a variable"))?;
            if done().is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
    }
    drop(scales);
    file.close().map_err(encoding("completing the file"))?;
    checksum::include_in(temporary.as_file_mut()).map_err(failed("adding the checksum"))?;
    temporary.as_file().sync_all().map_err(failed("forcing the file to the disk"))?;
    check(&temporary, frame, (columns, axes), &sums, path)?;
    file::name(temporary, path).map(ControlFlow::Continue)
}

impl Column {
    fn element(&self) -> Element {
        Element::of(&self.label, self.range)
    }

    /// The slabs of which its range is that of all numbers; none if they are reals.
    pub fn slabs_of_integers(&self, axes: usize) -> Vec<Slab> {
        match self.label.values {
            Values::Integer(_) => self.slabs(axes),
            Values::Real(_) => Vec::new(),
        }
    }

    /// The slabs in which it is written, none of which shares a chunk with another.
    fn slabs(&self, axes: usize) -> Vec<Slab> {
        let width = self.shape[axes..].iter().product::<usize>().max(1);
        let chunk = encode::chunk_shape(&self.shape, self.element().bytes());
        slabs(&self.shape[..axes], &chunk[..axes], (MOST_NUMBERS / width).max(1))
    }
}

/// Pieces of all columns together.
pub fn count_slabs(columns: &[Column], axes: usize) -> usize {
    columns.iter().map(|column| column.slabs(axes).len()).sum()
}

fn begin(file: &hdf5::File, column: &Column, scales: &Scales) -> hdf5::Result<Array> {
    let array = column.element().create(file, &column.name, &column.shape)?;
    encode::label(&array, &column.label, column.element())?;
    encode::attach(&array, (&column.name, &column.label, column.element()), scales)?;
    Ok(array)
}

/// Bytes that the numbers and texts of a dataset take at most.
fn frame_bytes(frame: &Dataset) -> u64 {
    let variables = frame.coordinates.iter().map(|(_, it)| it).chain(frame.variables.values());
    let numbers: usize = variables.map(|it| it.values.shape().iter().product::<usize>()).sum();
    let texts: usize = frame.texts.values().map(String::len).sum();
    (size_of::<f64>() * numbers + texts) as u64
}

/// Checks that so many bytes can be written beside `path`, on systems that can say so.
fn make_room(path: &Path, bytes: u64) -> io::Result<()> {
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
    let mut sum = crc32fast::Hasher::new();
    let mut bytes = Vec::with_capacity(1 << 16);
    let mut add = |number: [u8; 8]| {
        bytes.extend_from_slice(&number);
        if bytes.len() >= 1 << 16 {
            sum.update(&bytes);
            bytes.clear();
        }
    };
    match values {
        Values::Real(reals) => reals.iter().for_each(|it| add(it.to_bits().to_le_bytes())),
        Values::Integer(integers) => integers.iter().for_each(|it| add(it.to_le_bytes())),
    }
    sum.update(&bytes);
    sum.finalize()
}

/// Reads everything back and compares it with what was to be written.
fn check(
    temporary: &NamedTempFile<File>,
    frame: &Dataset,
    (columns, axes): (&[Column], usize),
    sums: &[u32],
    path: &Path,
) -> Result<(), StoreError> {
    let unequal = |difference: String| StoreError::Unequal { path: path.to_owned(), difference };
    let archive = match file::open(temporary.path()) {
        Ok(archive) => archive,
        Err(refused) => return Err(unequal(refused.to_string())),
    };
    let is_column = |name: &str| columns.iter().any(|column| column.name == name);
    if let Some(difference) = difference(frame, &archive.dataset(|name, _| !is_column(name))?) {
        return Err(unequal(difference));
    }
    let mut sums = sums.iter();
    for column in columns {
        for slab in column.slabs(axes) {
            if !same(&archive, column, &slab, sums.next()) {
                return Err(unequal(format!("the values of {}", column.name)));
            }
        }
    }
    Ok(())
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
