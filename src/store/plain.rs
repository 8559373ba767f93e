//! Plain files alone: no device is replaced, no pipe is waited for, and no link leads to what is another's.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use super::StoreError;
use crate::quantity::printable::printable;

/// File systems allow names of 255 bytes, and a file has a longer name until it is finished.
pub const LONGEST_NAME: usize = 243;

/// Why a path is none of a file of results that is not text.
pub const NO_TEXT: &str =
    "the name, or that of a folder it lies in, is not text in UTF-8, as names of HDF5 files are";

/// Opens a file of this program's own, which must be a plain one; where a link is in its place, it is not followed.
pub(super) fn open_own(path: &Path, options: &mut OpenOptions) -> io::Result<File> {
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        // A pipe is opened without a wait, and then seen to be one.
        let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
        options.custom_flags(flags.bits().cast_signed());
    }
    if path.is_symlink() {
        return Err(io::Error::other("it is a link, which is not followed here"));
    }
    let file = options.open(path)?;
    match file.metadata()?.is_file() {
        true => Ok(file),
        false => Err(io::Error::other("it is not a plain file")),
    }
}

/// Where a file that is to be written at `path` goes: there, or where a link there leads, so that not the link is replaced.
///
/// Fails if something else than a plain file is in its place, if a link leads to no file, or if the name is too long.
pub fn place(path: &Path) -> Result<PathBuf, StoreError> {
    let name = path.file_name().map_or(0, |name| name.len());
    if name > LONGEST_NAME {
        return Err(unfit(path, format!("the name has {name} bytes; {LONGEST_NAME} are the most")));
    }
    let found = match std::fs::symlink_metadata(path) {
        Ok(found) => found,
        Err(said) if said.kind() == io::ErrorKind::NotADirectory => {
            let file = path.ancestors().skip(1).find(|it| it.exists()).unwrap_or(path);
            return Err(unfit(path, format!("{} is a file, not a folder", printable(file))));
        }
        Err(_) => return Ok(path.to_owned()),
    };
    let is_link = found.is_symlink();
    match std::fs::metadata(path) {
        Ok(it) if it.is_file() && is_link => {
            std::fs::canonicalize(path).map_err(StoreError::system(path, "following the link"))
        }
        Ok(it) if it.is_file() => Ok(path.to_owned()),
        Ok(it) if it.is_dir() => Err(unfit(path, "is a folder; name a file")),
        Ok(_) => Err(unfit(path, "is not a plain file; name a file")),
        Err(_) if is_link => {
            Err(unfit(path, "is a link that leads to no file; remove it, or name another file"))
        }
        Err(said) => Err(StoreError::system(path, "looking at what is there")(said)),
    }
}

fn unfit(path: &Path, why: impl Into<String>) -> StoreError {
    StoreError::NoPlace { path: path.to_owned(), why: why.into() }
}
