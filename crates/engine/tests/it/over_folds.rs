//! Right values of a capsule over folds: closed forms, and what must not matter.

use std::f64::consts::PI;

use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::description::CAPSULE_OVER_FOLDS;
use capsulemap_models::capsule::{
    CapsuleParameters as _, DriveKind, Form, Output, Parameter, Parameters, Resistance, settle,
    simulate,
};
use capsulemap_models::description::State;

use super::draws;

/// A capsule of one mass, as r stays zero, that nothing but the folds acts on.
fn alone(period: f64, sharpness: f64) -> Parameters {
    let mut p = Parameters::of(&CAPSULE_OVER_FOLDS);
    p.resist_by(Resistance::Medium);
    p.drive_by(DriveKind::Prescribed);
    for (parameter, value) in [
        (Parameter::Xi1, 0.0),
        (Parameter::Period, period),
        (Parameter::FoldSpacing, 0.03),
        (Parameter::FoldForce, 0.2),
        (Parameter::FoldSharpness, sharpness),
    ] {
        p[parameter] = value;
    }
    p
}

/// The paper's capsule with these values, over folds that have no effect.
fn over_folds(values: &[(Parameter, f64)]) -> Parameters {
    Parameters::with(values).of_extension(&CAPSULE_OVER_FOLDS)
}

/// A state of a capsule whose mass lies still in it.
fn at(place: f64, y2: f64) -> State {
    State::new(&CAPSULE_OVER_FOLDS, &[0.0, y2, 0.0, y2, place])
}

/// Frequency of small vibrations between two folds of a sine [rad/s].
fn pendulum(p: &Parameters) -> f64 {
    let mass = p[Parameter::M1] + p[Parameter::M2];
    (2.0 * PI * p[Parameter::FoldForce] / (mass * p[Parameter::FoldSpacing])).sqrt()
}

