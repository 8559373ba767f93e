//! The ramps that a study asks for: motions whose drive, or another parameter, changes steadily with time.

use crate::description::{Parameter, Parameters, State};
use crate::motion::Case;

/// Where the motion is when a ramp begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beginning {
    /// On the motion that it settles to at the first value.
    Settled,
    /// At the start.
    Start,
}

impl Beginning {
    /// Each with its name in studies.
    pub const NAMES: [(&'static str, Beginning); 2] =
        [("settled", Beginning::Settled), ("start", Beginning::Start)];

    /// Its name in studies.
    pub fn name(self) -> &'static str {
        if self == Beginning::Settled { "settled" } else { "start" }
    }
}

/// A motion along which a parameter changes at a constant rate.
#[derive(Debug, Clone, PartialEq)]
pub struct Ramp {
    /// Its name.
    pub name: String,
    /// The parameter that changes.
    pub along: Parameter,
    /// Its first and its last value (SI).
    pub ends: [f64; 2],
    /// How much it changes in a second, in magnitude (SI).
    pub rate: f64,
    /// The parameters where it begins.
    pub parameters: Parameters,
    /// Where the motion starts.
    pub start: State,
    /// Phase of the drive at the start [rad].
    pub start_phase: f64,
    /// Phase of the drive at the section [rad].
    pub section_phase: f64,
    /// Where the motion is when the ramp begins.
    pub begins: Beginning,
    /// Parts of a cycle, of equal phase, in each of which the parameter is constant.
    pub parts: u32,
}

impl Ramp {
    /// How much the parameter changes in a second (SI).
    pub fn slope(&self) -> f64 {
        self.rate.copysign(self.ends[1] - self.ends[0])
    }

    /// How long it lasts [s].
    pub fn duration(&self) -> f64 {
        (self.ends[1] - self.ends[0]).abs() / self.rate
    }

    /// About how many cycles it lasts: its duration over the shorter period of the drive at its ends; none of a model without a
    /// drive.
    pub fn most_cycles(&self) -> Option<f64> {
        let periods = self.ends.map(|end| self.parameters_at(end).period_of_drive());
        Some(self.duration() / periods[0]?.min(periods[1]?))
    }

    /// The parameters at a value of the one that changes.
    pub fn parameters_at(&self, value: f64) -> Parameters {
        let mut parameters = self.parameters.clone();
        parameters[self.along] = value;
        parameters
    }

    /// The case that leads to the motion with which it begins.
    pub fn first_case(&self) -> Case {
        Case {
            parameters: self.parameters.clone(),
            start: self.start.clone(),
            start_phase: self.start_phase,
            section_phase: self.section_phase,
        }
    }
}
