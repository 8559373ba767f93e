//! A recording beside the simulation of the same case: aligned in phase, with what differs.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use super::agreement::{Difference, Doubt, advances};
use super::drive_phase::{Harmonic, harmonic};
use super::progression::{Progression, own_progression, progression};
use super::recorded_period::period_of;
use super::recording::{Recording, Sampling, Sensed};
use super::settled_motion::{Settled, TOLERANCE};
use super::simulated_span::check_span;
use super::spikes::{Spikes, contact_period, contacts, per_cycle, spikes};
use crate::capsule::sampled::{Signal, Started, sampled};
use crate::capsule::{self, CapsuleParameters as _, Parameter};
use crate::motion::Case;
use crate::orbit::{Outcome, Protocol};

/// Signals that repeat themselves with the motion, the best first.
const REPEATING: [Signal; 4] = [Signal::R, Signal::A1, Signal::Y1, Signal::Y2];
/// Events are counted over so many cycles at least, each of so many samples.
const LEAST_COUNTED: f64 = 3.0;
const LEAST_SAMPLES: f64 = 20.0;
/// Phases that are tried where the drive is not recorded, over so many cycles.
const PHASES: usize = 72;
const PHASE_CYCLES: f64 = 20.0;
/// The drive may have the other sign if the differences are this much smaller then.
const TURNED: f64 = 0.5;
/// An amplitude of the drive differs beyond so many standard errors, and this share of that of the study.
const AMPLITUDE: [f64; 2] = [3.0, 0.02];

/// A recording beside a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Times since the first sample [s].
    pub times: Vec<f64>,
    /// How the record is sampled.
    pub sampling: Sampling,
    /// The drive as recorded; none where it is not.
    pub drive: Option<Drive>,
    /// Phase of the drive at the first sample [rad].
    pub phase: f64,
    /// Cycles of the drive in the record, by the frequency of the recorded drive where it is recorded.
    pub cycles: f64,
    /// Progression as recorded, where x2 is and varies.
    pub recorded_speed: Option<Progression>,
    /// Progression as simulated.
    pub simulated_speed: Progression,
    /// Cycles over which a simulated motion that does not repeat is measured.
    pub measured_cycles: u64,
    /// What the simulation settles to, and its period [cycles].
    pub outcome: (Outcome, u64),
    /// The period of the record [cycles]; none where no period up to eight is seen, or nothing that repeats is recorded.
    pub recorded_period: Option<u64>,
    /// Pulses of the acceleration per cycle, over the whole cycles, as recorded and as simulated and sampled alike; none where it is
    /// not recorded, where the record cannot show them (see [`spikes`]), or where they cannot be counted: see
    /// [`Comparison::is_countable`].
    pub spikes: Option<[f64; 2]>,
    /// Impacts per cycle as recorded: where r, smoothed, rises through delta; none where r is not recorded or they cannot be counted.
    pub recorded_impacts: Option<f64>,
    /// Impacts per cycle of the simulation.
    pub impacts: f64,
    /// The signals that were recorded.
    pub differences: Vec<Difference>,
    /// Whether events can be counted: three cycles or more without a gap, of twenty samples or more.
    pub is_countable: bool,
    /// The simulated motion.
    pub motion: Started,
}

/// The recorded drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// Its harmonic.
    pub harmonic: Harmonic,
    /// Whether it is a force [N], rather than a current [A].
    pub is_force: bool,
    /// Whether the signals agree far better with the simulation if it has the other sign.
    pub may_be_inverted: bool,
}

impl Drive {
    /// Whether it is a force whose amplitude is not `p_d` [N]: beyond three standard errors and two per cent.
    pub fn differs_from(&self, p_d: f64) -> bool {
        let amplitude = &self.harmonic.amplitude;
        let allowed = (AMPLITUDE[0] * amplitude.standard_error).max(AMPLITUDE[1] * p_d);
        self.is_force && (amplitude.value - p_d).abs() > allowed
    }
}

/// A signal that was measured, with its values [SI].
pub type Measured = (Signal, Sensed);

/// The signals of a recording, which may have any of them, over the time from its first sample.
///
/// Fails where it has none of r, x1, x2, a1.
pub fn signals_of(recording: &Recording) -> Result<(Vec<f64>, Vec<Measured>), String> {
    let times = recording.required("t");
    let times: Vec<f64> = times.iter().map(|time| time - times[0]).collect();
    let measured = [Signal::X2, Signal::R, Signal::X1, Signal::Y1, Signal::Y2, Signal::A1];
    let mut found = Vec::new();
    for signal in measured {
        found.extend(recording.sensed(signal.name()).map(|sensed| (signal, sensed.clone())));
    }
    if found.is_empty() {
        let names = measured.map(Signal::name).join(", ");
        return Err(format!("has no signal of the motion; expected one of {names}"));
    }
    Ok((times, found))
}

