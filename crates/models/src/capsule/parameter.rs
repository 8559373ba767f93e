//! The parameters of the capsule, by name, with units, meanings and what is allowed.

use crate::quantity::{Allowed, Dimension};

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
            pub const fn symbol(self) -> &'static str {
                match self { $(Parameter::$variant => $symbol,)* }
            }
            /// Its name in code.
            pub const fn tag(self) -> &'static str {
                match self { $(Parameter::$variant => stringify!($variant),)* }
            }
            /// Its dimension.
            pub const fn dimension(self) -> Dimension {
                match self { $(Parameter::$variant => Dimension::$dimension,)* }
            }
            /// What values it may take.
            pub const fn allowed(self) -> Allowed {
                match self { $(Parameter::$variant => Allowed::$allowed,)* }
            }
            /// What it is, in a phrase.
            pub const fn meaning(self) -> &'static str {
                match self { $(Parameter::$variant => $meaning,)* }
            }
            /// Its value where none is given (SI).
            pub const fn default_value(self) -> f64 {
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
