//! Reference trajectories, computed in 113-bit arithmetic by another code: thirty capsules like the paper's, and
//! 44 over a wide box of parameters.

use super::forms::{simulate, simulate_by};
use capsulemap_engine::lane::Instructions;
use capsulemap_models::capsule::{Parameter, Parameters, State};
use capsulemap_models::description::Presence;
use serde_json::Value;

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} in {value}"))
}

#[test]
fn every_reference_trajectory_is_reproduced() {
    let text = include_str!("../data/trajectories.json");
    let file: Value = serde_json::from_str(text).expect("the reference file is JSON");
    let cases = file["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 30);
    let (mut worst_state, mut worst_event) = (0.0_f64, 0.0_f64);
    for case in cases {
        let id = &case["id"];
        let mut parameters = Parameters::default();
        for parameter in [
            Parameter::Omega,
            Parameter::Pd,
            Parameter::K2,
            Parameter::Delta,
            Parameter::MuS,
            Parameter::MuD,
        ] {
            parameters[parameter] = number(case, parameter.symbol());
        }
        let of = |key| number(&case["start"], key);
        let start = State::of([of("r"), of("y1"), of("x2"), of("y2")]);
        let simulation = simulate(&parameters, 0.0, start, 20, 1e-12);
        assert!(simulation.failure.is_none(), "case {id}");
        for (sample, expected) in simulation.section.iter().zip(case["section"].as_array().unwrap())
        {
            for (key, value) in [
                ("r", sample.r),
                ("y1", sample.y1),
                ("x2", sample.x2),
                ("y2", sample.y2),
                ("work_net", sample.energies.work_net),
                ("work_positive", sample.energies.work_positive),
                ("friction_loss", sample.energies.friction_loss),
                ("damper_loss", sample.energies.damper_loss),
            ] {
                let error = (value - number(expected, key)).abs() / number(&case["scale"], key);
                // A loss that is zero has the scale 1e-300: it must be met exactly.
                assert!(error <= 3e-11, "case {id}, n = {}, {key}: {error:e}", sample.n);
                worst_state = worst_state.max(error);
            }
            assert_eq!(Some(sample.impacts), expected["impacts"].as_u64(), "case {id}");
        }
        let events = case["events"].as_array().unwrap();
        let kinds = |value: &Value| value["kind"].as_str().unwrap().to_owned();
        let ours: Vec<String> = simulation
            .events
            .iter()
            .map(|event| kinds(&serde_json::to_value(event).unwrap()))
            .collect();
        let theirs: Vec<String> = events.iter().map(kinds).collect();
        assert_eq!(ours, theirs, "case {id}");
        for (event, expected) in simulation.events.iter().zip(events) {
            let error = (event.t - number(expected, "t")).abs();
            assert!(error <= 3e-13, "case {id}: {event:?} is {error:e} s off");
            worst_event = worst_event.max(error);
        }
    }
    println!("worst: {worst_state:.1e} of the scales, {worst_event:.1e} s");
}

/// Agreement asked for, relative to the velocity scale (displacements: to that over omega).
const WIDE: f64 = 2e-9;

#[test]
fn every_reference_trajectory_over_the_wide_box_is_reproduced() {
    let text = include_str!("../data/wide.json");
    let file: Value = serde_json::from_str(text).expect("the reference file is JSON");
    let cases = file["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 44);
    let instructions: Vec<_> = Instructions::available().collect();
    let mut errors = Vec::new();
    for case in cases {
        let of = |symbol| number(&case["parameters"], symbol);
        let mut parameters = Parameters::default();
        for &parameter in Parameter::ALL {
            if parameter.presence() == Presence::Always {
                parameters[parameter] = of(parameter.symbol());
            }
        }
        let start = |key| number(&case["start"], key);
        let start = State::of([start("r"), start("y1"), start("x2"), start("y2")]);
        let cycles = case["cycles"].as_u64().expect("cycles");
        let simulation = simulate_by(&instructions, &parameters, of("phase"), start, cycles, 1e-12);
        assert!(simulation.failure.is_none(), "case {}", case["id"]);
        let velocity = number(case, "velocity_scale");
        let length = velocity / parameters[Parameter::Omega];
        let mut worst = 0.0_f64;
        for (n, expected) in case["section"].as_object().expect("sections") {
            let sample = &simulation.section[n.parse::<usize>().expect("a number of cycles")];
            for (key, value, scale) in [
                ("r", sample.r, length),
                ("y1", sample.y1, velocity),
                ("x2", sample.x2, length),
                ("y2", sample.y2, velocity),
            ] {
                worst = worst.max((value - number(expected, key)).abs() / scale);
            }
        }
        errors.push((worst, case["id"].to_string()));
    }
    errors.sort_by(|a, b| b.0.total_cmp(&a.0));
    println!("worst: {:?}", &errors[..6]);
    let wrong: Vec<_> =
        errors.iter().filter(|(error, _)| error.is_nan() || *error > WIDE).collect();
    assert!(wrong.is_empty(), "{wrong:?}");
}
