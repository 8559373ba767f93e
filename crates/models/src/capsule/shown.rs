//! How figures show the parameters and outputs of the capsule.

use std::f64::consts::PI;

use super::output::Output;
use super::parameter::Parameter;
use crate::quantity::shown::{shown, words};
use crate::quantity::{Dimension, Shown};

/// How figures show a parameter.
pub(super) const fn parameter_shown(parameter: Parameter) -> Option<Shown> {
    let (label, symbol) = match parameter {
        Parameter::M1 => ("Internal mass", "*m*_{1}"),
        Parameter::M2 => ("Capsule mass", "*m*_{2}"),
        Parameter::K1 => ("Stiffness", "*k*_{1}"),
        Parameter::C => ("Damping", "*c*"),
        Parameter::K2 => ("Stiffness", "*k*_{2}"),
        Parameter::Delta => ("Gap", "*δ*"),
        Parameter::Pd => ("Force amplitude", "*p*_{d}"),
        Parameter::Omega => ("Frequency", "*ω*"),
        Parameter::MuS => ("Static friction", "*μ*_{s}"),
        Parameter::MuD => ("Dynamic friction", "*μ*_{d}"),
        Parameter::Vs => ("Stribeck velocity", "*v*_{s}"),
        Parameter::G => ("Gravity", "*g*"),
        Parameter::Period => ("Period", "*T*"),
        Parameter::P0 => ("Constant force", "*p*_{0}"),
        Parameter::PLow => ("Force between pulses", "*p*_{low}"),
        Parameter::Duty => ("Duty", "*D*"),
        Parameter::Rise => ("Rise", ""),
        Parameter::P2 => ("Second harmonic", "*p*_{2}"),
        Parameter::Phase2 => ("Phase of the second harmonic", "*φ*_{2}"),
        Parameter::Xi1 => ("Amplitude", "*ξ*_{1}"),
        Parameter::Xi2 => ("Second harmonic", "*ξ*_{2}"),
        Parameter::Stroke => ("Stroke", "*L*"),
        Parameter::Share1 => ("First phase", ""),
        Parameter::Share2 => ("Second phase", ""),
        Parameter::Incline => ("Incline", "*α*"),
        Parameter::Load => ("Load", "*F*_{ext}"),
        Parameter::PreloadGap => ("Preload gap", "*G*"),
        Parameter::K3 => ("Stiffness", "*k*_{3}"),
        Parameter::Delta3 => ("Rear gap", "*δ*_{3}"),
        Parameter::K2Damping => ("Damping of the stop", "*c*_{2}"),
        Parameter::K3Damping => ("Damping of the rear stop", "*c*_{3}"),
        Parameter::Restitution => ("Restitution", "*e*"),
        Parameter::MuSForward => ("Static friction forward", "*μ*_{s}^{+}"),
        Parameter::MuSBackward => ("Static friction backward", "*μ*_{s}^{−}"),
        Parameter::MuDForward => ("Dynamic friction forward", "*μ*_{d}^{+}"),
        Parameter::MuDBackward => ("Dynamic friction backward", "*μ*_{d}^{−}"),
        Parameter::Stribeck => ("Rise of friction towards rest", "*ν*"),
        Parameter::FoldSpacing => ("Spacing of folds", "*Λ*"),
        Parameter::FoldFriction => ("Friction of folds", ""),
        Parameter::FoldForce => ("Force of folds", ""),
        Parameter::FoldSharpness => ("Sharpness of folds", ""),
        Parameter::K1Cubic
        | Parameter::K2Cubic
        | Parameter::C1
        | Parameter::C2
        | Parameter::C1Forward
        | Parameter::C1Backward
        | Parameter::C2Forward
        | Parameter::C2Backward => return None,
    };
    let (unit, factor) = match parameter.dimension() {
        Dimension::Stiffness => ("kN/m", 1e-3),
        Dimension::Length => ("mm", 1e3),
        Dimension::Time => ("ms", 1e3),
        Dimension::Angle => ("deg", 180.0 / PI),
        Dimension::Acceleration => ("m/s^{2}", 1.0),
        Dimension::Number => ("", 1.0),
        dimension => (dimension.unit(), 1.0),
    };
    shown(label, symbol, unit, factor)
}

