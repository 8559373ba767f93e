//! Computes the blocks of a task that are not there yet, each kept on disk as soon as it is done.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use crate::run::run_blocks;
use crate::store::{BlockFolder, Blocks, StoreError, Unusable};
use crate::study::spread;

use super::error::CampaignError;
use super::report::{Event, Reports, Survey};
use super::request::Campaign;
use super::share::Task;

impl Campaign<'_> {
    /// Computes the blocks of a task that are missing in `folder`.
    pub(super) fn compute(
        &self,
        folder: &BlockFolder,
        task: Task,
        reports: &Reports<'_>,
    ) -> Result<(), CampaignError> {
        let share = task.share(spread(self.study.blocks()));
        let mut found = Blocks::open(folder, self.study, share.iter().copied());
        let (kept, missing) = (found.summaries(), std::mem::take(&mut found.missing));
        let left: Vec<usize> = missing.iter().map(|(number, _)| *number).collect();
        check(folder, missing, reports)?;
        let (blocks, cases) = (share.len(), self.cases(&share));
        let survey = Survey { folder: folder.path(), blocks, cases, kept: &kept };
        reports.send(Event::Surveyed(survey))?;
        if left.is_empty() {
            return Ok(());
        }
        let begun = Instant::now();
        let (done, error) = self.compute_blocks(folder, &left, reports)?;
        if let Some(error) = error {
            let (blocks, folder) = ([kept.len() + done, blocks], folder.path().to_owned());
            return Err(CampaignError::NotKept { error, blocks, folder });
        }
        reports.check()?;
        let (cases, time) = (self.cases(&left), begun.elapsed());
        reports.send(Event::Computed { cases, time })
    }

    /// Cases of some blocks.
    fn cases(&self, blocks: &[usize]) -> usize {
        blocks.iter().map(|&block| self.study.cases_of_block(block)).sum()
    }

    /// Computes and keeps blocks until all are done, one cannot be kept, or the listener asks to stop; returns
    /// how many are kept, and why one is not.
    fn compute_blocks(
        &self,
        folder: &BlockFolder,
        blocks: &[usize],
        reports: &Reports<'_>,
    ) -> Result<(usize, Option<StoreError>), CampaignError> {
        let (done, trouble) = (AtomicUsize::new(0), Mutex::new(None));
        let study = self.study;
        let each = |block: usize, record: &_| {
            // How many cases a tile needs is known only at its end.
            if study.refine.is_some() {
                return reports.proceed();
            }
            reports.note(Event::Case { block, cases: study.cases_of_block(block), record })
        };
        let whole = |block: usize, records: Vec<_>| match folder.keep(study, block, &records) {
            Ok(summary) => {
                done.fetch_add(1, Ordering::Relaxed);
                reports.note(Event::Block(&summary))
            }
            Err(error) => {
                trouble.lock().unwrap_or_else(|it| it.into_inner()).get_or_insert(error);
                ControlFlow::Break(())
            }
        };
        run_blocks(study, self.machine, blocks, each, whole)?;
        Ok((done.into_inner(), trouble.into_inner().unwrap_or_else(|it| it.into_inner())))
    }
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
