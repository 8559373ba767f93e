//! One case: parameters, a start, and the phases of the drive at the start and at the section.

use capsulemap_engine::flow::Stroboscopic;
use capsulemap_engine::orbit::{self, Trajectory};

use super::drive::reduced;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::state::State;
use super::system::{CapsuleSystem, Reading};
use crate::description::{self, Parameters};

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Its parameters.
    pub parameters: Parameters,
    /// Where it starts.
    pub start: description::State,
    /// Phase of the drive at the start [rad].
    pub start_phase: f64,
    /// Phase of the drive at the stroboscopic section [rad].
    pub section_phase: f64,
}

impl Case {
    /// A case that starts on its section, at `phase` of the drive [rad].
    pub fn at_section(
        parameters: Parameters,
        start: impl Into<description::State>,
        phase: f64,
    ) -> Case {
        Case { parameters, start: start.into(), start_phase: phase, section_phase: phase }
    }

    /// Time of the start since the last passage of the section phase [s]; zero where the phases are equal.
    pub fn start_time(&self) -> f64 {
        let turned = reduced(self.start_phase - self.section_phase);
        let time = turned / self.parameters[Parameter::Omega];
        // A phase that is less by rounding alone is a whole turn ahead.
        if time < self.parameters.drive_period() { time } else { 0.0 }
    }

    /// Its way from the start, as `system` moves.
    pub fn trajectory<'a, S>(&self, system: &'a S, tolerance: f64) -> Trajectory<'a, S, 3>
    where
        S: Stroboscopic<f64, 3, State = State<f64>>,
    {
        Trajectory::begun(system, State::from(&self.start), self.start_time(), tolerance)
    }

    /// The case for the engine, its friction read as `R` says.
    pub fn read<R: Reading>(&self) -> orbit::Case<CapsuleSystem<R>, 3> {
        let system = CapsuleSystem::new(self.parameters.clone(), self.section_phase);
        orbit::Case { system, start: State::from(&self.start), begins: self.start_time() }
    }
}
