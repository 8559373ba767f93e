//! Locks on files and folders, which other runs hold and some disks do not have.

use std::fs::{File, TryLockError};
use std::io;

/// Codes of Linux for a disk that gives no lock: a network disk has no server for them, or gives one only on what is
/// open for writing, which a folder never is.
const NO_LOCKS: [i32; 2] = [37, 9];

/// Who else may hold a lock at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lock {
    /// Nobody.
    Exclusive,
    /// Those who share it.
    Shared,
}

/// What came of trying a lock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tried {
    /// It is held until the file is closed.
    Taken,
    /// Another process holds it.
    Busy,
    /// The disk has no locks.
    Without,
}

/// Tries to lock what is open, without waiting.
pub fn try_lock(file: &File, lock: Lock) -> io::Result<Tried> {
    let tried = match lock {
        Lock::Exclusive => file.try_lock(),
        Lock::Shared => file.try_lock_shared(),
    };
    match tried {
        Ok(()) => Ok(Tried::Taken),
        Err(TryLockError::WouldBlock) => Ok(Tried::Busy),
        Err(TryLockError::Error(said)) if has_no_locks(&said) => Ok(Tried::Without),
        Err(TryLockError::Error(said)) => Err(said),
    }
}

fn has_no_locks(said: &io::Error) -> bool {
    said.kind() == io::ErrorKind::Unsupported
        || said.raw_os_error().is_some_and(|code| NO_LOCKS.contains(&code))
}
