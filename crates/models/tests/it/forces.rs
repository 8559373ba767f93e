//! Forces against their closed forms.

use capsulemap_models::capsule::{CapsuleParameters as _, Forces, Parameter, Parameters, State};

#[test]
fn forces_are_those_of_the_model() {
    let values = [
        (Parameter::K1, 100.0),
        (Parameter::C, 2.0),
        (Parameter::K2, 1e4),
        (Parameter::Delta, 1e-3),
        (Parameter::M1, 0.5),
        (Parameter::M2, 0.5),
        (Parameter::G, 10.0),
        (Parameter::MuD, 0.2),
        (Parameter::Vs, 0.1),
    ];
    let parameters = Parameters::with(&values);
    let at = |r: f64, y1: f64, y2: f64| Forces::of(&parameters, &State::of([r, y1, 7.0, y2]), 0.0);
    let open = at(5e-4, 0.1, 0.0);
    assert_eq!((open.contact, open.friction), (0.0, open.of_mass));
    assert!((open.of_mass - 0.25).abs() < 1e-15);
    let closed = at(3e-3, 0.1, 0.1);
    assert!((closed.contact - 20.0).abs() < 1e-12 && (closed.of_mass - 20.3).abs() < 1e-12);
    // mu_d N (1 + exp(-1)) against the motion, with N = 10 N.
    let sliding = 2.0 * (1.0 + (-1.0_f64).exp());
    assert!((closed.friction - sliding).abs() < 1e-12);
    assert!((at(0.0, 0.0, -0.1).friction + sliding).abs() < 1e-12);
}
