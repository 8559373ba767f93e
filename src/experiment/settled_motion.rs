//! What the capsule of a study settles to, as a recording is compared with it.

use super::estimate::Estimate;
use super::progression::Progression;
use crate::capsule::sampled::{Signal, Started, sampled};
use crate::capsule::{self, CapsuleParameters as _, CapsuleState as _, State, settle_case};
use crate::description::Outputs;
use crate::model::{Batches, Setting};
use crate::motion::{Case, Orbit, reduced};
use crate::of::model_of;
use crate::orbit::{Outcome, Protocol};

/// Relative local error of the steps of the simulation.
pub const TOLERANCE: f64 = 1e-12;
/// The cycles of a motion that does not repeat are averaged in so many batches, whose spread tells the error.
const BATCHES: u64 = 16;

/// The motion that a case settles to.
pub struct Settled {
    case: Case,
    /// What it is.
    pub orbit: Orbit,
    /// Its mean progression; without an error where it repeats itself, or cannot be followed on.
    pub speed: Progression,
    /// Cycles over which it was measured, where it does not repeat.
    pub measured_cycles: u64,
}

impl Settled {
    /// By the protocol of the study.
    ///
    /// The error of a motion that does not repeat is that of sixteen batches of the cycles that follow, as many as it was measured
    /// over.
    ///
    /// Fails where it cannot be followed.
    pub fn new(case: &Case, protocol: &Protocol) -> Result<Settled, String> {
        let protocol = Protocol { history: None, ..*protocol };
        let orbit = settle_case(case, &protocol);
        if let Some(failure) = &orbit.failure {
            return Err(format!("the simulation cannot be followed: {:?}", failure.reason));
        }
        let value = orbit.outputs[capsule::Output::ProgressionSpeed];
        let repeats = orbit.outcome == Outcome::Periodic;
        let batches = if repeats { None } else { outputs_of_batches(case, &orbit.end, &protocol) };
        let error = batches.map(|all| {
            let speeds = all.iter().map(|it| it[capsule::Output::ProgressionSpeed]);
            Estimate::mean(&speeds.collect::<Vec<_>>()).standard_error
        });
        let speed = Progression {
            value,
            standard_error: error,
            batches: (!repeats).then_some(BATCHES as usize),
        };
        let measured_cycles = protocol.measured_cycles;
        Ok(Settled { case: case.clone(), orbit, speed, measured_cycles })
    }

    /// The motion from this phase of the drive on, at x2 = 0.
    ///
    /// Fails where it cannot be followed.
    pub fn at_phase(&self, phase: f64) -> Result<Started, String> {
        let parameters = self.case.parameters.clone();
        let start = State { x2: 0.0, ..self.orbit.end.capsule() };
        let section = Started { parameters, start, phase: self.case.section_phase };
        let turned = reduced(phase - section.phase) / section.parameters.frequency();
        let signals = [Signal::R, Signal::Y1, Signal::Y2];
        let found = sampled(&section, &[turned], &signals, &[], TOLERANCE)
            .map_err(|why| format!("the simulation cannot be followed: {why:?}"))?;
        let [r, y1, y2] = [0, 1, 2].map(|i| found.values[i][0]);
        Ok(Started { start: State::of([r, y1, 0.0, y2]), phase, ..section })
    }
}

/// The outputs of sixteen batches of the cycles that follow the end of a case, together as many as it was measured over; none where
/// it cannot be followed.
pub fn outputs_of_batches(
    case: &Case,
    end: &crate::description::State,
    protocol: &Protocol,
) -> Option<Vec<Outputs>> {
    let cycles = protocol.measured_cycles.div_ceil(BATCHES);
    let batches = Batches { count: BATCHES, cycles };
    let from = end.section();
    model_of(&case.parameters).batches(&Setting::of(case), from, batches, protocol.tolerance)
}
