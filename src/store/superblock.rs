//! Where an HDF5 file says that it ends: in its first bytes, the superblock.
//!
//! A library that opens a file to change it cuts off, at its close, what is behind that end. So the checksum at the end of this
//! program's files is claimed as a part of them: a file that was opened and closed keeps it, and one that was changed has a
//! checksum that does not fit, or is behind what was added.

/// The first bytes, up to the end of the field that is read here.
pub const HEAD_BYTES: usize = 48;
/// Where the version of the superblock is, and the one that the library writes for the layout of this program's files.
const VERSION: (usize, u8) = (8, 0);
/// Where the length of offsets is, and that which is read here [bytes].
const OFFSETS: (usize, u8) = (13, 8);
/// Where the end of the file is, lowest byte first, in version 0 (HDF5 File Format Specification, II.A).
const END: std::ops::Range<usize> = 40..48;

/// Moves the end of the file whose first bytes these are so many bytes on; returns where it was.
///
/// Nothing is moved, and there is no answer, where the superblock has another version.
pub fn extend(head: &mut [u8], bytes: usize) -> Option<u64> {
    if [VERSION, OFFSETS].iter().any(|(place, value)| head.get(*place) != Some(value)) {
        return None;
    }
    let field = head.get_mut(END)?;
    let end = u64::from_le_bytes(field.try_into().ok()?);
    field.copy_from_slice(&(end + bytes as u64).to_le_bytes());
    Some(end)
}
