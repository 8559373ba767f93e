//! A recorded history of the motion, and what is unknown of its start.

use super::beginning::{Beginning, REACH, Reading, first_window};
use super::history::Scatter;
use super::least_squares::Bounds;
use super::line::line;
use super::noise::noise;
use super::recording::{Sensed, median};
use super::smoothing::smoothed;
use crate::capsule::sampled::{Direction, Signal, Started};
use crate::capsule::{CapsuleParameters as _, Parameter, State};
use crate::description::Parameters;

/// Values of a signal from which its noise is told.
const LEAST: usize = 4;
/// Velocities of the capsule at the first sample that are tried: how many, of either sign where it is not measured.
const TRIED: u32 = 16;
/// They lie within so many standard errors of a measured one.
const TRIED_REACH: f64 = 8.0;
/// Where it is not measured each is this share of the next.
const TRIED_SHARE: f64 = 0.7;
/// The capsule may be so many times as fast as the relative motion and the drive alone would make it.
const FASTEST: f64 = 10.0;

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
    /// What was recorded, with its values at those of the times at which it was [SI].
    pub signals: Vec<(Signal, Sensed)>,
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
    /// The noise of each signal.
    pub scatters: Vec<Scatter>,
    /// Velocities of the capsule at the first sample that are tried, rising [m/s].
    pub speeds: Vec<f64>,
    /// Whether the record has that velocity: by y2, by x2, by x1 and r, or by y1 and r.
    pub is_speed_measured: bool,
}

impl<'r> Course<'r> {
    /// The start as the first samples have it; the velocity of the capsule is unknown within what it can be where they say nothing of it.
    ///
    /// Fails where neither r, nor x1 and x2, is recorded, or a signal does not vary.
    pub fn new(recorded: &'r Recorded, weights: Weights) -> Result<Self, String> {
        for (signal, sensed) in &recorded.signals {
            varies(signal.name(), &sensed.values)?;
        }
        let scatters = recorded.signals.iter().map(|(_, sensed)| {
            let scatter = scatter_of(&sensed.values);
            match weights {
                Weights::Noise => scatter,
                Weights::Spread => {
                    let times = sensed.at(&recorded.times);
                    Scatter { unit: spread(&times, &sensed.values), ..scatter }
                }
            }
        });
        let scatters: Vec<Scatter> = scatters.collect();
        let first = FirstSample::of(recorded, &scatters)
            .ok_or("neither r, nor x1 and x2, is recorded: the start is unknown")?;
        let y2 = first.speed.unwrap_or(Reading { value: 0.0, error: fastest(recorded) / REACH });
        let speeds = match first.speed {
            Some(it) => speeds_about(it),
            None => speeds_up_to(REACH * y2.error),
        };
        let (start, mut unknown) = first.start(y2);
        if recorded.phase_error > 0.0 {
            let phase = Reading { value: recorded.phase, error: recorded.phase_error };
            unknown.push((Direction::StartPhase, phase.bounds()));
        }
        let guess =
            Started { parameters: recorded.parameters.clone(), start, phase: recorded.phase };
        let is_speed_measured = first.speed.is_some();
        Ok(Course { recorded, guess, unknown, scatters, speeds, is_speed_measured })
    }

    /// Whether the capsule is taken to rest at the first sample.
    pub fn rests(&self) -> bool {
        self.unknown.iter().all(|it| it.0 != Direction::StartY2)
    }
}

/// What a record says of the motion at its first sample.
struct FirstSample {
    r: Beginning,
    /// None where the capsule may be anywhere, as its displacement is not recorded.
    x2: Option<Beginning>,
    y1: Option<Reading>,
    /// The velocity of the capsule: by y2, by x2, by x1 and r, or by y1 and r.
    speed: Option<Reading>,
}

impl FirstSample {
    /// None where neither r, nor x1 and x2, is recorded.
    fn of(recorded: &Recorded, scatters: &[Scatter]) -> Option<FirstSample> {
        let [r, x1, x2, y1, y2] = [Signal::R, Signal::X1, Signal::X2, Signal::Y1, Signal::Y2]
            .map(|signal| begin(recorded, scatters, signal));
        let r = r.or(difference(x1, x2))?;
        let x2 = x2.or(difference(x1, Some(r)));
        let y1 = y1.map(|it| it.level);
        let speed = y2.map(|it| it.level).or(x2.map(|it| it.rate));
        let speed = speed.or(y1.map(|it| it.less(r.rate)));
        Some(FirstSample { r, x2, y1, speed })
    }

