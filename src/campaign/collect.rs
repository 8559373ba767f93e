//! Takes blocks of a study together that were computed on machines without a common disk.

use std::path::Path;

use super::error::CampaignError;
use super::report::{Event, Report, Reports};
use super::request::Campaign;
use super::result_file::{block_path, prepare};
use crate::store::{BlockFolder, Company, Unusable};
use crate::study::spread;

impl Campaign<'_> {
    /// Copies into the folder of the blocks those that it lacks and another `folder` of blocks has; returns how many. The other folder is
    /// only read, and what is damaged in it is reported and left out.
    ///
    /// Fails if the other folder has no blocks, or those of another study or program, or if a block cannot be written.
    pub fn collect(&self, folder: &Path, report: &Report<'_>) -> Result<usize, CampaignError> {
        let reports = Reports::new(report);
        let other = BlockFolder::enter(folder, self.study, Company::Anybody, false)?;
        prepare(self.output)?;
        let own = block_path(self.output);
        let own = BlockFolder::enter(&own, self.study, Company::Tasks, self.overwrite)?;
        let mut copied = 0;
        for number in 0..self.study.blocks() {
            if own.open(number).is_ok() {
                continue;
            }
            match other.open(number) {
                Ok(_) => {
                    own.copy(&other, number)?;
                    copied += 1;
                }
                Err(Unusable::Missing) => {}
                Err(why) => {
                    reports.send(Event::LeftOut { file: &other.file(number), why: &why })?;
                }
            }
        }
        Ok(copied)
    }

    /// Which of so many tasks have blocks that are not done, by their numbers; none where the file is whole.
    ///
    /// Fails if the folder of blocks holds those of another study or cannot be read.
    pub fn unfinished_tasks(&self, of: usize) -> Result<Vec<usize>, CampaignError> {
        if self.kept()?.is_some_and(|whole| whole.archive.has_cases()) {
            return Ok(Vec::new());
        }
        let done = self.status()?.blocks.unwrap_or_default();
        let mut missing = vec![true; self.study.blocks()];
        done.done.iter().for_each(|block| missing[block.number] = false);
        // The tasks take turns in the order in which blocks are computed.
        let mut unfinished = vec![false; of];
        for (place, block) in spread(self.study.blocks()).into_iter().enumerate() {
            unfinished[place % of] |= missing[block];
        }
        Ok((1..=of).filter(|number| unfinished[number - 1]).collect())
    }
}
