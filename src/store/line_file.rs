//! A file of lines of text that grows line by line: each is on the disk before the next, and what a kill leaves of one is dropped.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::StoreError;
use super::lock::{Lock, Tried, try_lock};

/// A file of lines that is open for more, and locked where the disk has locks.
#[derive(Debug)]
pub struct LineFile {
    file: Mutex<File>,
    path: PathBuf,
}

/// The whole lines of the file at `path`; none if it is not there.
///
/// Fails if the system refuses to read it, or it is no text.
pub fn read_lines(path: &Path) -> Result<Vec<String>, StoreError> {
    let failed = |said| StoreError::system(path, "reading lines", said);
    match std::fs::read(path) {
        Err(said) if said.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        bytes => whole_lines(bytes.map_err(failed)?).map_err(|_| damaged(path)),
    }
}

impl LineFile {
    /// Opens the file at `path`, or creates it, and returns the lines that it has; what is behind the last line end is removed.
    ///
    /// Fails if another process has it open here, if it is no text, or if the system refuses.
    pub fn open(path: &Path) -> Result<(LineFile, Vec<String>), StoreError> {
        let failed = |said| StoreError::system(path, "opening a file of lines", said);
        let mut options = OpenOptions::new();
        let opened = options.read(true).write(true).create(true).truncate(false).open(path);
        let mut file = opened.map_err(failed)?;
        if try_lock(&file, Lock::Exclusive).map_err(failed)? == Tried::Busy {
            return Err(StoreError::InUse { path: path.to_owned() });
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        let lines = whole_lines(bytes).map_err(|_| damaged(path))?;
        let length: usize = lines.iter().map(|line| line.len() + 1).sum();
        file.set_len(length as u64).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok((LineFile { file: Mutex::new(file), path: path.to_owned() }, lines))
    }

    /// Adds a line, which has no line end within; it is on the disk afterwards.
    ///
    /// Fails if the system refuses.
    pub fn add(&self, line: &str) -> Result<(), StoreError> {
        let failed = |said| StoreError::system(&self.path, "adding a line", said);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.write_all(format!("{line}\n").as_bytes()).map_err(failed)?;
        file.sync_data().map_err(failed)
    }

    /// Removes all lines.
    ///
    /// Fails if the system refuses.
    pub fn clear(&self) -> Result<(), StoreError> {
        let failed = |said| StoreError::system(&self.path, "removing lines", said);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.set_len(0).and_then(|()| file.rewind()).map_err(failed)
    }
}

/// The lines with an end.
fn whole_lines(mut bytes: Vec<u8>) -> Result<Vec<String>, std::string::FromUtf8Error> {
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
    bytes.truncate(whole);
    Ok(String::from_utf8(bytes)?.lines().map(str::to_owned).collect())
}

fn damaged(path: &Path) -> StoreError {
    let why = "it is not text in UTF-8".to_owned();
    StoreError::Foreign { path: path.to_owned(), why }
}

#[cfg(test)]
mod tests {
    use super::{LineFile, read_lines};

    #[test]
    fn what_is_torn_off_is_dropped_and_lines_go_on_behind_what_is_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("lines");
        assert_eq!(read_lines(&path).expect("it is not there"), Vec::<String>::new());
        std::fs::write(&path, "one\ntwo\nth").expect("it is written");
        assert_eq!(read_lines(&path).expect("it is read"), ["one", "two"]);
        let (file, lines) = LineFile::open(&path).expect("it opens");
        assert_eq!(lines, ["one", "two"]);
        assert!(LineFile::open(&path).is_err(), "it is locked");
        file.add("three").expect("a line is added");
        assert_eq!(read_lines(&path).expect("it is read"), ["one", "two", "three"]);
        file.clear().expect("it is cleared");
        file.add("four").expect("a line is added");
        assert_eq!(std::fs::read(&path).expect("it is read"), b"four\n");
    }
}
