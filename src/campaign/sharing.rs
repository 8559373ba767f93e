//! Shares a study among processes that come and go: each claims missing blocks one by one, and one of them joins all.

use std::collections::BTreeSet;
use std::io;
use std::path::Path;
use std::sync::{Mutex, MutexGuard};
use std::thread::sleep;
use std::time::Instant;

use super::claims::{ClaimStatus, Claims, Standing};
use super::compute::{Claimed, go_on};
use super::error::CampaignError;
use super::report::{Event, Report, Reports};
use super::request::{Campaign, Done};
use super::start::Begun;
use crate::store::{BlockFolder, Company, StoreError};
use crate::study::spread;

impl Campaign<'_> {
    /// Computes blocks that no other process has claimed, one by one, until all are there, and joins them unless another process does.
    /// Any number of processes may do so at a time with the same folder, on one machine or several, and each may end at any moment.
    ///
    /// Method: a block is computed by who has claimed it; when none is free, the claims of others are watched, and those that are
    /// abandoned are taken over. The join is claimed as a block is.
    ///
    /// Assumes that a file is created by one process alone where several try, which local and network disks hold to, and that of the
    /// folder all see what any has written before the limit of `claims` is over.
    ///
    /// Guarantees: the file has the same bytes as that of [`Campaign::run`], but for the time in `created`. Of two processes that
    /// compute the same block, as one was paused for longer than the limit, the first keeps it, and the second compares every bit.
    ///
    /// Fails as [`Campaign::run`] does, and if a claim cannot be written; what is done is kept, and no claim is left.
    pub fn run_with_claims(
        &self,
        claims: &Claims,
        report: &Report<'_>,
    ) -> Result<Done, CampaignError> {
        let reports = Reports::new(report);
        let mut done = self.share(claims, &reports);
        if let Err(CampaignError::Missing { .. }) = done {
            // Blocks were damaged after they had been kept.
            done = self.share(claims, &reports);
        }
        claims.release_all();
        self.or_elsewhere(done, &reports)
    }

    fn share(&self, claims: &Claims, reports: &Reports<'_>) -> Result<Done, CampaignError> {
        let folder = match self.begin(Company::Tasks, reports)? {
            Begun::Whole(whole) => return Ok(Done::Complete(whole)),
            Begun::Folder(folder) => folder,
        };
        let left = self.survey(&folder, &spread(self.study.blocks()), reports)?;
        let damaged = left.iter().copied().filter(|block| folder.file(*block).exists()).collect();
        let (left, trouble) = (Mutex::new(left), Mutex::default());
        let sharing = Sharing { campaign: self, claims, reports, folder, left, damaged, trouble };
        sharing.compute()?;
        sharing.join()
    }
}

/// A study that is computed by several processes at a time.
struct Sharing<'a> {
    campaign: &'a Campaign<'a>,
    claims: &'a Claims,
    reports: &'a Reports<'a>,
    folder: BlockFolder,
    /// Blocks that are not known to be there.
    left: Mutex<Vec<usize>>,
    /// Blocks that were damaged or foreign at the beginning, so that their name alone says nothing.
    damaged: BTreeSet<usize>,
    /// Why a block could not be claimed.
    trouble: Mutex<Option<CampaignError>>,
}

