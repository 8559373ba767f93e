//! Joins the blocks of a study into its file, with the attractors that the cases have ended on.

use std::path::Path;

use crate::store::{
    self, BlockFolder, Blocks, Company, Dataset, StoreError, Unusable, keep_branches,
};

use super::clear::clear_away;
use super::error::CampaignError;
use super::joining::Joining;
use super::kept::{Kept, branches_of, check_branches, kept};
use super::report::{Event, Report, Reports, Stage};
use super::request::{Campaign, Complete};
use super::result_file::{block_path, partial_path, prepare};

impl Campaign<'_> {
    /// Joins the blocks that are there, which must be all, into the file, and removes them; a file with all
    /// cases of the study that is there already stays.
    ///
    /// Fails if blocks are missing, another run holds them, or the file holds something else.
    pub fn join(&self, report: &Report<'_>) -> Result<Complete, CampaignError> {
        self.join_or_keep(self.output, report)
    }

    /// Joins the blocks that are there into a file in a folder `partial` beside them;
    /// cases that are not done have the outcome `missing`, and the blocks stay.
    ///
    /// Fails if no block was begun or the folder holds those of another study.
    pub fn join_partial(&self, report: &Report<'_>) -> Result<Complete, CampaignError> {
        self.join_partial_into(&partial_path(self.output), report)
    }

    /// The same into `file`, which is not the output.
    ///
    /// Fails as [`Campaign::join_partial`] does.
    pub fn join_partial_into(
        &self,
        file: &Path,
        report: &Report<'_>,
    ) -> Result<Complete, CampaignError> {
        Campaign { overwrite: true, ..*self }.join_or_keep(file, report)
    }

    /// Joins the blocks into `file`, which is partial unless it is the output.
    fn join_or_keep(&self, file: &Path, report: &Report<'_>) -> Result<Complete, CampaignError> {
        let reports = Reports::new(report);
        let is_partial = file != self.output;
        match self.kept()? {
            Some(older) if older.archive.has_cases() => self.keep(older, is_partial, &reports),
            older => {
                check_branches(older.as_ref(), self.output, self.overwrite)?;
                drop(older);
                // A look first, which makes no folder where nothing was begun.
                let seen = self.enter(Company::Anybody);
                let folder =
                    if is_partial { seen } else { seen.and_then(|_| self.enter(Company::Alone)) };
                let joined = folder
                    .map_err(CampaignError::from)
                    .and_then(|folder| self.join_blocks(folder, file, &reports));
                // A run that has ended meanwhile has taken its blocks away and left the whole.
                match (joined, self.kept()) {
                    (Err(CampaignError::Store(_)), Ok(Some(whole)))
                        if whole.archive.has_cases() =>
                    {
                        self.keep(whole, is_partial, &reports)
                    }
                    (joined, _) => joined,
                }
            }
        }
    }

    /// Enters the folder of the blocks.
    fn enter(&self, company: Company) -> Result<BlockFolder, StoreError> {
        BlockFolder::enter(&block_path(self.output), self.study, company, false)
    }

    /// Leaves a file with all cases as it is.
    fn keep(
        &self,
        older: Kept,
        is_partial: bool,
        reports: &Reports<'_>,
    ) -> Result<Complete, CampaignError> {
        reports.send(Event::Before { same_text: older.same_text })?;
        if !is_partial {
            clear_away(self.output, self.study, reports)?;
        }
        Ok(Complete { path: self.output.to_owned(), archive: older.archive })
    }

    /// Joins the blocks in `folder` into `file`, beside branches that have been continued by then, and removes
    /// them, unless the file is partial, which it is unless it is the output.
    pub(super) fn join_blocks(
        &self,
        folder: BlockFolder,
        file: &Path,
        reports: &Reports<'_>,
    ) -> Result<Complete, CampaignError> {
        let is_partial = file != self.output;
        prepare(file)?;
        let mut blocks = match is_partial {
            true => self.some_blocks(&folder, reports)?,
            false => all_of(&folder, self.open_blocks(&folder))?,
        };
        reports.send(Event::Joining { folder: folder.path() })?;
        let joining = Joining { study: self.study, machine: self.machine, reports };
        let frame = joining.frame(&mut blocks, is_partial)?;
        // Branches that were continued meanwhile are in the file, and none can come before it is replaced.
        let _held = store::hold(file, |folder| reports.wait(folder))?;
        self.write(&blocks, frame, file, reports)?;
        let archive = store::open(file)?;
        reports.send(Event::Joined { path: file, blocks: &blocks })?;
        drop(blocks);
        if !is_partial {
            folder.remove()?;
        }
        Ok(Complete { path: file.to_owned(), archive })
    }

    fn open_blocks(&self, folder: &BlockFolder) -> Blocks<'_> {
        Blocks::open(folder, self.study, 0..self.study.blocks())
    }

    /// The blocks that are there, of which some may be missing.
    fn some_blocks(
        &self,
        folder: &BlockFolder,
        reports: &Reports<'_>,
    ) -> Result<Blocks<'_>, CampaignError> {
        let blocks = self.open_blocks(folder);
        // A run that has ended since has removed some of them.
        if self.kept()?.is_some_and(|whole| whole.archive.has_cases()) {
            return Err(StoreError::NoBlocks { folder: folder.path().to_owned() }.into());
        }
        report_left_out(folder, &blocks, reports)?;
        Ok(blocks)
    }

    /// Writes the file, with the branches that the output holds.
    fn write(
        &self,
        blocks: &Blocks<'_>,
        mut frame: Dataset,
        file: &Path,
        reports: &Reports<'_>,
    ) -> Result<(), CampaignError> {
        let older = kept(self.output, self.study, self.overwrite)?;
        check_branches(older.as_ref(), self.output, self.overwrite)?;
        if let Some(branches) = branches_of(older.as_ref())? {
            keep_branches(&mut frame, &branches);
        }
        drop(older);
        store::discard_unfinished(file)?;
        store::discard_unfinished(&partial_path(self.output))?;
        let written = blocks.join(
            &frame,
            file,
            |parts| {
                // A request to stop takes effect at the first part.
                let _ = reports.note(Event::Begun(Stage::Writing, parts));
            },
            || reports.note(Event::Step(Stage::Writing)),
        )?;
        if written.is_break() {
            return Err(CampaignError::Stopped);
        }
        reports.send(Event::Ended(Stage::Writing))
    }
}

/// The blocks, if none is missing.
fn all_of<'a>(folder: &BlockFolder, mut blocks: Blocks<'a>) -> Result<Blocks<'a>, CampaignError> {
    if blocks.missing.is_empty() {
        return Ok(blocks);
    }
    let mut missing = blocks.missing.iter();
    if let Some(place) = missing.position(|(_, why)| matches!(why, Unusable::Refused(_))) {
        let (number, why) = blocks.missing.swap_remove(place);
        return Err(CampaignError::Block { file: folder.file(number), why });
    }
    let missing = std::mem::take(&mut blocks.missing).into_iter();
    let blocks = missing.map(|(number, why)| (number, folder.file(number), why)).collect();
    Err(CampaignError::Missing { folder: folder.path().to_owned(), blocks })
}

/// Reports the blocks that are damaged or foreign.
fn report_left_out(
    folder: &BlockFolder,
    blocks: &Blocks<'_>,
    reports: &Reports<'_>,
) -> Result<(), CampaignError> {
    for (number, why) in &blocks.missing {
        if !matches!(why, Unusable::Missing) {
            reports.send(Event::LeftOut { file: &folder.file(*number), why })?;
        }
    }
    Ok(())
}
