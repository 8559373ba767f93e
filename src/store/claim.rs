//! Claims: files by which processes that share a folder tell each other who computes what.
//!
//! A claim is created only where none is, which one process alone achieves, on network disks too. Its owner holds it open and
//! rewrites it in place, so that what it writes never reaches the claim of another that has the name by then. Who wants to
//! take it away renames it first and looks at what it has got, as two may try, or the owner may have come back.

use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::lock::{Lock, Tried, try_lock};

/// No claim is longer [bytes].
const LONGEST: u64 = 1 << 16;

/// Who has a claim, and how often it was renewed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owner {
    /// The name of its machine.
    pub host: String,
    /// The number of its process there.
    pub process: u32,
    /// What tells the running kernel of its machine from all others; empty if unknown.
    kernel: String,
    /// Whether it holds a lock on its claim as long as it lives.
    is_locked: bool,
    /// Tells this claim from all others.
    token: String,
    /// Others may take the claim if it was not renewed for so long [ms].
    limit: u64,
    /// How often it was renewed; it comes last, as it alone grows.
    renewed: u64,
}

impl Owner {
    /// This process, of a new claim that others may take if it is not renewed for `limit`.
    fn here(limit: Duration) -> Owner {
        Owner {
            host: host(),
            process: std::process::id(),
            kernel: kernel(),
            is_locked: false,
            token: random_text(),
            limit: u64::try_from(limit.as_millis()).unwrap_or(u64::MAX),
            renewed: 0,
        }
    }

    /// Others may take the claim if it was not renewed for so long.
    pub fn limit(&self) -> Duration {
        Duration::from_millis(self.limit)
    }
}

/// The name of this machine.
fn host() -> String {
    let of_kernel = fs::read_to_string("/proc/sys/kernel/hostname").ok();
    let name = of_kernel.or_else(|| std::env::var("HOSTNAME").ok()).unwrap_or_default();
    match name.trim() {
        "" => "a machine without a name".to_owned(),
        name => name.to_owned(),
    }
}

/// What tells the running kernel of this machine from all others; empty if unknown.
fn kernel() -> String {
    let read = fs::read_to_string("/proc/sys/kernel/random/boot_id");
    read.map_or(String::new(), |text| text.trim().to_owned())
}

/// A text that no other process has, of the random numbers of the system, by which the standard library seeds its hashes.
fn random_text() -> String {
    format!("{:016x}", RandomState::new().build_hasher().finish())
}

/// What is in the file of a claim.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    bytes: Vec<u8>,
}

impl Claim {
    /// The claim at `path`; none if there is none.
    pub fn read(path: &Path) -> io::Result<Option<Claim>> {
        let mut bytes = Vec::new();
        // It is opened each time, as a network disk shows what others have written only then.
        match File::open(path).and_then(|file| file.take(LONGEST).read_to_end(&mut bytes)) {
            Ok(_) => Ok(Some(Claim { bytes })),
            Err(said) if is_gone(&said) => Ok(None),
            Err(said) => Err(said),
        }
    }

    /// Who has it; unknown as long as the file is not written, or where it is damaged.
    pub fn owner(&self) -> Option<Owner> {
        serde_json::from_slice(&self.bytes).ok()
    }

    /// Whether its owner was a process of this machine that does not run any more.
    ///
    /// Method: the owner holds a lock on the file, which the kernel ends with the process. Elsewhere than under the kernel that
    /// the owner runs under nothing is concluded, as some network disks keep locks on each machine by itself.
    pub fn has_ended(&self, path: &Path) -> bool {
        let Some(owner) = self.owner() else { return false };
        if owner.kernel.is_empty() || owner.kernel != kernel() || !owner.is_locked {
            return false;
        }
        let file = File::options().read(true).write(true).open(path);
        let tried = file.and_then(|file| try_lock(&file, Lock::Exclusive));
        matches!(tried, Ok(Tried::Taken))
    }

    /// Takes it away if it still is what is at `path`; returns whether it was.
    pub fn remove(&self, path: &Path) -> io::Result<bool> {
        take_away(path, |there| there == self)
    }
}

/// A claim of this process.
#[derive(Debug)]
pub struct HeldClaim {
    path: PathBuf,
    file: File,
    owner: Owner,
}

impl HeldClaim {
    /// Claims what the file at `path` stands for; none if there is a claim.
    ///
    /// Fails if the system refuses; then no claim is left, as far as it can be removed.
    pub fn new(path: &Path, limit: Duration) -> io::Result<Option<HeldClaim>> {
        let mut file = match File::create_new(path) {
            Err(said) if said.kind() == io::ErrorKind::AlreadyExists => return Ok(None),
            created => created?,
        };
        let mut owner = Owner::here(limit);
        owner.is_locked = matches!(try_lock(&file, Lock::Exclusive), Ok(Tried::Taken));
        match write(&mut file, &owner) {
            Ok(()) => Ok(Some(HeldClaim { path: path.to_owned(), file, owner })),
            Err(said) => {
                drop(file);
                let _ = take_away(path, |there| there.owner().is_none());
                Err(said)
            }
        }
    }

