//! What other parameters would have to be for the simulation to describe a recording.

use std::slice::from_ref;

use super::comparison::Comparison;
use super::course::Recorded;
use super::motion_fit::{Effort, Free, Side, best_values};
use crate::capsule::{self, CapsuleParameters as _, State, settle_case};
use crate::description::Parameter;
use crate::motion::Case;
use crate::orbit::{Outcome, Protocol};

/// What parameters would have to be for the simulation to describe a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// The parameters that were free, with their values (SI), and the bound that the value lies on, if it does.
    pub changed: Vec<(Parameter, f64, Option<Side>)>,
    /// Root mean square of the residuals over the spread of each signal, without and with the change.
    pub misfit: [f64; 2],
    /// Impacts per cycle with the change.
    pub impacts: f64,
    /// Progression speed with the change [m/s].
    pub speed: f64,
}

/// Cycles of a record that explanations are fitted to.
pub const EXPLAINED_CYCLES: f64 = 3.0;

/// What other values of some parameters would bring the simulation nearest to the recording, each set in `choices` by itself.
///
/// The paper's section 4 argues that discrepancies come from the stiffness of the stop or from friction: fits in which they
/// alone are free show how much of the misfit each explains.
///
/// Fails where the simulation does not repeat: another start of the same motion differs as much as other parameters do.
pub fn explain(
    comparison: &Comparison,
    choices: &[Vec<Free>],
    effort: &Effort,
) -> Result<Vec<Explanation>, String> {
    if choices.is_empty() {
        return Ok(Vec::new());
    }
    if comparison.outcome.0 != Outcome::Periodic {
        return Err(format!(
            "the simulated motion is {}: histories of it differ by their starts, so that no difference is explained; speeds and \
             counts can be compared",
            comparison.outcome.0.name()
        ));
    }
    let recorded = first_cycles(comparison);
    let (_, without) = best_values(from_ref(&recorded), &[], &Effort { starts: 1, ..*effort })?;
    choices.iter().map(|free| explanation(&recorded, free, effort, without)).collect()
}

/// The first cycles of a recording, as far as explanations are fitted to them.
fn first_cycles(comparison: &Comparison) -> Recorded {
    let parameters = comparison.motion.parameters.clone();
    let span = EXPLAINED_CYCLES * parameters.drive_period();
    let count = comparison.times.iter().take_while(|time| **time <= span).count();
    let varying = comparison.differences.iter().filter(|it| it.errors.is_some());
    Recorded {
        parameters,
        times: comparison.times[..count].to_vec(),
        phase: comparison.phase,
        phase_error: comparison.drive.as_ref().map_or(0.0, |it| it.harmonic.phase.standard_error),
        signals: varying.map(|it| (it.signal, it.recorded[..count].to_vec().into())).collect(),
    }
}

/// What some parameters would have to be, where the misfit `without` a change is known.
fn explanation(
    recorded: &Recorded,
    free: &[Free],
    effort: &Effort,
    without: f64,
) -> Result<Explanation, String> {
    let (values, with) = best_values(from_ref(recorded), free, effort)?;
    let mut parameters = recorded.parameters.clone();
    let mut changed = Vec::new();
    for (it, value) in free.iter().zip(values) {
        changed.push((it.parameter, value, Side::of(value, it.bounds)));
        parameters[it.parameter] = value;
    }
    let case = Case::at_section(parameters, State::default(), recorded.phase);
    let orbit = settle_case(&case, &Protocol::default());
    Ok(Explanation {
        changed,
        misfit: [without, with],
        impacts: orbit.outputs[capsule::Output::ImpactsPerCycle],
        speed: orbit.outputs[capsule::Output::ProgressionSpeed],
    })
}
