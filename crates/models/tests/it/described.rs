//! What the capsule says of itself holds for it, and a parameter of one model is none of another.

use std::f64::consts::PI;

use capsulemap_engine::flow::Event as _;
use capsulemap_models::capsule::description::{CAPSULE, CAPSULE_OVER_FOLDS};
use capsulemap_models::capsule::{
    CapsuleParameters as _, EventKind, Forces, Output, Parameter, Parameters, Resistance, State,
    Switching,
};
use capsulemap_models::description::{
    self, Description, MotionDescription, ParameterDescription, Presence, Section,
};
use capsulemap_models::motion::Case;
use capsulemap_models::of::default_model;
use capsulemap_models::quantity::{Allowed, Dimension, Quantity};

/// A model of one parameter that is called as one of the capsule is.
static OTHER: Description = Description {
    name: "other",
    extends: None,
    parameters: &[ParameterDescription {
        quantity: Quantity { name: "m1", dimension: Dimension::Mass, meaning: "mass", shown: None },
        tag: "M",
        allowed: Allowed::Positive,
        default: 2.0,
        is_asked_for: false,
        presence: Presence::Always,
        replaces: None,
    }],
    choices: &[],
    coordinates: &[],
    drift: None,
    on_section: &[],
    section: &[],
    compared_as: &[],
    neutral: &[],
    edge: &[],
    end: &[],
    motion: MotionDescription::NONE,
    outputs: &[],
    roles: CAPSULE.roles,
    rules: CAPSULE.rules,
    equations: None,
    own: None,
};

#[test]
fn the_description_has_every_parameter_and_output_in_its_place() {
    assert!(*default_model() == CAPSULE);
    assert_eq!(CAPSULE.parameters().count(), Parameter::ALL.len());
    for (described, own) in CAPSULE.parameters().zip(Parameter::ALL) {
        assert!(described == *own && Parameter::which(described) == *own);
        assert_eq!(format!("{described:?}"), format!("{own:?}"));
        assert_eq!(CAPSULE.parameter(own.symbol()), Some(described));
        assert_eq!(Parameters::default()[described], own.default_value(), "{described:?}");
        let told = (described.dimension(), described.allowed(), described.meaning());
        assert_eq!(told, (own.dimension(), own.allowed(), own.meaning()), "{described:?}");
    }
    assert_eq!(CAPSULE.outputs().count(), Output::ALL.len());
    for (described, own) in CAPSULE.outputs().zip(Output::ALL) {
        assert!(described == *own && described.is_smooth() == own.is_smooth());
        assert_eq!(format!("{described:?}"), format!("{own:?}"));
        assert_eq!(CAPSULE.output(own.name()), Some(described));
        assert_eq!((described.unit(), described.meaning()), (own.unit(), own.meaning()));
    }
}

/// What a model has from another is the same in both, and what is its own is not in the other.
#[test]
fn a_capsule_over_folds_has_all_that_one_on_even_ground_has() {
    for (own, others) in CAPSULE_OVER_FOLDS.parameters().zip(CAPSULE.parameters()) {
        assert!(own == others && own.symbol() == others.symbol());
    }
    for (own, others) in CAPSULE_OVER_FOLDS.outputs().zip(CAPSULE.outputs()) {
        assert!(own == others && own.name() == others.name());
    }
    let of_folds: Vec<&str> =
        Parameter::OVER_FOLDS.iter().filter(|it| it.is_of_folds()).map(|it| it.symbol()).collect();
    assert_eq!(of_folds, ["fold_spacing", "fold_friction", "fold_force", "fold_sharpness"]);
    assert!(of_folds.iter().all(|it| CAPSULE.parameter(it).is_none()));
    let mut parameters = Parameters::of(&CAPSULE_OVER_FOLDS);
    parameters[Parameter::Omega] = 3.0;
    parameters[Parameter::FoldForce] = 0.2;
    assert_eq!((parameters[Parameter::Omega], parameters[Parameter::FoldForce]), (3.0, 0.2));
}

#[test]
#[should_panic(expected = "fold_force is no parameter of capsule")]
fn a_capsule_on_even_ground_has_no_parameter_of_folds() {
    let _ = Parameters::default()[Parameter::FoldForce];
}

#[test]
fn each_choice_is_the_law_of_its_name() {
    for (law, &(name, resistance)) in Resistance::NAMES.iter().enumerate() {
        for (reading, &(_, switching)) in Switching::NAMES.iter().enumerate() {
            let mut chosen = Parameters::default();
            chosen.choose(0, law);
            chosen.choose(1, reading);
            assert_eq!((chosen.resistance(), chosen.switching()), (resistance, switching));
            let mut same = Parameters::default();
            same.resist_by(resistance);
            same.switch_by(switching);
            assert_eq!(chosen, same);
            assert_eq!(chosen.choices().next(), Some(("resistance", name)));
            // What fingerprints have of it, as before there was a description.
            let known = format!("resistance: {resistance:?}, switching: {switching:?} }}");
            assert!(format!("{chosen:?}").ends_with(&known), "{chosen:?}");
        }
    }
}

#[test]
#[should_panic(expected = "m1 is no parameter of other")]
fn a_parameter_of_one_model_is_none_of_another() {
    let other = Parameters::of(&OTHER);
    assert_eq!(other[OTHER.parameters().next().expect("one")], 2.0);
    let _ = other[Parameter::M1];
}

/// The force needed to leave rest, and that of sliding at some speeds [N].
fn felt(parameters: &Parameters) -> (f64, [f64; 4]) {
    let sliding = [-1.3, -1e-3, 2e-4, 0.7]
        .map(|y2| Forces::of(parameters, &State::of([0.01, 0.2, 0.0, y2]), 0.0).friction);
    (parameters.break_away(), sliding)
}

