//! A record of an oscillator given as text beside the motion that its case settles to.

use std::f64::consts::TAU;

use capsulemap_text::sampled::{Started, sampled};

use super::history::Channel;
use super::recorded_period::period_of;
use super::recording::{Recording, Sampling};
use super::text_record::TextRecord;
use crate::description::State;
use crate::motion::{Case, Orbit};
use crate::of::settle_case;
use crate::orbit::{Outcome, Protocol};

/// Relative local error of the steps of the simulation.
const TOLERANCE: f64 = 1e-12;
/// The moment of a motion at the first sample is looked for over the first cycles of the record, so many.
const ALIGNED_CYCLES: f64 = 20.0;
/// Moments that are tried in a cycle without a drive.
const MOMENTS: usize = 72;
/// How often the distance of two of them is halved in the search for the best.
const HALVINGS: usize = 30;
/// A motion of a longer period begins in any of its first cycles, so many.
const MOST_CYCLES: u64 = 64;
/// A state varies if its standard deviation is above this share of its largest value.
const VARIES: f64 = 1e-9;

/// A record beside a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct TextComparison {
    /// Times since the first sample [s].
    pub times: Vec<f64>,
    /// How the record is sampled.
    pub sampling: Sampling,
    /// Duration of a cycle: of the drive, or of the motion between passages of its section in the mean [s].
    pub cycle: f64,
    /// What the case settles to, and its period [cycles].
    pub outcome: (Outcome, u64),
    /// The period of the record [cycles]; none where no period up to eight is seen.
    pub recorded_period: Option<u64>,
    /// The motion at the first sample.
    pub motion: Started,
    /// The states that were recorded.
    pub differences: Vec<StateDifference>,
}

/// How a recorded and a simulated state differ.
#[derive(Debug, Clone, PartialEq)]
pub struct StateDifference {
    /// Which state.
    pub channel: Channel,
    /// As recorded.
    pub recorded: Vec<f64>,
    /// As simulated, at the same times; that of what drifts is moved by a constant, so that both have one mean.
    pub simulated: Vec<f64>,
    /// The root mean square of the difference over the standard deviation of the record; none where that does not vary.
    pub error: Option<f64>,
}

/// The record beside what its case settles to by the protocol.
///
/// # Method
///
/// Under a drive its phase at time zero of the record is the start phase of the case; of a motion that repeats after several cycles
/// the one is taken as the first that makes the differences least. Without a drive the moment of the motion at the first sample is
/// looked for that makes the differences of the first twenty cycles least.
///
/// # Assumes
///
/// A rig that has settled. A record of how it settles is one for a fit, which knows the start.
///
/// Fails where the case cannot be followed.
pub fn compare_text(
    recording: &Recording,
    record: &TextRecord,
    case: &Case,
    protocol: &Protocol,
) -> Result<TextComparison, String> {
    for state in case.parameters.model().coordinates {
        recording.whole(state.name)?;
    }
    let orbit = settle_case(case, &Protocol { history: None, ..*protocol });
    if let Some(failure) = &orbit.failure {
        return Err(format!("the simulation cannot be followed: {}", failure.reason));
    }
    let cycle = cycle_of(&orbit, case);
    if !(cycle.is_finite() && cycle > 0.0) {
        return Err("the case settles to no motion that passes its section again".to_owned());
    }
    let settled = Settled { record, case, orbit: &orbit, cycle };
    let motion = match case.parameters.period_of_drive() {
        Some(period) => settled.in_best_cycle(period)?,
        None => settled.at_best_moment()?,
    };
    let differences = settled.beside(&motion, record.times.len())?;
    let drift = case.parameters.model().drift;
    let repeating = record.states.iter().find(|it| Some(it.0) != drift);
    let sampling = recording.sampling();
    let recorded_period = repeating
        .filter(|_| sampling.gaps.is_empty())
        .and_then(|it| period_of(&record.times, &it.1.values, cycle));
    Ok(TextComparison {
        times: record.times.clone(),
        sampling,
        cycle,
        outcome: (orbit.outcome, orbit.period),
        recorded_period,
        motion,
        differences,
    })
}

/// How long a cycle of a motion lasts.
fn cycle_of(orbit: &Orbit, case: &Case) -> f64 {
    let own = case.parameters.model().output("cycle_duration").map(|it| orbit.outputs[it]);
    case.parameters.period_of_drive().or(own).unwrap_or(f64::NAN)
}

/// The motion that a case settles to, beside a record.
struct Settled<'a> {
    record: &'a TextRecord,
    case: &'a Case,
    orbit: &'a Orbit,
    /// How long a cycle lasts [s].
    cycle: f64,
}

