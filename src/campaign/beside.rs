//! What is computed of a study beside its cases: branches and ramps.

use super::error::CampaignError;
use super::report::{Event, Reports, Stage};
use crate::run::{self, Continued, NotContinued, Ramped};
use crate::store::{Dataset, add_branches, add_ramps};
use crate::study::Study;

/// What is computed of a study beside its cases.
#[derive(Debug)]
pub struct Beside {
    /// What came of each branch.
    pub continued: Vec<Continued>,
    /// What came of each ramp.
    pub ramped: Vec<Ramped>,
}

impl Beside {
    /// The branches and the ramps of a study, on so many threads.
    pub(super) fn of(
        study: &Study,
        threads: Option<usize>,
        reports: &Reports<'_>,
    ) -> Result<Beside, CampaignError> {
        let stage = Stage::Continuing;
        reports.send(Event::Begun(stage, study.branches.len() + study.ramps.len()))?;
        let continued = run::continue_branches(study, threads, || reports.step(stage))?;
        let ramped = run::follow_ramps(study, threads, || reports.step(stage))?;
        reports.send(Event::Ended(stage))?;
        Ok(Beside { continued, ramped })
    }

    /// As if no branch could be continued and no ramp followed.
    pub fn none(study: &Study) -> Beside {
        Beside {
            continued: vec![Err(NotContinued::NoOrbit); study.branches.len()],
            ramped: vec![Ramped::NONE; study.ramps.len()],
        }
    }

    /// Adds both to a dataset.
    pub fn put_into(&self, dataset: &mut Dataset, study: &Study) {
        add_branches(dataset, study, &self.continued);
        add_ramps(dataset, study, &self.ramped);
    }
}
