//! Endings: what the search for attractors needs of a case, small enough to hold one for each of millions.

use crate::capsule::{Orbit, Section, State};
use crate::orbit::Outcome;
use crate::orbit::matrix::Complex;
use crate::orbit::matrix::least_from_one;

use super::Record;
use crate::study::Study;

/// How a case has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ending {
    /// What the case turned out to be.
    pub outcome: Outcome,
    /// Whether small pushes die out, by its multipliers.
    pub is_stable: bool,
    /// Its period [cycles]; zero unless periodic.
    pub period: u32,
    /// The section point where it was last, from where it can be followed on.
    pub section: Section,
    /// How far the section is from repeating after a period, relative to the motion [-].
    pub residual: f64,
    /// The least distance of a multiplier from one [-].
    pub from_one: f64,
}

impl Ending {
    /// The ending of a case with this outcome, period, last section point, and residual and multipliers of
    /// its certificate, the largest magnitude first; they are NaN where there is none.
    pub fn new(
        outcome: Outcome,
        period: u32,
        section: Section,
        residual: f64,
        multipliers: &[Complex; 3],
    ) -> Ending {
        let is_stable = multipliers[0].abs() < 1.0;
        let from_one = least_from_one(multipliers);
        Ending { outcome, is_stable, period, section, residual, from_one }
    }

    /// The ending of a case that settled to `orbit`.
    pub fn of(orbit: &Orbit) -> Ending {
        let State { r, y1, y2, .. } = orbit.end;
        let (period, certificate) = (orbit.period as u32, &orbit.certificate);
        let (residual, multipliers) = (certificate.residual, &certificate.multipliers);
        Ending::new(orbit.outcome, period, [r, y1, y2], residual, multipliers)
    }
}

/// The endings of the cases of a study by index; none for a case without a record.
pub fn endings(study: &Study, records: &[Record]) -> Vec<Option<Ending>> {
    let mut endings = vec![None; study.cases()];
    for record in records {
        endings[record.index] = Some(Ending::of(&record.orbit));
    }
    endings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ending_is_small_and_a_missing_one_takes_no_more() {
        assert_eq!(size_of::<Ending>(), 48);
        assert_eq!(size_of::<Option<Ending>>(), 48);
    }

    #[test]
    fn only_known_multipliers_within_the_unit_circle_are_stable() {
        let ending = |re: f64| {
            let multipliers = [re, 0.25, 0.0].map(|re| Complex { re, im: 0.0 });
            Ending::new(Outcome::Periodic, 1, [0.0; 3], 0.0, &multipliers)
        };
        assert_eq!((ending(-0.5).is_stable, ending(-0.5).from_one), (true, 0.75));
        assert!(!ending(-1.5).is_stable && !ending(f64::NAN).is_stable);
    }
}