/// The recording beside what the case settles to by the protocol.
///
/// # Method
///
/// The phase is that of the recorded drive (force, or current, which is in phase with it); where neither is recorded it is the
/// phase that makes the differences of the first twenty cycles least. The simulation begins on its attractor at that phase, and x2 at
/// the record's mean over the first cycle.
///
/// Fails where the record spans more cycles than its samples allow (`check_span`), lacks what is compared, or the simulation
/// cannot be followed.
pub fn compare(
    recording: &Recording,
    case: &Case,
    protocol: &Protocol,
) -> Result<Comparison, String> {
    let (times, signals) = signals_of(recording)?;
    for (signal, _) in &signals {
        recording.whole(signal.name())?;
    }
    let period = case.parameters.drive_period();
    let sampling = recording.sampling();
    check_span(&times, &sampling, period)?;
    let driven = recording.sensed("drive").or(recording.sensed("current"));
    let harmonic = driven.map(|it| harmonic(&it.at(&times), &it.values)).transpose()?;
    let settled = Settled::new(case, protocol)?;
    let cycle = harmonic.as_ref().map_or(period, |it| TAU / it.omega.value);
    let record = Record { times: &times, signals: &signals, period, cycle };
    let phase = match &harmonic {
        Some(harmonic) => harmonic.phase.value,
        None => record.best_phase(&settled)?,
    };
    let motion = settled.at_phase(phase)?;
    let differences = record.beside(&motion, times.len())?;
    let drive = match harmonic {
        Some(harmonic) => {
            let turned = record.beside(&settled.at_phase(phase + PI)?, times.len())?;
            let may_be_inverted = size(&turned) < TURNED * size(&differences);
            let is_force = recording.sensed("drive").is_some();
            Some(Drive { harmonic, is_force, may_be_inverted })
        }
        None => None,
    };
    Ok(record.told(sampling, &settled, drive, motion, differences))
}

/// The root of the sum of the squares of the errors of some signals, displacements without their progressions.
fn size(differences: &[Difference]) -> f64 {
    let shapes = differences.iter().filter_map(|it| it.errors).map(|it| it.shape * it.shape);
    shapes.sum::<f64>().sqrt()
}

/// A record with the period of the study and the cycle of its own drive [s].
struct Record<'r> {
    times: &'r [f64],
    signals: &'r [Measured],
    period: f64,
    cycle: f64,
}

