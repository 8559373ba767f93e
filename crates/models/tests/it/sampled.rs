//! A motion at given times against the simulation, with derivatives and without.

use capsulemap_models::capsule::sampled::{Direction, Signal, Started, sampled};
use capsulemap_models::capsule::{Parameter, Parameters, State, simulate};

#[test]
fn samples_are_those_of_the_simulation() {
    let parameters = Parameters::default();
    let simulation = simulate(&parameters, 0.4, State::default(), 6, 1e-13);
    let times: Vec<f64> = simulation.section.iter().map(|it| it.t).collect();
    let motion = Started { parameters, start: State::default(), phase: 0.4 };
    let signals = [Signal::R, Signal::X2, Signal::Y1, Signal::Y2];
    let plain = sampled(&motion, &times, &signals, &[], 1e-13).expect("followed");
    let directions = [Direction::Parameter(Parameter::K2), Direction::StartPhase];
    let with = sampled(&motion, &times, &signals, &directions, 1e-13).expect("followed");
    for (i, sample) in simulation.section.iter().enumerate() {
        let expected = [sample.r, sample.x2, sample.y1, sample.y2];
        for (signal, expected) in expected.iter().enumerate() {
            assert!((plain.values[signal][i] - expected).abs() < 1e-10, "{signal} {i}");
            assert!((with.values[signal][i] - expected).abs() < 1e-10, "{signal} {i}");
        }
    }
}
