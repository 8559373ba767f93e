//! What the capsule says of itself: the quantities of its starts, sections, impacts, histories, parameters and outputs.

use super::output::{Output, Outputs};
use super::parameter::Parameter;
use super::quantities::{
    EDGE_SECTION_PLACE, EDGE_SECTION_R, EDGE_SECTION_Y1, EDGE_SECTION_Y2, END_PLACE, END_R, END_Y1,
    END_Y2, NEUTRAL_PLACE, NEUTRAL_R, NEUTRAL_Y1, NEUTRAL_Y2, SECTION_PLACE, SECTION_R, SECTION_Y1,
    SECTION_Y2, START_PLACE, START_R, START_X2, START_Y1, START_Y2,
};
use super::resistance::{Resistance, Switching};
use super::rules::RULES;
use super::shape::{DriveKind, Reaction, Release};
use super::shown::{output_shown, parameter_shown};
use super::signals;
use super::state::State;
use crate::description::{
    self, Choice, CoordinateDescription, Description, DriveRoles, MotionDescription,
    OutputDescription, ParameterDescription, Roles, SpectrumRoles, TradeOffRoles,
};
use crate::quantity::Quantity;

/// The coordinates of a point of the stroboscopic section.
pub const SECTION: &[Quantity] = &[SECTION_R, SECTION_Y1, SECTION_Y2];

/// The capsule.
pub static CAPSULE: Description = ON_EVEN_GROUND;

/// What a capsule on even ground says of itself, which others go on from.
const ON_EVEN_GROUND: Description = Description {
    name: "capsule",
    extends: None,
    parameters: PARAMETERS.split_at(Parameter::ALL.len()).0,
    choices: &[
        Choice {
            name: "resistance",
            noun: "resistance",
            title: "Resistance",
            meaning: "law of resistance to the capsule",
            options: &Resistance::OPTIONS,
            tag: "resistance",
            option_tags: &["CoulombStribeck", "Coulomb", "Medium"],
            is_optional: false,
        },
        Choice {
            name: "friction_switching",
            noun: "reading",
            title: "Switching between stick and slip",
            meaning: "reading of the switching between stick and slip",
            options: &Switching::OPTIONS,
            tag: "switching",
            option_tags: &["Filippov", "AsPrinted"],
            is_optional: false,
        },
        Choice {
            name: "drive",
            noun: "drive",
            title: "Drive",
            meaning: "what moves the mass, by the phase of the drive",
            options: &DriveKind::OPTIONS,
            tag: "drive",
            option_tags: &[
                "Harmonic",
                "Square",
                "Trapezoid",
                "TwoHarmonics",
                "Prescribed",
                "TwoPhase",
                "ThreePhase",
            ],
            is_optional: true,
        },
        Choice {
            name: "drive_reaction",
            noun: "reaction",
            title: "Reaction of the drive",
            meaning: "what takes up the reaction of the drive",
            options: &Reaction::OPTIONS,
            tag: "reaction",
            option_tags: &["None", "Capsule"],
            is_optional: true,
        },
        Choice {
            name: "release",
            noun: "release",
            title: "Release of damped stops",
            meaning: "when the mass leaves a stop that damps",
            options: &Release::OPTIONS,
            tag: "release",
            option_tags: &["Geometry", "Force"],
            is_optional: true,
        },
    ],
    coordinates: COORDINATES.split_at(4).0,
    drift: Some(2),
    on_section: &[0, 1, 3],
    section: SECTION,
    compared_as: &["omega r", "y1", "y2"],
    neutral: &[NEUTRAL_R, NEUTRAL_Y1, NEUTRAL_Y2],
    edge: &[EDGE_SECTION_R, EDGE_SECTION_Y1, EDGE_SECTION_Y2],
    end: &[END_R, END_Y1, END_Y2],
    motion: signals::MOTION,
    outputs: OUTPUTS.split_at(Output::ALL.len()).0,
    roles: Roles {
        drive: Some(DriveRoles {
            frequency: Some(Parameter::Omega as usize),
            period: Some(Parameter::Period as usize),
            amplitude: Some(Parameter::Pd as usize),
            cycle: None,
        }),
        impact_surface: Some(Parameter::Delta as usize),
        rear_surface: Some(Parameter::Delta3 as usize),
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
        key_outputs: KEY_OUTPUTS.split_at(KEY_OUTPUTS.len() - 1).0,
        event_counts: &[
            Output::ImpactsPerCycle as usize,
            Output::ForwardSlips as usize,
            Output::BackwardSlips as usize,
            Output::Reversals as usize,
        ],
        impact_counts: &[Output::ImpactsPerCycle as usize, Output::RearImpactsPerCycle as usize],
        exponent: Output::LyapunovExponent as usize,
        exponent_error: Output::LyapunovUncertainty as usize,
        spectrum: Some(SpectrumRoles {
            exponents: EXPONENTS.split_at(3).0,
            dimension: [
                Output::KaplanYorkeDimension as usize,
                Output::KaplanYorkeDimensionError as usize,
            ],
        }),
        gain_error: Some(Output::ProgressionSpeedError as usize),
        excluded_period: Output::ExcludedPeriod as usize,
        defect: Output::IntegrationDefect as usize,
        section_residual: Output::SectionResidual as usize,
    },
    rules: RULES,
    equations: None,
    own: None,
};

