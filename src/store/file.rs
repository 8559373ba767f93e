//! Puts a dataset on disk whole or not at all, and reads it back.

use std::fs::File;
use std::io::{self, Read, Seek, Write};
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use tempfile::NamedTempFile;

use super::catalogue::{OWN_TEXT, SYSTEM_TEXT};
use super::checksum::{self, Checksum};
use super::decode::Archive;
use super::faults::faults;
use super::input::{Pipes, open_input};
use super::lock::{Lock, Tried, try_lock};
use super::names::MODEL;
use super::plain::{NO_TEXT, place};
use super::watched::Watched;
use super::{Dataset, StoreError, difference, encode};
use crate::of::model_called;
use crate::study::{named_system, own_outputs};

/// How often a folder is tried that another run holds, and the time between two tries: ten minutes in all.
const HOLD_TRIES: u32 = 3000;
const HOLD_PAUSE: Duration = Duration::from_millis(200);
/// Without locks, a file that is still unfinished after this time was abandoned: a figure is written in less.
const ABANDONED: Duration = Duration::from_secs(3600);
/// The first bytes of every HDF5 file.
const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";

/// Keeps `dataset` in the file at `path`, replacing an older one only by a complete new one.
///
/// The bytes go to a temporary file in the same folder, are forced to the disk, read back and
/// compared, and only then take the name `path`. After an error nothing is left behind and an
/// older file is as it was; a reader that has the older one open keeps reading it.
pub fn write(dataset: &Dataset, path: &Path) -> Result<(), StoreError> {
    let path = &place(path)?;
    let faults = faults(dataset);
    if !faults.is_empty() {
        return Err(StoreError::Unfit { path: path.to_owned(), faults });
    }
    let mut image = encode::image(dataset, path)?;
    checksum::include(&mut image);
    let file = filled(begun(path)?, path, &image)?;
    drop(image);
    let unequal = match read(file.path()) {
        Ok(kept) => difference(dataset, &kept),
        Err(refused) => Some(refused.to_string()),
    };
    if let Some(difference) = unequal {
        return Err(StoreError::Unequal { path: path.to_owned(), difference });
    }
    name(file, path)
}

/// Creates a folder, and those it lies in.
pub fn create_folder(folder: &Path) -> Result<(), StoreError> {
    std::fs::create_dir_all(folder).map_err(StoreError::system(folder, "making the folder"))
}

/// Keeps bytes in the file at `path`, or where a link there leads, replacing an older one only by all of them.
///
/// Fails if the system refuses, or if something else than a plain file is in its [place].
pub fn put(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    let path = &place(path)?;
    let file = begun(path)?;
    // As long as it is locked it is not abandoned; where there are no locks its age tells.
    let _ = try_lock(file.as_file(), Lock::Exclusive);
    name(filled(file, path, bytes)?, path)
}

/// Keeps bytes in a new file at `path`; false, and nothing is changed, if a file is there.
///
/// Fails as [put] does.
pub(super) fn put_new(path: &Path, bytes: &[u8]) -> Result<bool, StoreError> {
    let path = &place(path)?;
    let file = begun(path)?;
    let _ = try_lock(file.as_file(), Lock::Exclusive);
    match filled(file, path, bytes)?.persist_noclobber(path) {
        Ok(_) => {}
        Err(refused) if refused.error.kind() == io::ErrorKind::AlreadyExists => return Ok(false),
        // The disk knows no name that is given only where none is.
        Err(refused) => return name(refused.file, path).map(|()| true),
    }
    sync_folder(folder(path))
        .map_err(StoreError::system(path, "forcing the folder to the disk"))?;
    Ok(true)
}

/// A new file beside `path` that has not got its name yet.
fn begun(path: &Path) -> Result<NamedTempFile, StoreError> {
    temporary(path, folder(path)).map_err(StoreError::system(path, "starting a new file"))
}

/// A file that has not got its name yet, with bytes that are on the disk.
fn filled(mut file: NamedTempFile, path: &Path, bytes: &[u8]) -> Result<NamedTempFile, StoreError> {
    file.write_all(bytes).map_err(StoreError::system(path, "writing"))?;
    file.as_file().sync_all().map_err(StoreError::system(path, "forcing the file to the disk"))?;
    Ok(file)
}

