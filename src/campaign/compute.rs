//! Computes the blocks of a task that are not there yet, each kept on disk as soon as it is done.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use crate::flow::stop;
use crate::run::{Record, run_blocks};
use crate::store::{BlockFolder, Blocks, StoreError, Unusable, Written};
use crate::study::{Study, spread};

use super::claims::Claims;
use super::error::CampaignError;
use super::report::{Event, Reports, Survey};
use super::request::Campaign;
use super::share::Task;

/// Blocks that are computed only if they can be claimed.
#[derive(Clone, Copy)]
pub(super) struct Claimed<'a> {
    /// The claims of this process.
    pub claims: &'a Claims,
    /// Claims a block; returns whether it is to be computed.
    pub claim: &'a (dyn Fn(usize) -> bool + Sync),
}

impl Campaign<'_> {
    /// Computes the blocks of a task that are missing in `folder`.
    pub(super) fn compute(
        &self,
        folder: &BlockFolder,
        task: Task,
        reports: &Reports<'_>,
    ) -> Result<(), CampaignError> {
        let share = task.share(spread(self.study.blocks()));
        let left = self.survey(folder, &share, reports)?;
        if left.is_empty() {
            return Ok(());
        }
        let begun = Instant::now();
        let before = share.len() - left.len();
        let (done, error) = self.compute_blocks(folder, &left, None, reports)?;
        if let Some(error) = error {
            let (blocks, folder) = ([before + done, share.len()], folder.path().to_owned());
            return Err(CampaignError::NotKept { error, blocks, folder });
        }
        reports.check()?;
        let (cases, time) = (self.cases(&left), begun.elapsed());
        reports.send(Event::Computed { cases, time })
    }

    /// Reports which of some blocks are there; returns the others, in the same order.
    pub(super) fn survey(
        &self,
        folder: &BlockFolder,
        share: &[usize],
        reports: &Reports<'_>,
    ) -> Result<Vec<usize>, CampaignError> {
        let mut found = Blocks::open(folder, self.study, share.iter().copied());
        let (kept, missing) = (found.summaries(), std::mem::take(&mut found.missing));
        let left: Vec<usize> = missing.iter().map(|(number, _)| *number).collect();
        check(folder, missing, reports)?;
        let (blocks, cases) = (share.len(), self.cases(share));
        let survey = Survey { folder: folder.path(), blocks, cases, kept: &kept };
        reports.send(Event::Surveyed(survey))?;
        Ok(left)
    }

    /// Cases of some blocks.
    pub(super) fn cases(&self, blocks: &[usize]) -> usize {
        blocks.iter().map(|&block| self.study.cases_of_block(block)).sum()
    }

    /// Computes and keeps blocks, those that are `claimed` if any are to be, until all are done, one cannot be kept, or the
    /// listener asks to stop; returns how many are kept, and why one is not.
    pub(super) fn compute_blocks(
        &self,
        folder: &BlockFolder,
        blocks: &[usize],
        claimed: Option<Claimed<'_>>,
        reports: &Reports<'_>,
    ) -> Result<(usize, Option<StoreError>), CampaignError> {
        let study = self.study;
        let (done, trouble) = (AtomicUsize::new(0), Mutex::new(None));
        let claims = claimed.map(|it| it.claims);
        let keeping = Keeping { study, folder, claims, reports, done, trouble };
        run_blocks(
            study,
            self.machine,
            blocks,
            claimed.map(|it| it.claim),
            |block, record| keeping.note(block, record),
            |block, records| keeping.keep(block, &records),
        )?;
        let trouble = keeping.trouble.into_inner().unwrap_or_else(|it| it.into_inner());
        Ok((keeping.done.into_inner(), trouble))
    }
}

/// Blocks that are kept in a folder as soon as they are done.
struct Keeping<'a> {
    study: &'a Study,
    folder: &'a BlockFolder,
    /// The claims on them, which are given up then; none if they need none.
    claims: Option<&'a Claims>,
    reports: &'a Reports<'a>,
    /// How many are kept.
    done: AtomicUsize,
    /// Why the first was not that could not be kept.
    trouble: Mutex<Option<StoreError>>,
}

impl Keeping<'_> {
    /// Reports a case that is done.
    fn note(&self, block: usize, record: &Record) -> ControlFlow<()> {
        go_on()?;
        // How many cases a tile needs is known only at its end.
        if self.study.refine.is_some() {
            return self.reports.proceed();
        }
        let cases = self.study.cases_of_block(block);
        self.reports.note(Event::Case { block, cases, record })
    }

    /// Keeps a block.
    fn keep(&self, block: usize, records: &[Record]) -> ControlFlow<()> {
        go_on()?;
        match self.folder.keep(self.study, block, records) {
            Ok((summary, written)) => {
                self.done.fetch_add(1, Ordering::Relaxed);
                self.claims.into_iter().for_each(|it| it.release(&self.folder.claim(block)));
                if written == Written::Before {
                    self.reports.note(Event::Twice { block })?;
                }
                self.reports.note(Event::Block(&summary))
            }
            Err(error) => {
                self.trouble.lock().unwrap_or_else(|it| it.into_inner()).get_or_insert(error);
                ControlFlow::Break(())
            }
        }
    }
}

/// Ends where the computation is to stop, as what is computed from then on has no meaning.
pub(super) fn go_on() -> ControlFlow<()> {
    if stop::is_asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Reports the blocks that are damaged or foreign; fails if one cannot be read.
fn check(
    folder: &BlockFolder,
    missing: Vec<(usize, Unusable)>,
    reports: &Reports<'_>,
) -> Result<(), CampaignError> {
    for (number, why) in missing {
        let file = folder.file(number);
        match why {
            Unusable::Missing => {}
            Unusable::Torn | Unusable::Foreign(_) => {
                reports.send(Event::Again { file: &file, why: &why })?;
            }
            Unusable::Refused(_) => return Err(CampaignError::Block { file, why }),
        }
    }
    Ok(())
}