    /// The start with this velocity of the capsule, and what is unknown of it.
    fn start(&self, y2: Reading) -> (State<f64>, Vec<(Direction, Bounds)>) {
        let FirstSample { r, x2, y1, .. } = self;
        let y1 = y1.unwrap_or(r.rate.plus(y2));
        let level = x2.map_or(0.0, |it| it.level.value);
        let start = State::of([r.level.value, y1.value, level, y2.value]);
        let mut unknown = vec![
            (Direction::StartR, r.level.bounds()),
            (Direction::StartY1, y1.bounds()),
            (Direction::StartY2, y2.bounds()),
        ];
        unknown.extend(x2.map(|it| (Direction::StartX2, it.level.bounds())));
        (start, unknown)
    }
}

/// The difference of two signals, where both are recorded.
fn difference(a: Option<Beginning>, b: Option<Beginning>) -> Option<Beginning> {
    Some(a?.less(b?))
}

/// The noise of a signal, by which its residuals are divided.
pub(super) fn scatter_of(values: &[f64]) -> Scatter {
    let size = values.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    let least = (1e-9 * size).max(f64::MIN_POSITIVE);
    let noise = noise(values).max(least);
    Scatter { unit: noise, noise, least }
}

/// The speeds that are tried about a measured one.
fn speeds_about(speed: Reading) -> Vec<f64> {
    let count = f64::from(TRIED);
    let shares = (0..TRIED).map(|i| (2.0 * f64::from(i) + 1.0) / count - 1.0);
    shares.map(|share| speed.value + TRIED_REACH * speed.error * share).collect()
}

/// Speeds of either sign up to the largest, each a share of the next, as the record says nothing of their size.
fn speeds_up_to(largest: f64) -> Vec<f64> {
    let sizes = (0..TRIED).map(|i| largest * TRIED_SHARE.powi(i as i32));
    let mut speeds: Vec<f64> = sizes.flat_map(|it| [-it, it]).collect();
    speeds.sort_by(f64::total_cmp);
    speeds
}

/// A speed that the capsule hardly exceeds [m/s]: some times the usual relative velocity of the record, by its median, which spikes do
/// not change, and the speed that the drive alone would give both bodies.
fn fastest(recorded: &Recorded) -> f64 {
    let parameters = &recorded.parameters;
    let mass = parameters[Parameter::M1] + parameters[Parameter::M2];
    let by_drive = parameters[Parameter::Pd] / (mass * parameters.frequency());
    let r = recorded.signals.iter().find(|it| it.0 == Signal::R).map(|it| &it.1);
    let rates = r.and_then(|r| {
        let times = r.at(&recorded.times);
        smoothed(&times, &r.values, first_window(times.len()), 1).ok()
    });
    let relative = rates.map_or(0.0, |it| {
        let sizes: Vec<f64> = it.iter().map(|rate| rate.abs()).collect();
        median(&sizes)
    });
    FASTEST * (relative + by_drive)
}

/// Fails where the values of a signal are all equal, or too few.
pub fn varies(name: &str, values: &[f64]) -> Result<(), String> {
    if values.len() < LEAST {
        let count = values.len();
        return Err(format!(
            "{name} has {count} values, and its noise is told by {LEAST} at least; remove the column"
        ));
    }
    match values.iter().all(|it| *it == values[0]) {
        true => Err(format!(
            "{name} does not vary, so that it says nothing of the motion and its noise is unknown; remove the column"
        )),
        false => Ok(()),
    }
}

/// A signal's beginning; none where it is not recorded.
fn begin(recorded: &Recorded, scatters: &[Scatter], signal: Signal) -> Option<Beginning> {
    let place = recorded.signals.iter().position(|(its, _)| *its == signal)?;
    let sensed = &recorded.signals[place].1;
    Beginning::of(&sensed.at(&recorded.times), &sensed.values, scatters[place].noise)
}

/// The standard deviation of a record about its line.
fn spread(times: &[f64], values: &[f64]) -> f64 {
    let about_line = line(times, values).map_or(0.0, |it| it.scatter);
    about_line.max(f64::MIN_POSITIVE)
}
