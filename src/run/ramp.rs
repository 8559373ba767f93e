//! The ramps of a study, each followed on a thread of its own, to the same results on any number of them.

use std::f64::consts::PI;

use super::cases::{RunError, on_all_threads};
use super::jump::{Jump, jumps};
use crate::description::{Section, State};
use crate::motion::{Case, Failure, Setting, SimulationSize, reduced};
use crate::of::{model_of, settle_case};
use crate::orbit::{Outcome, Protocol};
use crate::study::{Beginning, Ramp, Study};

/// The value in the middle of a part is found by so many iterations, the error of each far below that of the one before.
const ITERATIONS: usize = 8;

/// A motion along a ramp, where a cycle ends.
#[derive(Debug, Clone, PartialEq)]
pub struct RampPoint {
    /// Time since the ramp began [s].
    pub time: f64,
    /// The parameter that changes (SI).
    pub value: f64,
    /// Where the motion is.
    pub state: State,
    /// What the model sums up, over the cycle that ends here; none at the beginning.
    pub sums: Vec<f64>,
    /// How long that cycle lasted [s].
    pub duration: f64,
}

/// What came of a ramp.
#[derive(Debug, Clone, PartialEq)]
pub struct Ramped {
    /// What the motion at its first value settled to, and its period; none where it begins at the start.
    pub settled: Option<(Outcome, u64)>,
    /// Its points, one for each cycle, that where it begins included.
    pub points: Vec<RampPoint>,
    /// Where its motion jumps.
    pub jumps: Vec<Jump>,
    /// Why the motion could not be followed to its end, if so.
    pub failure: Option<Failure>,
}

impl Ramped {
    /// Nothing followed.
    pub const NONE: Ramped =
        Ramped { settled: None, points: Vec::new(), jumps: Vec::new(), failure: None };
}

/// Follows every ramp of `study` on so many threads, all cores for none; `done` is told of each, from any thread.
///
/// Method: within each of the parts of a cycle, of equal phase, the parameter has the value of the middle of the part; the part of
/// a drive whose frequency changes ends when that of the steady change does. What the parameter is in between differs from the
/// steady change by half of what it changes in a part at most, to either side alike.
/// Guarantees: results in the order of the study, the same on any number of threads.
/// Breaks: where the parameter changes much within a part of a cycle.
pub fn follow_ramps(
    study: &Study,
    threads: Option<usize>,
    done: impl Fn() + Sync,
) -> Result<Vec<Ramped>, RunError> {
    on_all_threads(threads, study.ramps.len(), |number| {
        let ramped = follow(&study.ramps[number], &study.protocol);
        done();
        ramped
    })
}

fn follow(ramp: &Ramp, protocol: &Protocol) -> Ramped {
    let mut ramped = Ramped::NONE;
    let Some(state) = begin(ramp, protocol, &mut ramped) else { return ramped };
    let first =
        RampPoint { time: 0.0, value: ramp.ends[0], state, sums: Vec::new(), duration: 0.0 };
    ramped.points.push(first);
    while let Some(last) = ramped.points.last().filter(|it| it.time < ramp.duration()) {
        match next_point(ramp, last, protocol.tolerance) {
            Ok(point) => ramped.points.push(point),
            Err(failure) => {
                ramped.failure = Some(failure);
                break;
            }
        }
    }
    ramped.jumps = jumps(&compared(ramp, &ramped.points));
    ramped
}

/// The section points of a ramp, in units in which their coordinates are compared.
fn compared(ramp: &Ramp, points: &[RampPoint]) -> Vec<Section> {
    let setting = Setting { parameters: ramp.parameters.clone(), phase: ramp.section_phase };
    let scales = model_of(&ramp.parameters).scales(&setting);
    let scaled = points.iter().map(|point| {
        point.state.section().iter().zip(&scales).map(|(x, scale)| x * scale).collect()
    });
    scaled.collect()
}

/// The state where the ramp begins, on its section; none where the motion fails before.
fn begin(ramp: &Ramp, protocol: &Protocol, ramped: &mut Ramped) -> Option<State> {
    let case = ramp.first_case();
    let model = case.parameters.model();
    if ramp.begins == Beginning::Settled {
        let protocol = Protocol { points: 1, impact_points: 0, history: None, ..*protocol };
        let orbit = settle_case(&case, &protocol);
        ramped.settled = Some((orbit.outcome, orbit.period));
        ramped.failure = orbit.failure;
        return orbit.section.first().map(|point| State::at_section(model, point));
    }
    let most = SimulationSize { cycles: 0, events: usize::MAX };
    let simulation = model_of(&case.parameters).simulate(&case, most, protocol.tolerance);
    ramped.failure = simulation.failure;
    simulation.section.into_iter().next().map(|sample| sample.state.without_drift())
}

/// The motion a cycle after `last`.
fn next_point(ramp: &Ramp, last: &RampPoint, tolerance: f64) -> Result<RampPoint, Failure> {
    let mut next = RampPoint { sums: Vec::new(), duration: 0.0, ..last.clone() };
    for part in 0..ramp.parts {
        let phase = |part: u32| {
            reduced(ramp.section_phase + 2.0 * PI * f64::from(part) / f64::from(ramp.parts))
        };
        let case = Case {
            parameters: ramp.parameters_at(middle(ramp, next.time)),
            start: next.state.clone(),
            start_phase: phase(part),
            section_phase: phase(part + 1),
        };
        // A part that is a whole cycle starts on its section.
        let most = SimulationSize { cycles: u64::from(ramp.parts == 1), events: usize::MAX };
        let simulation = model_of(&case.parameters).simulate(&case, most, tolerance);
        if let Some(failure) = simulation.failure {
            return Err(failure);
        }
        let Some(sample) = simulation.section.into_iter().next_back() else { break };
        next.time += sample.time;
        next.duration += sample.time;
        next.state = sample.state;
        next.sums.resize(sample.sums.len(), 0.0);
        next.sums.iter_mut().zip(sample.sums).for_each(|(sum, more)| *sum += more);
    }
    next.value = value(ramp, next.time);
    Ok(next)
}

/// The parameter at a time; after the end of the ramp it stays.
fn value(ramp: &Ramp, time: f64) -> f64 {
    if time < ramp.duration() { ramp.ends[0] + ramp.slope() * time } else { ramp.ends[1] }
}

/// The parameter in the middle of the part of a cycle that begins at a time.
///
/// Of a frequency it is the mean over the part, as the steady change has it: the phase that is passed is that frequency times the
/// duration.
fn middle(ramp: &Ramp, time: f64) -> f64 {
    let mut middle = value(ramp, time);
    for _ in 0..ITERATIONS {
        let period = ramp.parameters_at(middle).period_of_drive().unwrap_or(0.0);
        middle = value(ramp, time + 0.5 * period / f64::from(ramp.parts));
    }
    middle
}
