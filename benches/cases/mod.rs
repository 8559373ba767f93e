//! The cases that the benches measure: those of Figs 5 to 7 and a grid, computed from rest side by side.

use capsulemap::capsule::{CapsuleParameters as _, Parameter, Parameters, State};
use capsulemap::lane::Instructions;

use super::lanes::{End, integrate_from};

/// Relative local error of a step.
pub const TOLERANCE: f64 = 1e-12;
/// Copies of a figure's one case, which fill the lanes.
const COPIES: usize = 64;

/// Table 1's capsule with these.
pub fn parameters(k2: f64, omega: f64, p_d: f64, delta: f64) -> Parameters {
    Parameters::with(&[
        (Parameter::K2, k2),
        (Parameter::Omega, omega),
        (Parameter::Pd, p_d),
        (Parameter::Delta, delta),
    ])
}

/// The sets of cases by name: copies of the case of a figure, and a grid of 32 x 32 cases over omega 10..100 rad/s
/// and p_d 1..6 N (k2 18.96 kN/m, delta 1.5 mm).
pub fn case_sets() -> [(&'static str, Vec<Parameters>); 4] {
    let along = |index: usize, from: f64, to: f64| from + (to - from) * index as f64 / 31.0;
    let grid = (0..32 * 32)
        .map(|i| parameters(18_960.0, along(i % 32, 10.0, 100.0), along(i / 32, 1.0, 6.0), 0.0015));
    [
        ("Fig 5", vec![parameters(2420.0, 77.91, 4.0, 0.0035); COPIES]),
        ("Fig 6", vec![parameters(18_960.0, 20.73, 4.0, 0.0015); COPIES]),
        ("Fig 7, 54.6 rad/s", vec![parameters(59_410.0, 54.6, 2.5, 0.0015); COPIES]),
        ("grid 32 x 32", grid.collect()),
    ]
}

/// Integrates every case from rest over so many cycles.
pub fn integrate(
    instructions: Instructions,
    cases: &[Parameters],
    cycles: u64,
    tolerance: f64,
) -> Vec<End> {
    let cases: Vec<_> = cases.iter().map(|case| (case.clone(), State::default())).collect();
    integrate_from(instructions, &cases, cycles, tolerance)
}
