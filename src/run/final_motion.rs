//! What the search for attractors needs of the cases of a study, small enough to be held for millions.

use super::Record;
use crate::attractor;
use crate::capsule::Orbit;
use crate::study::Study;

/// What a case has settled to.
pub type FinalMotion = attractor::FinalMotion<3>;

/// The summary of a case that settled to `orbit`.
pub fn final_motion(orbit: &Orbit) -> FinalMotion {
    let (period, certificate) = (orbit.period as u32, &orbit.certificate);
    let (residual, multipliers) = (certificate.residual, &certificate.multipliers);
    attractor::FinalMotion::new(orbit.outcome, period, orbit.end.section(), residual, multipliers)
}

/// What the cases of a study have settled to, by index, as far as they have been computed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FinalMotions {
    /// The cases below, in rising order; none if they are all that the study has.
    cases: Option<Vec<usize>>,
    motions: Vec<Option<FinalMotion>>,
}

impl FinalMotions {
    /// Those of a study, of which some cases are known, in any order; of a refined study only these are held.
    pub fn of(study: &Study, known: impl Iterator<Item = (usize, FinalMotion)>) -> FinalMotions {
        if study.refine.is_some() {
            let mut known: Vec<(usize, FinalMotion)> = known.collect();
            known.sort_by_key(|(case, _)| *case);
            // Neighbouring tiles both have the cases between them.
            known.dedup_by_key(|(case, _)| *case);
            let (cases, motions) = known.into_iter().map(|(case, it)| (case, Some(it))).unzip();
            return FinalMotions { cases: Some(cases), motions };
        }
        let mut motions = vec![None; study.cases()];
        known.for_each(|(case, motion)| motions[case] = Some(motion));
        FinalMotions { cases: None, motions }
    }

    /// What a case has settled to; none if it has not been computed.
    pub fn get(&self, case: usize) -> Option<FinalMotion> {
        match &self.cases {
            None => self.motions[case],
            Some(cases) => self.motions[cases.binary_search(&case).ok()?],
        }
    }

    /// The cases that have been computed, in the order of their indices.
    pub fn known(&self) -> impl Iterator<Item = (usize, FinalMotion)> + '_ {
        let case = |place: usize| self.cases.as_ref().map_or(place, |cases| cases[place]);
        let all = self.motions.iter().enumerate();
        all.filter_map(move |(place, motion)| Some((case(place), (*motion)?)))
    }
}

/// The summaries of the cases of a study by index.
pub fn final_motions(study: &Study, records: &[Record]) -> FinalMotions {
    let of = |record: &Record| (record.index, final_motion(&record.orbit));
    FinalMotions::of(study, records.iter().map(of))
}
