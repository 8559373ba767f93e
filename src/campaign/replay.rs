//! A case of a study by its number, with the start that it had in the run, to be computed again.

use super::error::CampaignError;
use super::report::{Event, Report, Reports, Stage};
use crate::motion::Case;
use crate::orbit::Protocol;
use crate::run::{Machine, run_sample};
use crate::study::Study;

/// A case of a study that is computed again.
#[derive(Debug, Clone, Copy)]
pub struct Replay<'a> {
    study: &'a Study,
    index: usize,
    /// The chain that it is in.
    chain: usize,
    /// Its place there.
    place: usize,
}

impl<'a> Replay<'a> {
    /// Case `index` of `study`, counted from 0 with the last axis fastest.
    ///
    /// Fails if there is no such case.
    pub fn new(study: &'a Study, index: usize) -> Result<Self, CampaignError> {
        let found = (0..study.chains())
            .find_map(|chain| Some((chain, study.chain(chain).position(|case| case == index)?)));
        let missing = CampaignError::NoCase { index, cases: study.cases() };
        let (chain, place) = found.ok_or(missing)?;
        Ok(Replay { study, index, chain, place })
    }

    /// How the case is integrated and judged.
    pub fn protocol(&self) -> &'a Protocol {
        &self.study.protocol
    }

    /// Cases that must be computed first, as each starts where the one before it settles.
    pub fn cases_before(&self) -> usize {
        self.place
    }

    /// Parameters, start and phase as the study gives them, which for a case with others before it is not
    /// where it started in the run.
    pub fn as_asked(&self) -> Case {
        self.study.case(self.index)
    }

    /// Parameters, start and phase as they were in the run, to the bit; the cases of its chain are computed if
    /// others come before it.
    ///
    /// Fails if the computation cannot be started.
    pub fn as_run(&self, machine: Machine, report: &Report<'_>) -> Result<Case, CampaignError> {
        let mut case = self.as_asked();
        if self.place == 0 {
            return Ok(case);
        }
        let reports = Reports::new(report);
        let cases = self.study.chain(self.chain).count();
        reports.send(Event::Begun(Stage::Repeating, cases))?;
        let records =
            run_sample(self.study, machine, &[self.chain], || reports.step(Stage::Repeating))?;
        reports.send(Event::Ended(Stage::Repeating))?;
        if let Some(record) = records.iter().find(|record| record.index == self.index) {
            (case.start, case.start_phase) = (record.start.clone(), record.start_phase);
        }
        Ok(case)
    }
}
