//! What this program writes into a file and nothing else: arrays in the file itself, no larger than it can hold.
//!
//! HDF5 lets a file name other files for its objects and its numbers, which would be opened unasked, and claim sizes
//! that no memory has.

use hdf5::dataset::Layout;
use hdf5::{Attribute, Dataset as Array, File, H5Type, LinkType, Location, LocationType};

/// zlib cannot shrink further than this, so a file that claims more is damaged.
const LARGEST_COMPRESSION: u64 = 1100;

/// The arrays of a file by name.
///
/// # Errors
/// Where something is not an array in the file itself.
pub fn arrays(file: &File) -> hdf5::Result<Vec<(String, Array)>> {
    let mut names = Vec::new();
    file.iter_visit_default(|name, link| {
        names.push((name.to_owned(), link.link_type));
        Ok(())
    })?;
    let mut arrays = Vec::new();
    for (name, link) in names {
        if link != LinkType::Hard || file.loc_type_by_name(&name)? != LocationType::Dataset {
            return Err(format!("{name} is not an array in the file itself").into());
        }
        let array = file.dataset(&name)?;
        check(&array, &name, file)?;
        arrays.push((name, array));
    }
    Ok(arrays)
}

/// Refuses an array whose numbers lie elsewhere, or are more than the bytes it has in the file can stand for.
fn check(array: &Array, name: &str, file: &File) -> hdf5::Result<()> {
    let creation = array.dcpl()?;
    if creation.layout() == Layout::Virtual || !creation.external().is_empty() {
        return Err(format!("the numbers of {name} are in another place than the file").into());
    }
    let (stored, claimed) = (array.storage_size(), bytes(&array.shape(), array.dtype()?.size()));
    if stored > file.size() || claimed / LARGEST_COMPRESSION > stored {
        return Err(format!("{name} claims {claimed} bytes, more than the file can hold").into());
    }
    Ok(())
}

/// The numbers of an attribute.
///
/// # Errors
/// Where they are more than the file can hold.
pub fn attribute<T: H5Type>(place: &Location, name: &str, file: &File) -> hdf5::Result<Vec<T>> {
    let attribute: Attribute = place.attr(name)?;
    let claimed = bytes(&attribute.shape(), size_of::<T>());
    if claimed > file.size() {
        return Err(format!("{name} claims {claimed} bytes, more than the file can hold").into());
    }
    attribute.read_raw()
}

/// Bytes of so many elements of a size.
fn bytes(shape: &[usize], size: usize) -> u64 {
    shape.iter().fold(size as u64, |bytes, length| bytes.saturating_mul(*length as u64))
}
