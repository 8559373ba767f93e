//! What has to be kept of a settled case to tell its attractor.

use crate::orbit::matrix::{Complex, least_from_one};
use crate::orbit::{Orbit, Outcome};

/// What a case has settled to, without the orbit itself, which can be followed again from its last point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FinalMotion<P> {
    /// What the case turned out to be.
    pub outcome: Outcome,
    /// Whether small pushes die out, by its multipliers.
    pub is_stable: bool,
    /// Its period [cycles]; zero unless periodic.
    pub period: u32,
    /// The section point where it was last, from where it can be followed on.
    pub section: P,
    /// How far the section is from repeating after a period, relative to the motion [-].
    pub residual: f64,
    /// The least distance of a multiplier from one [-].
    pub from_one: f64,
}

impl<P> FinalMotion<P> {
    /// The motion of a case with this outcome, period, last section point, and residual and multipliers of
    /// its certificate, the largest magnitude first; they are NaN where there is none.
    pub fn new(
        outcome: Outcome,
        period: u32,
        section: P,
        residual: f64,
        multipliers: &[Complex],
    ) -> Self {
        let is_stable = multipliers[0].abs() < 1.0;
        let from_one = least_from_one(multipliers);
        FinalMotion { outcome, is_stable, period, section, residual, from_one }
    }

    /// The same with the section point held in another way.
    pub fn map<Q>(self, held: impl FnOnce(P) -> Q) -> FinalMotion<Q> {
        let FinalMotion { outcome, is_stable, period, section, residual, from_one } = self;
        FinalMotion { outcome, is_stable, period, section: held(section), residual, from_one }
    }
}

impl<const D: usize> FinalMotion<[f64; D]> {
    /// The motion of what a case of any system has settled to.
    pub fn of<S, O>(orbit: &Orbit<S, O, D>, section: [f64; D]) -> Self {
        let certificate = &orbit.certificate;
        let (period, multipliers) = (orbit.period as u32, &certificate.multipliers);
        FinalMotion::new(orbit.outcome, period, section, certificate.residual, multipliers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_is_small_and_a_missing_one_takes_no_more() {
        assert_eq!(size_of::<FinalMotion<[f64; 3]>>(), 48);
        assert_eq!(size_of::<Option<FinalMotion<[f64; 3]>>>(), 48);
    }

    #[test]
    fn only_known_multipliers_within_the_unit_circle_are_stable() {
        let motion = |re: f64| {
            let multipliers = [re, 0.25, 0.0].map(|re| Complex { re, im: 0.0 });
            FinalMotion::new(Outcome::Periodic, 1, [0.0; 3], 0.0, &multipliers)
        };
        assert_eq!((motion(-0.5).is_stable, motion(-0.5).from_one), (true, 0.75));
        assert!(!motion(-1.5).is_stable && !motion(f64::NAN).is_stable);
    }
}
