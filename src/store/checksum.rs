//! A checksum behind the last byte of a file, so that damage is found before HDF5 reads the file.
//!
//! HDF5 checks its own structure only in part, some versions crash on a damaged file, and plain
//! numbers carry no checksum at all. HDF5 takes the checksum for a part of the file that nothing refers to (see
//! [`superblock`](super::superblock)), so that it stays where a program opens the file and closes it. A file that a program has changed
//! is refused, as it cannot be told from one that is damaged. The checksum guards against damage, not against a person who
//! forges it: HDF5 may crash on a forged file.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

use super::superblock;

/// Mark before the checksum of all bytes before the mark, lowest byte first.
const MARK: &[u8] = b"capsulemap";
/// Bytes of the mark and the checksum.
pub const CHECKSUM_BYTES: usize = MARK.len() + 4;
/// Bytes that are read at a time.
const READ_BYTES: usize = 1 << 20;

/// The checksum at the end of a file, compared with the bytes before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Checksum {
    /// It is that of the bytes.
    Valid,
    /// The bytes have changed.
    Invalid,
    /// There is none.
    Absent,
}

/// Makes the image of an HDF5 file end with the checksum, as a part of it.
pub fn include(image: &mut Vec<u8>) {
    superblock::extend(image, CHECKSUM_BYTES);
    append(image);
}

/// The same of a file that is open.
pub fn include_in(file: &mut File) -> io::Result<()> {
    let mut head = [0; superblock::HEAD_BYTES];
    file.rewind()?;
    file.read_exact(&mut head)?;
    superblock::extend(&mut head, CHECKSUM_BYTES);
    file.rewind()?;
    file.write_all(&head)?;
    append_to(file)
}

/// Appends the checksum of `bytes`.
pub fn append(bytes: &mut Vec<u8>) {
    let sum = crc32fast::hash(bytes);
    bytes.extend_from_slice(MARK);
    bytes.extend_from_slice(&sum.to_le_bytes());
}

/// Appends the checksum of all bytes of a file, read again from its beginning.
fn append_to(file: &mut File) -> io::Result<()> {
    let mut sum = crc32fast::Hasher::new();
    let mut bytes = Vec::new();
    file.rewind()?;
    while file.take(READ_BYTES as u64).read_to_end(&mut bytes)? > 0 {
        sum.update(&bytes);
        bytes.clear();
    }
    file.seek(SeekFrom::End(0))?;
    file.write_all(MARK)?;
    file.write_all(&sum.finalize().to_le_bytes())
}

/// Reads `source` to its end and compares the checksum there with the bytes before it.
pub fn check(mut source: impl Read) -> io::Result<Checksum> {
    let mut sum = crc32fast::Hasher::new();
    let mut bytes = Vec::new();
    loop {
        let read = source.by_ref().take(READ_BYTES as u64).read_to_end(&mut bytes)?;
        if read == 0 {
            break;
        }
        // The last bytes are kept: they may be the checksum, or the beginning of it.
        let body = bytes.len().saturating_sub(CHECKSUM_BYTES);
        sum.update(&bytes[..body]);
        bytes.drain(..body);
    }
    let expected = [MARK, &sum.finalize().to_le_bytes()].concat();
    Ok(match bytes {
        end if !end.starts_with(MARK) => Checksum::Absent,
        end if end == expected => Checksum::Valid,
        _ => Checksum::Invalid,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_of_any_bit_is_found() -> io::Result<()> {
        let mut bytes = b"some numbers".to_vec();
        assert_eq!(check(&bytes[..])?, Checksum::Absent);
        append(&mut bytes);
        assert_eq!(check(&bytes[..])?, Checksum::Valid);
        for bit in 0..8 * (bytes.len() - CHECKSUM_BYTES) {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(check(&bytes[..])?, Checksum::Invalid);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        Ok(())
    }

    #[test]
    fn the_checksum_of_a_file_is_that_of_its_bytes() -> io::Result<()> {
        let mut bytes: Vec<u8> = (0..READ_BYTES + 11).map(|i| (i % 251) as u8).collect();
        let mut file = tempfile::tempfile()?;
        file.write_all(&bytes)?;
        append_to(&mut file)?;
        append(&mut bytes);
        let mut kept = Vec::new();
        file.rewind()?;
        file.read_to_end(&mut kept)?;
        assert_eq!(kept, bytes);
        Ok(())
    }

    #[test]
    fn the_size_of_the_reads_does_not_change_the_checksum() -> io::Result<()> {
        for length in [0, 1, READ_BYTES - 5, READ_BYTES, READ_BYTES + 3, 3 * READ_BYTES] {
            let mut bytes: Vec<u8> = (0..length).map(|i| (i % 251) as u8).collect();
            append(&mut bytes);
            assert_eq!(check(&bytes[..])?, Checksum::Valid, "{length} bytes");
        }
        Ok(())
    }
}