/// The arithmetic-geometric mean.
fn mean(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

/// Between two folds that are a sine the capsule is a pendulum: its periods, to and fro and all round, are known.
#[test]
fn folds_of_a_sine_make_a_pendulum() {
    let omega = pendulum(&alone(1.0, 0.0));
    for amplitude in [0.1, 1.0, 2.5] {
        let period = 2.0 * PI / (omega * mean(1.0, libm::cos(0.5 * amplitude)));
        let place = 0.5 + amplitude / (2.0 * PI);
        let run = simulate(&alone(period, 0.0), 0.0, at(place, 0.0), 5, 1e-14);
        let last = run.section.last().expect("it goes on");
        let spacing = 0.03;
        assert!(last.x2.abs() < 1e-11 * spacing, "{amplitude}: {last:?}");
        assert!(last.y2.abs() < 1e-11 * spacing * omega, "{amplitude}: {last:?}");
    }
    for faster in [1.2, 3.0] {
        // At the bottom of a pendulum that goes round, faster than one that just reaches the top.
        let speed = 2.0 * omega * faster;
        let modulus: f64 = 1.0 / faster;
        let period = 4.0 / speed * 0.5 * PI / mean(1.0, (1.0 - modulus * modulus).sqrt());
        let y2 = speed * 0.03 / (2.0 * PI);
        let run = simulate(&alone(period, 0.0), 0.0, at(0.5, y2), 5, 1e-14);
        let last = run.section.last().expect("it goes on");
        assert!((last.x2 - 5.0 * 0.03).abs() < 1e-11, "{faster}: {last:?}");
        assert!((last.y2 - y2).abs() < 1e-11 * y2, "{faster}: {last:?}");
    }
}

/// The height of a fold in the energy that it takes to climb it: the integral of its force in closed form.
#[test]
fn a_fold_is_climbed_with_its_energy() {
    for sharpness in [0.3, 2.0, 10.0] {
        let p = alone(0.01, sharpness);
        let twice = 2.0 * sharpness;
        let cos = (libm::sqrt(1.0 + twice * twice) - 1.0) / twice;
        let largest = (1.0 - cos * cos).sqrt() * libm::exp(sharpness * (cos - 1.0));
        let energy = |place: f64| {
            let height = libm::exp(sharpness * (libm::cos(2.0 * PI * place) - 1.0));
            p[Parameter::FoldForce] * 0.03 / (2.0 * PI * sharpness * largest) * height
        };
        let mass = p[Parameter::M1] + p[Parameter::M2];
        let start = 0.45;
        let run = simulate(&p, 0.0, at(start, 0.4), 40, 1e-14);
        let total = 0.5 * mass * 0.4 * 0.4 + energy(start);
        for point in &run.section {
            let now = 0.5 * mass * point.y2 * point.y2 + energy(start + point.x2 / 0.03);
            assert!((now - total).abs() < 1e-13 * total.max(1.0), "{now} {total}: {point:?}");
        }
        assert!(run.section.last().is_some_and(|it| it.x2.abs() > 0.1), "{sharpness}");
    }
}

/// On a way whose folds neither resist nor push every member moves as on even ground, to the bit.
#[test]
fn folds_without_height_leave_the_bits_of_even_ground() {
    let mut compared = 0;
    for (_, law) in Resistance::NAMES {
        for case in draws::members(40, 37, law) {
            if case.parameters.form() != Form::General {
                continue;
            }
            let over = case.parameters.of_extension(&CAPSULE_OVER_FOLDS);
            let of = |p: &Parameters| {
                let run = simulate(p, case.section_phase, case.start.clone(), 5, 1e-12);
                let bits = |it: [f64; 4]| it.map(f64::to_bits);
                run.section.iter().map(|it| bits([it.r, it.y1, it.x2, it.y2])).collect::<Vec<_>>()
            };
            assert_eq!(of(&case.parameters), of(&over), "{case:?}");
            compared += 1;
        }
    }
    assert!(compared > 60, "{compared}");
}

/// Its speed goes to that of even ground as the folds fade.
#[test]
fn faint_folds_give_the_speed_of_even_ground() {
    let even = Parameters::with(&[(Parameter::Omega, 60.0)]);
    let speed = |p: &Parameters| {
        let orbit = settle(p, 0.0, State::default(), &Protocol::default());
        orbit.outputs[Output::ProgressionSpeed]
    };
    let on_even_ground = speed(&even);
    let over = |height: f64| {
        let mut p = even.of_extension(&CAPSULE_OVER_FOLDS);
        p[Parameter::FoldFriction] = height;
        p[Parameter::FoldForce] = height;
        speed(&p)
    };
    assert!((over(0.0) - on_even_ground).abs() < 1e-12, "{} {on_even_ground}", over(0.0));
    let [near, nearer] = [1e-2, 1e-4].map(|height| (over(height) - on_even_ground).abs());
    assert!(nearer < 0.02 * near.max(1e-6), "{near:e} {nearer:e}");
}

/// How the whole spacings before the start are told does not matter.
#[test]
fn a_motion_does_not_depend_on_the_number_of_a_fold() {
    let mut p = over_folds(&[(Parameter::Omega, 60.0)]);
    p[Parameter::FoldFriction] = 0.5;
    p[Parameter::FoldForce] = 0.4;
    let run = |place: f64| simulate(&p, 0.0, at(place, 0.02), 8, 1e-14);
    let near = run(0.3);
    for whole in [1.0, -3.0, 40.0] {
        for (a, b) in near.section.iter().zip(&run(0.3 + whole).section) {
            assert!((a.x2 - b.x2).abs() < 1e-12 && (a.y2 - b.y2).abs() < 1e-11, "{a:?} {b:?}");
        }
    }
}

/// A capsule that gets over a fold in a cycle, or in some, is locked to them: its speed is a ratio of whole numbers of spacings and
/// periods, and stays while the drive changes a little.
#[test]
fn locked_motions_pass_whole_numbers_of_folds() {
    let mut locked = Vec::new();
    for p_d in (0..24).map(|step| 3.0 + 0.15 * f64::from(step)) {
        let mut p = over_folds(&[
            (Parameter::Omega, 60.0),
            (Parameter::Pd, p_d),
            (Parameter::MuS, 0.2),
            (Parameter::MuD, 0.1),
        ]);
        p[Parameter::FoldSpacing] = 2e-3;
        p[Parameter::FoldForce] = 0.8;
        p[Parameter::FoldFriction] = 0.5;
        let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        let (folds, period) = (orbit.outputs[Output::FoldsPerPeriod], orbit.period as f64);
        let speed = folds / period * p[Parameter::FoldSpacing] / p.drive_period();
        let found = orbit.outputs[Output::ProgressionSpeed];
        assert!((found - speed).abs() < 1e-10, "{p_d}: {found} {speed}");
        locked.push((p_d, folds, orbit.period));
    }
    println!("{locked:?}");
    assert!(locked.iter().any(|(_, folds, _)| *folds != 0.0), "{locked:?}");
}
