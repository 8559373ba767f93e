//! A recording beside the simulation of the same case: aligned in phase, with what differs.

use std::f64::consts::TAU;
use std::ops::Range;

use super::course::Recorded;
use super::drive_phase::{Harmonic, harmonic};
use super::estimate::Estimate;
use super::free_vibration::noise;
use super::line::line;
use super::motion_fit::{Effort, Free, Side, best_values};
use super::recording::{Recording, Sampling};
use super::sampled::{Signal, Started, sampled};
use super::spikes::{Spike, contacts, spikes};
use crate::capsule::{Case, Output, Parameter, Parameters, State, settle_case};
use crate::orbit::{Outcome, Protocol};

/// Relative local error of the steps of the simulation.
const TOLERANCE: f64 = 1e-12;
/// The longest period that is looked for in a record [cycles].
const LONGEST: u64 = 8;
/// Signals that repeat themselves with the motion, the best first.
const REPEATING: [Signal; 4] = [Signal::R, Signal::A1, Signal::Y1, Signal::Y2];
/// Events are counted over so many cycles at least, each of so many samples.
const LEAST_COUNTED: f64 = 3.0;
const LEAST_SAMPLES: f64 = 20.0;
/// Phases that are tried where the drive is not recorded.
const PHASES: usize = 72;

/// How a recording and a simulation differ in one signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Which signal.
    pub signal: Signal,
    /// As recorded [SI].
    pub recorded: Vec<f64>,
    /// As simulated, at the same times [SI].
    pub simulated: Vec<f64>,
    /// Root mean square of the difference over the standard deviation of the record; x2 without its mean advance.
    pub error: f64,
}

/// A recording beside a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Times since the first sample [s].
    pub times: Vec<f64>,
    /// How the record is sampled.
    pub sampling: Sampling,
    /// The drive as recorded; none where it is not.
    pub drive: Option<Harmonic>,
    /// Phase of the drive at the first sample [rad].
    pub phase: f64,
    /// Cycles of the drive in the record, by the frequency of the recorded drive where it is recorded.
    pub cycles: f64,
    /// Progression speed as recorded, where x2 is [m/s].
    pub recorded_speed: Option<Estimate>,
    /// Progression speed as simulated [m/s].
    pub simulated_speed: f64,
    /// What the simulation settles to, and its period [cycles].
    pub outcome: (Outcome, u64),
    /// The period of the record [cycles]; none where no period up to eight is seen, or nothing that repeats is recorded.
    pub recorded_period: Option<u64>,
    /// Spikes of the acceleration per cycle, over the whole cycles, as recorded and as simulated and sampled alike; none where it is
    /// not recorded, or where they cannot be counted: see [`Comparison::is_countable`].
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

/// A signal that was measured, with its values [SI].
pub type Measured = (Signal, Vec<f64>);

/// The signals of a recording, which may have any of them, over the time from its first sample.
///
/// Fails where it has none of r, x1, x2, a1.
pub fn signals_of(recording: &Recording) -> Result<(Vec<f64>, Vec<Measured>), String> {
    let times = recording.required("t");
    let times: Vec<f64> = times.iter().map(|time| time - times[0]).collect();
    let measured = [Signal::X2, Signal::R, Signal::X1, Signal::Y1, Signal::Y2, Signal::A1];
    let found: Vec<(Signal, Vec<f64>)> = measured
        .into_iter()
        .filter_map(|signal| Some((signal, recording.column(signal.name())?.to_vec())))
        .collect();
    if found.is_empty() {
        let names = measured.map(Signal::name).join(", ");
        return Err(format!("has no signal of the motion; expected one of {names}"));
    }
    Ok((times, found))
}

