//! What some outputs and parameters of a model are for, so that the program need not know them by name.

use super::{Description, Output, Parameter, Parameters};

/// Places among the outputs of a model, and among its parameters, of those that the program does more with than to show them.
#[derive(Debug, Clone, Copy)]
pub struct Roles {
    /// The drive, if there is one.
    pub drive: Option<DriveRoles>,
    /// The value of the first coordinate on the surface of impacts, if there is one: a parameter.
    pub impact_surface: Option<usize>,
    /// Minus its value on the surface of a stop on the other side, if there may be one: a parameter.
    pub rear_surface: Option<usize>,
    /// A stiffness and a mass, whose natural frequency figures take as a unit, if there is one: parameters.
    pub natural: Option<[usize; 2]>,
    /// What a motion gains and costs, if it gains anything.
    pub trade_off: Option<TradeOffRoles>,
    /// The share of time at which a motion is at rest, if it can be.
    pub rest_share: Option<usize>,
    /// What sums up a motion at first sight.
    pub key_outputs: &'static [usize],
    /// How often each event happens in a cycle.
    pub event_counts: &'static [usize],
    /// How often the motion meets a surface that it may touch, of each such surface, in a cycle.
    pub impact_counts: &'static [usize],
    /// The largest Lyapunov exponent.
    pub exponent: usize,
    /// Its standard error.
    pub exponent_error: usize,
    /// All Lyapunov exponents and the dimension that follows from them, if it tells them.
    pub spectrum: Option<SpectrumRoles>,
    /// The standard error of the mean of what a motion gains, if it gains anything whose mean is known better the longer it is
    /// measured.
    pub gain_error: Option<usize>,
    /// The longest period that is excluded, with all shorter ones.
    pub excluded_period: usize,
    /// The largest defect of a step.
    pub defect: usize,
    /// How far the section is from repeating after the period.
    pub section_residual: usize,
}

/// Places among the parameters of a model of those of its drive.
#[derive(Debug, Clone, Copy)]
pub struct DriveRoles {
    /// Its frequency, if there is such a parameter; a cycle is one of its periods.
    pub frequency: Option<usize>,
    /// Its period, which stands for the frequency where it is given, if there is such a parameter.
    pub period: Option<usize>,
    /// Its amplitude, that of a force, if there is such a parameter.
    pub amplitude: Option<usize>,
    /// How long a cycle lasts [s], where that follows from the parameters in another way.
    pub cycle: Option<fn(&Parameters) -> f64>,
}

/// Places among the outputs of a model of all Lyapunov exponents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SpectrumRoles {
    /// Each, the largest first, with its standard error: as many as a section point has coordinates.
    pub exponents: &'static [[usize; 2]],
    /// The dimension that follows from them, with its standard error.
    pub dimension: [usize; 2],
}

impl SpectrumRoles {
    /// All the places.
    pub fn all(&self) -> impl Iterator<Item = usize> + '_ {
        self.exponents.iter().chain([&self.dimension]).flatten().copied()
    }
}

/// Places among the outputs of a model of what a motion gains and costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TradeOffRoles {
    /// What it gains: the output that is to be large, in one of two directions.
    pub speed: usize,
    /// What it costs over a cycle.
    pub work: usize,
    /// What it costs over time.
    pub power: usize,
    /// What it costs over the distance that it gains.
    pub energy_per_distance: usize,
    /// All that can be held against what it gains.
    pub costs: &'static [usize],
}

/// Outputs of the trade-off by their roles: name of the function, and what it is.
macro_rules! outputs_of_trade_off {
    ($($role:ident $meaning:literal;)*) => {
        impl Description {
            $(
                #[doc = $meaning]
                ///
                /// # Panics
                /// Where motions of the model gain nothing, see [`Description::has_trade_off`].
                pub const fn $role(&'static self) -> Output {
                    let roles = self.roles.trade_off.expect("motions of the model gain something");
                    Output::of(self, roles.$role)
                }
            )*
        }
    };
}

outputs_of_trade_off! {
    speed "What a motion gains: the output that is to be large, in one of two directions.";
    work "What a motion costs over a cycle.";
    power "What a motion costs over time.";
    energy_per_distance "What a motion costs over the distance that it gains.";
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
    exponent "The largest Lyapunov exponent.";
    exponent_error "The standard error of the largest Lyapunov exponent.";
    excluded_period "The longest period that is excluded, with all shorter ones.";
    defect "The largest defect of a step.";
    section_residual "How far the section is from repeating after the period.";
}

