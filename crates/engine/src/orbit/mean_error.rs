//! How long a motion is measured that does not repeat: until the mean of what it gains is known well enough.

use crate::flow::System;

use super::measuring::{MeasureRequest, Measured, batch_ends};
use super::passage::Integrator;

/// Measures cycles, and where an error is `wanted`, relative to the mean gain, twice as many again and again until the mean is known so
/// well or the steps do not suffice for twice as many; returns how many, and what was measured.
///
/// Method: each time from the beginning, so that what is observed is that of all cycles; that takes twice as long at most. The error is
/// the standard deviation of the means of the batches over the root of their number.
/// Assumes: batches are long against the memory of the motion.
pub(super) fn measured_until<M: System<D>, const D: usize>(
    integrator: &dyn Integrator<M, D>,
    request: MeasureRequest<M, D>,
    wanted: Option<f64>,
) -> (u64, Measured<M, D>) {
    let mut cycles = request.cycles;
    let Some(wanted) = wanted else { return (cycles, integrator.measured(request)) };
    let mut known = integrator.measured(request.lasting(cycles));
    while known.failure.is_none()
        && relative_error::<M, D>(&known, (cycles, request.batches)) > wanted
        && can_go_on(&known, &request)
    {
        let measured = integrator.measured(request.lasting(2 * cycles));
        if measured.failure.is_some() {
            break;
        }
        (cycles, known) = (2 * cycles, measured);
    }
    (cycles, known)
}

/// Whether twice as many cycles take no more steps than the case may, if they take as many in the mean.
fn can_go_on<M: System<D>, const D: usize>(
    known: &Measured<M, D>,
    request: &MeasureRequest<M, D>,
) -> bool {
    let taken = known.progress.steps_before - request.progress.steps_before;
    taken <= known.progress.steps_left(request.max_steps)
}

/// The standard error of the mean gain over so many cycles in so many batches, relative to the mean; zero where nothing is gained that
/// could be known better.
fn relative_error<M: System<D>, const D: usize>(
    measured: &Measured<M, D>,
    (cycles, batches): (u64, u64),
) -> f64 {
    let (mut before, mut rates) = ((0.0, 0), Vec::new());
    for (observed, end) in measured.batches.iter().zip(batch_ends(cycles, batches)) {
        let Some(gained) = M::gained(observed) else { return 0.0 };
        rates.push((gained - before.0) / (end - before.1) as f64);
        before = (gained, end);
    }
    let count = rates.len() as f64;
    let mean = rates.iter().sum::<f64>() / count;
    let squares: f64 = rates.iter().map(|rate| (rate - mean) * (rate - mean)).sum();
    let error = (squares / (count * (count - 1.0))).sqrt();
    if error == 0.0 { 0.0 } else { error / mean.abs() }
}
