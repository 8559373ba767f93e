//! The claims of this process on what others must not compute at the same time, and its watch over those of others.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, Weak};
use std::thread;
use std::time::{Duration, Instant};

use crate::store::{Claim, HeldClaim, Owner};

/// A claim is renewed so often within its limit, so that slow disks and busy processors lose none.
const RENEWALS: u32 = 12;
/// The longest time between two looks at the claims of others.
const LONGEST_PAUSE: Duration = Duration::from_secs(1);

/// The claims that this process holds and those that it watches; copies of it are the same claims.
///
/// Guarantees: a claim is given up when it is done with, when [`Claims::release_all`] is called, and when the process ends.
/// Assumes nothing of the clocks of other machines: a claim is abandoned if this process has seen it unchanged for its limit.
#[derive(Debug, Clone)]
pub struct Claims(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    limit: Duration,
    all: Mutex<All>,
}

#[derive(Debug, Default)]
struct All {
    held: BTreeMap<PathBuf, HeldClaim>,
    watched: BTreeMap<PathBuf, Watched>,
    /// Whether nothing is to be claimed any more.
    is_closed: bool,
}

/// A claim of another process, as it is watched.
#[derive(Debug)]
struct Watched {
    claim: Claim,
    /// How long it is known to be unchanged.
    unchanged: Duration,
    seen: Instant,
}

/// A claim that is there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClaimStatus {
    /// The block; none for the join of all.
    pub block: Option<usize>,
    /// Who has it; none if that cannot be read.
    pub owner: Option<Owner>,
    /// Whether it is known that its process does not run any more.
    pub has_ended: bool,
}

impl ClaimStatus {
    /// The claim at `path`, on a block or on the join; none if there is none, or if it cannot be read.
    pub(super) fn read(path: &Path, block: Option<usize>) -> Option<ClaimStatus> {
        let claim = Claim::read(path).ok().flatten()?;
        Some(ClaimStatus { block, owner: claim.owner(), has_ended: claim.has_ended(path) })
    }
}

/// Why the claim of another process was taken over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Abandoned {
    /// Its process does not run any more.
    Ended,
    /// It was not renewed within its limit.
    Silent,
}

/// How things stand with something that can be claimed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Standing {
    /// Nobody has claimed it.
    Free,
    /// Another process has, of which a claim that is damaged or just begun says nothing.
    Held(Option<Owner>),
    /// Another process had, and has abandoned it.
    Abandoned(Claim, Abandoned),
}

impl Claims {
    /// No claims yet; others may take one that is not renewed for `limit`.
    pub fn new(limit: Duration) -> Claims {
        let shared = Arc::new(Shared { limit, all: Mutex::default() });
        let (renewed, pause) = (Arc::downgrade(&shared), limit / RENEWALS);
        thread::spawn(move || renew(&renewed, pause));
        Claims(shared)
    }

    /// How long to wait between two looks at the claims of others.
    pub(super) fn pause(&self) -> Duration {
        (self.0.limit / RENEWALS).min(LONGEST_PAUSE)
    }

    /// Claims what the file at `path` stands for, also if its claim is abandoned; returns how things stood before, and claims nothing if
    /// another has it.
    ///
    /// Fails if the system refuses.
    pub(super) fn claim(&self, path: &Path) -> io::Result<Standing> {
        let before = self.standing(path)?;
        match &before {
            Standing::Held(_) => return Ok(before),
            Standing::Abandoned(claim, _) if !claim.remove(path)? => {
                return Ok(Standing::Held(None));
            }
            _ => {}
        }
        let mut all = self.0.all();
        if all.is_closed {
            return Ok(Standing::Held(None));
        }
        match HeldClaim::new(path, self.0.limit)? {
            None => Ok(Standing::Held(None)),
            Some(held) => {
                all.watched.remove(path);
                all.held.insert(path.to_owned(), held);
                Ok(before)
            }
        }
    }

    /// How things stand with what the file at `path` stands for, which this process has not claimed.
    ///
    /// Method: what another process writes into its claim is compared with what it was at the last look. Between two looks more time may
    /// have passed than was meant, as this process was paused, or its whole machine with the owner; it counts as two pauses.
    ///
    /// Fails if the system refuses.
    pub(super) fn standing(&self, path: &Path) -> io::Result<Standing> {
        let Some(claim) = Claim::read(path)? else {
            self.0.all().watched.remove(path);
            return Ok(Standing::Free);
        };
        if claim.has_ended(path) {
            return Ok(Standing::Abandoned(claim, Abandoned::Ended));
        }
        let owner = claim.owner();
        let limit = owner.as_ref().map_or(self.0.limit, Owner::limit);
        let mut all = self.0.all();
        let now = Instant::now();
        let watched = all.watched.entry(path.to_owned()).or_insert_with(|| Watched {
            claim: claim.clone(),
            unchanged: Duration::ZERO,
            seen: now,
        });
        let between = now.duration_since(watched.seen).min(2 * self.pause());
        let unchanged =
            if watched.claim == claim { watched.unchanged + between } else { Duration::ZERO };
        *watched = Watched { claim, unchanged, seen: now };
        match unchanged > limit {
            true => Ok(Standing::Abandoned(watched.claim.clone(), Abandoned::Silent)),
            false => Ok(Standing::Held(owner)),
        }
    }

    /// Gives up a claim of this process.
    pub(super) fn release(&self, path: &Path) {
        let held = self.0.all().held.remove(path);
        // One that cannot be removed is not renewed any more, and so becomes abandoned.
        held.into_iter().for_each(|it| drop(it.release()));
    }

    /// Gives up all claims of this process, which makes no others from then on.
    pub fn release_all(&self) {
        let mut all = self.0.all();
        all.is_closed = true;
        std::mem::take(&mut all.held).into_values().for_each(|it| drop(it.release()));
    }
}

impl Shared {
    fn all(&self) -> MutexGuard<'_, All> {
        self.all.lock().unwrap_or_else(|it| it.into_inner())
    }
}

/// Renews the claims as long as anybody uses them.
fn renew(shared: &Weak<Shared>, pause: Duration) {
    loop {
        thread::sleep(pause);
        let Some(shared) = shared.upgrade() else { return };
        for claim in shared.all().held.values_mut() {
            // One that is lost or cannot be renewed may be taken by another, which then computes the same; that is seen at its end.
            let _ = claim.renew();
        }
    }
}
