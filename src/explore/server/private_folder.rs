//! A folder of the server among the temporary files of the machine, which its user alone can read.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::TempDir;

/// How the names of these folders begin.
const PREFIX: &str = "capsulemap-explore-";
/// How often a folder is created that another server takes for one that was left.
const TRIES: usize = 8;

/// A folder for what a server keeps while it runs.
///
/// A lock on it is held as long as the server lives, so that the next one tells the folders that killed servers have left, and
/// removes them. On a disk without locks they stay.
pub struct PrivateFolder {
    folder: TempDir,
    /// The folder, locked.
    _lock: Option<File>,
}

impl PrivateFolder {
    /// A new one among the temporary files of the machine; those that killed servers of the same user have left are removed.
    ///
    /// Fails if it cannot be created there.
    pub fn new() -> io::Result<PrivateFolder> {
        PrivateFolder::within(&std::env::temp_dir())
    }

    fn within(place: &Path) -> io::Result<PrivateFolder> {
        for _ in 0..TRIES {
            let folder = created(place)?;
            let lock = locked(folder.path());
            // Another server may have looked at it before it was locked.
            if folder.path().is_dir() {
                discard_left(place, folder.path());
                return Ok(PrivateFolder { folder, _lock: lock });
            }
        }
        Err(io::Error::other("each new folder is removed by another program"))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Puts a text into a new file there, which others cannot read.
    ///
    /// Fails if it cannot be written.
    pub fn put(&self, name: &str, text: &str) -> io::Result<PathBuf> {
        let path = self.path().join(name);
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(&path)?.write_all(text.as_bytes())?;
        Ok(path)
    }

    /// Removes a file from it, if it is there.
    pub fn remove(&self, name: &str) {
        // What cannot be removed goes with the folder.
        let _ = fs::remove_file(self.path().join(name));
    }

    /// Removes it with all that is in it, before the process ends.
    pub fn close(&self) {
        // What cannot be removed is left to the next server.
        let _ = fs::remove_dir_all(self.path());
    }
}

/// A new folder in `place`, of this user alone.
fn created(place: &Path) -> io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    builder.tempdir_in(place)
}

/// The folder with a lock on it; none where another holds one, or the disk has none.
fn locked(folder: &Path) -> Option<File> {
    let folder = File::open(folder).ok()?;
    folder.try_lock().ok().map(|()| folder)
}

/// Removes the folders that killed servers of the user of `own` have left in a place.
fn discard_left(place: &Path, own: &Path) {
    for entry in fs::read_dir(place).into_iter().flatten().flatten() {
        let is_named = entry.file_name().to_string_lossy().starts_with(PREFIX);
        let path = entry.path();
        if is_named && path != own && has_owner_of(own, &path) {
            // Its server lives as long as it is locked.
            if let Some(_lock) = locked(&path) {
                let _ = fs::remove_dir_all(&path);
            }
        }
    }
}

/// Whether a path is a folder, and no link to one, of the user who has the folder `own`.
#[cfg(unix)]
fn has_owner_of(own: &Path, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let [own, other] = [own, path].map(fs::symlink_metadata);
    matches!((own, other), (Ok(own), Ok(other)) if other.is_dir() && own.uid() == other.uid())
}

/// Whether a path is a folder: elsewhere temporary files are of one user.
#[cfg(not(unix))]
fn has_owner_of(_: &Path, path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|it| it.is_dir())
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::{PermissionsExt, symlink};

    use super::*;

    #[test]
    fn folders_that_were_left_are_removed_and_no_others() -> io::Result<()> {
        let place = tempfile::tempdir()?;
        let at = |name: &str| place.path().join(name);
        let first = PrivateFolder::within(place.path())?;
        let file = first.put("a", "text")?;
        let mode = |path: &Path| fs::metadata(path).map(|it| it.permissions().mode() & 0o777);
        assert_eq!((mode(first.path())?, mode(&file)?), (0o700, 0o600));
        fs::create_dir(at("capsulemap-explore-left"))?;
        fs::write(at("capsulemap-explore-left").join("b"), "text")?;
        fs::create_dir(at("other"))?;
        fs::write(at("other").join("mine"), "text")?;
        symlink(at("other"), at("capsulemap-explore-link"))?;
        fs::write(at("capsulemap-explore-file"), "text")?;
        let second = PrivateFolder::within(place.path())?;
        assert!(!at("capsulemap-explore-left").exists());
        assert!(file.is_file() && second.path().is_dir() && at("other").join("mine").is_file());
        assert!(at("capsulemap-explore-link").is_symlink());
        assert!(at("capsulemap-explore-file").is_file());
        // Of the user alone, whose folder it is, until it is closed.
        let kept = first.path().to_owned();
        first.close();
        assert!(!kept.exists());
        Ok(())
    }
}
