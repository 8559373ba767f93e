//! The parameters of a capsule: a value for each, the law of resistance and the reading of the switching.

use capsulemap_engine::flow::Metric;

use super::drag::Drag;
use super::parameter::Parameter;
use super::resistance::{Resistance, Switching};
use crate::description::Parameters;

/// The places of the two choices of a capsule.
const RESISTANCE: usize = 0;
const SWITCHING: usize = 1;

/// What follows from the parameters of a capsule.
pub trait CapsuleParameters: Sized {
    /// The defaults, with these values (SI) in place of theirs.
    fn with(values: &[(Parameter, f64)]) -> Self;

    /// The law of resistance to the capsule.
    fn resistance(&self) -> Resistance;

    /// The reading of the switching between stick and slip.
    fn switching(&self) -> Switching;

    /// Chooses a law of resistance.
    fn resist_by(&mut self, law: Resistance);

    /// Chooses a reading of the switching.
    fn switch_by(&mut self, reading: Switching);

    /// Period of the drive, `2 pi / omega` [s].
    fn drive_period(&self) -> f64;

    /// How far two section points are apart: a displacement r counts as the velocity omega r, so that a section where y1 passes zero
    /// has a size too.
    fn metric(&self) -> Metric<3>;

    /// Force needed to leave rest, f_b = max(f_s, f_d(0+)); zero in a medium [N].
    fn break_away(&self) -> f64;

    /// That mu_s has no effect, in a sentence, where the friction at the onset of sliding is larger and alone decides when rest
    /// ends. In Eq. (1) as printed mu_s always has one.
    fn idle_static_friction(&self) -> Option<String>;

    /// The law of resistance with its constants.
    fn drag(&self) -> Drag<f64>;

    /// Normal load, `(m1 + m2) g` [N].
    fn normal_load(&self) -> f64;
}

impl CapsuleParameters for Parameters {
    fn with(values: &[(Parameter, f64)]) -> Self {
        let mut parameters = Parameters::default();
        for &(parameter, value) in values {
            parameters[parameter] = value;
        }
        parameters
    }

    fn resistance(&self) -> Resistance {
        Resistance::NAMES[self.chosen(RESISTANCE)].1
    }

    fn switching(&self) -> Switching {
        Switching::NAMES[self.chosen(SWITCHING)].1
    }

    fn resist_by(&mut self, law: Resistance) {
        self.choose(RESISTANCE, law as usize);
    }

    fn switch_by(&mut self, reading: Switching) {
        self.choose(SWITCHING, reading as usize);
    }

    fn drive_period(&self) -> f64 {
        2.0 * std::f64::consts::PI / self[Parameter::Omega]
    }

    fn metric(&self) -> Metric<3> {
        Metric { scales: [self[Parameter::Omega], 1.0, 1.0] }
    }

    fn break_away(&self) -> f64 {
        self.drag().break_away
    }

    fn idle_static_friction(&self) -> Option<String> {
        let drag = self.drag();
        let is_idle = self.switching() == Switching::Filippov && drag.static_limit < drag.at_onset;
        let onset = self.resistance().onset_in_words();
        is_idle.then(|| {
            format!(
                "mu_s below {onset} has no effect; the capsule breaks away at {onset} (m1 + m2) g = {:.4} N",
                drag.break_away
            )
        })
    }

    fn drag(&self) -> Drag<f64> {
        Drag::new(|parameter| self[parameter], self.resistance())
    }

    fn normal_load(&self) -> f64 {
        (self[Parameter::M1] + self[Parameter::M2]) * self[Parameter::G]
    }
}
