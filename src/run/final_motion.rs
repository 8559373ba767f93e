//! What the search for attractors needs of the cases of a study, small enough to be held for millions.

use super::Record;
use crate::attractor;
use crate::description::Section;
use crate::motion::Orbit;
use crate::study::Study;

/// What a case has settled to.
pub type FinalMotion = attractor::FinalMotion<Section>;

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
    /// What each has settled to, but for the section point.
    motions: Vec<Option<attractor::FinalMotion<()>>>,
    /// The section points, one after the other, each of so many coordinates: there may be millions.
    points: Vec<f64>,
    coordinates: usize,
}

impl FinalMotions {
    /// Those of a study, of which some cases are known, in any order; of a refined study only these are held.
    pub fn of(study: &Study, known: impl Iterator<Item = (usize, FinalMotion)>) -> FinalMotions {
        if study.refine.is_some() {
            let mut known: Vec<(usize, FinalMotion)> = known.collect();
            known.sort_by_key(|(case, _)| *case);
            // Neighbouring tiles both have the cases between them.
            known.dedup_by_key(|(case, _)| *case);
            let cases = Some(known.iter().map(|(case, _)| *case).collect());
            let mut all = FinalMotions { cases, ..FinalMotions::blank(study, known.len()) };
            known.into_iter().enumerate().for_each(|(place, (_, motion))| all.put(place, motion));
            return all;
        }
        let mut all = FinalMotions::blank(study, study.cases());
        known.for_each(|(case, motion)| all.put(case, motion));
        all
    }

    /// Room for so many cases of a study, of which none is known.
    fn blank(study: &Study, cases: usize) -> FinalMotions {
        let coordinates = study.base.model().section.len();
        FinalMotions {
            cases: None,
            motions: vec![None; cases],
            points: vec![f64::NAN; coordinates * cases],
            coordinates,
        }
    }

    /// Bytes that are held of each case of a study.
    pub fn bytes_of_case(study: &Study) -> usize {
        let coordinates = study.base.model().section.len();
        size_of::<Option<attractor::FinalMotion<()>>>() + coordinates * size_of::<f64>()
    }

    fn put(&mut self, place: usize, motion: FinalMotion) {
        self.points[self.coordinates * place..][..self.coordinates]
            .copy_from_slice(&motion.section);
        self.motions[place] = Some(motion.map(|_| ()));
    }

    /// What stands at a place among those that are held.
    fn at(&self, place: usize) -> Option<FinalMotion> {
        let motion = self.motions[place]?;
        let point = &self.points[self.coordinates * place..][..self.coordinates];
        Some(motion.map(|()| Section::new(point)))
    }

    /// What a case has settled to; none if it has not been computed.
    pub fn get(&self, case: usize) -> Option<FinalMotion> {
        match &self.cases {
            None => self.at(case),
            Some(cases) => self.at(cases.binary_search(&case).ok()?),
        }
    }

    /// The cases that have been computed, in the order of their indices.
    pub fn known(&self) -> impl Iterator<Item = (usize, FinalMotion)> + '_ {
        (0..self.motions.len()).filter_map(|place| Some((self.case(place), self.at(place)?)))
    }

    /// The case at a place among those that are held.
    fn case(&self, place: usize) -> usize {
        self.cases.as_ref().map_or(place, |cases| cases[place])
    }
}

/// The summaries of the cases of a study by index.
pub fn final_motions(study: &Study, records: &[Record]) -> FinalMotions {
    FinalMotions::of(study, records.iter().map(|it| (it.index, final_motion(&it.orbit))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::Outcome;
    use crate::orbit::matrix::Complex;
    use crate::study::Refine;

    #[test]
    fn what_is_held_flat_comes_back_as_it_was() {
        let text = "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\np_d = \"3 N\"\n\
                    [[axes]]\nname = \"omega\"\nfrom = \"30 rad/s\"\nto = \"90 rad/s\"\npoints = 5\n";
        let study = Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"));
        let motion = |case: usize| {
            let section = [case as f64, 0.5, -1.0].into();
            FinalMotion::new(
                Outcome::Periodic,
                case as u32,
                section,
                1e-13,
                &[Complex { re: 0.5, im: 0.0 }],
            )
        };
        let known = [4, 1].map(|case| (case, motion(case)));
        let refined = Study { refine: Some(Refine::Attractors), ..study.clone() };
        for study in [study, refined] {
            let all = FinalMotions::of(&study, known.into_iter());
            assert_eq!(all.known().collect::<Vec<_>>(), [1, 4].map(|case| (case, motion(case))));
            assert_eq!((all.get(4), all.get(2)), (Some(motion(4)), None));
        }
    }
}
