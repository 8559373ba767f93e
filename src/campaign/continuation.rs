//! Continues the branches of a study, follows its ramps and the boundaries of its map, and puts all into its file, beside the cases that
//! it holds.

use std::time::Instant;

use super::beside::Beside;
use super::error::CampaignError;
use super::kept::{Kept, check_branches};
use super::map_cases::Results;
use super::report::{Event, Report, Reports};
use super::request::{BranchesDone, Campaign, Complete};
use super::result_file::prepare;
use crate::store::{self, Dataset, drop_branches, has_branches};

impl Campaign<'_> {
    /// Continues the branches of the study, follows its ramps and the boundaries of its map, and puts all into the file; cases that are
    /// there stay, and branches of this study that are there too, unless they are to be overwritten.
    ///
    /// Fails if the study asks for none of them, if it asks for boundaries and the file has no cases, or if the file holds results of
    /// something else.
    pub fn continue_branches(&self, report: &Report<'_>) -> Result<BranchesDone, CampaignError> {
        if !self.study.has_more_than_cases() {
            return Err(CampaignError::NoBranches);
        }
        self.study.check_text("the study")?;
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
        // Only the boundaries of a map need the cases; a file that is open cannot be replaced by others meanwhile.
        let older = older.filter(|it| self.study.boundaries.is_some() && it.archive.has_cases());
        prepare(self.output)?;
        let begun = Instant::now();
        let results = older.as_ref().map(|it| Results::File(&it.archive));
        let found = Beside::of(self.study, results, self.machine.threads, &reports)?;
        drop(older);
        let time = begun.elapsed();
        self.put(&found, &reports)?;
        Ok(BranchesDone::Now { found, time })
    }

    /// Whether a file that is there has the branches of this study and is to stay.
    fn has_its_branches(&self, older: &Kept) -> bool {
        older.same_text && has_branches(older.archive.frame()) && !self.overwrite
    }

    /// Writes the branches beside what the file holds by now.
    fn put(&self, found: &Beside, reports: &Reports<'_>) -> Result<(), CampaignError> {
        // Cases that were joined meanwhile are in the file, and none can come before it is replaced.
        let _held = store::hold(self.output, |folder| reports.wait(folder))?;
        store::discard_unfinished(self.output)?;
        let older = self.kept()?;
        check_branches(older.as_ref(), self.output, self.overwrite)?;
        let older = older.filter(|older| older.archive.has_cases());
        let of_case = store::numbers_of_case(self.study);
        let mut frame =
            self.without_branches(older.as_ref(), |name| !of_case.contains_key(name))?;
        found.put_into(&mut frame, self.study);
        match older {
            Some(older) => {
                store::write_beside_cases(&older.archive, self.study, &frame, self.output)?;
            }
            None => store::write(&frame, self.output)?,
        }
        Ok(())
    }

    /// What the file holds beside branches, of which variables those that are `wanted`, with the text of this study.
    ///
    /// Fails if the file cannot be read.
    pub fn without_branches(
        &self,
        older: Option<&Kept>,
        wanted: impl Fn(&str) -> bool,
    ) -> Result<Dataset, CampaignError> {
        let frame = store::frame(self.study);
        let Some(older) = older else { return Ok(frame) };
        let mut dataset = older.archive.dataset(|name, _| wanted(name))?;
        dataset.texts.extend(frame.texts);
        dataset.attributes.extend(frame.attributes);
        drop_branches(&mut dataset);
        Ok(dataset)
    }
}
