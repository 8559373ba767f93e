//! A recorded history of the motion, and what is unknown of its start.

use super::free_vibration::noise;
use super::least_squares::Bounds;
use super::line::line;
use super::sampled::{Direction, Signal, Started};
use super::smoothing::{Window, smoothed};
use crate::capsule::{Parameters, State};

/// Standard deviations within which the start is looked for about its estimate from the record.
const REACH: f64 = 60.0;

/// A recorded history.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Parameters as they were set; those that are fitted are replaced.
    pub parameters: Parameters,
    /// Times since the first sample [s], the first of which is zero.
    pub times: Vec<f64>,
    /// The phase of the drive at the first sample [rad].
    pub phase: f64,
    /// Its standard error, with which it is fitted, too; zero where it is exact [rad].
    pub phase_error: f64,
    /// What was recorded, with its values at those times [SI].
    pub signals: Vec<(Signal, Vec<f64>)>,
}

/// What the residuals of a signal are divided by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weights {
    /// The noise of the record, from its third differences: right where the model describes the record.
    #[default]
    Noise,
    /// The standard deviation of the record about a line: where the model describes it roughly, no signal then counts more
    /// because it is measured better.
    Spread,
}

/// A recording with what is unknown of its start.
pub struct Course<'r> {
    /// The recording.
    pub recorded: &'r Recorded,
    /// The start as estimated from the record.
    pub guess: Started,
    /// What is unknown of the start, and where it is looked for.
    pub unknown: Vec<(Direction, Bounds)>,
    /// What the residuals of each signal are divided by.
    pub units: Vec<f64>,
    /// The noise of each signal by its third differences, and the least that is taken for noise.
    pub noise: Vec<[f64; 2]>,
}

impl<'r> Course<'r> {
    /// The start as the first samples have it.
    ///
    /// Fails where neither r, nor x1 and x2, is recorded, or a signal does not vary.
    pub fn new(recorded: &'r Recorded, weights: Weights) -> Result<Self, String> {
        let least = |values: &[f64]| {
            let size = values.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
            (1e-9 * size).max(f64::MIN_POSITIVE)
        };
        let both = recorded.signals.iter().map(|(_, values)| {
            let least = least(values);
            [noise(values).max(least), least]
        });
        let both: Vec<[f64; 2]> = both.collect();
        let noise: Vec<f64> = both.iter().map(|it| it[0]).collect();
        let units = match weights {
            Weights::Noise => noise.clone(),
            Weights::Spread => {
                recorded.signals.iter().map(|it| spread(&recorded.times, &it.1)).collect()
            }
        };
        varies(&recorded.signals)?;
        let begin = |signal: Signal| begin(recorded, &noise, signal);
        let x2 = begin(Signal::X2);
        let r = match (begin(Signal::R), begin(Signal::X1), x2) {
            (Some(r), ..) => r,
            (None, Some(x1), Some(x2)) => x1.less(x2),
            _ => {
                return Err(
                    "neither r, nor x1 and x2, is recorded: the start is unknown".to_owned()
                );
            }
        };
        // A capsule whose displacement is not recorded may be anywhere, and is taken to rest.
        let x2 = x2.unwrap_or_default();
        let y2 = x2.velocity;
        let start = State { r: r.value, y1: r.velocity + y2, x2: x2.value, y2 };
        let about = |value: f64, error: f64| Bounds {
            least: value - REACH * error,
            greatest: value + REACH * error,
        };
        let y1_error = r.velocity_error.hypot(x2.velocity_error);
        let mut unknown = vec![
            (Direction::StartR, about(r.value, r.error)),
            (Direction::StartY1, about(start.y1, y1_error)),
        ];
        if x2.error > 0.0 {
            unknown.push((Direction::StartX2, about(x2.value, x2.error)));
            unknown.push((Direction::StartY2, about(y2, x2.velocity_error)));
        }
        if recorded.phase_error > 0.0 {
            unknown.push((Direction::StartPhase, about(recorded.phase, recorded.phase_error)));
        }
        let guess =
            Started { parameters: recorded.parameters.clone(), start, phase: recorded.phase };
        Ok(Course { recorded, guess, unknown, units, noise: both })
    }
}

/// Fails where the values of a signal are all equal.
pub fn varies(signals: &[(Signal, Vec<f64>)]) -> Result<(), String> {
    let constant = signals.iter().find(|(_, values)| values.iter().all(|it| *it == values[0]));
    constant.map_or(Ok(()), |(signal, _)| {
        Err(format!(
            "{} does not vary, so that it says nothing of the motion and its noise is unknown; remove the column",
            signal.name()
        ))
    })
}

/// A signal at the first sample of a record, with its rate and the standard errors of both.
#[derive(Debug, Clone, Copy, Default)]
struct Beginning {
    value: f64,
    error: f64,
    velocity: f64,
    velocity_error: f64,
}

impl Beginning {
    fn less(self, other: Beginning) -> Beginning {
        Beginning {
            value: self.value - other.value,
            error: self.error.hypot(other.error),
            velocity: self.velocity - other.velocity,
            velocity_error: self.velocity_error.hypot(other.velocity_error),
        }
    }
}

/// A signal's beginning, by a parabola through its first samples; none where it is not recorded.
fn begin(recorded: &Recorded, noise: &[f64], signal: Signal) -> Option<Beginning> {
    let place = recorded.signals.iter().position(|(its, _)| *its == signal)?;
    let values = &recorded.signals[place].1;
    let samples = 7.min((values.len() - 1) | 1);
    let window = Window { samples, order: 2.min(samples - 1) };
    let read = |derivative| smoothed(&recorded.times, values, window, derivative).ok();
    let span = recorded.times[samples - 1] - recorded.times[0];
    let error = noise[place];
    // The standard errors of a parabola through seven even samples at its end are 0.87 and about 4.7 over the span.
    Some(Beginning {
        value: read(0)?[0],
        error,
        velocity: read(1)?[0],
        velocity_error: 4.7 * error / span,
    })
}

/// The standard deviation of a record about its line.
fn spread(times: &[f64], values: &[f64]) -> f64 {
    let about_line = line(times, values).map_or(0.0, |it| it.scatter);
    about_line.max(f64::MIN_POSITIVE)
}
