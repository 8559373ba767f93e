//! A mass on a moving belt as a model, x'' + c x' + x = friction: a system without a drive, whose section is where the mass turns back.

use capsulemap_engine::orbit::OrbitOf;
use capsulemap_models::description::{
    Chart, CoordinateDescription, Description, MotionDescription, Outputs, Parameter, Parameters,
    Roles, Rules, Signal, SignalKind, State,
};
use capsulemap_models::face::Face;
use capsulemap_models::model::Model;
use capsulemap_models::of::Of;
use capsulemap_models::quantity::{Allowed, Quantity};

use super::words::{number, output, outputs_of, parameter};

// Of the example only its system is used here, not its program.
#[path = "../../engine/examples/belt.rs"]
#[allow(dead_code)]
mod example;

pub use example::Belt;

/// The mass on the belt as a model.
///
/// Behind the door, so that its lanes are compiled here and not in each crate that names it.
pub static BELT: &dyn Model = &Of::<Belt<f64>, 1>::described(&MASS_ON_BELT);

const DISPLACEMENT: Quantity = number("history_x", "displacement");
const VELOCITY: Quantity = number("history_v", "velocity");
const FRICTION: Quantity = number("history_friction", "friction on the mass");

/// The names of the parameters in the system, in the order of the description.
const NAMES: [&str; 4] = ["c", "a", "s", "v"];

/// What the mass on the belt says of itself; all in the units in which mass and stiffness are one.
pub static MASS_ON_BELT: Description = Description {
    name: "belt",
    extends: None,
    parameters: &[
        parameter(("c", "C"), "damping", (Allowed::NonNegative, 0.1)),
        parameter(("a", "A"), "friction of fast sliding", (Allowed::NonNegative, 0.5)),
        parameter(("s", "S"), "Stribeck velocity", (Allowed::Positive, 0.5)),
        parameter(("v", "V"), "velocity of the belt", (Allowed::Positive, 1.5)),
    ],
    choices: &[],
    coordinates: &[
        CoordinateDescription {
            name: "x",
            tag: "StartX",
            start: number("start_x", "displacement at the start"),
        },
        CoordinateDescription {
            name: "u",
            tag: "StartU",
            start: number("start_u", "velocity at the start"),
        },
    ],
    drift: None,
    on_section: &[0],
    section: &[number("section_x", "displacement where the mass turns back")],
    compared_as: &["x"],
    neutral: &[number("neutral_x", "part of x in the direction of the family of a neutral orbit")],
    edge: &[number("edge_section_x", "displacement of the saddle where the mass turns back")],
    end: &[number("end_x", "displacement at the end of the case")],
    motion: MotionDescription {
        histories: &[DISPLACEMENT, VELOCITY],
        signals: &[
            Signal::kept(DISPLACEMENT, SignalKind::Coordinate, 0),
            Signal::kept(VELOCITY, SignalKind::Coordinate, 1),
            Signal::force(FRICTION, |parameters, state, _| {
                let [x, u] = [0, 1].map(|at| state.values()[at]);
                let [c, a, s, v] = of_description(parameters);
                let slip = u - v;
                // At rest on the belt the mass is not accelerated.
                let sliding = -slip.signum() * a * (1.0 + libm::exp(-slip.abs() / s));
                if slip == 0.0 { x + c * u } else { sliding }
            }),
        ],
        charts: &[
            Chart { title: "Displacement", signals: &[DISPLACEMENT.name] },
            Chart { title: "Velocity", signals: &[VELOCITY.name] },
            Chart { title: "Force", signals: &[FRICTION.name] },
        ],
        panels: &[DISPLACEMENT.name, VELOCITY.name],
        portrait: Some([DISPLACEMENT.name, VELOCITY.name]),
        events: &["stick", "slip", "reversal"],
        ..MotionDescription::NONE
    },
    outputs: &[
        output(("size", "Size"), "largest displacement at the section"),
        output(("duration", "Duration"), "mean duration of a cycle"),
        output(("lyapunov_exponent", "LyapunovExponent"), "largest Lyapunov exponent"),
        output(("lyapunov_uncertainty", "LyapunovUncertainty"), "standard error of that exponent"),
        output(("excluded_period", "ExcludedPeriod"), "longest period excluded, in cycles"),
        output(("integration_defect", "IntegrationDefect"), "largest defect of a step"),
        output(("section_residual", "SectionResidual"), "how far the section is from repeating"),
    ],
    roles: Roles {
        drive: None,
        impact_surface: None,
        rear_surface: None,
        natural: None,
        trade_off: None,
        rest_share: None,
        key_outputs: &[0, 1, 2],
        event_counts: &[],
        impact_counts: &[],
        exponent: 2,
        exponent_error: 3,
        spectrum: None,
        gain_error: None,
        excluded_period: 4,
        defect: 5,
        section_residual: 6,
    },
    rules: Rules::NONE,
    equations: None,
    own: None,
};

/// The values of the parameters, in the order of the description.
fn of_description(parameters: &Parameters) -> [f64; 4] {
    std::array::from_fn(|at| parameters[Parameter::of(&MASS_ON_BELT, at)])
}

impl Face<1> for Belt<f64> {
    fn description(&self) -> &'static Description {
        &MASS_ON_BELT
    }

    /// There is no drive.
    fn of(parameters: &Parameters, _: f64) -> Self {
        let [c, a, s, v] = of_description(parameters);
        Belt { c, a, s, v }
    }

    fn which(parameter: Parameter) -> &'static str {
        NAMES[parameter.index()]
    }

    fn state(state: &State) -> [f64; 2] {
        [0, 1].map(|at| state.values()[at])
    }

    fn told(&self, state: &[f64; 2]) -> State {
        State::new(&MASS_ON_BELT, state)
    }

    fn outputs(&self, orbit: &OrbitOf<Self, 1>, _: f64) -> Outputs {
        let (exponent, cycle) = (orbit.exponent, orbit.duration);
        outputs_of(
            &MASS_ON_BELT,
            &[
                orbit.size,
                cycle,
                exponent.value,
                exponent.uncertainty,
                orbit.excluded,
                orbit.defect,
                orbit.residual,
            ],
        )
    }
}
