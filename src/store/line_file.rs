//! A file of JSON objects that grows line by line: each is on the disk before the next, and has a checksum of its own.
//!
//! Nothing is changed before the next line is added, so that who opens a file can look first whether it is his own.

use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use super::StoreError;
use super::lock::{Lock, Tried, try_lock};
use super::plain::open_own;

/// What is between an object and its checksum at the end of a line, and behind it.
const CHECKSUM: [&str; 2] = [",\"checksum\":\"", "\"}"];

/// A file of lines that is open for more, and locked where the disk has locks.
#[derive(Debug)]
pub struct LineFile {
    open: Mutex<Open>,
    path: PathBuf,
}

/// The open file, and where the next line begins: behind the last line end.
#[derive(Debug)]
struct Open {
    file: File,
    end: u64,
}

/// What is in a file of lines; bytes that are no text are replaced, so that no checksum fits them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Lines {
    /// The lines with an end.
    pub whole: Vec<String>,
    /// What is behind the last line end: what a kill has left of a line.
    pub torn: String,
}

/// The lines of the file at `path`; none if it is not there.
///
/// Fails if it is no plain file, or if the system refuses to read it.
pub fn read_lines(path: &Path) -> Result<Lines, StoreError> {
    let mut options = OpenOptions::new();
    match open_own(path, options.read(true)) {
        Err(said) if said.kind() == io::ErrorKind::NotFound => Ok(Lines::default()),
        opened => {
            let found = opened.and_then(|mut file| lines(&mut file));
            Ok(found.map_err(StoreError::system(path, "reading lines"))?.0)
        }
    }
}

/// The object in a line, as text; none where its checksum does not fit.
pub fn unsealed(line: &str) -> Option<String> {
    let [before, behind] = CHECKSUM;
    let (object, sum) = line.strip_suffix(behind)?.rsplit_once(before)?;
    (sum == checksum(object)).then(|| format!("{object}}}"))
}

impl LineFile {
    /// Opens the file at `path`, or creates it, and returns what is in it, which stays as it is until a line is added.
    ///
    /// Fails if something else than a plain file is there, a link among them, if another process has it open here, or if the system
    /// refuses.
    pub fn open(path: &Path) -> Result<(LineFile, Lines), StoreError> {
        let failed = StoreError::system(path, "opening a file of lines");
        let mut options = OpenOptions::new();
        let opened = open_own(path, options.read(true).write(true).create(true).truncate(false));
        let mut file = opened.map_err(failed)?;
        if try_lock(&file, Lock::Exclusive).map_err(failed)? == Tried::Busy {
            return Err(StoreError::InUse { path: path.to_owned() });
        }
        let (lines, end) = lines(&mut file).map_err(failed)?;
        Ok((LineFile { open: Mutex::new(Open { file, end }), path: path.to_owned() }, lines))
    }

    /// Adds an object, which has a member, in place of what a kill has left of a line; it is on the disk afterwards.
    ///
    /// Fails if the system refuses; then no part of it stays, as far as the system allows.
    pub fn add(&self, object: &Value) -> Result<(), StoreError> {
        let line = sealed(object) + "\n";
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        open.add(line.as_bytes()).map_err(StoreError::system(&self.path, "adding a line"))
    }

    /// Removes all lines.
    ///
    /// Fails if the system refuses.
    pub fn clear(&self) -> Result<(), StoreError> {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        open.file.set_len(0).map_err(StoreError::system(&self.path, "removing lines"))?;
        open.end = 0;
        Ok(())
    }
}

impl Open {
    fn add(&mut self, line: &[u8]) -> io::Result<()> {
        self.file.set_len(self.end)?;
        self.file.seek(SeekFrom::Start(self.end))?;
        self.file.write_all(line)?;
        self.file.sync_data()?;
        self.end += line.len() as u64;
        Ok(())
    }
}