/// Gives a file that is on the disk its name.
///
/// Fails if it would take that of something else than a plain file, or the system refuses.
pub(super) fn name(file: NamedTempFile, path: &Path) -> Result<(), StoreError> {
    let path = &place(path)?;
    let named = file.persist(path).map_err(|refused| refused.error);
    named.map_err(StoreError::system(path, "giving the file its name"))?;
    sync_folder(folder(path)).map_err(StoreError::system(path, "forcing the folder to the disk"))
}

/// The dataset in the file at `path`, exactly as it was written.
pub fn read(path: &Path) -> Result<Dataset, StoreError> {
    open(path)?.dataset(|_, _| true)
}

/// The file of results at `path`, once every byte has been checked.
pub fn open(path: &Path) -> Result<Archive, StoreError> {
    let (checksum, checked) = checksum_of(path)?;
    match checksum {
        Checksum::Valid => decoded(path, checked),
        Checksum::Invalid => Err(StoreError::Damaged { path: path.to_owned() }),
        Checksum::Absent => {
            let why = "the checksum at its end is missing: it was cut short, or another program wrote it or \
                       added to it";
            Err(StoreError::Foreign { path: path.to_owned(), why: why.to_owned() })
        }
    }
}

/// The same, and whether every byte has been checked, which cannot be done of a file that another program has changed.
pub fn open_changed(path: &Path) -> Result<(Archive, bool), StoreError> {
    let (checksum, checked) = checksum_of(path)?;
    decoded(path, checked).map(|archive| (archive, checksum == Checksum::Valid))
}

/// A file of results of a model that is known.
fn decoded(path: &Path, checked: Watched) -> Result<Archive, StoreError> {
    let archive = Archive::decode(path, checked)?;
    let frame = archive.frame();
    match check_model(frame) {
        Ok(()) => Ok(archive),
        Err(why) => Err(StoreError::Foreign { path: path.to_owned(), why }),
    }
}

/// Makes sure that the model of results is known, with the outputs that their study defines; fails with why it is not.
fn check_model(frame: &Dataset) -> Result<(), String> {
    if let Some(tables) = frame.texts.get(SYSTEM_TEXT) {
        named_system::model_of(SYSTEM_TEXT, tables).map_err(|why| why.to_string())?;
    } else if let Some(name) = frame.attributes.get(MODEL)
        && model_called(name).is_none()
    {
        return Err(format!("its results are of the model {name}, which is not known here"));
    }
    let Some(table) = frame.texts.get(OWN_TEXT) else { return Ok(()) };
    let model = frame.model().without_own();
    own_outputs::check_known(OWN_TEXT, model, table).map_err(|why| why.to_string())
}

/// What the checksum of the HDF5 file at `path` tells, and the file as it was before that.
fn checksum_of(path: &Path) -> Result<(Checksum, Watched), StoreError> {
    let failed = StoreError::system(path, "opening the file");
    if std::path::absolute(path).is_ok_and(|whole| whole.to_str().is_none()) {
        return Err(StoreError::NoPlace { path: path.to_owned(), why: NO_TEXT.to_owned() });
    }
    let opened = open_input(path, Pipes::Refused);
    let (file, _) = opened.map_err(|said| match said.kind() {
        io::ErrorKind::InvalidInput => {
            StoreError::Foreign { path: path.to_owned(), why: format!("it {said}") }
        }
        _ => failed(said),
    })?;
    let checked = Watched::new(file).map_err(failed)?;
    let mut file = checked.file();
    let mut start = Vec::new();
    Read::by_ref(&mut file).take(SIGNATURE.len() as u64).read_to_end(&mut start).map_err(failed)?;
    if start != SIGNATURE {
        let why = "it is not an HDF5 file".to_owned();
        return Err(StoreError::Foreign { path: path.to_owned(), why });
    }
    file.rewind().map_err(failed)?;
    let checksum = checksum::check(file).map_err(failed)?;
    Ok((checksum, checked))
}

