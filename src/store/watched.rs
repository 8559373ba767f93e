//! Whether a file that is open is still as it was when its checksum was looked at.

use std::fs::{File, Metadata};
use std::io;
use std::path::Path;
use std::time::SystemTime;

/// A file with its length and the time of its last change.
///
/// Assumes that who changes a file in place changes one of the two, which a program may forge.
#[derive(Debug)]
pub(super) struct Watched {
    file: File,
    state: State,
}

#[derive(Debug, PartialEq, Eq)]
struct State {
    /// Length [bytes].
    length: u64,
    modified: SystemTime,
}

impl Watched {
    /// The file as it is now; to be called before its bytes are read.
    pub fn new(file: File) -> io::Result<Watched> {
        let state = State::of(&file.metadata()?)?;
        Ok(Watched { file, state })
    }

    /// The file.
    pub fn file(&self) -> &File {
        &self.file
    }

    /// Whether it is as it was; one that another file has replaced still is, as long as it is open.
    pub fn is_unchanged(&self) -> io::Result<bool> {
        Ok(State::of(&self.file.metadata()?)? == self.state)
    }

    /// Whether it is still the file at `path`, which another may have replaced.
    pub fn is_at(&self, path: &Path) -> io::Result<bool> {
        Ok(place(&self.file.metadata()?) == place(&std::fs::metadata(path)?))
    }
}

impl State {
    fn of(metadata: &Metadata) -> io::Result<State> {
        Ok(State { length: metadata.len(), modified: metadata.modified()? })
    }
}

/// What tells a file from all others on the machine: its device and its number there.
#[cfg(unix)]
fn place(metadata: &Metadata) -> [u64; 2] {
    use std::os::unix::fs::MetadataExt;
    [metadata.dev(), metadata.ino()]
}

/// The same where the system tells neither.
#[cfg(not(unix))]
fn place(_: &Metadata) -> [u64; 2] {
    [0; 2]
}

#[cfg(test)]
mod tests {
    use std::fs::{self, OpenOptions};
    use std::io::Write;

    use super::*;

    #[test]
    fn a_file_that_is_changed_or_replaced_is_told() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let [path, other] = ["a", "b"].map(|name| folder.path().join(name));
        fs::write(&path, "first")?;
        let watched = Watched::new(File::open(&path)?)?;
        assert!(watched.is_unchanged()? && watched.is_at(&path)?);
        fs::write(&other, "second")?;
        fs::rename(&other, &path)?;
        // What is open is the older file, as it was.
        assert!(watched.is_unchanged()? && !watched.is_at(&path)?);
        let watched = Watched::new(File::open(&path)?)?;
        OpenOptions::new().append(true).open(&path)?.write_all(b"!")?;
        assert!(!watched.is_unchanged()? && watched.is_at(&path)?);
        let watched = Watched::new(File::open(&path)?)?;
        let mut same_length = OpenOptions::new().write(true).open(&path)?;
        // A file system tells times apart by some milliseconds.
        std::thread::sleep(std::time::Duration::from_millis(50));
        same_length.write_all(b"S")?;
        assert!(!watched.is_unchanged()?);
        Ok(())
    }
}
