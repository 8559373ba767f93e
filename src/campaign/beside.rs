//! What is computed of a study beside its cases: branches, ramps, and the boundaries of its map.

use super::error::CampaignError;
use super::map_cases::Results;
use super::report::{Event, Reports, Stage};
use crate::run::{self, Continued, MapBoundaries, NotContinued, Ramped};
use crate::store::{Dataset, add_boundaries, add_branches, add_ramps};
use crate::study::{Continuation, Study};

/// What is computed of a study beside its cases.
#[derive(Debug)]
pub struct Beside {
    /// What came of each branch.
    pub continued: Vec<Continued>,
    /// What came of each ramp.
    pub ramped: Vec<Ramped>,
    /// The boundaries of its map, if it asks for them.
    pub boundaries: Option<MapBoundaries>,
}

impl Beside {
    /// The branches, the ramps and the boundaries of a study, on so many threads; `results` hold its cases, if they are there.
    pub(super) fn of(
        study: &Study,
        results: Option<Results<'_>>,
        threads: Option<usize>,
        reports: &Reports<'_>,
    ) -> Result<Beside, CampaignError> {
        let results = match (study.boundaries, results) {
            (Some(_), None) => return Err(CampaignError::NoMap),
            (asked, results) => asked.zip(results),
        };
        let stage = Stage::Continuing;
        reports.send(Event::Begun(stage, study.branches.len() + study.ramps.len()))?;
        let continued = run::continue_branches(study, threads, || reports.step(stage))?;
        let ramped = run::follow_ramps(study, threads, || reports.step(stage))?;
        reports.send(Event::Ended(stage))?;
        let mut boundaries = None;
        if let Some((asked, results)) = results {
            let stage = Stage::Outlining;
            reports.send(Event::Begun(stage, asked.most_tries))?;
            let done = || reports.note(Event::Step(stage));
            boundaries = Some(results.boundaries(study, &asked, threads, done)?);
            reports.send(Event::Ended(stage))?;
        }
        Ok(Beside { continued, ramped, boundaries })
    }

    /// As if no branch could be continued, no ramp followed and no boundary located.
    pub fn none(study: &Study) -> Beside {
        Beside {
            continued: vec![Err(NotContinued::NoOrbit); study.branches.len()],
            ramped: vec![Ramped::NONE; study.ramps.len()],
            boundaries: study.boundaries.map(|_| MapBoundaries::default()),
        }
    }

    /// Adds all to a dataset.
    pub fn put_into(&self, dataset: &mut Dataset, study: &Study) {
        let followed = self.boundaries.iter().flat_map(|it| &it.followed);
        let (continuations, found): (Vec<&Continuation>, Vec<Continued>) =
            followed.map(|(continuation, found)| (continuation, Ok(found.clone()))).unzip();
        let all: Vec<Continuation> = study.branches.iter().chain(continuations).cloned().collect();
        let continued: Vec<Continued> = self.continued.iter().cloned().chain(found).collect();
        add_branches(dataset, study, &all, &continued);
        if let Some(boundaries) = &self.boundaries {
            add_boundaries(dataset, study, boundaries);
        }
        add_ramps(dataset, study, &self.ramped);
    }
}
