//! A checksum behind the last byte of a result, so that damage is seen before HDF5 meets it.
//!
//! HDF5 checks its own structure only in part, some versions crash on a damaged file, and plain
//! numbers carry no checksum at all. Every reader ignores bytes behind the end that HDF5 knows.
//! A program that opens the file to change it drops the seal, and HDF5 is trusted as usual.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

/// What a seal begins with; the checksum of all bytes before follows, lowest byte first.
const MARK: &[u8] = b"capsulemap";
const SEAL_BYTES: usize = MARK.len() + 4;
/// Files are read in pieces of this size.
const PIECE_BYTES: usize = 1 << 20;

/// What a seal says of the bytes before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seal {
    /// They are as they were written.
    Whole,
    /// They have changed.
    Broken,
    /// Nothing: there is none.
    Absent,
}

/// Appends the seal of `bytes`.
pub fn put(bytes: &mut Vec<u8>) {
    let sum = crc32fast::hash(bytes);
    bytes.extend_from_slice(MARK);
    bytes.extend_from_slice(&sum.to_le_bytes());
}

/// Appends the seal of all bytes of a file, read again from its beginning.
pub fn put_on(file: &mut File) -> io::Result<()> {
    let mut sum = crc32fast::Hasher::new();
    let mut bytes = Vec::new();
    file.rewind()?;
    while file.take(PIECE_BYTES as u64).read_to_end(&mut bytes)? > 0 {
        sum.update(&bytes);
        bytes.clear();
    }
    file.seek(SeekFrom::End(0))?;
    file.write_all(MARK)?;
    file.write_all(&sum.finalize().to_le_bytes())
}

/// Reads `source` to its end and judges the seal found there.
pub fn judge(mut source: impl Read) -> io::Result<Seal> {
    let mut sum = crc32fast::Hasher::new();
    let mut bytes = Vec::new();
    loop {
        let read = source.by_ref().take(PIECE_BYTES as u64).read_to_end(&mut bytes)?;
        if read == 0 {
            break;
        }
        // The last bytes stay behind: they may be the seal, or the beginning of it.
        let body = bytes.len().saturating_sub(SEAL_BYTES);
        sum.update(&bytes[..body]);
        bytes.drain(..body);
    }
    let expected = [MARK, &sum.finalize().to_le_bytes()].concat();
    Ok(match bytes {
        seal if !seal.starts_with(MARK) => Seal::Absent,
        seal if seal == expected => Seal::Whole,
        _ => Seal::Broken,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_of_any_bit_breaks_the_seal() -> io::Result<()> {
        let mut bytes = b"some numbers".to_vec();
        assert_eq!(judge(&bytes[..])?, Seal::Absent);
        put(&mut bytes);
        assert_eq!(judge(&bytes[..])?, Seal::Whole);
        for bit in 0..8 * (bytes.len() - SEAL_BYTES) {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(judge(&bytes[..])?, Seal::Broken);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        Ok(())
    }

    #[test]
    fn a_file_is_sealed_as_its_bytes_are() -> io::Result<()> {
        let mut bytes: Vec<u8> = (0..PIECE_BYTES + 11).map(|i| (i % 251) as u8).collect();
        let mut file = tempfile::tempfile()?;
        file.write_all(&bytes)?;
        put_on(&mut file)?;
        put(&mut bytes);
        let mut kept = Vec::new();
        file.rewind()?;
        file.read_to_end(&mut kept)?;
        assert_eq!(kept, bytes);
        Ok(())
    }

    #[test]
    fn pieces_do_not_change_the_seal() -> io::Result<()> {
        for length in [0, 1, PIECE_BYTES - 5, PIECE_BYTES, PIECE_BYTES + 3, 3 * PIECE_BYTES] {
            let mut bytes: Vec<u8> = (0..length).map(|i| (i % 251) as u8).collect();
            put(&mut bytes);
            assert_eq!(judge(&bytes[..])?, Seal::Whole, "{length} bytes");
        }
        Ok(())
    }
}
