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
        let turned = reduced(self.start_phase - self.section_phase);
        let model = self.parameters.model();
        let by_period = model.drive_period().is_some_and(|it| self.parameters.is_given(it));
        let (time, period) = match model.drive_frequency().filter(|_| !by_period) {
            Some(frequency) => {
                let frequency = self.parameters[frequency];
                (turned / frequency, 2.0 * PI / frequency)
            }
            None => {
                let Some(period) = self.parameters.period_of_drive() else { return 0.0 };
                (turned / (2.0 * PI) * period, period)
            }
        };
        // A phase that is less by rounding alone is a whole turn ahead.
        if time < period { time } else { 0.0 }
    }
}

/// The same phase within 0..2 pi [rad].
pub fn reduced(phase: f64) -> f64 {
    phase.rem_euclid(2.0 * PI)
}
