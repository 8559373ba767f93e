//! What the capsule says of itself: the quantities of its starts, sections, impacts, histories, parameters and outputs.

use super::friction_rules::RULES;
use super::output::{Output, Outputs};
use super::parameter::Parameter;
use super::quantities::{
    EDGE_SECTION_R, EDGE_SECTION_Y1, EDGE_SECTION_Y2, END_R, END_Y1, END_Y2, NEUTRAL_R, NEUTRAL_Y1,
    NEUTRAL_Y2, SECTION_R, SECTION_Y1, SECTION_Y2, START_R, START_X2, START_Y1, START_Y2,
};
use super::resistance::{Resistance, Switching};
use super::signals;
use super::state::State;
use crate::description::{
    self, Choice, CoordinateDescription, Description, DriveRoles, OutputDescription,
    ParameterDescription, Roles, TradeOffRoles,
};
use crate::quantity::shown::{shown, words};
use crate::quantity::{Dimension, Quantity, Shown};

/// The coordinates of a point of the stroboscopic section.
pub const SECTION: &[Quantity] = &[SECTION_R, SECTION_Y1, SECTION_Y2];

/// The capsule.
pub static CAPSULE: Description = Description {
    name: "capsule",
    parameters: &PARAMETERS,
    choices: &[
        Choice {
            name: "resistance",
            noun: "resistance",
            title: "Resistance",
            meaning: "law of resistance to the capsule",
            options: &Resistance::OPTIONS,
            tag: "resistance",
            option_tags: &["CoulombStribeck", "Coulomb", "Medium"],
        },
        Choice {
            name: "friction_switching",
            noun: "reading",
            title: "Switching between stick and slip",
            meaning: "reading of the switching between stick and slip",
            options: &Switching::OPTIONS,
            tag: "switching",
            option_tags: &["Filippov", "AsPrinted"],
        },
    ],
    coordinates: &[
        CoordinateDescription { name: "r", tag: "StartR", start: START_R },
        CoordinateDescription { name: "y1", tag: "StartY1", start: START_Y1 },
        CoordinateDescription { name: "x2", tag: "StartX2", start: START_X2 },
        CoordinateDescription { name: "y2", tag: "StartY2", start: START_Y2 },
    ],
    drift: Some(2),
    on_section: &[0, 1, 3],
    section: SECTION,
    compared_as: &["omega r", "y1", "y2"],
    neutral: &[NEUTRAL_R, NEUTRAL_Y1, NEUTRAL_Y2],
    edge: &[EDGE_SECTION_R, EDGE_SECTION_Y1, EDGE_SECTION_Y2],
    end: &[END_R, END_Y1, END_Y2],
    motion: signals::MOTION,
    outputs: &OUTPUTS,
    roles: Roles {
        drive: Some(DriveRoles {
            frequency: Parameter::Omega as usize,
            amplitude: Parameter::Pd as usize,
        }),
        impact_surface: Some(Parameter::Delta as usize),
        natural: Some([Parameter::K1 as usize, Parameter::M1 as usize]),
        trade_off: Some(TradeOffRoles {
            speed: Output::ProgressionSpeed as usize,
            work: Output::WorkPositive as usize,
            power: Output::Power as usize,
            energy_per_distance: Output::EnergyPerMetre as usize,
            costs: &[
                Output::WorkPositive as usize,
                Output::Power as usize,
                Output::EnergyPerMetre as usize,
                Output::CostOfTransport as usize,
            ],
        }),
        rest_share: Some(Output::StickShare as usize),
        key_outputs: &[
            Output::ProgressionSpeed as usize,
            Output::ProgressionPerCycle as usize,
            Output::WorkNet as usize,
            Output::WorkPositive as usize,
            Output::FrictionLoss as usize,
            Output::DamperLoss as usize,
            Output::Power as usize,
            Output::EnergyPerMetre as usize,
            Output::CostOfTransport as usize,
            Output::ImpactsPerCycle as usize,
            Output::StickShare as usize,
            Output::PeakContactForce as usize,
            Output::LyapunovExponent as usize,
        ],
        event_counts: &[
            Output::ImpactsPerCycle as usize,
            Output::ForwardSlips as usize,
            Output::BackwardSlips as usize,
            Output::Reversals as usize,
        ],
        exponent: Output::LyapunovExponent as usize,
        exponent_error: Output::LyapunovUncertainty as usize,
        excluded_period: Output::ExcludedPeriod as usize,
        defect: Output::IntegrationDefect as usize,
        section_residual: Output::SectionResidual as usize,
    },
    rules: RULES,
};