impl Description {
    /// The standard error of an output, if it has one.
    pub fn error_of(&'static self, output: Output) -> Option<Output> {
        if output == self.exponent() {
            return Some(self.exponent_error());
        }
        self.output(&format!("{}_error", output.name()))
    }

    /// All Lyapunov exponents and the dimension, if it tells them.
    pub fn spectrum(&'static self) -> impl Iterator<Item = Output> {
        let roles = self.roles.spectrum.iter();
        let places = roles.flat_map(|it| it.exponents.iter().chain([&it.dimension]));
        places.map(move |[place, _]| Output::of(self, *place))
    }

    /// Whether it has a drive, whose period is a cycle; without one a cycle is from section to section.
    pub fn has_drive(&self) -> bool {
        self.roles.drive.is_some()
    }

    /// The frequency of the drive, of which a cycle is a period, if there is such a parameter.
    pub fn drive_frequency(&'static self) -> Option<Parameter> {
        self.roles.drive.and_then(|it| it.frequency).map(|place| Parameter::of(self, place))
    }

    /// The period of the drive, which stands for its frequency where it is given, if there is such a parameter.
    pub fn drive_period(&'static self) -> Option<Parameter> {
        self.roles.drive.and_then(|it| it.period).map(|place| Parameter::of(self, place))
    }

    /// The amplitude of the drive, that of a force, if there is such a parameter.
    pub fn drive_amplitude(&'static self) -> Option<Parameter> {
        self.roles.drive.and_then(|it| it.amplitude).map(|place| Parameter::of(self, place))
    }

    /// The value of the first coordinate on the surface of impacts, if there is one.
    pub fn impact_surface(&'static self) -> Option<Parameter> {
        self.roles.impact_surface.map(|index| Parameter::of(self, index))
    }

    /// The parameters of the surfaces of impacts, each with the side of the first coordinate on which its stop is, 1 or -1: the surface is
    /// where that coordinate is the parameter times the side.
    pub fn surfaces(&'static self) -> impl Iterator<Item = (Parameter, f64)> {
        let sides = [(self.roles.impact_surface, 1.0), (self.roles.rear_surface, -1.0)];
        sides.into_iter().filter_map(move |(index, side)| Some((Parameter::of(self, index?), side)))
    }

    /// A stiffness and a mass, whose natural frequency figures take as a unit, if there is one.
    pub fn natural(&'static self) -> Option<[Parameter; 2]> {
        Some(self.roles.natural?.map(|index| Parameter::of(self, index)))
    }

    /// The share of time at which a motion is at rest, if it can be.
    pub fn rest_share(&'static self) -> Option<Output> {
        self.roles.rest_share.map(|index| Output::of(self, index))
    }

    /// Whether a motion gains anything, for which it has a cost.
    pub fn has_trade_off(&'static self) -> bool {
        self.roles.trade_off.is_some()
    }

    /// Why nothing that is about a gain and its cost suits motions of it, in a sentence.
    pub fn without_trade_off(&self) -> String {
        format!("motions of the model {} gain nothing that has a cost", self.name)
    }

    /// What is shown of a motion where nothing else is asked for: what it gains and costs over a cycle, if it does.
    pub fn gain_and_work(&'static self) -> Vec<Output> {
        let roles = self.roles.trade_off.map(|it| [it.speed, it.work]);
        roles.into_iter().flatten().map(|index| Output::of(self, index)).collect()
    }

    /// All that can be held against what a motion gains, if it gains anything.
    pub fn costs(&'static self) -> impl Iterator<Item = Output> {
        let costs = self.roles.trade_off.map_or(&[][..], |it| it.costs);
        costs.iter().map(move |index| Output::of(self, *index))
    }

    /// The one output that is shown where no other is asked for: what a motion gains, or the first.
    pub fn main_output(&'static self) -> Output {
        Output::of(self, self.roles.trade_off.map_or(0, |it| it.speed))
    }

    /// What sums up a motion at first sight.
    pub fn key_outputs(&'static self) -> impl Iterator<Item = Output> {
        self.roles.key_outputs.iter().map(move |index| Output::of(self, *index))
    }

    /// How often each event happens in a cycle.
    pub fn event_counts(&'static self) -> impl Iterator<Item = Output> {
        self.roles.event_counts.iter().map(move |index| Output::of(self, *index))
    }

    /// How often the motion meets a surface that it may touch, of each such surface, in a cycle.
    pub fn impact_counts(&'static self) -> impl Iterator<Item = Output> {
        self.roles.impact_counts.iter().map(move |index| Output::of(self, *index))
    }
}
