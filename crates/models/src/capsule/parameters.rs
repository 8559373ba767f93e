//! The parameters of a capsule: a value for each, the law of resistance and the reading of the switching.

use capsulemap_engine::flow::Metric;

use super::drag::Drag;
use super::general::balance::Balance;
use super::parameter::Parameter;
use super::resistance::{Resistance, Switching};
use super::shape::{DriveKind, Form, Reaction, Release, Shape};
use crate::description::Parameters;

/// The places of the choices of a capsule.
const RESISTANCE: usize = 0;
const SWITCHING: usize = 1;
const DRIVE: usize = 2;
const REACTION: usize = 3;
const RELEASE: usize = 4;

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

    /// Chooses how the force of the drive depends on its phase.
    fn drive_by(&mut self, kind: DriveKind);

    /// Chooses what takes up the reaction of the drive.
    fn react_on(&mut self, reaction: Reaction);

    /// Chooses when the mass leaves a stop that damps.
    fn release_by(&mut self, release: Release);

    /// What the equations are made of.
    fn shape(&self) -> Shape;

    /// By which equations the capsule moves.
    fn form(&self) -> Form;

    /// Frequency of the drive [rad/s].
    fn frequency(&self) -> f64;

    /// Period of the drive, `2 pi / omega` [s].
    fn drive_period(&self) -> f64;

    /// How far two section points are apart: a displacement r counts as the velocity omega r, so that a section where y1 passes zero
    /// has a size too.
    fn metric(&self) -> Metric<3>;

    /// How many times mu_d N the friction is where sliding begins.
    fn onset_factor(&self) -> f64;

    /// The friction coefficient where sliding begins, in words.
    fn onset_in_words(&self) -> String;

    /// Force needed to leave rest, f_b = max(f_s, f_d(0+)), the larger one where it differs by direction; zero in a medium [N].
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

    fn drive_by(&mut self, kind: DriveKind) {
        self.choose(DRIVE, kind as usize);
    }

    fn react_on(&mut self, reaction: Reaction) {
        self.choose(REACTION, reaction as usize);
    }

    fn release_by(&mut self, release: Release) {
        self.choose(RELEASE, release as usize);
    }

    fn shape(&self) -> Shape {
        Shape::of(self)
    }

    fn form(&self) -> Form {
        self.shape().form(self.switching())
    }

    fn frequency(&self) -> f64 {
        self.shape().frequency(|it| self[it])
    }

    fn drive_period(&self) -> f64 {
        2.0 * std::f64::consts::PI / self.frequency()
    }

    fn metric(&self) -> Metric<3> {
        Metric::new([self.frequency(), 1.0, 1.0])
    }

    fn onset_factor(&self) -> f64 {
        let is_given = self.shape().has(Parameter::Stribeck);
        match self.resistance() {
            Resistance::CoulombStribeck if is_given => 1.0 + self[Parameter::Stribeck],
            law => law.onset_factor(),
        }
    }

    fn onset_in_words(&self) -> String {
        let is_given = self.shape().has(Parameter::Stribeck);
        match self.resistance() {
            Resistance::CoulombStribeck if is_given => "(1 + stribeck) mu_d".to_owned(),
            law => law.onset_in_words(),
        }
    }

    fn break_away(&self) -> f64 {
        match self.form() {
            Form::General | Form::OverFolds => Balance::of(self).break_away,
            Form::Filippov | Form::AsPrinted => self.drag().break_away,
        }
    }

    fn idle_static_friction(&self) -> Option<String> {
        let shape = self.shape();
        let onset = self.onset_factor() * self[Parameter::MuD];
        let is_idle = self.switching() == Switching::Filippov
            && !shape.is_medium()
            && !shape.has_friction_by_direction()
            && self.normal_load() > 0.0
            && self[Parameter::MuS] < onset;
        let onset = self.onset_in_words();
        let load =
            if shape.has(Parameter::Incline) { "(m1 + m2) g cos(incline)" } else { "(m1 + m2) g" };
        is_idle.then(|| {
            format!(
                "mu_s below {onset} has no effect; the capsule breaks away at {onset} {load} = {:.4} N",
                self.break_away()
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