impl Sharing<'_> {
    /// Computes what can be claimed, and waits for what others have claimed, until all blocks are there.
    fn compute(&self) -> Result<(), CampaignError> {
        let begun = Instant::now();
        let mut cases = 0;
        loop {
            self.look()?;
            let left = locked(&self.left).clone();
            if left.is_empty() || self.campaign.joined()?.is_some() {
                break;
            }
            if !self.await_one(&left)? {
                continue;
            }
            cases += self.compute_free(&left)?;
        }
        match cases {
            0 => Ok(()),
            cases => self.reports.send(Event::Computed { cases, time: begun.elapsed() }),
        }
    }

    /// Finds and reports which blocks others have kept meanwhile.
    fn look(&self) -> Result<(), CampaignError> {
        // What is left changes below, so that it must not be locked meanwhile.
        let left = locked(&self.left).clone();
        for block in left {
            if self.is_kept(block) {
                self.note_kept(block)?;
            }
        }
        Ok(())
    }

    fn is_kept(&self, block: usize) -> bool {
        match self.damaged.contains(&block) {
            true => self.folder.open(block).is_ok(),
            false => self.folder.file(block).exists(),
        }
    }

    /// Reports a block that another process has kept; once, as it is not looked for again.
    fn note_kept(&self, block: usize) -> Result<(), CampaignError> {
        let mut left = locked(&self.left);
        let before = left.len();
        left.retain(|it| *it != block);
        let is_new = left.len() < before;
        drop(left);
        match self.folder.head(block) {
            Ok(head) if is_new => self.reports.send(Event::KeptElsewhere(&head.block)),
            _ => Ok(()),
        }
    }

    /// Whether one of the blocks that are left can be claimed; if not, waits for a moment.
    fn await_one(&self, left: &[usize]) -> Result<bool, CampaignError> {
        let mut held = Vec::new();
        for &block in left {
            let path = self.folder.claim(block);
            match self.claims.standing(&path).map_err(refused(&path))? {
                Standing::Held(owner) => held.push(claimed(Some(block), owner)),
                Standing::Free | Standing::Abandoned(..) => return Ok(true),
            }
        }
        self.wait(&held)?;
        Ok(false)
    }

    fn wait(&self, held: &[ClaimStatus]) -> Result<(), CampaignError> {
        go_on().is_continue().then_some(()).ok_or(CampaignError::Stopped)?;
        self.reports.send(Event::Awaiting(held))?;
        sleep(self.claims.pause());
        self.reports.check()
    }

    /// Computes those of the blocks that can be claimed; returns how many cases they have.
    fn compute_free(&self, left: &[usize]) -> Result<usize, CampaignError> {
        let taken = Mutex::new(Vec::new());
        let (campaign, folder) = (self.campaign, &self.folder);
        let claimed = Claimed { claims: self.claims, claim: &|block| self.take(block, &taken) };
        let (_, error) = campaign.compute_blocks(folder, left, Some(claimed), self.reports)?;
        if let Some(error) = error {
            let all = campaign.study.blocks();
            let done = all - locked(&self.left).iter().filter(|it| !self.is_kept(**it)).count();
            let (blocks, folder) = ([done, all], folder.path().to_owned());
            return Err(CampaignError::NotKept { error, blocks, folder });
        }
        if let Some(error) = locked(&self.trouble).take() {
            return Err(error);
        }
        self.reports.check()?;
        let taken = taken.into_inner().unwrap_or_else(|it| it.into_inner());
        locked(&self.left).retain(|block| !taken.contains(block));
        Ok(campaign.cases(&taken))
    }

    /// Claims a block, which is `taken` then; returns whether it was.
    fn take(&self, block: usize, taken: &Mutex<Vec<usize>>) -> bool {
        match self.claim_block(block) {
            Ok(is_claimed) => {
                locked(taken).extend(is_claimed.then_some(block));
                is_claimed
            }
            Err(error) => {
                locked(&self.trouble).get_or_insert(error);
                false
            }
        }
    }

    /// Claims a block if it is missing and free.
    fn claim_block(&self, block: usize) -> Result<bool, CampaignError> {
        if self.reports.proceed().is_break() || locked(&self.trouble).is_some() {
            return Ok(false);
        }
        if self.is_kept(block) {
            return self.note_kept(block).map(|()| false);
        }
        let path = self.folder.claim(block);
        if !self.claim(&path, Some(block))? {
            return Ok(false);
        }
        // It may have been kept between the look and the claim, and have been joined and removed after that.
        let is_kept = self.is_kept(block);
        if is_kept || self.campaign.joined()?.is_some() {
            self.claims.release(&path);
            if is_kept {
                self.note_kept(block)?;
            }
            return Ok(false);
        }
        Ok(true)
    }

    /// Claims a block, or the join, and reports whose claim is taken over for that; returns whether it is claimed.
    fn claim(&self, path: &Path, block: Option<usize>) -> Result<bool, CampaignError> {
        match self.claims.claim(path).map_err(refused(path))? {
            Standing::Held(_) => Ok(false),
            Standing::Free => Ok(true),
            Standing::Abandoned(claim, why) => {
                let owner = claim.owner();
                let owner = owner.as_ref();
                self.reports.send(Event::TakenOver { block, owner, why }).map(|()| true)
            }
        }
    }

    /// Joins all blocks, or waits until another process has.
    fn join(self) -> Result<Done, CampaignError> {
        let path = self.folder.claim_on_join();
        loop {
            if let Some(whole) = self.campaign.joined()? {
                drop(self.folder);
                return self.campaign.leave_to_others(whole, self.reports);
            }
            match self.claims.standing(&path).map_err(refused(&path))? {
                Standing::Held(owner) => self.wait(&[claimed(None, owner)])?,
                // Who has joined between the look and the claim has removed the folder.
                _ if self.claim(&path, None)? && self.campaign.joined()?.is_none() => break,
                _ => self.claims.release(&path),
            }
        }
        let done = self.campaign.join_blocks(self.folder, self.campaign.output, self.reports);
        self.claims.release(&path);
        done.map(Done::Complete)
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|it| it.into_inner())
}

fn claimed(block: Option<usize>, owner: Option<crate::store::Owner>) -> ClaimStatus {
    ClaimStatus { block, owner, has_ended: false }
}

/// Makes what the system said of a claim an error.
fn refused(path: &Path) -> impl Fn(io::Error) -> CampaignError + Copy {
    move |said| {
        let (path, doing) = (path.to_owned(), "claiming what is to be computed");
        StoreError::System { path, doing, said }.into()
    }
}
