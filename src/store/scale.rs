//! The three calls of the HDF5 library that its Rust binding lacks, by `unsafe` calls.
//!
//! A *dimension scale* is HDF5's term for a coordinate: a dataset of one dimension that other
//! datasets name as the axis of theirs. Declared by hand as plain attributes it is understood by
//! some readers only, so the library itself must do it.
#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_uint};

use hdf5_sys::h5::herr_t;
use hdf5_sys::h5f::H5Fget_file_image;
use hdf5_sys::h5i::hid_t;

unsafe extern "C" {
    fn H5DSset_scale(scale: hid_t, name: *const c_char) -> herr_t;
    fn H5DSattach_scale(dataset: hid_t, scale: hid_t, dimension: c_uint) -> herr_t;
}

/// Declares `dataset` to be the coordinate called `name`.
pub fn declare(dataset: &hdf5::Dataset, name: &str) -> hdf5::Result<()> {
    let name = CString::new(name).map_err(|error| error.to_string())?;
    // SAFETY: the identifier lives as long as `dataset`, the string as long as `name`; the library
    // is entered by one thread at a time.
    hdf5::sync::sync(|| unsafe { hdf5::h5check(H5DSset_scale(dataset.id(), name.as_ptr())) })?;
    Ok(())
}

/// Names `scale` as the coordinate of `dataset` along `dimension`, slowest first.
pub fn attach(
    dataset: &hdf5::Dataset,
    scale: &hdf5::Dataset,
    dimension: usize,
) -> hdf5::Result<()> {
    let dimension = c_uint::try_from(dimension).map_err(|error| error.to_string())?;
    // SAFETY: both identifiers live as long as the borrowed datasets; the library is entered by
    // one thread at a time.
    hdf5::sync::sync(|| unsafe {
        hdf5::h5check(H5DSattach_scale(dataset.id(), scale.id(), dimension))
    })?;
    Ok(())
}

/// The bytes of an open, flushed file.
pub fn image(file: &hdf5::File) -> hdf5::Result<Vec<u8>> {
    // SAFETY: without a buffer the call only returns the length; with one it writes at most that
    // many bytes, all of which the vector owns. One lock spans both, so the length stays true.
    hdf5::sync::sync(|| unsafe {
        let length = H5Fget_file_image(file.id(), std::ptr::null_mut(), 0);
        let length = usize::try_from(length).map_err(|_| "the file has no image")?;
        let mut bytes = vec![0_u8; length];
        let copied = H5Fget_file_image(file.id(), bytes.as_mut_ptr().cast(), length);
        if usize::try_from(copied) == Ok(length) {
            Ok(bytes)
        } else {
            Err("the image is cut".into())
        }
    })
}