/// The recording beside what the capsule with these parameters settles to from rest.
///
/// # Method
///
/// The phase is that of the recorded drive (force, or current, which is in phase with it); where neither is recorded it is the
/// phase that makes the differences least. The simulation begins on its attractor at that phase, and x2 at the record's mean
/// over the first cycle.
pub fn compare(recording: &Recording, parameters: &Parameters) -> Result<Comparison, String> {
    let (times, signals) = signals_of(recording)?;
    let driven = recording.column("drive").or(recording.column("current"));
    let drive = driven.map(|values| harmonic(&times, values)).transpose()?;
    let cycle = drive.as_ref().map_or(parameters.drive_period(), |it| TAU / it.omega.value);
    let compared = |phase: f64| beside(recording, (&times, &signals), parameters, (phase, cycle));
    let mut best = match &drive {
        Some(drive) => compared(drive.phase.value)?,
        None => {
            let phases = (0..PHASES).map(|i| TAU * i as f64 / PHASES as f64);
            let found = phases.map(compared).collect::<Result<Vec<_>, _>>()?;
            let error =
                |it: &Comparison| it.differences.iter().map(|it| it.error * it.error).sum::<f64>();
            let least = |a: &Comparison, b: &Comparison| error(a).total_cmp(&error(b));
            found.into_iter().min_by(least).ok_or("no phase can be compared")?
        }
    };
    best.drive = drive;
    Ok(best)
}

fn beside(
    recording: &Recording,
    (times, signals): (&[f64], &[(Signal, Vec<f64>)]),
    parameters: &Parameters,
    (phase, cycle): (f64, f64),
) -> Result<Comparison, String> {
    let case = Case::at_section(parameters.clone(), State::default(), phase);
    let orbit = settle_case(&case, &Protocol::default());
    let motion =
        Started { parameters: parameters.clone(), start: State { x2: 0.0, ..orbit.end }, phase };
    let names: Vec<Signal> = signals.iter().map(|it| it.0).collect();
    let lost = |why| format!("the simulation cannot be followed: {why:?}");
    let samples = sampled(&motion, times, &names, &[], TOLERANCE).map_err(lost)?;
    let period = parameters.drive_period();
    let first = times.iter().take_while(|time| **time < period).count().max(1);
    let speed = orbit.outputs[Output::ProgressionSpeed];
    let mut differences = Vec::new();
    for ((signal, recorded), mut simulated) in signals.iter().cloned().zip(samples.values) {
        let moves_on = matches!(signal, Signal::X1 | Signal::X2);
        if moves_on {
            let mean = |values: &[f64]| values[..first].iter().sum::<f64>() / first as f64;
            let offset = mean(&recorded) - mean(&simulated);
            simulated.iter_mut().for_each(|value| *value += offset);
        }
        let advance = if moves_on { speed } else { 0.0 };
        let error = error(times, &recorded, &simulated, advance);
        differences.push(Difference { signal, recorded, simulated, error });
    }
    let of = |signal: Signal| differences.iter().find(|it| it.signal == signal);
    let sampling = recording.sampling();
    let whole = whole_part(times, &sampling);
    let at = &times[whole.clone()];
    let at: Vec<f64> = at.iter().map(|time| time - at[0]).collect();
    let cut = |values: &[f64]| values[whole.clone()].to_vec();
    let last = at[at.len() - 1];
    let is_countable = last >= LEAST_COUNTED * cycle && sampling.interval * LEAST_SAMPLES <= cycle;
    // The simulated motion has the cycles of the study.
    let spikes = of(Signal::A1).filter(|_| is_countable).map(|it| {
        let count = |values: &[f64], cycle: f64| {
            per_cycle(&times_of(&spikes(&at, &cut(values))), cycle, last / cycle)
        };
        [count(&it.recorded, cycle), count(&it.simulated, period)]
    });
    let repeating = REPEATING.into_iter().find_map(of).map(|it| it.recorded.clone());
    let difference = || {
        let both = (of(Signal::X1)?, of(Signal::X2)?);
        Some(both.0.recorded.iter().zip(&both.1.recorded).map(|(a, b)| a - b).collect())
    };
    let repeating: Option<Vec<f64>> = repeating.or_else(difference);
    Ok(Comparison {
        times: times.to_vec(),
        sampling,
        drive: None,
        phase,
        cycles: times[times.len() - 1] / cycle,
        recorded_speed: of(Signal::X2).and_then(|it| speed_of(times, &it.recorded, cycle)),
        simulated_speed: speed,
        outcome: (orbit.outcome, orbit.period),
        recorded_period: repeating.and_then(|it| period_of(&at, &cut(&it), cycle)),
        spikes,
        recorded_impacts: of(Signal::R).filter(|_| is_countable).map(|it| {
            let impacts = contacts(&at, &cut(&it.recorded), parameters[Parameter::Delta]);
            per_cycle(&impacts, cycle, last / cycle)
        }),
        impacts: orbit.outputs[Output::ImpactsPerCycle],
        differences,
        is_countable,
        motion,
    })
}

