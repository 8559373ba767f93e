//! Standard errors of the outputs that are means of a motion that does not repeat, from batches of its measured cycles.

use capsulemap_engine::orbit::exponent::BATCHES;
use capsulemap_engine::orbit::measuring::batch_ends;
use capsulemap_engine::orbit::{self, Outcome};

use super::account::Account;
use super::output::{Output, Outputs};
use super::parameters::CapsuleParameters as _;
use super::state::State;
use crate::description::Parameters;

/// The outputs that are standard errors.
pub const ERRORS: [Output; 7] = [
    Output::ProgressionSpeedError,
    Output::WorkNetError,
    Output::WorkPositiveError,
    Output::WorkAbsoluteError,
    Output::WorkActuatorError,
    Output::FrictionLossError,
    Output::DamperLossError,
];

/// Adds the standard errors of the means of an orbit: zero of a periodic one, whose means are exact, and NaN where the measured
/// cycles are too few for two batches.
///
/// Method: the measured cycles are cut into 16 batches of whole cycles, or as many as there are cycles; the error is the standard
/// deviation of the means of the batches over the root of their number.
/// Assumes: batches are long against the memory of the motion. That of a quasi-periodic motion never fades; its error is that
/// of the batches all the same.
pub(super) fn add<const D: usize>(
    outputs: &mut Outputs,
    orbit: &orbit::Orbit<State<f64>, Account<f64>, D>,
    parameters: &Parameters,
) {
    if orbit.outcome == Outcome::Periodic {
        ERRORS.into_iter().for_each(|output| outputs[output] = 0.0);
        return;
    }
    let of_batches = of_batches(orbit);
    for (at, output) in ERRORS.into_iter().enumerate() {
        let values: Vec<f64> = of_batches.iter().map(|sums| sums[at]).collect();
        outputs[output] = standard_error(&values);
    }
    outputs[Output::ProgressionSpeedError] /= parameters.drive_period();
}

/// The means per cycle of each batch, in the order of [`ERRORS`], the progression [m] in the place of its speed.
fn of_batches<const D: usize>(
    orbit: &orbit::Orbit<State<f64>, Account<f64>, D>,
) -> Vec<[f64; ERRORS.len()]> {
    let ends = batch_ends(orbit.measured_cycles, BATCHES as u64);
    let (mut before, mut cycles_before) = ([0.0; ERRORS.len()], 0);
    let mut means = Vec::new();
    for (account, end) in orbit.batches.iter().zip(ends) {
        let (sums, cycles) = (sums(account), (end - cycles_before) as f64);
        means.push(std::array::from_fn(|at| (sums[at] - before[at]) / cycles));
        (before, cycles_before) = (sums, end);
    }
    means
}

/// What an account has summed, in the order of [`ERRORS`].
fn sums(account: &Account<f64>) -> [f64; ERRORS.len()] {
    let energies = account.energies.all();
    std::array::from_fn(|at| if at == 0 { account.advance } else { energies[at - 1] })
}

/// The standard error of the mean of some numbers; NaN of fewer than two.
pub fn standard_error(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return f64::NAN;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (count - 1.0) / count).sqrt()
}