/// What has no effect changes no force: neither that needed to leave rest nor that of sliding at any speed.
#[test]
fn what_is_said_to_have_no_effect_has_none() {
    let mut idle = 0;
    for (_, law) in Resistance::NAMES {
        for mu_s in [0.0, 0.1, 0.3, 0.5, 0.9] {
            let mut parameters = Parameters::with(&[
                (Parameter::MuS, mu_s),
                (Parameter::MuD, 0.25),
                (Parameter::C1, 0.4),
                (Parameter::C2, 0.7),
            ]);
            parameters.resist_by(law);
            let friction =
                [Parameter::MuS, Parameter::MuD, Parameter::Vs, Parameter::C1, Parameter::C2];
            for parameter in friction {
                let mut other = parameters.clone();
                // Upward mu_s may pass the value from which it has an effect.
                other[parameter] *= if parameter == Parameter::MuS { 0.9 } else { 1.1 };
                let rules = CAPSULE.rules;
                let never = (rules.no_effect)(&parameters, parameter.into()).is_some();
                let below = (rules.no_effect_below)(&parameters, parameter.into());
                let is_below = below.is_some_and(|it| parameters[parameter] <= it.value);
                let changes = felt(&parameters) != felt(&other);
                let is_other = parameters[parameter] != other[parameter];
                let said = never || is_below || !is_other;
                assert_eq!(changes, !said, "{law:?}, mu_s = {mu_s}: {parameter:?}");
                idle += usize::from(said);
            }
        }
    }
    assert!(idle > 20, "{idle}");
}

/// Where both directions have a coefficient of their own, that of both changes no force; where one has, it changes some.
#[test]
fn what_both_directions_have_of_their_own_has_no_effect_for_both() {
    use Parameter::{MuD, MuDBackward, MuDForward, MuS, MuSBackward, MuSForward};
    for (both, [forward, backward]) in
        [(MuS, [MuSForward, MuSBackward]), (MuD, [MuDForward, MuDBackward])]
    {
        let mut parameters = Parameters::with(&[(forward, 0.8), (Parameter::P0, -1.0)]);
        let changes = |parameters: &Parameters| {
            let mut other = parameters.clone();
            other[both] *= 1.5;
            felt(parameters) != felt(&other)
        };
        let said = |it: &Parameters| (CAPSULE.rules.no_effect)(it, both.into());
        assert!(changes(&parameters) && said(&parameters).is_none(), "{both:?}");
        parameters[backward] = 0.9;
        let symbol = both.symbol();
        let why = format!("beside `{symbol}_forward` and `{symbol}_backward`");
        assert!(!changes(&parameters) && said(&parameters) == Some(why), "{both:?}");
    }
}

#[test]
fn a_state_is_shown_with_its_units_as_the_capsule_shows_it() {
    let state = State::of([1.5e-3, -0.25, 4.0, 0.0]);
    assert_eq!(description::State::from(state).to_string(), state.to_string());
}

#[test]
fn a_section_point_is_the_list_of_its_coordinates() {
    let point = description::State::from(State::of([1.0, 2.0, 3.0, 4.0])).section();
    assert_eq!(
        (point.array(), format!("{point:?}")),
        ([1.0, 2.0, 4.0], "[1.0, 2.0, 4.0]".to_owned())
    );
    assert!(
        point == [1.0, 2.0, 4.0]
            && point != [1.0, 2.0]
            && point == point.iter().copied().collect::<Section>()
    );
    let at = description::State::at_section(&CAPSULE, &point);
    assert_eq!(State::from(&at), State::of([1.0, 2.0, 0.0, 4.0]));
}

#[test]
fn a_description_whose_parts_do_not_fit_together_says_which() {
    assert_eq!(CAPSULE.faults(3), Vec::<String>::new());
    let faults = CAPSULE.faults(2);
    assert_eq!(faults.len(), 7, "{faults:?}");
    assert!(faults[0].starts_with("on_section has 3 entries"), "{faults:?}");
    // The roles of another model name what this one does not have, and its histories have no coordinates.
    let faults = OTHER.faults(0);
    for part in [
        "a section point has 1 to 8 coordinates, not 0",
        "a role names parameter 7 of 1, counted from 0",
        "a role names output 0 of 0, counted from 0",
    ] {
        assert!(faults.iter().any(|it| it == part), "{part}: {faults:?}");
    }
}

#[test]
fn events_are_called_as_the_capsule_calls_them() {
    for kind in EventKind::ALL {
        let mut name = String::new();
        for letter in format!("{kind:?}").chars() {
            if letter.is_uppercase() && !name.is_empty() {
                name.push('-');
            }
            name.push(letter.to_ascii_lowercase());
        }
        assert_eq!(CAPSULE.event(kind.number()), name);
    }
    assert_eq!(CAPSULE.motion.events.len(), EventKind::ALL.len());
}

#[test]
fn a_start_is_as_late_as_its_phase_whichever_parameter_tells_the_period() {
    let mut parameters = Parameters::of(default_model());
    let case = |parameters: &Parameters, start_phase: f64| Case {
        parameters: parameters.clone(),
        start: description::State::origin(default_model()),
        start_phase,
        section_phase: 0.5,
    };
    let omega = parameters[Parameter::Omega];
    assert_eq!(case(&parameters, 2.5).start_time(), 2.0 / omega);
    parameters[Parameter::Period] = 0.08;
    assert!((case(&parameters, 0.5 + PI).start_time() - 0.04).abs() < 1e-17);
    assert_eq!(case(&parameters, 0.5).start_time(), 0.0);
}
