//! A stretch of motion, sampled evenly for a figure.

use crate::flow::Stroboscopic;
use crate::lane::series;
use crate::orbit::{HistorySpan, Trajectory};

use super::Failure;
use super::locomotion::Locomotion;
use super::parameter::Parameter;
use super::parameters::Parameters;
use super::state::State;

/// Samples at even times, both ends included.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    /// Positions and velocities [m, m/s].
    pub states: Vec<State<f64>>,
    /// Force of the drive [N].
    pub drive: Vec<f64>,
}

impl History {
    /// Follows the motion from `start` and samples its series, which are exact to `tolerance` too.
    pub fn sample<S: Locomotion + Stroboscopic<f64, 3>>(
        system: &S,
        parameters: &Parameters,
        start: State<f64>,
        span: HistorySpan,
        tolerance: f64,
    ) -> Result<History, Failure> {
        let drive_period = parameters.drive_period();
        let between = drive_period / f64::from(span.per_cycle);
        let p_d = parameters[Parameter::Pd];
        let mut trajectory = Trajectory::new(system, start, tolerance);
        let mut history = History::default();
        for _ in 0..span.cycles {
            let mut next = 0;
            trajectory.cycle(|step| {
                let jet = system.jet(&step.jet);
                let end = step.start + step.length;
                while next < span.per_cycle && f64::from(next) * between <= end {
                    let h = (f64::from(next) * between - step.start).max(0.0);
                    history.states.push(jet.state(h));
                    history.drive.push(p_d * series::value(&jet.cos, h));
                    next += 1;
                }
            })?;
        }
        history.states.push(trajectory.state());
        history.drive.extend(history.drive.first().copied());
        Ok(history)
    }
}