/// The samples of the longest part of a record without a gap.
fn whole_part(times: &[f64], sampling: &Sampling) -> Range<usize> {
    let place = |(begins, _): &(f64, f64)| {
        times.partition_point(|time| {
            time - times[0] <= begins - sampling.first + 0.5 * sampling.interval
        })
    };
    let ends = sampling.gaps.iter().map(place).chain([times.len()]);
    let mut from = 0;
    let parts = ends.map(|end| {
        let part = from..end.max(from);
        from = end.max(from);
        part
    });
    let parts: Vec<Range<usize>> = parts.collect();
    parts.into_iter().max_by_key(ExactSizeIterator::len).unwrap_or(0..times.len())
}

/// The root mean square of the differences over the standard deviation of the record, without the advance.
fn error(times: &[f64], recorded: &[f64], simulated: &[f64], advance: f64) -> f64 {
    let count = times.len() as f64;
    let level: Vec<f64> =
        times.iter().zip(recorded).map(|(t, value)| value - advance * t).collect();
    let mean = level.iter().sum::<f64>() / count;
    let variance = level.iter().map(|it| (it - mean) * (it - mean)).sum::<f64>() / count;
    let square =
        recorded.iter().zip(simulated).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / count;
    (square / variance).sqrt()
}

/// The fewest cycles after which a record repeats itself, up to [`LONGEST`]; none where it does not, or is too short.
///
/// Method: the record is compared with itself so many cycles later, by interpolation between samples. It repeats where the root
/// mean square of the difference is below three times what the noise alone gives, or a fiftieth of the record's standard
/// deviation.
fn period_of(times: &[f64], values: &[f64], cycle: f64) -> Option<u64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let deviation =
        (values.iter().map(|it| (it - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
    let allowed = (3.0 * std::f64::consts::SQRT_2 * noise(values)).max(0.02 * deviation);
    let later = |time: f64| {
        let after = times.partition_point(|it| *it < time).max(1);
        let (a, b) = (after - 1, after);
        let share = (time - times[a]) / (times[b] - times[a]);
        values[a] + share * (values[b] - values[a])
    };
    (1..=LONGEST).find(|&count| {
        let shift = count as f64 * cycle;
        let last = times[times.len() - 1];
        let pairs = times.iter().zip(values).filter(|(time, _)| **time + shift <= last);
        let squares: Vec<f64> =
            pairs.map(|(time, value)| (later(time + shift) - value).powi(2)).collect();
        // A comparison over less than a cycle would say nothing.
        let is_long = last - shift >= cycle;
        is_long && (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() < allowed
    })
}

fn times_of(spikes: &[Spike]) -> Vec<f64> {
    spikes.iter().map(|it| it.time).collect()
}

/// Events per cycle, over as many whole cycles as follow the middle of the longest interval without one in the first three.
///
/// A window that begins there cuts none in half, which one that begins with the record may.
fn per_cycle(events: &[f64], period: f64, cycles: f64) -> f64 {
    let early: Vec<f64> = events.iter().copied().take_while(|time| *time < 3.0 * period).collect();
    let longest = early.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let begins = longest.map_or(0.0, |pair| 0.5 * (pair[0] + pair[1]));
    let whole = (cycles - begins / period).floor().max(1.0);
    let is_within = |time: &&f64| (begins..begins + whole * period).contains(*time);
    events.iter().filter(is_within).count() as f64 / whole
}

/// The slope of the means of x2 over whole cycles of the drive; none for fewer than three.
fn speed_of(times: &[f64], x2: &[f64], period: f64) -> Option<Estimate> {
    let cycle = |time: f64| (time / period).floor();
    let whole = cycle(times[times.len() - 1]);
    let (mut at, mut means) = (Vec::new(), Vec::new());
    let mut from = 0;
    while from < times.len() && cycle(times[from]) < whole {
        let count =
            times[from..].iter().take_while(|time| cycle(**time) == cycle(times[from])).count();
        let mean = |values: &[f64]| values[from..from + count].iter().sum::<f64>() / count as f64;
        at.push(mean(times));
        means.push(mean(x2));
        from += count;
    }
    line(&at, &means).map(|it| it.slope)
}

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
    if comparison.outcome.0 != Outcome::Periodic && !choices.is_empty() {
        return Err(format!(
            "the simulated motion is {}: histories of it differ by their starts, so that no difference is explained; speeds and \
             counts can be compared",
            comparison.outcome.0.name()
        ));
    }
    let parameters = &comparison.motion.parameters;
    let span = EXPLAINED_CYCLES * parameters.drive_period();
    let count = comparison.times.iter().take_while(|time| **time <= span).count();
    let cut = |it: &Difference| (it.signal, it.recorded[..count].to_vec());
    let recorded = Recorded {
        parameters: parameters.clone(),
        times: comparison.times[..count].to_vec(),
        phase: comparison.phase,
        phase_error: comparison.drive.as_ref().map_or(0.0, |it| it.phase.standard_error),
        signals: comparison.differences.iter().map(cut).collect(),
    };
    let recorded = [recorded];
    let (_, without) = best_values(&recorded, &[], &Effort { starts: 1, ..*effort })?;
    let explanation = |free: &Vec<Free>| {
        let (values, with) = best_values(&recorded, free, effort)?;
        let one = |(it, value): (&Free, f64)| (it.parameter, value, Side::of(value, it.bounds));
        let changed: Vec<_> = free.iter().zip(values).map(one).collect();
        let mut parameters = parameters.clone();
        for (parameter, value, _) in &changed {
            parameters[*parameter] = *value;
        }
        let case = Case::at_section(parameters, State::default(), comparison.phase);
        let orbit = settle_case(&case, &Protocol::default());
        Ok(Explanation {
            changed,
            misfit: [without, with],
            impacts: orbit.outputs[Output::ImpactsPerCycle],
            speed: orbit.outputs[Output::ProgressionSpeed],
        })
    };
    choices.iter().map(explanation).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_of_records_are_found() {
        let times: Vec<f64> = (0..2000).map(|i| 1e-3 * f64::from(i)).collect();
        let noise = |i: usize| 0.01 * ((i * i * 31 % 101) as f64 / 50.0 - 1.0);
        let record = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
            times.iter().enumerate().map(|(i, t)| of(*t) + noise(i)).collect()
        };
        let cycle = 0.11;
        let wave = |t: f64| (TAU * t / cycle).cos();
        assert_eq!(period_of(&times, &record(&wave), cycle), Some(1));
        let third = |t: f64| wave(t) + 0.2 * (TAU * t / (3.0 * cycle)).sin();
        assert_eq!(period_of(&times, &record(&third), cycle), Some(3));
        let never = |t: f64| {
            wave(t) + 0.3 * (TAU * t / (2f64.sqrt() * cycle)).sin() + 0.3 * (5.0 * t * t).sin()
        };
        assert_eq!(period_of(&times, &record(&never), cycle), None);
    }
}
