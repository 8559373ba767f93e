//! The entries of parameters, starts and outputs, whose names the floors below give.

use crate::capsule::{Dimension, Output, Parameter};
use crate::study::Coordinate;

use super::entry::{Entry, Extent, Shown, Type, shown, words};

impl Entry {
    /// A parameter of the model, as an axis or a constant of the study.
    pub fn of_parameter(parameter: Parameter) -> Entry {
        Entry::of_coordinate(Coordinate::Parameter(parameter))
    }

    /// What an axis can vary, as an axis or a constant of the study.
    pub fn of_coordinate(coordinate: Coordinate) -> Entry {
        let shown = match coordinate {
            Coordinate::Parameter(parameter) => parameter_shown(parameter),
            Coordinate::StartR => shown("Initial", "*x*_{1} − *x*_{2}", "mm", 1e3),
            Coordinate::StartY1 => shown("Initial", "*y*_{1}", "m/s", 1.0),
            Coordinate::StartY2 => shown("Initial", "*y*_{2}", "m/s", 1.0),
            Coordinate::StartPhase => shown("Initial phase", "*φ*", "rad", 1.0),
            Coordinate::SectionPhase => shown("Section phase", "*φ*_{s}", "rad", 1.0),
        };
        Entry {
            name: coordinate.name(),
            unit: coordinate.dimension().unit(),
            meaning: coordinate.meaning(),
            extent: Extent::Study,
            numbers: Type::Real,
            shown,
        }
    }

    /// An output of each case.
    pub const fn of_output(output: Output) -> Entry {
        Entry {
            name: output.name(),
            unit: output.unit(),
            meaning: output.meaning(),
            extent: Extent::Case,
            numbers: Type::Real,
            shown: output_shown(output),
        }
    }
}

/// Where a case starts, which in a block may be where its neighbour settled.
pub fn starts() -> [Entry; 3] {
    [Coordinate::StartR, Coordinate::StartY1, Coordinate::StartY2].map(Entry::of_coordinate)
}

/// How figures show a parameter.
fn parameter_shown(parameter: Parameter) -> Option<Shown> {
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
        Parameter::C1 | Parameter::C2 => return None,
    };
    let (unit, factor) = match parameter.dimension() {
        Dimension::Stiffness => ("kN/m", 1e-3),
        Dimension::Length => ("mm", 1e3),
        Dimension::Acceleration => ("m/s^{2}", 1.0),
        Dimension::Number => ("", 1.0),
        dimension => (dimension.unit(), 1.0),
    };
    shown(label, symbol, unit, factor)
}

/// How figures show an output.
const fn output_shown(output: Output) -> Option<Shown> {
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
        Output::DamperLossError => shown("Error of the damper loss per cycle", "", "mJ", 1e3),
    }
}