/// The folder of a file.
pub fn folder(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

/// A new file beside `path`, hidden, removed again unless it gets its final name.
pub(super) fn temporary(path: &Path, folder: &Path) -> io::Result<NamedTempFile> {
    let name = path.file_name().ok_or(io::ErrorKind::InvalidInput)?;
    let prefix = format!(".{}.", name.to_string_lossy());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".tmp");
    #[cfg(unix)]
    // Without this only its owner could read the result; the user's umask still applies.
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Keeps others that write results in the folder of `path` waiting as long as the answer lives, so that what
/// two of them put into one file is not lost; on a disk without locks it has no effect.
///
/// Calls `waits` once if another holds it, and fails if that one holds it for ten minutes.
pub fn hold(path: &Path, waits: impl FnOnce(&Path)) -> Result<File, StoreError> {
    let failed = StoreError::system(path, "waiting for others that write there");
    let place = folder(path);
    let folder = File::open(place).map_err(failed)?;
    let mut waits = Some(waits);
    for _ in 0..HOLD_TRIES {
        match try_lock(&folder, Lock::Exclusive).map_err(failed)? {
            Tried::Taken | Tried::Without => return Ok(folder),
            Tried::Busy => {
                waits.take().into_iter().for_each(|waits| waits(place));
                sleep(HOLD_PAUSE);
            }
        }
    }
    Err(StoreError::Held { folder: place.to_owned() })
}

/// Removes what runs that were killed have left of a file at `path` that is [put](put) there, for whom does not hold it.
pub fn discard_abandoned(path: &Path) -> Result<(), StoreError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    discard_unfinished_in(folder(path), |of, file| of == name && is_abandoned(file))
        .map_err(StoreError::system(path, "clearing away what is unfinished"))
}

/// Whether nobody writes to an unfinished file any more.
fn is_abandoned(file: &Path) -> bool {
    File::open(file).is_ok_and(|file| match try_lock(&file, Lock::Exclusive) {
        Ok(Tried::Taken) => true,
        Ok(Tried::Busy) => false,
        Ok(Tried::Without) | Err(_) => is_old(&file),
    })
}

fn is_old(file: &File) -> bool {
    let written = file.metadata().and_then(|it| it.modified());
    written.is_ok_and(|at| at.elapsed().is_ok_and(|age| age >= ABANDONED))
}

/// Removes what runs that were killed have left of the file at `path`; to be called by who [holds](hold) it.
pub fn discard_unfinished(path: &Path) -> Result<(), StoreError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    discard_unfinished_in(folder(path), |of, _| of == name)
        .map_err(StoreError::system(path, "clearing away what is unfinished"))
}

/// Removes what runs that were killed have left in `folder` of those files that `is_ours` by what they were to become
/// and where they are.
pub(super) fn discard_unfinished_in(
    folder: &Path,
    is_ours: impl Fn(&str, &Path) -> bool,
) -> io::Result<()> {
    let entries = match std::fs::read_dir(folder) {
        Err(said) if said.kind() == io::ErrorKind::NotFound => return Ok(()),
        entries => entries?,
    };
    for entry in entries {
        let path = entry?.path();
        let found = path.file_name().unwrap_or_default().to_string_lossy();
        if unfinished(&found).is_some_and(|of| is_ours(of, &path)) {
            match std::fs::remove_file(&path) {
                // Another run may have removed it, or given it its name.
                Err(said) if said.kind() != io::ErrorKind::NotFound => return Err(said),
                _ => {}
            }
        }
    }
    Ok(())
}

/// The name of the file that one of this name was to become: what [`temporary`] has made of it.
pub(super) fn unfinished(name: &str) -> Option<&str> {
    let inside = name.strip_prefix('.')?.strip_suffix(".tmp")?;
    inside.rsplit_once('.').map(|(of, _)| of)
}

/// Creates the file that one at `path` begins as, and removes it: fails where a file of that name cannot be written.
pub fn try_to_begin(path: &Path) -> io::Result<()> {
    temporary(path, folder(path))?.close()
}

/// A new name is safe only once the folder that lists it is on the disk.
pub(super) fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}
