//! Forcing cycles per second on one core, by the scalar integrator at a tolerance of 1e-12.
//!
//! `cargo bench --bench cycles` prints, for Fig 5, Fig 6 and Fig 7 (54.6 rad/s) of the paper and for a
//! 32 x 32 grid over omega 10..100 rad/s and p_d 1..6 N (k2 18.96 kN/m, delta 1.5 mm), the cycles per
//! second of 100 cycles from rest, the steps per cycle, and the spread over the repetitions. Compare
//! figures of one run only: machines are shared.

use std::hint::black_box;
use std::time::Instant;

use capsulemap::model::{Capsule, Parameter, Parameters, State};
use capsulemap::orbit::Trajectory;

const CYCLES: u64 = 100;
const TOLERANCE: f64 = 1e-12;
const REPETITIONS: usize = 5;

fn parameters(k2: f64, omega: f64, p_d: f64, delta: f64) -> Parameters {
    Parameters::with(&[
        (Parameter::K2, k2),
        (Parameter::Omega, omega),
        (Parameter::Pd, p_d),
        (Parameter::Delta, delta),
    ])
}

/// Follows one case; returns the number of steps.
fn follow(parameters: &Parameters) -> u64 {
    let system = Capsule::single(parameters, 0.0);
    let mut trajectory =
        Trajectory::new(&system, State::default(), parameters.drive_period(), TOLERANCE);
    let mut steps = 0;
    for _ in 0..CYCLES {
        trajectory.cycle(|_| steps += 1).expect("the case can be followed");
    }
    black_box(trajectory.state());
    steps
}

fn main() {
    let grid: Vec<Parameters> = (0..32 * 32)
        .map(|i| {
            let along =
                |index: i32, from: f64, to: f64| from + (to - from) * f64::from(index) / 31.0;
            parameters(18_960.0, along(i % 32, 10.0, 100.0), along(i / 32, 1.0, 6.0), 0.0015)
        })
        .collect();
    let works = [
        ("Fig 5", vec![parameters(2420.0, 77.91, 4.0, 0.0035); 40]),
        ("Fig 6", vec![parameters(18_960.0, 20.73, 4.0, 0.0015); 20]),
        ("Fig 7, 54.6 rad/s", vec![parameters(59_410.0, 54.6, 2.5, 0.0015); 20]),
        ("grid 32 x 32", grid),
    ];
    println!("{:<18} {:>12} {:>24} {:>12}", "work", "cycles/s", "min .. max", "steps/cycle");
    for (name, cases) in works {
        let mut speeds = Vec::new();
        let mut steps = 0;
        for _ in 0..REPETITIONS {
            let begun = Instant::now();
            steps = cases.iter().map(follow).sum();
            speeds.push((cases.len() as u64 * CYCLES) as f64 / begun.elapsed().as_secs_f64());
        }
        speeds.sort_by(f64::total_cmp);
        println!(
            "{name:<18} {:>12.0} {:>11.0} .. {:>9.0} {:>12.1}",
            speeds[REPETITIONS / 2],
            speeds[0],
            speeds[REPETITIONS - 1],
            steps as f64 / (cases.len() as u64 * CYCLES) as f64
        );
    }
}
