//! Families of periodic orbits: without friction of sliding every orbit has neighbours that move faster and
//! slower.

use capsulemap_engine::branch::NotFollowed;
use capsulemap_engine::flow::System;
use capsulemap_engine::orbit::neutral::close_neutral;
use capsulemap_engine::orbit::passage::{OneByOne, image};
use capsulemap_engine::orbit::return_map::Cycles;
use capsulemap_engine::orbit::{Outcome, Proof, Protocol};
use capsulemap_models::capsule::branch::follow;
use capsulemap_models::capsule::{
    CapsuleCase as _, CapsuleParameters as _, CapsuleState as _, Case, Filippov, Orbit, Output,
    Parameter, Parameters, State,
};

use super::branch::request;
use super::draws;
use super::forms::settle;

/// A capsule that slides without friction; its section repeats after two cycles to rounding, and after one.
fn frictionless() -> Parameters {
    Parameters::with(&[
        (Parameter::Omega, 268.059_627_791_266_85),
        (Parameter::Pd, 11.886_887_681_148_162),
        (Parameter::K2, 141.307_901_241_731_77),
        (Parameter::Delta, 2.745_038_448_485_034_3e-3),
        (Parameter::M2, 0.493_126_061_669_770_24),
        (Parameter::C, 0.096_315_110_542_868_62),
        (Parameter::MuS, 0.115_198_172_266_684_6),
        (Parameter::MuD, 0.0),
    ])
}

/// A neutral orbit of period 1 along the common velocity of mass and capsule.
fn check(orbit: &Orbit, about: &str) {
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1), "{about}");
    assert_eq!(orbit.certificate.proof, Proof::Neutral, "{about}");
    assert_eq!(orbit.outputs[Output::LargestMultiplier], 1.0, "{about}");
    assert_eq!(orbit.outputs[Output::LyapunovExponent], 0.0, "{about}");
    assert!(!orbit.certificate.is_stable(), "{about}");
    // Seen from a frame that moves at constant velocity, frictionless motion obeys the same equations.
    let [r, y1, y2]: [f64; 3] = orbit.certificate.neutral.expect("a direction").array();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert!(r.abs() < 1e-7 && (y1 - half).abs() < 1e-7 && (y2 - half).abs() < 1e-7, "{about}");
}

#[test]
fn a_capsule_without_friction_of_sliding_is_neutral_and_of_least_period() {
    let p = frictionless();
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    check(&orbit, "from rest");
    let [r, y1, y2] = orbit.section[0].array();
    let speed = orbit.outputs[Output::ProgressionSpeed];
    for faster in [-0.01, 0.003, 0.02] {
        let start = State::of([r, y1 + faster, 0.0, y2 + faster]);
        let other = settle(&p, 0.0, start, &Protocol::default());
        check(&other, "from another member");
        let gain = other.outputs[Output::ProgressionSpeed] - speed;
        assert!((gain - faster).abs() < 1e-12, "{faster}: {gain}");
    }
}

#[test]
fn a_family_is_not_followed_as_if_it_were_a_branch() {
    let p = frictionless();
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    let request = request(&p, orbit.section[0], 1, Parameter::Pd, [10.0, 13.0]);
    assert_eq!(follow(&request).err(), Some(NotFollowed::Neutral));
}

#[test]
fn every_case_without_friction_that_slides_for_ever_is_neutral() {
    let mut neutral = 0;
    for mut case in draws::cases(60, 9) {
        case.parameters[Parameter::MuD] = 0.0;
        case.parameters[Parameter::MuS] *= 0.1;
        let Case { parameters, start, section_phase: phase, .. } = &case;
        let orbit = settle(parameters, *phase, start.capsule(), &Protocol::default());
        let slides = orbit.outputs[Output::StickShare] == 0.0;
        if orbit.outcome == Outcome::Periodic && orbit.period == 1 && slides {
            check(&orbit, &format!("{case:?}"));
            neutral += 1;
        } else {
            assert_ne!(orbit.certificate.proof, Proof::Neutral, "{case:?}");
        }
    }
    assert!(neutral > 30, "{neutral}");
}

#[test]
fn an_orbit_that_attracts_belongs_to_no_family() {
    for case in draws::cases(20, 10) {
        let Case { parameters: p, start, section_phase: phase, .. } = &case;
        let orbit = settle(p, *phase, start.capsule(), &Protocol::default());
        if orbit.certificate.proof != Proof::Newton {
            continue;
        }
        let capsule = case.read::<Filippov>().system;
        let metric = capsule.metric();
        let cycles = Cycles { count: orbit.period, tolerance: 1e-12 };
        let size = orbit.section[0].iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let family = close_neutral(
            |point| image(&OneByOne, &capsule, point, &cycles),
            cycles.count,
            &metric,
            &orbit.section[0].array(),
            (size, 1e-10),
        );
        assert_eq!(family, Ok(None), "{case:?}");
    }
}
