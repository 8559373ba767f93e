//! Plain files alone: no device is replaced, no pipe is waited for, and no link leads to what is another's.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use super::StoreError;

/// File systems allow names of 255 bytes, and a file has a longer name until it is finished.
pub const LONGEST_NAME: usize = 243;

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
    let unfit = |why: String| Err(StoreError::NoPlace { path: path.to_owned(), why });
    let name = path.file_name().map_or(0, |name| name.len());
    if name > LONGEST_NAME {
        return unfit(format!("the name has {name} bytes; {LONGEST_NAME} are the most"));
    }
    let Ok(found) = std::fs::symlink_metadata(path) else { return Ok(path.to_owned()) };
    let is_link = found.is_symlink();
    match std::fs::metadata(path) {
        Ok(it) if it.is_file() && is_link => std::fs::canonicalize(path)
            .map_err(|said| StoreError::system(path, "following the link", said)),
        Ok(it) if it.is_file() => Ok(path.to_owned()),
        Ok(it) if it.is_dir() => unfit("is a folder; name a file".to_owned()),
        Ok(_) => unfit("is not a plain file; name a file".to_owned()),
        Err(_) if is_link => {
            unfit("is a link that leads to no file; remove it, or name another file".to_owned())
        }
        Err(said) => Err(StoreError::system(path, "looking at what is there", said)),
    }
}
