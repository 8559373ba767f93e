//! Continues the branches of a study and puts them into its file, beside the cases that it holds.

use std::time::Instant;

use crate::run;
use crate::store::{self, Dataset, add_branches, drop_branches, has_branches};

use super::error::CampaignError;
use super::kept::{Kept, check_branches};
use super::report::{Event, Report, Reports, Stage};
use super::request::{BranchesDone, Campaign, Complete};
use super::result_file::prepare;

impl Campaign<'_> {
    /// Continues the branches of the study and puts them into the file; cases that are there stay, and branches of
    /// this study that are there too, unless they are to be overwritten.
    ///
    /// Fails if the study asks for no branches or the file holds results of something else.
    pub fn continue_branches(&self, report: &Report<'_>) -> Result<BranchesDone, CampaignError> {
        if self.study.branches.is_empty() {
            return Err(CampaignError::NoBranches);
        }
        let reports = Reports::new(report);
        let older = match self.kept()? {
            Some(older) if self.has_its_branches(&older) => {
                reports.send(Event::Before { same_text: true })?;
                let (path, archive) = (self.output.to_owned(), older.archive);
                return Ok(BranchesDone::Before(Complete { path, archive }));
            }
            older => older,
        };
        check_branches(older.as_ref(), self.output, self.overwrite)?;
        reports.send(Event::Accepted(older.as_ref()))?;
        drop(older);
        prepare(self.output)?;
        reports.send(Event::Begun(Stage::Continuing, self.study.branches.len()))?;
        let (begun, threads) = (Instant::now(), self.machine.threads);
        let done = || reports.step(Stage::Continuing);
        let continued = run::continue_branches(self.study, threads, done)?;
        let time = begun.elapsed();
        reports.send(Event::Ended(Stage::Continuing))?;
        self.put(&continued, &reports)?;
        Ok(BranchesDone::Now { continued, time })
    }

    /// Whether a file that is there has the branches of this study and is to stay.
    fn has_its_branches(&self, older: &Kept) -> bool {
        older.same_text && has_branches(older.archive.frame()) && !self.overwrite
    }

    /// Writes the branches beside what the file holds by now.
    fn put(
        &self,
        continued: &[run::Continued],
        reports: &Reports<'_>,
    ) -> Result<(), CampaignError> {
        // Cases that were joined meanwhile are in the file, and none can come before it is replaced.
        let _held = store::hold(self.output, |folder| reports.wait(folder))?;
        store::discard_unfinished(self.output)?;
        let older = self.kept()?;
        check_branches(older.as_ref(), self.output, self.overwrite)?;
        match older.filter(|older| older.archive.has_cases()) {
            None => {
                let mut dataset = store::frame(self.study);
                add_branches(&mut dataset, self.study, continued);
                store::write(&dataset, self.output)?;
            }
            Some(older) => {
                let is_of_case = |name: &str| store::is_of_case(self.study, name);
                let frame = older.archive.dataset(|name, _| !is_of_case(name))?;
                let mut frame = self.renewed(frame);
                add_branches(&mut frame, self.study, continued);
                store::write_beside_cases(&older.archive, self.study, &frame, self.output)?;
            }
        }
        Ok(())
    }

    /// What the file holds beside branches, with the text of this study.
    ///
    /// Fails if the file cannot be read.
    pub fn without_branches(&self, older: Option<&Kept>) -> Result<Dataset, CampaignError> {
        let Some(older) = older else { return Ok(store::frame(self.study)) };
        Ok(self.renewed(older.archive.dataset(|_, _| true)?))
    }

    /// What a file held, without branches and with the text of this study.
    fn renewed(&self, mut dataset: Dataset) -> Dataset {
        let frame = store::frame(self.study);
        dataset.texts.extend(frame.texts);
        dataset.attributes.extend(frame.attributes);
        drop_branches(&mut dataset);
        dataset
    }
}