/// The capsule on a way with evenly spaced folds. Its displacement drifts, as on even ground; its place between two folds is a
/// coordinate of the section, so that a motion that repeats there passes a whole number of folds in its period.
pub static CAPSULE_OVER_FOLDS: Description = Description {
    name: "capsule-over-folds",
    extends: Some(&CAPSULE),
    parameters: PARAMETERS,
    coordinates: COORDINATES,
    on_section: &[0, 1, 3, 4],
    section: &[SECTION_R, SECTION_Y1, SECTION_Y2, SECTION_PLACE],
    compared_as: &["omega r", "y1", "y2", "omega x2"],
    neutral: &[NEUTRAL_R, NEUTRAL_Y1, NEUTRAL_Y2, NEUTRAL_PLACE],
    edge: &[EDGE_SECTION_R, EDGE_SECTION_Y1, EDGE_SECTION_Y2, EDGE_SECTION_PLACE],
    end: &[END_R, END_Y1, END_Y2, END_PLACE],
    motion: MotionDescription {
        // Impacts are not told with the place where they happen.
        at_impact: Some(|r, told| {
            let state = [r, told[1], 0.0, told[2], f64::NAN];
            description::State::new(&CAPSULE_OVER_FOLDS, &state)
        }),
        ..signals::MOTION_OVER_FOLDS
    },
    outputs: OUTPUTS,
    roles: Roles {
        key_outputs: KEY_OUTPUTS,
        spectrum: match ON_EVEN_GROUND.roles.spectrum {
            Some(it) => Some(SpectrumRoles { exponents: EXPONENTS, ..it }),
            None => None,
        },
        ..ON_EVEN_GROUND.roles
    },
    ..ON_EVEN_GROUND
};

/// The coordinates of a state, that of folds last.
const COORDINATES: &[CoordinateDescription] = &[
    CoordinateDescription { name: "r", tag: "StartR", start: START_R },
    CoordinateDescription { name: "y1", tag: "StartY1", start: START_Y1 },
    CoordinateDescription { name: "x2", tag: "StartX2", start: START_X2 },
    CoordinateDescription { name: "y2", tag: "StartY2", start: START_Y2 },
    CoordinateDescription { name: "place", tag: "StartPlace", start: START_PLACE },
];

/// The exponents with their errors, that of folds last.
const EXPONENTS: &[[usize; 2]] = &[
    [Output::Lyapunov1 as usize, Output::Lyapunov1Error as usize],
    [Output::Lyapunov2 as usize, Output::Lyapunov2Error as usize],
    [Output::Lyapunov3 as usize, Output::Lyapunov3Error as usize],
    [Output::Lyapunov4 as usize, Output::Lyapunov4Error as usize],
];

/// The outputs that are told first, that of folds last.
const KEY_OUTPUTS: &[usize] = &[
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
    Output::FoldsPerPeriod as usize,
];

/// All outputs, those of folds last.
const OUTPUTS: &[OutputDescription] = &{
    let mut all = [Output::ProgressionSpeed.description(); Output::OVER_FOLDS.len()];
    let mut index = 0;
    while index < all.len() {
        all[index] = Output::OVER_FOLDS[index].description();
        index += 1;
    }
    all
};

/// All parameters, those of folds last.
const PARAMETERS: &[ParameterDescription] = &{
    let mut all = [Parameter::M1.description(); Parameter::OVER_FOLDS.len()];
    let mut index = 0;
    while index < all.len() {
        all[index] = Parameter::OVER_FOLDS[index].description();
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
        let is_asked_for = matches!(
            self,
            Parameter::Omega
                | Parameter::Pd
                | Parameter::K2
                | Parameter::Delta
                | Parameter::FoldSpacing
        );
        let (tag, presence) = (self.tag(), self.presence());
        let replaces = match self {
            Parameter::Period => Some(Parameter::Omega as usize),
            Parameter::Restitution => Some(Parameter::K2 as usize),
            _ => None,
        };
        ParameterDescription { quantity, tag, allowed, default, is_asked_for, presence, replaces }
    }

    /// It as a parameter that the description of the capsule tells of.
    pub const fn described(self) -> description::Parameter {
        let model = if self.is_of_folds() { &CAPSULE_OVER_FOLDS } else { &CAPSULE };
        description::Parameter::of(model, self as usize)
    }

    /// Of a parameter of the capsule, which it is.
    ///
    /// # Panics
    /// Where it is a parameter of another model.
    pub fn which(parameter: description::Parameter) -> Parameter {
        let is_its = parameter.model().shares_with(&CAPSULE);
        assert!(is_its, "{parameter:?} is no parameter of the capsule");
        Parameter::OVER_FOLDS[parameter.index()]
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
            kept: self.kept(),
        }
    }

    /// It as an output that the description of the capsule tells of.
    pub const fn described(self) -> description::Output {
        let model = if self.is_of_folds() { &CAPSULE_OVER_FOLDS } else { &CAPSULE };
        description::Output::of(model, self as usize)
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
        match *state.values() {
            [r, y1, x2, y2] => State { r, y1, x2, y2, place: 0.0 },
            [r, y1, x2, y2, place] => State { r, y1, x2, y2, place },
            _ => panic!("{state:?} is no state of the capsule"),
        }
    }
}

/// A capsule at rest in its middle, as the model where none is named.
impl Default for description::State {
    fn default() -> Self {
        description::State::origin(&CAPSULE)
    }
}

/// On even ground.
impl From<Outputs> for description::Outputs {
    fn from(outputs: Outputs) -> Self {
        description::Outputs::new(&CAPSULE, &outputs.values()[..Output::ALL.len()])
    }
}
