//! Derivatives of the outputs of periodic orbits in every parameter, against differences of orbits that are closed anew.

use capsulemap_engine::flow::System as _;
use capsulemap_engine::lane::Dual;
use capsulemap_engine::orbit::matrix::{less_identity, solve};
use capsulemap_engine::orbit::return_map::{Cycles, jacobian, observed, returned, seeded};
use capsulemap_models::capsule::{
    Account, Capsule, CapsuleParameters as _, CapsuleSystem, Filippov, Output, Outputs, Parameter,
    Parameters, per_cycle, sensitivity,
};

use super::derivatives::{Periodic, periodic};
use super::differences::{TOLERANCE, slope};

/// The outputs that a trade-off is about, and every energy.
const OUTPUTS: [Output; 9] = [
    Output::ProgressionSpeed,
    Output::Power,
    Output::WorkNet,
    Output::WorkPositive,
    Output::WorkAbsolute,
    Output::WorkActuator,
    Output::FrictionLoss,
    Output::DamperLoss,
    Output::PeakContactForce,
];
/// The tolerance that studies use; tighter ones leave derivatives of nearly vanishing terms no step.
const STUDIES: f64 = 1e-13;
/// Differences that do not agree so closely with each other cannot tell 1e-6.
const RESOLVED: f64 = 3e-7;

/// A period as studies follow it.
fn studies(period: u64) -> Cycles {
    Cycles { count: period, tolerance: STUDIES }
}

/// The orbit near a section point, by Newton's method on the return map alone.
fn closed(parameters: &Parameters, phase: f64, guess: [f64; 3], period: u64) -> [f64; 3] {
    let of = |it: Parameter| -> Dual<f64, 3> { Dual::constant(parameters[it]) };
    let system = Capsule::new(of, parameters.shape(), phase);
    let cycles = Cycles { count: period, tolerance: TOLERANCE };
    let mut point = guess;
    for _ in 0..5 {
        let image = returned(&system, seeded(&point), &cycles, |_| ()).expect("it goes on");
        let matrix = less_identity(&jacobian(&image));
        let gap = std::array::from_fn(|i| image[i].value - point[i]);
        let step = solve(matrix, gap).expect("no multiplier is one");
        point = std::array::from_fn(|i| point[i] - step[i]);
    }
    point
}

/// The outputs over a period from a section point, in plain numbers.
fn outputs(parameters: &Parameters, phase: f64, point: [f64; 3], period: u64) -> Outputs {
    let system = Capsule::single(parameters, phase);
    let cycles = Cycles { count: period, tolerance: TOLERANCE };
    let mut account = Account::single(parameters, 0);
    observed(&system, point, &cycles, &mut account).expect("it goes on");
    per_cycle(&account, |it| parameters[it], parameters.shape(), period as f64)
}

/// Compares derivatives of outputs in every parameter with differences: how many agree, and of how many these do not tell.
fn compare<const N: usize>(wanted: [Output; N]) -> [usize; 2] {
    let (mut compared, mut doubtful) = (0, 0);
    for Periodic { case, point, period } in periodic(100, 16, |_| ()) {
        let (base, phase) = (&case.parameters, case.section_phase);
        let at = closed(base, phase, point, period);
        let system = CapsuleSystem::<Filippov>::new(base.clone(), phase);
        let here = outputs(base, phase, at, period);
        // No maximum without an impact has no distance from the stop.
        if wanted.iter().any(|it| !here[*it].is_finite()) {
            continue;
        }
        let free: Vec<Parameter> = Parameter::ALL
            .iter()
            .copied()
            .filter(|it| system.has(*it) && base[*it] != 0.0)
            .collect();
        let relative = |parameter: Parameter| {
            let found = sensitivity(&system, &at, studies(period), parameter);
            let slopes = found.expect("an orbit goes on").slopes;
            wanted.map(|output| slopes[output] * base[parameter])
        };
        let exact: Vec<[f64; N]> = free.iter().map(|it| relative(*it)).collect();
        let largest: [f64; N] = std::array::from_fn(|output| {
            exact.iter().fold(1e-300, |most: f64, all| most.max(all[output].abs()))
        });
        let weights = largest.map(|it| 1.0 / it);
        for (parameter, exact) in free.iter().zip(exact) {
            let moved = |h: f64| {
                let mut changed = base.clone();
                changed[*parameter] *= 1.0 + h;
                let point = closed(&changed, phase, at, period);
                let outputs = outputs(&changed, phase, point, period);
                wanted.map(|output| outputs[output])
            };
            let differences = slope(moved, 1e-3, &weights);
            if differences.doubt.is_nan() || differences.doubt >= RESOLVED {
                doubtful += 1;
                continue;
            }
            compared += 1;
            for (output, (exact, difference)) in
                exact.into_iter().zip(differences.value).enumerate()
            {
                let error = (exact - difference).abs() * weights[output];
                assert!(
                    error < 1e-6,
                    "{} in {}: {exact:e} {difference:e}, {error:e}: {case:?}",
                    wanted[output].name(),
                    parameter.symbol()
                );
            }
        }
    }
    [compared, doubtful]
}

#[test]
fn derivatives_in_every_parameter_are_those_of_differences() {
    // Where the sensitivity is near nothing or an event near another, differences do not tell it.
    let [compared, doubtful] = compare(OUTPUTS);
    assert!(compared > 1000, "{compared} compared, {doubtful} doubtful");
}

#[test]
fn derivatives_of_times_at_rest_and_distances_from_grazing_are_those_of_differences() {
    for output in [Output::StickShare, Output::GrazingMargin] {
        let [compared, doubtful] = compare([output]);
        assert!(compared > 300, "{}: {compared} compared, {doubtful} doubtful", output.name());
    }
}

#[test]
fn the_outputs_that_are_smooth_are_those_that_have_derivatives() {
    let Periodic { case, point, period } = periodic(10, 16, |_| ()).remove(0);
    let system = CapsuleSystem::<Filippov>::new(case.parameters, case.section_phase);
    let found = sensitivity(&system, &point, studies(period), Parameter::Omega);
    let outputs = found.expect("an orbit goes on").outputs;
    for output in Output::ALL {
        assert_eq!(output.is_smooth(), !outputs[*output].is_nan(), "{}", output.name());
    }
}
