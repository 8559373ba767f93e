//! A stretch of motion, sampled evenly for a figure.

use capsulemap_engine::flow::Stroboscopic;
use capsulemap_engine::lane::series;
use capsulemap_engine::orbit::HistorySpan;

use super::Failure;
use super::locomotion::Locomotion;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::simulate::trajectory;
use super::state::State;
use crate::motion::Case;

/// Samples at even times, both ends included.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    /// Positions and velocities [m, m/s].
    pub states: Vec<State<f64>>,
    /// Force of the drive [N].
    pub drive: Vec<f64>,
}

impl History {
    /// Follows the motion from the start of `case` and samples its series, which are exact to `tolerance` too.
    pub fn sample<S: Locomotion<f64> + Stroboscopic<f64, 3>>(
        system: &S,
        case: &Case,
        span: HistorySpan,
        tolerance: f64,
    ) -> Result<History, Failure> {
        let drive_period = case.parameters.drive_period();
        let between = drive_period / f64::from(span.per_cycle);
        let p_d = case.parameters[Parameter::Pd];
        let mut trajectory = trajectory(case, system, tolerance);
        let mut history = History::default();
        // When a cycle of the history begins, since that of the drive.
        let mut begins = case.start_time();
        let ends_at_section = begins == 0.0;
        let wanted = span.samples() - usize::from(ends_at_section);
        let mut next = 0;
        while history.states.len() < wanted {
            trajectory.cycle(|step| {
                let jet = system.jet(&step.jet);
                let end = step.start + step.length;
                while history.states.len() < wanted {
                    let at = begins + f64::from(next) * between;
                    if at > end || at >= drive_period {
                        return;
                    }
                    let h = (at - step.start).max(0.0);
                    history.states.push(jet.state(h));
                    history.drive.push(p_d * series::value(&jet.cos, h));
                    next += 1;
                    if next == span.per_cycle {
                        (next, begins) = (0, begins + drive_period);
                    }
                }
            })?;
            begins -= drive_period;
        }
        if ends_at_section {
            history.states.push(trajectory.state());
            history.drive.extend(history.drive.first().copied());
        }
        Ok(history)
    }

    /// What the description of the capsule has of it, see
    /// [`HISTORIES`](super::description::HISTORIES).
    pub fn columns(&self) -> Vec<Vec<f64>> {
        let of = |value: fn(&State<f64>) -> f64| self.states.iter().map(value).collect();
        vec![of(|it| it.r), of(|it| it.y1), of(|it| it.x2), of(|it| it.y2), self.drive.clone()]
    }
}