static OUTPUTS: [OutputDescription; Output::ALL.len()] = {
    let mut all = [Output::ProgressionSpeed.description(); Output::ALL.len()];
    let mut index = 0;
    while index < all.len() {
        all[index] = Output::ALL[index].description();
        index += 1;
    }
    all
};

static PARAMETERS: [ParameterDescription; Parameter::ALL.len()] = {
    let mut all = [Parameter::M1.description(); Parameter::ALL.len()];
    let mut index = 0;
    while index < all.len() {
        all[index] = Parameter::ALL[index].description();
        index += 1;
    }
    all
};

impl Parameter {
    /// What the capsule says of it; Table 1 of the paper leaves four of them open.
    const fn description(self) -> ParameterDescription {
        let (name, dimension, meaning) = (self.symbol(), self.dimension(), self.meaning());
        let quantity = Quantity { name, dimension, meaning, shown: parameter_shown(self) };
        let (allowed, default) = (self.allowed(), self.default_value());
        let is_asked_for =
            matches!(self, Parameter::Omega | Parameter::Pd | Parameter::K2 | Parameter::Delta);
        ParameterDescription { quantity, tag: self.tag(), allowed, default, is_asked_for }
    }

    /// It as a parameter that the description of the capsule tells of.
    pub const fn described(self) -> description::Parameter {
        description::Parameter::of(&CAPSULE, self as usize)
    }

    /// Of a parameter of the capsule, which it is.
    ///
    /// # Panics
    /// Where it is a parameter of another model.
    pub fn which(parameter: description::Parameter) -> Parameter {
        assert!(*parameter.model() == CAPSULE, "{parameter:?} is no parameter of the capsule");
        Parameter::ALL[parameter.index()]
    }
}

impl From<Parameter> for description::Parameter {
    fn from(parameter: Parameter) -> Self {
        parameter.described()
    }
}

impl PartialEq<Parameter> for description::Parameter {
    fn eq(&self, other: &Parameter) -> bool {
        *self == description::Parameter::from(*other)
    }
}

impl Output {
    /// It as a quantity.
    pub const fn quantity(self) -> Quantity {
        let (name, dimension, meaning) = (self.name(), self.dimension(), self.meaning());
        Quantity { name, dimension, meaning, shown: output_shown(self) }
    }

    /// What the capsule says of it.
    const fn description(self) -> OutputDescription {
        OutputDescription {
            quantity: self.quantity(),
            tag: self.tag(),
            is_smooth: self.is_smooth(),
        }
    }

    /// It as an output that the description of the capsule tells of.
    pub const fn described(self) -> description::Output {
        description::Output::of(&CAPSULE, self as usize)
    }
}

impl From<Output> for description::Output {
    fn from(output: Output) -> Self {
        output.described()
    }
}

impl PartialEq<Output> for description::Output {
    fn eq(&self, other: &Output) -> bool {
        *self == description::Output::from(*other)
    }
}

/// Those of a capsule, as the model where none is named.
impl Default for description::Parameters {
    fn default() -> Self {
        description::Parameters::of(&CAPSULE)
    }
}

impl From<State<f64>> for description::State {
    fn from(state: State<f64>) -> Self {
        description::State::new(&CAPSULE, &state.coordinates())
    }
}

impl From<&description::State> for State<f64> {
    fn from(state: &description::State) -> Self {
        let &[r, y1, x2, y2] = state.values() else {
            panic!("{state:?} is no state of the capsule")
        };
        State { r, y1, x2, y2 }
    }
}

/// A capsule at rest in its middle, as the model where none is named.
impl Default for description::State {
    fn default() -> Self {
        description::State::origin(&CAPSULE)
    }
}

impl From<Outputs> for description::Outputs {
    fn from(outputs: Outputs) -> Self {
        description::Outputs::new(&CAPSULE, outputs.values())
    }
}

/// How figures show a parameter.
const fn parameter_shown(parameter: Parameter) -> Option<Shown> {
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
