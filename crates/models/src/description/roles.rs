//! What some outputs and parameters of a model are for, so that the program need not know them by name.

use super::{Description, Output, Parameter};

/// Places among the outputs of a model, and among its parameters, of those that the program does more with than to show them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Roles {
    /// The frequency of the drive, of which a cycle is a period: a parameter.
    pub drive_frequency: usize,
    /// Its amplitude, that of a force: a parameter.
    pub drive_amplitude: usize,
    /// The value of the first coordinate on the surface of impacts: a parameter.
    pub impact_surface: usize,
    /// A stiffness and a mass, whose natural frequency figures take as a unit: parameters.
    pub natural: [usize; 2],
    /// What a motion gains: the output that is to be large, in one of two directions.
    pub speed: usize,
    /// What it costs over a cycle.
    pub work: usize,
    /// What it costs over time.
    pub power: usize,
    /// What it costs over the distance that it gains.
    pub energy_per_distance: usize,
    /// The share of time at which it is at rest.
    pub rest_share: usize,
    /// How often each event happens in a cycle.
    pub event_counts: &'static [usize],
    /// The largest Lyapunov exponent.
    pub exponent: usize,
    /// Its standard error.
    pub exponent_error: usize,
    /// The longest period that is excluded, with all shorter ones.
    pub excluded_period: usize,
    /// The largest defect of a step.
    pub defect: usize,
    /// How far the section is from repeating after the period.
    pub section_residual: usize,
}

/// Outputs by their roles: name of the function, and what it is.
macro_rules! outputs_by_role {
    ($($role:ident $meaning:literal;)*) => {
        impl Description {
            $(
                #[doc = $meaning]
                pub const fn $role(&'static self) -> Output {
                    Output::of(self, self.roles.$role)
                }
            )*
        }
    };
}

outputs_by_role! {
    speed "What a motion gains: the output that is to be large, in one of two directions.";
    work "What a motion costs over a cycle.";
    power "What a motion costs over time.";
    energy_per_distance "What a motion costs over the distance that it gains.";
    rest_share "The share of time at which a motion is at rest.";
    exponent "The largest Lyapunov exponent.";
    exponent_error "The standard error of the largest Lyapunov exponent.";
    excluded_period "The longest period that is excluded, with all shorter ones.";
    defect "The largest defect of a step.";
    section_residual "How far the section is from repeating after the period.";
}

impl Description {
    /// The frequency of the drive, of which a cycle is a period.
    pub const fn drive_frequency(&'static self) -> Parameter {
        Parameter::of(self, self.roles.drive_frequency)
    }

    /// The amplitude of the drive, that of a force.
    pub const fn drive_amplitude(&'static self) -> Parameter {
        Parameter::of(self, self.roles.drive_amplitude)
    }

    /// The value of the first coordinate on the surface of impacts.
    pub const fn impact_surface(&'static self) -> Parameter {
        Parameter::of(self, self.roles.impact_surface)
    }

    /// A stiffness and a mass, whose natural frequency figures take as a unit.
    pub fn natural(&'static self) -> [Parameter; 2] {
        self.roles.natural.map(|index| Parameter::of(self, index))
    }

    /// How often each event happens in a cycle.
    pub fn event_counts(&'static self) -> impl Iterator<Item = Output> {
        self.roles.event_counts.iter().map(move |index| Output::of(self, *index))
    }
}
