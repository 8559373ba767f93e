//! What does not fit together between a system and its description is told before it can be computed with.

use capsulemap_engine::orbit::OrbitOf;
use capsulemap_models::capsule::description::{CAPSULE, CAPSULE_OVER_FOLDS};
use capsulemap_models::capsule::{CapsuleParameters as _, Parameters, Switching};
use capsulemap_models::description::{
    CoordinateDescription, Description, MotionDescription, Outputs, Parameter,
    ParameterDescription, Presence, Roles, Rules, State,
};
use capsulemap_models::face::{Face, faults};
use capsulemap_models::of::model_of;
use capsulemap_models::quantity::{Allowed, Dimension, Quantity};

// Of the example only its system is used here, not its program.
#[path = "../../../engine/examples/duffing.rs"]
#[allow(dead_code)]
mod duffing;

use duffing::Duffing;

const fn number(name: &'static str) -> Quantity {
    Quantity { name, dimension: Dimension::Number, meaning: "a number", shown: None }
}

const fn parameter(name: &'static str, default: f64) -> ParameterDescription {
    let allowed = Allowed::NonNegative;
    ParameterDescription {
        quantity: number(name),
        tag: name,
        allowed,
        default,
        is_asked_for: true,
        presence: Presence::Always,
        replaces: None,
    }
}

const fn coordinate(name: &'static str, start: &'static str) -> CoordinateDescription {
    CoordinateDescription { name, tag: name, start: number(start) }
}

/// Duffing's oscillator with an event that it does not have, and a parameter.
static WRONG: Description = Description {
    name: "wrong",
    extends: None,
    parameters: &[parameter("c", 0.1), parameter("p", 0.2), parameter("q", 0.3)],
    choices: &[],
    coordinates: &[coordinate("x", "start_x"), coordinate("v", "start_v")],
    drift: None,
    on_section: &[0, 1],
    section: &[number("section_x"), number("section_v")],
    compared_as: &["x", "v"],
    neutral: &[number("neutral_x"), number("neutral_v")],
    edge: &[number("edge_x"), number("edge_v")],
    end: &[number("end_x"), number("end_v")],
    motion: MotionDescription { events: &["impact"], ..MotionDescription::NONE },
    outputs: CAPSULE.outputs,
    roles: Roles {
        drive: None,
        impact_surface: None,
        rear_surface: None,
        natural: None,
        spectrum: None,
        ..CAPSULE.roles
    },
    rules: Rules::NONE,
    equations: None,
    own: None,
};

impl Face<2> for Duffing<f64> {
    fn description(&self) -> &'static Description {
        &WRONG
    }

    /// The values of c and p exchanged, as by a list in another order.
    fn of(parameters: &Parameters, _: f64) -> Self {
        let [p, c] = [0, 1].map(|at| parameters[Parameter::of(&WRONG, at)]);
        Duffing { c, p }
    }

    fn which(parameter: Parameter) -> &'static str {
        ["c", "p", "q"][parameter.index()]
    }

    fn state(state: &State) -> [f64; 2] {
        state.section().array()
    }

    fn told(&self, state: &[f64; 2]) -> State {
        State::new(&WRONG, state)
    }

    fn outputs(&self, _: &OrbitOf<Self, 2>, _: f64) -> Outputs {
        Outputs::unknown(&WRONG)
    }
}

#[test]
fn a_system_and_its_description_have_the_same_parameters_and_events() {
    assert_eq!(
        faults::<Duffing<f64>, 2>(&WRONG),
        [
            "the system has 0 events, and the description names 1",
            "c is \"c\" of the system, which another parameter sets",
            "p is \"p\" of the system, which another parameter sets",
            "q is \"q\" of the system, which has none of that name",
        ]
    );
}

#[test]
fn each_form_of_the_capsule_fits_its_description() {
    for (_, switching) in Switching::NAMES {
        let mut parameters = Parameters::default();
        parameters.switch_by(switching);
        assert_eq!(model_of(&parameters).faults(), Vec::<String>::new());
    }
    let over_folds = model_of(&Parameters::of(&CAPSULE_OVER_FOLDS));
    assert_eq!(over_folds.faults(), Vec::<String>::new());
}
