//! Starts a campaign or resumes it: what is missing is computed, and joined unless tasks share the study.

use super::clear::clear_away;
use super::error::CampaignError;
use super::kept::{Kept, check_branches};
use super::report::{Event, Report, Reports};
use super::request::{Campaign, Complete, Done};
use super::result_file::{block_path, prepare};
use super::share::Task;
use crate::store::{BlockFolder, Company};

/// Where a run begins.
pub(super) enum Begun {
    /// With the file, which has all cases.
    Whole(Complete),
    /// With the blocks in their folder.
    Folder(BlockFolder),
}

impl Campaign<'_> {
    /// Computes the blocks of a task that are missing, and joins all if it is the only task. A run that was
    /// interrupted is resumed by calling this again.
    ///
    /// Guarantees: the file has the same bytes however often the run was stopped, in whatever order its blocks
    /// were computed and by however many tasks, but for the time in `created`.
    ///
    /// Fails if the study is not the one that its text says, if something else is in the place of the file or of the blocks, if another
    /// run holds them, or if the machine refuses to keep a block; what is done is kept.
    pub fn run(&self, task: Task, report: &Report<'_>) -> Result<Done, CampaignError> {
        let reports = Reports::new(report);
        match task.of {
            1 => self.run_alone(&reports),
            _ => self.or_elsewhere(self.run_task(task, &reports), &reports),
        }
    }

    fn run_alone(&self, reports: &Reports<'_>) -> Result<Done, CampaignError> {
        match self.begin(Company::Alone, reports)? {
            Begun::Whole(whole) => Ok(Done::Complete(whole)),
            Begun::Folder(folder) => {
                self.compute(&folder, Task::WHOLE, reports)?;
                Ok(Done::Complete(self.join_blocks(folder, self.output, reports)?))
            }
        }
    }

    fn run_task(&self, task: Task, reports: &Reports<'_>) -> Result<Done, CampaignError> {
        match self.begin(Company::Tasks, reports)? {
            Begun::Whole(whole) => Ok(Done::Complete(whole)),
            Begun::Folder(folder) => {
                self.compute(&folder, task, reports)?;
                Ok(Done::Shared(folder.path().to_owned()))
            }
        }
    }

    /// What a run has come to among others, which may have joined all meanwhile, so that it finds the blocks gone.
    pub(super) fn or_elsewhere(
        &self,
        done: Result<Done, CampaignError>,
        reports: &Reports<'_>,
    ) -> Result<Done, CampaignError> {
        match done {
            Err(error) if !matches!(error, CampaignError::Stopped) => match self.joined() {
                Ok(Some(whole)) => self.leave_to_others(whole, reports),
                _ => Err(error),
            },
            done => done,
        }
    }

    /// The file, if another process has joined all cases.
    pub(super) fn joined(&self) -> Result<Option<Complete>, CampaignError> {
        if !self.output.exists() {
            return Ok(None);
        }
        let whole = self.kept()?.filter(|it| self.suffices(it));
        Ok(whole.map(|it| Complete { path: self.output.to_owned(), archive: it.archive }))
    }

    /// Ends with what another process has joined, and removes the blocks if it was killed before it did so.
    pub(super) fn leave_to_others(
        &self,
        whole: Complete,
        reports: &Reports<'_>,
    ) -> Result<Done, CampaignError> {
        clear_away(self.output, self.study, reports)?;
        Ok(Done::Elsewhere(whole))
    }

    /// Enters the folder of the blocks, unless the file has all cases already.
    pub(super) fn begin(
        &self,
        company: Company,
        reports: &Reports<'_>,
    ) -> Result<Begun, CampaignError> {
        self.study.check_text("the study")?;
        match self.kept()? {
            Some(older) if self.suffices(&older) => return self.leave(older, reports),
            older => {
                check_branches(older.as_ref(), self.output, self.overwrite)?;
                reports.send(Event::Accepted(older.as_ref()))?;
            }
        }
        prepare(self.output)?;
        let path = block_path(self.output);
        let folder = BlockFolder::enter(&path, self.study, company, self.overwrite)?;
        // A run that has just ended may have joined all while this one waited for it.
        if let Some(older) = self.kept()?.filter(|older| self.suffices(older)) {
            drop(folder);
            return self.leave(older, reports);
        }
        Ok(Begun::Folder(folder))
    }

    /// Whether a file that is there has all cases and is to stay.
    fn suffices(&self, older: &Kept) -> bool {
        older.archive.has_cases() && !self.overwrite
    }

    /// Leaves a file as it is, and removes the blocks of a run that was stopped at its very end.
    fn leave(&self, older: Kept, reports: &Reports<'_>) -> Result<Begun, CampaignError> {
        reports.send(Event::Before { same_text: older.same_text })?;
        clear_away(self.output, self.study, reports)?;
        let (path, archive) = (self.output.to_owned(), older.archive);
        Ok(Begun::Whole(Complete { path, archive }))
    }
}
