//! Reads the files that a person names: plain files, which end, and where a shell puts one, a pipe.

use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

/// Whether a pipe may stand for a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pipes {
    /// None may.
    Refused,
    /// One that the shell has opened for the program may, as `<(zcat x.csv.gz)` or `/dev/stdin`.
    OfShell,
}

/// Bytes of a pipe: all that come.
const ALL: u64 = u64::MAX;
/// Where the files lie that the program has open itself.
const OWN_FILES: [&str; 3] = ["/dev/fd/", "/dev/stdin", "/proc/self/fd/"];

/// The bytes of the file at `path`.
///
/// A plain file is read as far as it is long when it is opened, so that files of a system that wait for more, as /proc/kmsg, are
/// not waited for.
///
/// Fails if the system refuses, and where no plain file is there: a FIFO, a device, a socket or a folder would not end.
pub fn read_input(path: &Path, pipes: Pipes) -> io::Result<Vec<u8>> {
    let (file, length) = open_input(path, pipes)?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes)?;
    if length == ALL && bytes.is_empty() {
        let why = "is a pipe that holds nothing (any more: a pipe can be read once)";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    }
    Ok(bytes)
}

/// The open file at `path`, and how many bytes of it there are; more than any file has of a pipe.
pub fn open_input(path: &Path, pipes: Pipes) -> io::Result<(File, u64)> {
    let file = open_at_once(path)?;
    let metadata = file.metadata()?;
    if metadata.is_file() {
        return Ok((file, metadata.len()));
    }
    if pipes == Pipes::OfShell && is_pipe(&metadata) && is_own(path) {
        wait_for_writers(&file)?;
        return Ok((file, ALL));
    }
    let advice = match pipes {
        Pipes::OfShell if !metadata.is_dir() => "; a pipe may be given as <(command) alone",
        _ => "",
    };
    let why = format!("is {}{advice}", what_it_is(&metadata));
    Err(io::Error::new(io::ErrorKind::InvalidInput, why))
}

/// Whether a path names a file that the program has open itself.
fn is_own(path: &Path) -> bool {
    OWN_FILES.iter().any(|it| path.to_string_lossy().starts_with(it))
}

/// Opens a file to be read without waiting for those who write it.
#[cfg(unix)]
fn open_at_once(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    let at_once = rustix::fs::OFlags::NONBLOCK.bits() as i32;
    OpenOptions::new().read(true).custom_flags(at_once).open(path)
}

#[cfg(not(unix))]
fn open_at_once(path: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).open(path)
}

/// Lets reads from a pipe wait until more is written or nobody writes any more.
#[cfg(unix)]
fn wait_for_writers(pipe: &File) -> io::Result<()> {
    let flags = rustix::fs::fcntl_getfl(pipe)?;
    Ok(rustix::fs::fcntl_setfl(pipe, flags - rustix::fs::OFlags::NONBLOCK)?)
}

#[cfg(not(unix))]
fn wait_for_writers(_: &File) -> io::Result<()> {
    Ok(())
}

#[cfg(unix)]
fn is_pipe(metadata: &std::fs::Metadata) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&metadata.file_type())
}

#[cfg(not(unix))]
fn is_pipe(_: &std::fs::Metadata) -> bool {
    false
}

/// What is no plain file, in words.
fn what_it_is(metadata: &std::fs::Metadata) -> &'static str {
    if metadata.is_dir() {
        return "a folder";
    }
    match is_pipe(metadata) {
        true => "not a plain file, but a FIFO, a pipe with a name",
        false => "not a plain file, but a device",
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::os::fd::AsRawFd;

    fn refused(path: &Path, pipes: Pipes) -> String {
        read_input(path, pipes).expect_err("refused").to_string()
    }

    #[test]
    fn plain_files_and_pipes_of_the_shell_are_read_and_nothing_else_is_waited_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("plain");
        std::fs::write(&path, "text").expect("it is written");
        assert_eq!(read_input(&path, Pipes::Refused).expect("it is read"), b"text");
        let fifo = folder.path().join("fifo");
        let ended = std::process::Command::new("mkfifo").arg(&fifo).status().expect("mkfifo");
        assert!(ended.success());
        for pipes in [Pipes::Refused, Pipes::OfShell] {
            assert!(refused(&fifo, pipes).starts_with("is not a plain file, but a FIFO"));
            assert!(refused(folder.path(), pipes).starts_with("is a folder"));
            let device = refused(Path::new("/dev/urandom"), pipes);
            assert!(device.starts_with("is not a plain file, but a device"), "{device}");
        }
        let (reader, mut writer) = io::pipe().expect("a pipe");
        let own = format!("/proc/self/fd/{}", reader.as_raw_fd());
        let strict = refused(Path::new(&own), Pipes::Refused);
        assert!(strict.starts_with("is not a plain file, but a FIFO"), "{strict}");
        let writes = std::thread::spawn(move || {
            std::thread::sleep(std::time::Duration::from_millis(50));
            io::Write::write_all(&mut writer, b"late").expect("it is written");
        });
        assert_eq!(read_input(Path::new(&own), Pipes::OfShell).expect("it is read"), b"late");
        assert!(
            refused(Path::new(&own), Pipes::OfShell).starts_with("is a pipe that holds nothing")
        );
        writes.join().expect("it has ended");
    }
}
