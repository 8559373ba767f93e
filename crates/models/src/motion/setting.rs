//! What a motion depends on beside its start.

use super::Case;
use crate::description::{Outputs, Parameters, Section};

/// What a motion depends on beside its start.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The parameters.
    pub parameters: Parameters,
    /// Phase of the drive at the section [rad].
    pub phase: f64,
}

impl Setting {
    /// That of a case.
    pub fn of(case: &Case) -> Setting {
        Setting { parameters: case.parameters.clone(), phase: case.section_phase }
    }
}

/// The outputs of a periodic orbit, and its derivatives in a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The outputs that are smooth, NaN for others (SI).
    pub outputs: Outputs,
    /// The derivative of the section point (SI).
    pub section_slope: Section,
    /// The derivatives of the outputs (SI).
    pub slopes: Outputs,
}
