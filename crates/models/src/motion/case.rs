//! One case: parameters, a start, and the phases of the drive at the start and at the section.

use std::f64::consts::PI;

use crate::description::{Parameters, State};

/// A case: parameters, where it starts, and the phases of the drive at the start and at the section.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The parameters.
    pub parameters: Parameters,
    /// Where it starts.
    pub start: State,
    /// Phase of the drive at the start [rad].
    pub start_phase: f64,
    /// Phase of the drive at the stroboscopic section [rad].
    pub section_phase: f64,
}

impl Case {
    /// A case that starts on its section, at `phase` of the drive [rad].
    pub fn at_section(parameters: Parameters, start: impl Into<State>, phase: f64) -> Case {
        Case { parameters, start: start.into(), start_phase: phase, section_phase: phase }
    }

    /// Time of the start since the last passage of the section phase [s]; zero where the phases are equal, and without a drive.
    pub fn start_time(&self) -> f64 {
        let Some(frequency) = self.parameters.model().drive_frequency() else { return 0.0 };
        let frequency = self.parameters[frequency];
        let turned = reduced(self.start_phase - self.section_phase);
        let time = turned / frequency;
        // A phase that is less by rounding alone is a whole turn ahead.
        if time < 2.0 * PI / frequency { time } else { 0.0 }
    }
}

/// The same phase within 0..2 pi [rad].
pub fn reduced(phase: f64) -> f64 {
    phase.rem_euclid(2.0 * PI)
}
