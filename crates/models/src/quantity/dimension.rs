//! Physical dimensions with their units, and what values a quantity may take.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// A physical dimension that a parameter, a coordinate or an output can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Mass [kg].
    Mass,
    /// Stiffness [N/m].
    Stiffness,
    /// Stiffness of a cubic spring [N/m^3].
    CubicStiffness,
    /// Viscous damping [N s/m].
    Damping,
    /// Quadratic drag [N s^2/m^2].
    QuadraticDamping,
    /// Length [m].
    Length,
    /// Force [N].
    Force,
    /// Angular frequency [rad/s].
    AngularFrequency,
    /// Velocity [m/s].
    Velocity,
    /// Acceleration [m/s^2].
    Acceleration,
    /// Angle [rad].
    Angle,
    /// Energy [J].
    Energy,
    /// Power [W].
    Power,
    /// Energy over a distance [J/m].
    EnergyPerLength,
    /// Rate of growth [1/s].
    Rate,
    /// Time [s].
    Time,
    /// Electric current [A].
    Current,
    /// Force per electric current [N/A].
    ForcePerCurrent,
    /// A plain number.
    Number,
    /// What only its unit tells, which it always has.
    Other(&'static str),
}

impl Dimension {
    /// All of them that are known by name.
    pub const ALL: [Dimension; 19] = [
        Dimension::Mass,
        Dimension::Stiffness,
        Dimension::CubicStiffness,
        Dimension::Damping,
        Dimension::QuadraticDamping,
        Dimension::Length,
        Dimension::Force,
        Dimension::AngularFrequency,
        Dimension::Velocity,
        Dimension::Acceleration,
        Dimension::Angle,
        Dimension::Energy,
        Dimension::Power,
        Dimension::EnergyPerLength,
        Dimension::Rate,
        Dimension::Time,
        Dimension::Current,
        Dimension::ForcePerCurrent,
        Dimension::Number,
    ];

    /// The SI unit as written in tables and files.
    pub const fn unit(self) -> &'static str {
        match self {
            Dimension::Mass => "kg",
            Dimension::Stiffness => "N/m",
            Dimension::CubicStiffness => "N/m3",
            Dimension::Damping => "N s/m",
            Dimension::QuadraticDamping => "N s2/m2",
            Dimension::Length => "m",
            Dimension::Force => "N",
            Dimension::AngularFrequency => "rad/s",
            Dimension::Velocity => "m/s",
            Dimension::Acceleration => "m/s2",
            Dimension::Angle => "rad",
            Dimension::Energy => "J",
            Dimension::Power => "W",
            Dimension::EnergyPerLength => "J/m",
            Dimension::Rate => "1/s",
            Dimension::Time => "s",
            Dimension::Current => "A",
            Dimension::ForcePerCurrent => "N/A",
            Dimension::Number => "1",
            Dimension::Other(unit) => unit,
        }
    }
}

/// What values a parameter may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Allowed {
    /// Any finite number.
    Finite,
    /// Finite and at least zero.
    NonNegative,
    /// Finite and above zero.
    Positive,
    /// Above 0 and below 1.
    Share,
    /// From 0 to 1.
    UpToOne,
    /// From 0 to 10.
    UpToTen,
    /// Above -pi/2 and below pi/2, an angle.
    Slope,
}

impl Allowed {
    /// Whether `value` may be used.
    pub fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Allowed::Finite => true,
                Allowed::NonNegative => value >= 0.0,
                Allowed::Positive => value > 0.0,
                Allowed::Share => value > 0.0 && value < 1.0,
                Allowed::UpToOne => (0.0..=1.0).contains(&value),
                Allowed::UpToTen => (0.0..=10.0).contains(&value),
                Allowed::Slope => value.abs() < FRAC_PI_2,
            }
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Allowed::Finite => "a finite number",
            Allowed::NonNegative => "a finite number, zero or above",
            Allowed::Positive => "a finite number above zero",
            Allowed::Share => "a number above 0 and below 1",
            Allowed::UpToOne => "a number from 0 to 1",
            Allowed::UpToTen => "a number from 0 to 10",
            Allowed::Slope => "an angle above -90 deg and below 90 deg",
        })
    }
}