impl Record<'_> {
    /// The phase at which the differences of the first cycles are least.
    fn best_phase(&self, settled: &Settled) -> Result<f64, String> {
        let count = self.times.partition_point(|time| *time <= PHASE_CYCLES * self.cycle);
        let mut best = (f64::INFINITY, 0.0);
        for phase in (0..PHASES).map(|i| TAU * i as f64 / PHASES as f64) {
            let size = size(&self.beside(&settled.at_phase(phase)?, count)?);
            if size < best.0 {
                best = (size, phase);
            }
        }
        Ok(best.1)
    }

    /// The first samples of all signals beside those of a motion.
    fn beside(&self, motion: &Started, count: usize) -> Result<Vec<Difference>, String> {
        let times = &self.times[..count];
        let names: Vec<Signal> = self.signals.iter().map(|it| it.0).collect();
        let samples = sampled(motion, times, &names, &[], TOLERANCE)
            .map_err(|why| format!("the simulation cannot be followed: {why:?}"))?;
        let both = self.signals.iter().zip(samples.values);
        Ok(both.map(|(measured, simulated)| self.difference(measured, simulated)).collect())
    }

    /// The first samples of a signal beside those that are simulated, which begin at the same mean where they advance.
    fn difference(&self, measured: &Measured, mut simulated: Vec<f64>) -> Difference {
        let (signal, recorded) = measured;
        let times = &self.times[..simulated.len()];
        let recorded = recorded.values[..simulated.len()].to_vec();
        if advances(*signal) {
            let first = times.iter().take_while(|time| **time < self.period).count().max(1);
            let offset = mean(&recorded[..first]) - mean(&simulated[..first]);
            simulated.iter_mut().for_each(|value| *value += offset);
        }
        Difference::new(*signal, times, self.cycle, recorded, simulated)
    }

    /// All that is told of the record beside a motion.
    fn told(
        &self,
        sampling: Sampling,
        settled: &Settled,
        drive: Option<Drive>,
        motion: Started,
        mut differences: Vec<Difference>,
    ) -> Comparison {
        if drive.as_ref().is_some_and(|it| it.may_be_inverted) {
            // What is inverted then is the drive.
            drop_doubts_of_sign(&mut differences);
        }
        let whole = Whole::new(self.times, sampling.whole_part(self.times));
        let recorded_period = self.recorded_period(&whole, &differences);
        let recorded_speed = varying(&differences, Signal::X2)
            .and_then(|it| progression(self.times, &it.recorded, self.cycle, recorded_period));
        let is_countable = whole.last() >= LEAST_COUNTED * self.cycle
            && sampling.interval * LEAST_SAMPLES <= self.cycle;
        let counted = is_countable.then(|| self.counted(&whole, &motion, &differences));
        let (spikes, recorded_impacts) = counted.unwrap_or_default();
        Comparison {
            times: self.times.to_vec(),
            cycles: self.times[self.times.len() - 1] / self.cycle,
            sampling,
            drive,
            phase: motion.phase,
            recorded_speed,
            simulated_speed: settled.speed,
            measured_cycles: settled.measured_cycles,
            outcome: (settled.orbit.outcome, settled.orbit.period),
            recorded_period,
            spikes,
            recorded_impacts,
            impacts: settled.orbit.outputs[capsule::Output::ImpactsPerCycle],
            is_countable,
            motion,
            differences,
        }
    }

    /// The period of the record, by what repeats itself in it [cycles].
    fn recorded_period(&self, whole: &Whole, differences: &[Difference]) -> Option<u64> {
        let repeating = repeating(self.times, self.cycle, differences)?;
        period_of(&whole.times, whole.of(&repeating), self.cycle)
    }

    /// Pulses of the acceleration per cycle, recorded and simulated, and recorded impacts, where they can be seen.
    fn counted(
        &self,
        whole: &Whole,
        motion: &Started,
        differences: &[Difference],
    ) -> (Option<[f64; 2]>, Option<f64>) {
        let contact = contact_period(&motion.parameters);
        let a1 = differences.iter().find(|it| it.signal == Signal::A1);
        let spikes = a1.and_then(|it| {
            // The simulated motion has the cycles of the study.
            let simulated = whole.spikes_per_cycle(&it.simulated, contact, self.period);
            Some([whole.spikes_per_cycle(&it.recorded, contact, self.cycle)?, simulated?])
        });
        let delta = motion.parameters[Parameter::Delta];
        let impacts = differences.iter().find(|it| it.signal == Signal::R).map(|it| {
            let found = contacts(&whole.times, whole.of(&it.recorded), delta);
            per_cycle(&found, self.cycle, whole.last())
        });
        (spikes, impacts)
    }
}

/// The longest part of a record without a gap.
struct Whole {
    /// Its samples.
    range: Range<usize>,
    /// Their times since the first of them [s].
    times: Vec<f64>,
}

impl Whole {
    fn new(times: &[f64], range: Range<usize>) -> Whole {
        let first = times[range.start];
        Whole { times: times[range.clone()].iter().map(|it| it - first).collect(), range }
    }

    /// The values in it.
    fn of<'v>(&self, values: &'v [f64]) -> &'v [f64] {
        &values[self.range.clone()]
    }

    /// Pulses of an acceleration per cycle; none where the record cannot show them.
    fn spikes_per_cycle(&self, values: &[f64], contact: f64, cycle: f64) -> Option<f64> {
        let Spikes { found, margin } = spikes(&self.times, self.of(values), contact, cycle)?;
        let found: Vec<f64> = found.iter().map(|it| it.time).collect();
        Some(per_cycle(&found, cycle, self.last() - margin))
    }

    /// Its last time [s].
    fn last(&self) -> f64 {
        self.times[self.times.len() - 1]
    }
}

/// A record that repeats itself with the motion and varies, if there is one: a displacement without its progression at the last.
fn repeating(times: &[f64], cycle: f64, differences: &[Difference]) -> Option<Vec<f64>> {
    if let Some(own) = REPEATING.into_iter().find_map(|signal| varying(differences, signal)) {
        return Some(own.recorded.clone());
    }
    let [x1, x2] = [Signal::X1, Signal::X2].map(|signal| varying(differences, signal));
    if let (Some(x1), Some(x2)) = (x1, x2) {
        return Some(x1.recorded.iter().zip(&x2.recorded).map(|(a, b)| a - b).collect());
    }
    let own = x1.or(x2)?;
    let speed = own_progression(times, &own.recorded, cycle);
    Some(times.iter().zip(&own.recorded).map(|(t, value)| value - speed * t).collect())
}

fn drop_doubts_of_sign(differences: &mut [Difference]) {
    let inverted = differences.iter_mut().filter(|it| it.doubt == Some(Doubt::Sign));
    inverted.for_each(|it| it.doubt = None);
}

/// A signal that was recorded and varies.
fn varying(differences: &[Difference], signal: Signal) -> Option<&Difference> {
    differences.iter().find(|it| it.signal == signal && it.errors.is_some())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
