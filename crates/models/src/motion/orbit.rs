//! What a case settles to.

use capsulemap_engine::flow::Reason;
use capsulemap_engine::orbit::{self, Certificate, Outcome};

use crate::description::{Description, Outputs, Section, State};

/// Where and why a case failed.
pub type Failure = orbit::Failure<State>;

/// Why a case of a model may fail, with its names in files; under a drive it always comes back to its section.
pub fn reasons(model: &Description) -> Vec<(Reason, &'static str)> {
    let always_returns = model.has_drive();
    let names = Reason::NAMES.into_iter();
    names.filter(|(reason, _)| *reason != Reason::NoReturn || !always_returns).collect()
}

/// What a case settled to.
#[derive(Debug, Clone, PartialEq)]
pub struct Orbit {
    /// What it turned out to be.
    pub outcome: Outcome,
    /// Its period [cycles]; zero unless periodic.
    pub period: u64,
    /// What is proven of its period.
    ///
    /// Of an orbit that is at rest at the section on a surface that holds it, as that of dry friction, one multiplier is 0. It is
    /// that of pushes off the surface as far as they end on it again; where what holds it is more than what resists its motion, a
    /// push off the surface, however small, sets it in motion.
    pub certificate: Certificate<Section>,
    /// Cycles followed since the first section, measuring included.
    pub cycles: u64,
    /// Per-cycle sums and the like; NaN where the case failed.
    pub outputs: Outputs,
    /// Section points of the measured cycles, up to `Protocol::points`.
    pub section: Vec<Section>,
    /// Impacts of the measured cycles, up to `Protocol::impact_points`: by what the model tells of an impact, then by impact.
    pub impacts: Vec<Vec<f64>>,
    /// Samples of the motion at even times, both ends included, where the protocol asks for them: by what the model tells at each
    /// time, then by time; none where it does not.
    pub history: Vec<Vec<f64>>,
    /// Where it was last.
    pub end: State,
    /// Why it could not be followed, if so.
    pub failure: Option<Failure>,
}
