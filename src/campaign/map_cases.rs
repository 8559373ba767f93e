//! What the cases of a map are, from the results that hold them, for its boundaries.

use std::cell::RefCell;
use std::ops::ControlFlow;

use super::error::CampaignError;
use crate::description::Section;
use crate::run::{MapBoundaries, MapCases, MotionKind, map_boundaries};
use crate::store::catalogue::{OUTCOME, PERIOD, section};
use crate::store::{Archive, Dataset, StoreError, Values, Variable};
use crate::study::{Boundaries, Study};

/// Results that hold the cases of a study.
#[derive(Clone, Copy)]
pub enum Results<'a> {
    /// In a file.
    File(&'a Archive),
    /// In memory.
    Memory(&'a Dataset),
}

impl Results<'_> {
    /// A variable with its numbers; none if there is none of this name.
    fn variable(&self, name: &str) -> Result<Option<Variable>, StoreError> {
        match self {
            Results::File(archive) => archive.variable(name),
            Results::Memory(dataset) => Ok(dataset.variable(name).cloned()),
        }
    }

    /// The first section point of the case at a position, if it has one.
    fn section_point(&self, position: &[usize]) -> Result<Option<Section>, StoreError> {
        let dataset = match self {
            Results::File(archive) => return archive.section_point(position),
            Results::Memory(dataset) => dataset,
        };
        let first: Vec<usize> = position.iter().copied().chain([0]).collect();
        let coordinates = section(dataset.model()).into_iter().map(|entry| {
            match &dataset.variable(entry.name)?.values {
                Values::Real(values) => values.get(&first[..]).copied(),
                Values::Integer(_) => None,
            }
        });
        let coordinates = coordinates.map(|value| value.filter(|it: &f64| it.is_finite()));
        Ok(coordinates.collect::<Option<Vec<f64>>>().map(|it| it.into_iter().collect()))
    }

    /// The kind of motion of each case; none of a case that failed or has not been computed.
    fn kinds(&self, study: &Study) -> Result<Vec<Option<MotionKind>>, StoreError> {
        let missing = vec![None; study.cases()];
        let (Some(outcomes), Some(periods)) =
            (self.variable(OUTCOME.name)?, self.variable(PERIOD.name)?)
        else {
            return Ok(missing);
        };
        let names = outcomes.names().into_iter().map(|name| name.unwrap_or("missing"));
        let periods = periods.values.to_real();
        let mut counts = Vec::new();
        for output in study.base.model().impact_counts().filter(|it| study.outputs.contains(it)) {
            counts.extend(self.variable(output.name())?.map(|it| it.values.to_real()));
        }
        let counts: Vec<Vec<f64>> = counts.into_iter().map(|it| it.into_iter().collect()).collect();
        let kinds = names.zip(periods).enumerate().map(|(case, (outcome, period))| match outcome {
            "missing" | "inferred" | "failed" => None,
            _ if period > 0.0 => {
                let impacts = counts.iter().map(|of_case| (of_case[case] * period).round() as i64);
                Some(MotionKind { period: period as u64, impacts: impacts.collect() })
            }
            _ => Some(MotionKind { period: 0, impacts: Vec::new() }),
        });
        Ok(kinds.collect())
    }

    /// The boundaries of the map that they hold, see [`map_boundaries`].
    ///
    /// Fails if the results cannot be read, or the threads cannot be started.
    pub fn boundaries(
        &self,
        study: &Study,
        asked: &Boundaries,
        threads: Option<usize>,
        done: impl Fn() -> ControlFlow<()> + Sync,
    ) -> Result<MapBoundaries, CampaignError> {
        let kinds = self.kinds(study)?;
        let unread = RefCell::new(None);
        let section = |case: usize| match self.section_point(&study.position(case)) {
            Ok(point) => point,
            Err(error) => {
                *unread.borrow_mut() = Some(error);
                None
            }
        };
        let cases = MapCases { kinds: &kinds, section: &section };
        let found = map_boundaries(study, asked, &cases, threads, done)?;
        unread.into_inner().map_or(Ok(found), |error| Err(error.into()))
    }
}
