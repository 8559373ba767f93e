//! A stretch of motion, sampled evenly for a figure.

use crate::capsule::{Locomotion, Parameter, Parameters, State};
use crate::lane::series;

use super::{Failure, Trajectory};

/// What to sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HistorySpan {
    /// Drive cycles.
    pub cycles: u32,
    /// Samples in each of them.
    pub per_cycle: u32,
    /// Whether to begin where the case starts rather than where it has settled.
    pub from_start: bool,
}

impl HistorySpan {
    /// Number of samples, both ends included.
    pub fn samples(&self) -> usize {
        self.cycles as usize * self.per_cycle as usize + 1
    }
}

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
    pub fn sample<S: Locomotion>(
        system: &S,
        parameters: &Parameters,
        start: State<f64>,
        span: HistorySpan,
        tolerance: f64,
    ) -> Result<History, Failure> {
        let drive_period = parameters.drive_period();
        let between = drive_period / f64::from(span.per_cycle);
        let p_d = parameters[Parameter::Pd];
        let mut trajectory = Trajectory::new(system, start, drive_period, tolerance);
        let mut history = History::default();
        for _ in 0..span.cycles {
            let mut next = 0;
            trajectory.cycle(|step| {
                let jet = system.motion(&step.jet);
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
