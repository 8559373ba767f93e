//! Starts a campaign or resumes it: what is missing is computed, and joined unless tasks share the study.

use super::clear::clear_away;
use super::error::CampaignError;
use super::kept::{Kept, check_branches};
use super::report::{Event, Report, Reports};
use super::request::{Campaign, Complete, Done};
use super::result_file::{block_path, prepare};
use super::share::Task;
use crate::store::{BlockFolder, Company};

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
        self.study.check_text("the study")?;
        let reports = Reports::new(report);
        match self.kept()? {
            Some(older) if self.suffices(&older) => return self.leave(older, &reports),
            older => {
                check_branches(older.as_ref(), self.output, self.overwrite)?;
                reports.send(Event::Accepted(older.as_ref()))?;
            }
        }
        prepare(self.output)?;
        let company = if task.of > 1 { Company::Tasks } else { Company::Alone };
        let path = block_path(self.output);
        let folder = BlockFolder::enter(&path, self.study, company, self.overwrite)?;
        // A run that has just ended may have joined all while this one waited for it.
        if let Some(older) = self.kept()?.filter(|older| self.suffices(older)) {
            drop(folder);
            return self.leave(older, &reports);
        }
        self.compute(&folder, task, &reports)?;
        match task.of {
            1 => Ok(Done::Complete(self.join_blocks(folder, self.output, &reports)?)),
            _ => Ok(Done::Shared(path)),
        }
    }

    /// Whether a file that is there has all cases and is to stay.
    fn suffices(&self, older: &Kept) -> bool {
        older.archive.has_cases() && !self.overwrite
    }

    /// Leaves a file as it is, and removes the blocks of a run that was stopped at its very end.
    fn leave(&self, older: Kept, reports: &Reports<'_>) -> Result<Done, CampaignError> {
        reports.send(Event::Before { same_text: older.same_text })?;
        clear_away(self.output, self.study, reports)?;
        let (path, archive) = (self.output.to_owned(), older.archive);
        Ok(Done::Complete(Complete { path, archive }))
    }
}
