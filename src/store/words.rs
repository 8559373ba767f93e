//! Reads texts of an HDF5 file, whoever wrote them.

use hdf5::Location;
use hdf5::types::{FixedAscii, FixedUnicode, TypeDescriptor, VarLenUnicode};

/// Texts of a fixed length are no longer than this [bytes].
const LONGEST_TEXT: usize = 1024;

/// Whether something has an attribute.
pub(super) fn has(place: &Location, name: &str) -> hdf5::Result<bool> {
    Ok(place.attr_names()?.iter().any(|present| present == name))
}

/// An attribute as text, or another text where there is none.
pub(super) fn words_or(place: &Location, name: &str, without: &str) -> hdf5::Result<String> {
    match has(place, name)? {
        true => words(place, name),
        false => Ok(without.to_owned()),
    }
}

/// An attribute as text; netCDF-4 writes texts of a fixed length, too.
pub(super) fn words(place: &Location, name: &str) -> hdf5::Result<String> {
    let attribute = place.attr(name)?;
    match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::FixedAscii(length) if length <= LONGEST_TEXT => {
            Ok(attribute.read_scalar::<FixedAscii<LONGEST_TEXT>>()?.to_string())
        }
        TypeDescriptor::FixedUnicode(length) if length <= LONGEST_TEXT => {
            Ok(attribute.read_scalar::<FixedUnicode<LONGEST_TEXT>>()?.to_string())
        }
        _ => text(attribute.read_scalar::<VarLenUnicode>()?),
    }
}

/// A damaged file may hold any bytes, so they are checked to be text.
pub(super) fn text(string: VarLenUnicode) -> hdf5::Result<String> {
    let text = std::str::from_utf8(string.as_bytes());
    Ok(text.map_err(|_| "a text is not valid UTF-8")?.to_owned())
}
