//! Physical dimensions with their units.

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
