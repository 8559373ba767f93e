//! The simple tests of a rig, and what is told of a constant that they give.

use crate::description::Parameter;
use crate::experiment::estimate::Estimate;
use crate::experiment::profile::Verdict;
use crate::experiment::recording::{Column, Presence::Required};
use crate::quantity::Dimension;

/// A simple test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Test {
    /// The mass is displaced and let go, on a capsule that is held: k1 and c.
    FreeVibration,
    /// The stop is loaded by weights: k2.
    StaticForce,
    /// A weight is increased until it moves the rig: mu_s.
    Pull,
    /// The rig is given a speed and slides until it rests: mu_d and v_s.
    Coasting,
    /// The force on the rod is measured over the current: the motor constant.
    Motor,
}

impl Test {
    /// All of them.
    pub const ALL: [Test; 5] =
        [Test::FreeVibration, Test::StaticForce, Test::Pull, Test::Coasting, Test::Motor];

    /// Its name, which is that of its option and the stem of its file.
    pub fn name(self) -> &'static str {
        match self {
            Test::FreeVibration => "free-vibration",
            Test::StaticForce => "static-force",
            Test::Pull => "pull",
            Test::Coasting => "coasting",
            Test::Motor => "motor",
        }
    }

    /// The columns of its recording.
    pub fn columns(self) -> Vec<Column> {
        let columns: &[(&'static str, Dimension)] = match self {
            Test::FreeVibration => &[("t", Dimension::Time), ("r", Dimension::Length)],
            Test::StaticForce => &[("force", Dimension::Force), ("deflection", Dimension::Length)],
            Test::Pull => &[("pulled_mass", Dimension::Mass)],
            Test::Coasting => &[("v", Dimension::Velocity), ("d", Dimension::Length)],
            Test::Motor => &[("current", Dimension::Current), ("force", Dimension::Force)],
        };
        let all = columns.iter();
        all.map(|&(name, dimension)| Column { name, dimension, presence: Required }).collect()
    }

    /// Rows that its recording must have.
    pub fn least_rows(self) -> usize {
        match self {
            Test::FreeVibration => 30,
            Test::StaticForce | Test::Motor => 4,
            Test::Pull => 2,
            Test::Coasting => 4,
        }
    }
}

/// What was identified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Constant {
    /// A parameter of the model.
    Parameter(Parameter),
    /// Force per current of the motor.
    MotorConstant,
}

impl Constant {
    /// Its symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Constant::Parameter(parameter) => parameter.symbol(),
            Constant::MotorConstant => "motor_constant",
        }
    }

    /// What it measures.
    pub fn dimension(self) -> Dimension {
        match self {
            Constant::Parameter(parameter) => parameter.dimension(),
            Constant::MotorConstant => Dimension::ForcePerCurrent,
        }
    }
}

/// What a second method gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Other {
    /// The method.
    pub method: &'static str,
    /// Its value with its uncertainty (SI).
    pub estimate: Estimate,
    /// How far it lies above the identified value, in its standard errors; none where the method is biased by construction.
    pub disagreement: Option<f64>,
    /// Why it is biased by construction, if it is: then it is no independent estimate.
    pub bias: Option<&'static str>,
}

/// An identified constant with where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// Which.
    pub constant: Constant,
    /// Its value with its uncertainty (SI).
    pub estimate: Estimate,
    /// What the data say of it, where they may leave it open.
    pub verdict: Verdict,
    /// How it was found.
    pub method: &'static str,
    /// The recording.
    pub source: String,
    /// What another method gives.
    pub other: Option<Other>,
    /// What must be known of it, a sentence each.
    pub notes: Vec<String>,
}

/// Masses and gravity, which the tests take as exact (SI).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Given {
    /// The mass.
    pub m1: f64,
    /// The capsule.
    pub m2: f64,
    /// Gravity.
    pub g: f64,
}
