//! Starts far from zero: they change neither the orbit nor its speed, and what is not proven is not certified.

use capsulemap_engine::orbit::{Outcome, Proof, Protocol};
use capsulemap_models::capsule::{CapsuleState as _, Output, Parameters, State, settle};

use super::draws;

#[test]
fn the_place_of_the_start_changes_no_bit_of_what_comes_of_it() {
    let protocol = Protocol::default();
    for case in draws::cases(40, 91) {
        let from = |x2: f64| {
            let start = State { x2, ..case.start.capsule() };
            settle(&case.parameters, case.section_phase, start, &protocol)
        };
        let here = from(0.0);
        for x2 in [1.0, -1e9, 1e12, 1e15] {
            let there = from(x2);
            assert_eq!((here.outcome, here.period), (there.outcome, there.period));
            assert_eq!(here.section, there.section);
            for &output in Output::ALL {
                let bits = [&here, &there].map(|it| it.outputs[output].to_bits());
                assert_eq!(bits[0], bits[1], "{output:?} from x2 = {x2:e}: {case:?}");
            }
        }
    }
}

#[test]
fn a_fast_start_loses_no_digit_of_the_speed() {
    let speed = |y1: f64| {
        let start = State { y1, ..State::default() };
        let orbit = settle(&Parameters::default(), 0.0, start, &Protocol::default());
        assert_eq!(orbit.certificate.proof, Proof::Newton);
        orbit.outputs[Output::ProgressionSpeed]
    };
    let slow = speed(0.0);
    for y1 in [1.0, 1e2, 1e3] {
        assert!((speed(y1) - slow).abs() < 1e-13 * slow, "from y1 = {y1}");
    }
}

#[test]
fn a_motion_that_slows_down_is_no_orbit() {
    for fast in [1e10, 1e12, 1e14] {
        let start = State { y1: fast, y2: fast, ..State::default() };
        let orbit = settle(&Parameters::default(), 0.0, start, &Protocol::default());
        assert_eq!((orbit.outcome, orbit.certificate.proof), (Outcome::Undecided, Proof::None));
        assert!(orbit.outputs[Output::MomentumResidual].abs() > 1e-2);
    }
}