/// How figures show an output.
pub(super) const fn output_shown(output: Output) -> Option<Shown> {
    match output {
        Output::ProgressionSpeed => shown("Progression speed", "", "mm/s", 1e3),
        Output::ProgressionPerCycle => shown("Progression per cycle", "", "mm", 1e3),
        Output::WorkNet => shown("Net work per cycle", "", "mJ", 1e3),
        Output::WorkPositive => shown("Positive work per cycle", "", "mJ", 1e3),
        Output::WorkAbsolute => shown("Absolute work per cycle", "", "mJ", 1e3),
        Output::WorkActuator => shown("Actuator work per cycle", "", "mJ", 1e3),
        Output::FrictionLoss => shown("Friction loss per cycle", "", "mJ", 1e3),
        Output::DamperLoss => shown("Damper loss per cycle", "", "mJ", 1e3),
        Output::EnergyResidual => words("Energy residual", ""),
        Output::MomentumResidual => words("Momentum residual", ""),
        Output::CostOfTransport => words("Cost of transport", ""),
        Output::Power => shown("Power", "", "mW", 1e3),
        Output::EnergyPerMetre => words("Energy per metre", "J/m"),
        Output::ImpactsPerCycle => words("Impacts per cycle", ""),
        Output::ForwardSlips => words("Forward slips per cycle", ""),
        Output::BackwardSlips => words("Backward slips per cycle", ""),
        Output::Reversals => words("Reversals per cycle", ""),
        Output::StickShare => words("Share of sticking", ""),
        Output::PeakContactForce => words("Peak contact force", "N"),
        Output::GrazingMargin => shown("Grazing margin", "", "mm", 1e3),
        Output::LyapunovExponent => words("Lyapunov exponent", "1/s"),
        Output::LyapunovUncertainty => words("Uncertainty of the exponent", "1/s"),
        Output::LargestMultiplier => words("Largest multiplier", ""),
        Output::IntegrationDefect => words("Integration defect", ""),
        Output::ExcludedPeriod => words("Longest period excluded", ""),
        Output::SectionResidual => words("Section residual", ""),
        Output::ProgressionSpeedError => shown("Error of the progression speed", "", "mm/s", 1e3),
        Output::WorkNetError => shown("Error of the net work per cycle", "", "mJ", 1e3),
        Output::WorkPositiveError => shown("Error of the positive work per cycle", "", "mJ", 1e3),
        Output::WorkAbsoluteError => shown("Error of the absolute work per cycle", "", "mJ", 1e3),
        Output::WorkActuatorError => shown("Error of the actuator work per cycle", "", "mJ", 1e3),
        Output::FrictionLossError => shown("Error of the friction loss per cycle", "", "mJ", 1e3),
        Output::Lyapunov1 => words("First Lyapunov exponent", "1/s"),
        Output::Lyapunov1Error => words("Error of the first exponent", "1/s"),
        Output::Lyapunov2 => words("Second Lyapunov exponent", "1/s"),
        Output::Lyapunov2Error => words("Error of the second exponent", "1/s"),
        Output::Lyapunov3 => words("Third Lyapunov exponent", "1/s"),
        Output::Lyapunov3Error => words("Error of the third exponent", "1/s"),
        Output::Lyapunov4 => words("Fourth Lyapunov exponent", "1/s"),
        Output::Lyapunov4Error => words("Error of the fourth exponent", "1/s"),
        Output::KaplanYorkeDimension => words("Kaplan-Yorke dimension", ""),
        Output::KaplanYorkeDimensionError => words("Error of the dimension", ""),
        Output::ContactLoss => shown("Loss in the stops per cycle", "", "mJ", 1e3),
        Output::DragLoss => shown("Drag loss per cycle", "", "mJ", 1e3),
        Output::LiftingWork => shown("Work against incline and load per cycle", "", "mJ", 1e3),
        Output::RearImpactsPerCycle => words("Rear impacts per cycle", ""),
        Output::RearPeakContactForce => words("Peak force of the rear stop", "N"),
        Output::RearGrazingMargin => shown("Rear grazing margin", "", "mm", 1e3),
        Output::FoldsPerPeriod => words("Folds per period", ""),
        Output::DamperLossError => shown("Error of the damper loss per cycle", "", "mJ", 1e3),
    }
}
