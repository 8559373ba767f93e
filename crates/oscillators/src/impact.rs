//! A driven mass at a wall as a model: x'' + c x' + x = f cos(w t + phase), with an impact x' -> -r x' at x = wall.

use capsulemap_engine::flow::Step;
use capsulemap_engine::orbit::{self, OrbitOf, Protocol};
use capsulemap_models::description::{
    Chart, CoordinateDescription, Description, DriveRoles, MotionDescription, Outputs, Parameter,
    Parameters, Roles, Rules, Signal, SignalKind, State,
};
use capsulemap_models::face::{Face, engine_case};
use capsulemap_models::model::Model;
use capsulemap_models::motion::Case;
use capsulemap_models::of::Of;
use capsulemap_models::quantity::{Allowed, Quantity};

use super::words::{number, output, outputs_of, parameter};

// Of the example only its system is used here, not its program.
#[path = "../../engine/examples/impact_oscillator.rs"]
#[allow(dead_code)]
mod example;

pub use example::Impactor;

/// The impact oscillator as a model.
///
/// Behind the door, so that its lanes are compiled here and not in each crate that names it.
pub static IMPACT: &dyn Model = &Of::<Impactor<f64>, 2>::described(&IMPACT_OSCILLATOR);

const DISPLACEMENT: Quantity = number("history_x", "displacement");
const VELOCITY: Quantity = number("history_v", "velocity");
const FORCE: Quantity = number("history_force", "driving force");
const SPRING_FORCE: Quantity = number("history_spring", "force of the spring");

/// The names of the parameters in the system, in the order of the description.
const NAMES: [&str; 5] = ["c", "f", "w", "r", "wall"];

/// What the impact oscillator says of itself; all in the units in which mass and stiffness are one.
pub static IMPACT_OSCILLATOR: Description = Description {
    name: "impact-oscillator",
    extends: None,
    parameters: &[
        parameter(("c", "C"), "damping", (Allowed::NonNegative, 0.1)),
        parameter(("f", "F"), "amplitude of the force", (Allowed::NonNegative, 1.0)),
        parameter(("w", "W"), "frequency of the force", (Allowed::Positive, 1.5)),
        parameter(("r", "R"), "coefficient of restitution", (Allowed::NonNegative, 0.7)),
        parameter(
            ("wall", "Wall"),
            "displacement at which the wall stands",
            (Allowed::Finite, 1.0),
        ),
    ],
    choices: &[],
    coordinates: &[
        CoordinateDescription {
            name: "x",
            tag: "StartX",
            start: number("start_x", "displacement at the start"),
        },
        CoordinateDescription {
            name: "v",
            tag: "StartV",
            start: number("start_v", "velocity at the start"),
        },
    ],
    drift: None,
    on_section: &[0, 1],
    section: &[
        number("section_x", "displacement at the stroboscopic section"),
        number("section_v", "velocity at the stroboscopic section"),
    ],
    compared_as: &["w x", "v"],
    neutral: &[
        number("neutral_x", "part of w x in the direction of the family of a neutral orbit"),
        number("neutral_v", "part of v in the direction of the family of a neutral orbit"),
    ],
    edge: &[
        number("edge_section_x", "displacement of the saddle at the stroboscopic section"),
        number("edge_section_v", "velocity of the saddle at the stroboscopic section"),
    ],
    end: &[
        number("end_x", "displacement at the end of the case"),
        number("end_v", "velocity at the end of the case"),
    ],
    motion: MotionDescription {
        histories: &[DISPLACEMENT, VELOCITY, FORCE],
        signals: &[
            Signal::kept(DISPLACEMENT, SignalKind::Coordinate, 0),
            Signal::kept(VELOCITY, SignalKind::Coordinate, 1),
            Signal::kept(FORCE, SignalKind::Force, 2),
            Signal::force(SPRING_FORCE, |_, state, _| -state.values()[0]),
        ],
        panels: &[DISPLACEMENT.name, VELOCITY.name],
        charts: &[
            Chart { title: "Displacement", signals: &[DISPLACEMENT.name] },
            Chart { title: "Velocity", signals: &[VELOCITY.name] },
            Chart { title: "Force", signals: &[FORCE.name, SPRING_FORCE.name] },
        ],
        portrait: Some([DISPLACEMENT.name, VELOCITY.name]),
        events: &["impact"],
        ..MotionDescription::NONE
    },
    outputs: &[
        output(("size", "Size"), "largest of w x and v at the section"),
        output(("lyapunov_exponent", "LyapunovExponent"), "largest Lyapunov exponent"),
        output(("lyapunov_uncertainty", "LyapunovUncertainty"), "standard error of that exponent"),
        output(("excluded_period", "ExcludedPeriod"), "longest period excluded, in drive cycles"),
        output(("integration_defect", "IntegrationDefect"), "largest defect of a step"),
        output(("section_residual", "SectionResidual"), "how far the section is from repeating"),
    ],
    roles: Roles {
        drive: Some(DriveRoles {
            frequency: Some(2),
            period: None,
            amplitude: Some(1),
            cycle: None,
        }),
        impact_surface: Some(4),
        rear_surface: None,
        natural: None,
        trade_off: None,
        rest_share: None,
        key_outputs: &[0, 1],
        event_counts: &[],
        impact_counts: &[],
        exponent: 1,
        exponent_error: 2,
        spectrum: None,
        gain_error: None,
        excluded_period: 3,
        defect: 4,
        section_residual: 5,
    },
    rules: Rules::NONE,
    equations: None,
    own: None,
};

impl Face<2> for Impactor<f64> {
    fn description(&self) -> &'static Description {
        &IMPACT_OSCILLATOR
    }

    fn of(parameters: &Parameters, phase: f64) -> Self {
        let [c, f, w, r, wall] =
            std::array::from_fn(|at| parameters[Parameter::of(&IMPACT_OSCILLATOR, at)]);
        Impactor { c, f, w, r, wall, phase }
    }

    fn which(parameter: Parameter) -> &'static str {
        NAMES[parameter.index()]
    }

    fn state(state: &State) -> [f64; 2] {
        state.section().array()
    }

    fn told(&self, state: &[f64; 2]) -> State {
        State::new(&IMPACT_OSCILLATOR, state)
    }

    fn driven(&self, _: &Self, step: &Step<f64, Self>, h: f64) -> Vec<f64> {
        vec![self.f * libm::cos(self.w * (step.start + h) + self.phase)]
    }

    fn outputs(&self, orbit: &OrbitOf<Self, 2>, _: f64) -> Outputs {
        let exponent = orbit.exponent;
        outputs_of(
            &IMPACT_OSCILLATOR,
            &[
                orbit.size,
                exponent.value,
                exponent.uncertainty,
                orbit.excluded,
                orbit.defect,
                orbit.residual,
            ],
        )
    }
}

/// The oscillator of a case, and what the engine alone says that it settles to.
pub fn settled(case: &Case, protocol: &Protocol) -> (Impactor<f64>, OrbitOf<Impactor<f64>, 2>) {
    let case = engine_case::<Impactor<f64>, 2>(case);
    (case.system, orbit::settle(&case, protocol))
}