    /// Renews it; returns whether it still is this process's own.
    pub fn renew(&mut self) -> io::Result<bool> {
        if !self.is_own(Claim::read(&self.path)?.as_ref()) {
            return Ok(false);
        }
        self.owner.renewed += 1;
        write(&mut self.file, &self.owner).map(|()| true)
    }

    fn is_own(&self, there: Option<&Claim>) -> bool {
        let owner = there.and_then(Claim::owner);
        owner.is_some_and(|owner| owner.token == self.owner.token)
    }

    /// Gives it up; one that another has taken meanwhile stays.
    pub fn release(self) -> io::Result<()> {
        let HeldClaim { path, file, owner } = self;
        // A network disk does not remove a file that is open.
        drop(file);
        take_away(&path, |there| there.owner().is_some_and(|it| it.token == owner.token))?;
        Ok(())
    }
}

/// Writes a claim over what it was before, which is never longer.
fn write(file: &mut File, owner: &Owner) -> io::Result<()> {
    let text = serde_json::to_vec(owner)?;
    file.rewind()?;
    file.write_all(&text)?;
    file.sync_data()
}

/// Removes the claim at `path` if it is the one that is meant; returns whether it was.
///
/// Guarantees: of several processes one alone removes a claim. Another claim that has come to its place meanwhile is put back; if
/// in that moment a third process has claimed the same, that one stays, and both compute it.
fn take_away(path: &Path, is_meant: impl Fn(&Claim) -> bool) -> io::Result<bool> {
    if !Claim::read(path)?.is_some_and(|there| is_meant(&there)) {
        return Ok(false);
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let aside = path.with_file_name(format!(".{name}.{}.tmp", random_text()));
    match fs::rename(path, &aside) {
        Err(said) if is_gone(&said) => return Ok(false),
        renamed => renamed?,
    }
    let is_it = Claim::read(&aside)?.is_some_and(|taken| is_meant(&taken));
    if !is_it {
        // Without links on the disk its owner sees that it is lost.
        let _ = fs::hard_link(&aside, path);
    }
    match fs::remove_file(&aside) {
        Err(said) if !is_gone(&said) => Err(said),
        _ => Ok(is_it),
    }
}

/// Whether a file is not there, or was removed on the server of a network disk while it was read.
fn is_gone(said: &io::Error) -> bool {
    matches!(said.kind(), io::ErrorKind::NotFound | io::ErrorKind::StaleNetworkFileHandle)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: Duration = Duration::from_secs(60);

    fn there(path: &Path) -> Claim {
        Claim::read(path).expect("it is read").expect("a claim")
    }

    /// How many of four threads succeed that try the same at once.
    fn winners(attempt: impl Fn() -> io::Result<bool> + Sync) -> usize {
        std::thread::scope(|scope| {
            let all: Vec<_> = (0..4).map(|_| scope.spawn(&attempt)).collect();
            let tried = all.into_iter().map(|it| it.join().expect("no panic").expect("no error"));
            tried.filter(|won| *won).count()
        })
    }

    #[test]
    fn one_of_many_threads_gets_a_claim_and_one_takes_it_over() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = &folder.path().join("claim-0000001");
        for _ in 0..50 {
            // The file is closed at once, as if its process had ended.
            assert_eq!(winners(|| HeldClaim::new(path, LIMIT).map(|it| it.is_some())), 1);
            let stale = there(path);
            assert!(stale.has_ended(path));
            assert_eq!(winners(|| stale.remove(path)), 1);
            assert_eq!(fs::read_dir(folder.path())?.count(), 0);
        }
        Ok(())
    }

    #[test]
    fn who_comes_back_touches_no_claim_of_another() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = &folder.path().join("claim-0000001");
        let mut paused = HeldClaim::new(path, LIMIT)?.expect("a claim");
        let before = there(path);
        assert!(paused.renew()? && there(path) != before);
        assert!(!before.remove(path)?, "it was renewed");
        assert!(!there(path).has_ended(path), "its owner lives");
        assert!(HeldClaim::new(path, LIMIT)?.is_none());
        assert!(there(path).remove(path)?);
        let other = HeldClaim::new(path, LIMIT)?.expect("a claim");
        let of_other = there(path);
        assert!(!paused.renew()? && there(path) == of_other);
        paused.release()?;
        assert!(there(path) == of_other);
        other.release()?;
        assert_eq!(fs::read_dir(folder.path())?.count(), 0);
        Ok(())
    }

    #[test]
    fn what_names_no_owner_is_a_claim_all_the_same() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = &folder.path().join("claim-join");
        assert_eq!(Claim::read(path)?, None);
        fs::write(path, "{\"host\":")?;
        let half = there(path);
        assert!(half.owner().is_none() && !half.has_ended(path));
        assert!(HeldClaim::new(path, LIMIT)?.is_none() && half.remove(path)?);
        assert!(HeldClaim::new(path, LIMIT)?.is_some());
        Ok(())
    }
}
