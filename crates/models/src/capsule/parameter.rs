//! The parameters of the capsule, by name, with units, meanings and what is allowed.

use crate::description::Presence;
use crate::quantity::{Allowed, Dimension};

macro_rules! parameters {
    ($($variant:ident $symbol:literal $dimension:ident $allowed:ident $default:literal $meaning:literal;)*) => {
        /// A parameter of the model.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Parameter {
            $(#[doc = $meaning] $variant,)*
        }

        impl Parameter {
            /// Every parameter of a capsule over folds: those of one on even ground, then those of the folds.
            pub const OVER_FOLDS: &[Parameter] = &[$(Parameter::$variant,)*];

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
    Period "drive_period" Time Positive 1.0 "period of the drive, in place of its frequency";
    P0 "p_0" Force Finite 0.0 "constant part of the drive";
    PLow "p_low" Force Finite 0.0 "force of the drive outside its pulse";
    Duty "duty" Number Share 0.5 "share of the period that a pulse lasts";
    Rise "rise" Number Share 0.1 "share of the period that an edge of a pulse lasts";
    P2 "p_2" Force Finite 0.0 "amplitude of the second harmonic of the drive";
    Phase2 "phase_2" Angle Finite 0.0 "phase of the second harmonic of the drive";
    Xi1 "xi_1" Length Finite 0.005 "amplitude of a prescribed relative motion";
    Xi2 "xi_2" Length Finite 0.0 "amplitude of its second harmonic";
    Stroke "stroke" Length NonNegative 0.01 "stroke of a prescribed relative motion in phases";
    Share1 "share_1" Number Share 0.25 "share of the period of the first of three phases";
    Share2 "share_2" Number Share 0.5 "share of the period of the second of three phases";
    Incline "incline" Angle Slope 0.0 "slope of the ground; forward is uphill";
    Load "load" Force Finite 0.0 "constant force on the capsule; forward is positive";
    PreloadGap "preload_gap" Length Finite 0.0 "compression of the spring k1 where r = 0";
    K3 "k3" Stiffness NonNegative 0.0 "stiffness of the rear stop";
    Delta3 "delta_3" Length Finite 0.0 "gap between mass and rear stop";
    K2Damping "k2_damping" Damping NonNegative 0.0 "damping of the stop in contact";
    K3Damping "k3_damping" Damping NonNegative 0.0 "damping of the rear stop in contact";
    K1Cubic "k1_cubic" CubicStiffness Finite 0.0 "cubic stiffness between mass and capsule";
    K2Cubic "k2_cubic" CubicStiffness Finite 0.0 "cubic stiffness of the stop";
    Restitution "restitution" Number UpToOne 0.5 "coefficient of restitution of a rigid stop, in place of k2";
    MuSForward "mu_s_forward" Number NonNegative 0.66 "static friction coefficient against forward motion";
    MuSBackward "mu_s_backward" Number NonNegative 0.66 "static friction coefficient against backward motion";
    MuDForward "mu_d_forward" Number NonNegative 0.33 "dynamic friction coefficient of forward motion";
    MuDBackward "mu_d_backward" Number NonNegative 0.33 "dynamic friction coefficient of backward motion";
    Stribeck "stribeck" Number NonNegative 1.0 "rise of friction towards rest, relative to that at speed";
    C1Forward "c1_forward" Damping NonNegative 0.0 "linear drag of forward motion";
    C1Backward "c1_backward" Damping NonNegative 0.0 "linear drag of backward motion";
    C2Forward "c2_forward" QuadraticDamping NonNegative 0.0 "quadratic drag of forward motion";
    C2Backward "c2_backward" QuadraticDamping NonNegative 0.0 "quadratic drag of backward motion";
    FoldSpacing "fold_spacing" Length Positive 0.02 "distance from one fold to the next";
    FoldFriction "fold_friction" Number NonNegative 0.0 "rise of the resistance at the top of a fold, relative to even ground";
    FoldForce "fold_force" Force NonNegative 0.0 "largest force of a fold, backward before its top, forward behind it";
    FoldSharpness "fold_sharpness" Number UpToTen 2.0 "sharpness of folds; 0 is a sine";
}

impl Parameter {
    /// Every parameter of a capsule on even ground, in the order of the paper's Table 1; those after it are optional.
    pub const ALL: &[Parameter] = Parameter::OVER_FOLDS.split_at(Parameter::FoldSpacing as usize).0;

    /// Whether it is one of folds.
    pub const fn is_of_folds(self) -> bool {
        self as usize >= Parameter::ALL.len()
    }

    /// Where the equations have it: what follows the paper's parameters is there where it is given, and so is a drag beside friction;
    /// a capsule over folds always has theirs.
    pub const fn presence(self) -> Presence {
        match self {
            Parameter::C1 | Parameter::C2 => Presence::Told,
            _ if self.is_of_folds() => Presence::Always,
            _ if self as usize > Parameter::C2 as usize => Presence::Optional,
            _ => Presence::Always,
        }
    }

    /// The parameter that stands for it where it is not given; itself unless it is that of one direction.
    pub const fn leader(self) -> Parameter {
        match self {
            Parameter::MuSForward | Parameter::MuSBackward => Parameter::MuS,
            Parameter::MuDForward | Parameter::MuDBackward => Parameter::MuD,
            Parameter::C1Forward | Parameter::C1Backward => Parameter::C1,
            Parameter::C2Forward | Parameter::C2Backward => Parameter::C2,
            own => own,
        }
    }

    /// Those of one direction each for which it stands where they are not given.
    pub fn directions(self) -> impl Iterator<Item = Parameter> {
        let follows = move |it: &Parameter| it.leader() == self && *it != self;
        Parameter::ALL.iter().copied().filter(follows)
    }

    /// The parameter with this symbol.
    pub fn named(symbol: &str) -> Option<Parameter> {
        Parameter::OVER_FOLDS.iter().copied().find(|parameter| parameter.symbol() == symbol)
    }
}
