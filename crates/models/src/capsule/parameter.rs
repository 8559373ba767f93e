//! The parameters of the capsule, by name, with units, meanings and what is allowed.

use std::fmt;

/// A physical dimension that a parameter, a coordinate or an output can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Mass [kg].
    Mass,
    /// Stiffness [N/m].
    Stiffness,
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
}

impl Dimension {
    /// All of them.
    pub const ALL: [Dimension; 18] = [
        Dimension::Mass,
        Dimension::Stiffness,
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
    pub fn unit(self) -> &'static str {
        match self {
            Dimension::Mass => "kg",
            Dimension::Stiffness => "N/m",
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
}

impl Allowed {
    /// Whether `value` may be used.
    pub fn admits(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Allowed::Finite => true,
                Allowed::NonNegative => value >= 0.0,
                Allowed::Positive => value > 0.0,
            }
    }
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Allowed::Finite => "a finite number",
            Allowed::NonNegative => "a finite number, zero or above",
            Allowed::Positive => "a finite number above zero",
        })
    }
}

macro_rules! parameters {
    ($($variant:ident $symbol:literal $dimension:ident $allowed:ident $default:literal $meaning:literal;)*) => {
        /// A parameter of the model.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Parameter {
            $(#[doc = $meaning] $variant,)*
        }

        impl Parameter {
            /// Every parameter, in the order of the paper's Table 1.
            pub const ALL: &[Parameter] = &[$(Parameter::$variant,)*];

            /// The symbol used in studies, on the command line and in files.
            pub fn symbol(self) -> &'static str {
                match self { $(Parameter::$variant => $symbol,)* }
            }
            /// Its dimension.
            pub fn dimension(self) -> Dimension {
                match self { $(Parameter::$variant => Dimension::$dimension,)* }
            }
            /// What values it may take.
            pub fn allowed(self) -> Allowed {
                match self { $(Parameter::$variant => Allowed::$allowed,)* }
            }
            /// What it is, in a phrase.
            pub fn meaning(self) -> &'static str {
                match self { $(Parameter::$variant => $meaning,)* }
            }
            /// Its value where none is given (SI).
            pub fn default_value(self) -> f64 {
                match self { $(Parameter::$variant => $default,)* }
            }
        }
    };
}

// Table 1 of the paper; the four that it lets vary stand at the values of its Fig 5, and the one
// friction coefficient that it gives is the static one, with half of it for the dynamic.
parameters! {
    M1 "m1" Mass Positive 0.11 "internal mass";
    M2 "m2" Mass Positive 0.53 "mass of the capsule";
    K1 "k1" Stiffness NonNegative 1420.0 "stiffness between mass and capsule";
    C "c" Damping NonNegative 3.89 "damping between mass and capsule";
    K2 "k2" Stiffness NonNegative 2420.0 "stiffness of the stop";
    Delta "delta" Length Finite 0.0035 "gap between mass and stop";
    Pd "p_d" Force NonNegative 4.0 "amplitude of the drive";
    Omega "omega" AngularFrequency Positive 77.91 "frequency of the drive";
    MuS "mu_s" Number NonNegative 0.66 "static friction coefficient";
    MuD "mu_d" Number NonNegative 0.33 "dynamic friction coefficient";
    Vs "v_s" Velocity Positive 0.3 "Stribeck velocity";
    G "g" Acceleration NonNegative 9.81 "acceleration of gravity";
    C1 "c1" Damping NonNegative 0.0 "linear drag of the medium";
    C2 "c2" QuadraticDamping NonNegative 0.0 "quadratic drag of the medium";
}

impl Parameter {
    /// The parameter with this symbol.
    pub fn named(symbol: &str) -> Option<Parameter> {
        Parameter::ALL.iter().copied().find(|parameter| parameter.symbol() == symbol)
    }
}
