//! Where the bytes of a block are: in its file, or in memory.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where the bytes of a block are.
#[derive(Debug)]
pub enum BlockSource {
    /// In this file.
    File(PathBuf),
    /// In memory.
    Memory(Arc<[u8]>),
}

impl BlockSource {
    /// Where it is, for messages.
    pub fn path(&self) -> &Path {
        match self {
            BlockSource::File(path) => path,
            BlockSource::Memory(_) => Path::new("a block in memory"),
        }
    }

    /// The bytes from this one on.
    ///
    /// Fails if the file cannot be read.
    pub fn from(&self, first: u64) -> io::Result<Box<dyn Read + '_>> {
        Ok(match self {
            BlockSource::File(path) => {
                let mut file = File::open(path)?;
                file.seek(SeekFrom::Start(first))?;
                Box::new(file)
            }
            BlockSource::Memory(bytes) => {
                let place = usize::try_from(first).unwrap_or(usize::MAX);
                Box::new(bytes.get(place..).unwrap_or_default())
            }
        })
    }
}
