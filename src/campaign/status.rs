//! How far a campaign is, from the files on the disk.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

use crate::run::{Estimate, Forecast};
use crate::store::{BlockFolder, Company, StoreError, Summary, Unusable, provenance};
use crate::study::Study;

use super::claims::ClaimStatus;
use super::error::CampaignError;
use super::kept::{Kept, kept};
use super::request::Campaign;
use super::result_file::block_path;

/// The pace is that of the blocks written within this time.
const RECENT: Duration = Duration::from_secs(300);

/// What lies on the disk of a campaign.
#[derive(Debug)]
pub struct Status {
    /// The blocks that are not joined yet; none if there is no folder of them.
    pub blocks: Option<BlockStatus>,
    /// The file in the place of the results, or why that is none of this study.
    pub file: Result<Option<Kept>, CampaignError>,
}

/// The blocks in a folder, from their heads.
#[derive(Debug, Default)]
pub struct BlockStatus {
    /// Their folder.
    pub folder: PathBuf,
    /// Whether a run holds them.
    pub is_busy: bool,
    /// Those that are done.
    pub done: Vec<Summary>,
    /// When each of them was written.
    pub written: Vec<SystemTime>,
    /// Their size [bytes].
    pub bytes: u64,
    /// How many each program and machine computed.
    pub makers: BTreeMap<String, usize>,
    /// The claims on those that are not done, and on the join.
    pub claims: Vec<ClaimStatus>,
    /// The files of others, and what is wrong with them.
    pub faults: Vec<(PathBuf, Unusable)>,
}

/// The rate at which blocks are done.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Time since the last one.
    pub since_last: Duration,
    /// Cases done lately [1/s]; none if too few blocks are done.
    pub cases_per_second: Option<f64>,
    /// Time that the rest will take [s].
    pub left: Option<Estimate>,
}

impl Campaign<'_> {
    /// What lies on the disk; a run is not disturbed, and nothing is changed.
    ///
    /// Fails if the folder of blocks holds those of another study or cannot be read.
    pub fn status(&self) -> Result<Status, CampaignError> {
        let path = block_path(self.output);
        let blocks = match BlockFolder::enter(&path, self.study, Company::Anybody, false) {
            Ok(folder) => Some(BlockStatus::of(self.study, &folder)),
            Err(StoreError::NoBlocks { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        Ok(Status { blocks, file: kept(self.output, self.study, false) })
    }
}

impl BlockStatus {
    /// Reads the heads of all blocks, not their numbers.
    fn of(study: &Study, folder: &BlockFolder) -> BlockStatus {
        let is_busy = BlockFolder::is_busy(folder.path());
        let mut blocks =
            BlockStatus { folder: folder.path().to_owned(), is_busy, ..BlockStatus::default() };
        for number in 0..study.blocks() {
            let file = folder.file(number);
            match folder.head(number) {
                Ok(head) => {
                    let metadata = std::fs::metadata(&file);
                    blocks.bytes += metadata.as_ref().map_or(0, |it| it.len());
                    let written = metadata.and_then(|it| it.modified());
                    blocks.written.push(written.unwrap_or(SystemTime::UNIX_EPOCH));
                    *blocks.makers.entry(provenance::maker(&head.provenance)).or_default() += 1;
                    blocks.done.push(head.block);
                }
                Err(Unusable::Missing) => {
                    blocks.claims.extend(ClaimStatus::read(&folder.claim(number), Some(number)));
                }
                Err(why) => blocks.faults.push((file, why)),
            }
        }
        blocks.claims.extend(ClaimStatus::read(&folder.claim_on_join(), None));
        blocks
    }

    /// Cases in the blocks that are done.
    pub fn cases(&self) -> usize {
        self.done.iter().map(|block| block.cases).sum()
    }

    /// Time since the last block, rate of the blocks, and time that the rest of `study` will take; none before
    /// the first block.
    pub fn pace(&self, study: &Study) -> Option<Pace> {
        let last = *self.written.iter().max()?;
        let since_last = last.elapsed().unwrap_or(Duration::ZERO);
        let written = self.written.iter().copied();
        let recent = written.filter(|at| last.duration_since(*at).is_ok_and(|ago| ago <= RECENT));
        let first = recent.min().unwrap_or(last);
        let span = last.duration_since(first).unwrap_or(Duration::ZERO).as_secs_f64();
        // The first block of the span was computed before it.
        let in_span = self.done.iter().zip(&self.written);
        let in_span = in_span.filter(|(_, at)| **at > first && **at <= last);
        let in_span: Vec<&Summary> = in_span.map(|(it, _)| it).collect();
        let cases: usize = in_span.iter().map(|block| block.cases).sum();
        let cycles: u64 = in_span.iter().map(|block| block.cycles).sum();
        if cycles == 0 || span == 0.0 {
            return Some(Pace { since_last, cases_per_second: None, left: None });
        }
        let mut forecast = Forecast::new(study.cases());
        self.done.iter().for_each(|it| forecast.complete(it.number, it.cases, it.cycles));
        let left = forecast.seconds_left(span / cycles as f64);
        Some(Pace { since_last, cases_per_second: Some(cases as f64 / span), left })
    }
}