impl Settled<'_> {
    /// The motion from each of some times after the section on [s], which rise, as that at the first sample.
    fn starting(&self, after: &[f64]) -> Result<Vec<Started>, String> {
        let parameters = self.case.parameters.clone();
        let model = parameters.model();
        let columns: Vec<usize> = (0..model.coordinates.len()).collect();
        let (start, phase) = (self.orbit.end.clone(), self.case.section_phase);
        let section = Started { parameters, start, phase, time: 0.0 };
        let found = sampled(&section, after, &columns, &[], TOLERANCE)
            .map_err(|why| format!("the simulation cannot be followed: {why}"))?;
        let at = |place: usize| {
            let values: Vec<f64> = found.values.iter().map(|it| it[place]).collect();
            let start = State::new(model, &values);
            let (parameters, phase) = (section.parameters.clone(), self.record.phase);
            Started { parameters, start, phase, time: self.record.first }
        };
        Ok((0..after.len()).map(at).collect())
    }

    /// How many cycles pass until it repeats; one where it does not.
    fn cycles(&self) -> u64 {
        self.orbit.period.clamp(1, MOST_CYCLES)
    }

    /// Under a drive of this period [s], in that of its cycles that makes the differences least.
    fn in_best_cycle(&self, period: f64) -> Result<Started, String> {
        let phase = (self.record.phase - self.case.section_phase) / TAU;
        let first = (phase + self.record.first / period).rem_euclid(1.0) * period;
        let after: Vec<f64> = (0..self.cycles()).map(|i| first + i as f64 * period).collect();
        self.best_of(self.starting(&after)?).map(|it| it.1)
    }

    /// Without a drive, at that of its moments that makes the differences least.
    fn at_best_moment(&self) -> Result<Started, String> {
        let count = MOMENTS * self.cycles() as usize;
        let apart = self.cycle / MOMENTS as f64;
        let after: Vec<f64> = (0..count).map(|i| i as f64 * apart).collect();
        let (place, mut best) = self.best_of(self.starting(&after)?)?;
        let (mut at, mut reach) = (after[place], apart);
        for _ in 0..HALVINGS {
            reach *= 0.5;
            let around = [(at - reach).max(0.0), at, at + reach];
            let (place, motion) = self.best_of(self.starting(&around)?)?;
            (at, best) = (around[place], motion);
        }
        Ok(best)
    }

    /// The motion that makes the differences of the first cycles least, with its place.
    fn best_of(&self, motions: Vec<Started>) -> Result<(usize, Started), String> {
        let span = ALIGNED_CYCLES * self.cycle;
        let count = self.record.times.partition_point(|time| *time <= span).max(1);
        let mut best = (f64::INFINITY, 0);
        if motions.len() > 1 {
            for (place, motion) in motions.iter().enumerate() {
                let size = size(&self.beside(motion, count)?);
                if size < best.0 {
                    best = (size, place);
                }
            }
        }
        let motion = motions.into_iter().nth(best.1).ok_or("the motion has no cycle")?;
        Ok((best.1, motion))
    }

    /// The first samples of all recorded states beside those of a motion.
    fn beside(&self, motion: &Started, count: usize) -> Result<Vec<StateDifference>, String> {
        let TextRecord { times, states, .. } = self.record;
        let columns: Vec<usize> = states.iter().map(|it| it.0).collect();
        let found = sampled(motion, &times[..count], &columns, &[], TOLERANCE)
            .map_err(|why| format!("the simulation cannot be followed: {why}"))?;
        let both = states.iter().zip(found.values);
        Ok(both
            .map(|((place, recorded), simulated)| {
                self.difference(*place, recorded.values[..count].to_vec(), simulated)
            })
            .collect())
    }

    fn difference(
        &self,
        place: usize,
        recorded: Vec<f64>,
        mut simulated: Vec<f64>,
    ) -> StateDifference {
        let average = mean(&recorded);
        if self.case.parameters.model().drift == Some(place) {
            let offset = average - mean(&simulated);
            simulated.iter_mut().for_each(|it| *it += offset);
        }
        let about = recorded.iter().map(|it| (it - average).powi(2)).sum::<f64>();
        let pairs = recorded.iter().zip(&simulated);
        let apart = pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        let largest = recorded.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
        let varies = (about / recorded.len() as f64).sqrt() > VARIES * largest;
        let error = varies.then(|| (apart / about).sqrt());
        StateDifference { channel: self.record.channel(place), recorded, simulated, error }
    }
}

/// The root of the sum of the squares of the errors of some states.
fn size(differences: &[StateDifference]) -> f64 {
    differences.iter().filter_map(|it| it.error).map(|it| it * it).sum::<f64>().sqrt()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