/// What is in a file, and where its last line ends.
fn lines(file: &mut File) -> io::Result<(Lines, u64)> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    let end = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
    let torn = String::from_utf8_lossy(&bytes[end..]).into_owned();
    // Not as lines of text, which may end in a carriage return, too.
    let whole = String::from_utf8_lossy(&bytes[..end]);
    let whole = whole.split_terminator('\n').map(str::to_owned).collect();
    Ok((Lines { whole, torn }, end as u64))
}

/// An object as a line whose last member is the checksum of what is before it.
pub fn sealed(object: &Value) -> String {
    let text = object.to_string();
    let open = text.strip_suffix('}').unwrap_or(&text);
    let [before, behind] = CHECKSUM;
    format!("{open}{before}{}{behind}", checksum(open))
}

fn checksum(text: &str) -> String {
    format!("{:08x}", crc32fast::hash(text.as_bytes()))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::{LineFile, Lines, read_lines, sealed, unsealed};

    fn is(whole: &[&str], torn: &str) -> Lines {
        Lines { whole: whole.iter().map(|it| (*it).to_owned()).collect(), torn: torn.to_owned() }
    }

    #[test]
    fn nothing_changes_until_a_line_takes_the_place_of_what_is_torn() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("lines");
        assert_eq!(read_lines(&path).expect("it is not there"), Lines::default());
        for text in ["one\ntwo\nth", "one\r\ntwo\r\nth", "th"] {
            std::fs::write(&path, text).expect("it is written");
            let (_, lines) = LineFile::open(&path).expect("it opens");
            assert_eq!(lines, read_lines(&path).expect("it is read"));
            assert_eq!(lines.torn, "th");
            assert_eq!(std::fs::read_to_string(&path).expect("it is read"), text);
        }
        std::fs::write(&path, "one\ntwo\nth").expect("it is written");
        let (file, _) = LineFile::open(&path).expect("it opens");
        assert!(LineFile::open(&path).is_err(), "it is locked");
        file.add(&json!({ "a": 1.5 })).expect("a line is added");
        let line = sealed(&json!({ "a": 1.5 }));
        assert_eq!(read_lines(&path).expect("it is read"), is(&["one", "two", &line], ""));
        file.clear().expect("it is cleared");
        file.add(&json!({ "a": 1.5 })).expect("a line is added");
        assert_eq!(std::fs::read_to_string(&path).expect("it is read"), line + "\n");
    }

    #[test]
    fn no_changed_byte_of_a_line_is_taken() {
        let line = sealed(&json!({ "found": [949.83, "\u{e9}"], "search": { "of": "power" } }));
        assert_eq!(
            unsealed(&line).expect("it fits"),
            "{\"found\":[949.83,\"\u{e9}\"],\"search\":{\"of\":\"power\"}}"
        );
        for place in 0..line.len() {
            for bit in 0..8 {
                let mut bytes = line.clone().into_bytes();
                bytes[place] ^= 1 << bit;
                assert_eq!(unsealed(&String::from_utf8_lossy(&bytes)), None, "{place} {bit}");
            }
            if line.is_char_boundary(place) {
                assert_eq!(unsealed(&line[..place]), None);
            }
        }
    }

    #[cfg(unix)]
    #[test]
    fn no_link_is_followed_and_no_pipe_is_waited_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let [path, other] = ["lines", "other"].map(|name| folder.path().join(name));
        std::fs::write(&other, "mine").expect("it is written");
        std::os::unix::fs::symlink(&other, &path).expect("a link");
        assert!(LineFile::open(&path).is_err() && read_lines(&path).is_err());
        assert_eq!(std::fs::read(&other).expect("it is read"), b"mine");
        std::fs::remove_file(&other).expect("it is removed");
        assert!(LineFile::open(&path).is_err() && !other.exists(), "a file behind the link");
        std::fs::remove_file(&path).expect("the link is removed");
        std::fs::create_dir(&path).expect("a folder");
        assert!(LineFile::open(&path).is_err() && read_lines(&path).is_err());
        std::fs::remove_dir(&path).expect("it is removed");
        let created = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(created.expect("it runs").success());
        assert!(LineFile::open(&path).is_err() && read_lines(&path).is_err());
    }
}
