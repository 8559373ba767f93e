//! A recorded history of an oscillator given as text, and what is unknown of its start.

use capsulemap_text::linear_rates::{LinearRate, linear_rates};
use capsulemap_text::sampled::{Direction, Started, sampled};

use super::beginning::{Beginning, Reading};
use super::course::{scatter_of, varies};
use super::free_parameter::Free;
use super::history::{Channel, History, Scatter};
use super::least_squares::{Bounds, Loss, Residuals};
use super::search_starts::halton_point;
use super::text_record::TextRecord;
use crate::description::State;

/// Relative local error of the steps of the simulation.
const TOLERANCE: f64 = 1e-11;
/// The error of a reading is so large that the first samples by themselves are no more than so many errors away, as an event among the
/// first samples spoils the parabola through them.
const EVENT: f64 = 30.0;
/// A state of which the record says nothing is looked for so many times as far from the start of the study as the motion from there goes.
const FAR: f64 = 3.0;
/// So many values are tried for the states of which the record says nothing.
const TRIED: u32 = 48;
/// Where no motion starts at the first sample, as noise has put it behind a bound, starts so many standard errors beside it are tried.
const BESIDE: [f64; 3] = [3.0, 10.0, 30.0];

/// A recording with what is unknown of its start.
#[derive(Debug)]
pub struct TextCourse<'r> {
    recorded: &'r TextRecord,
    /// The start as it is estimated.
    guess: Started,
    /// The states that are unknown at the start by their places, and where each is looked for.
    unknown: Vec<(usize, Bounds)>,
    /// Which of them the record says nothing of.
    is_hidden: Vec<bool>,
    scatters: Vec<Scatter>,
}

impl<'r> TextCourse<'r> {
    /// The start as the first samples have it.
    ///
    /// # Method
    ///
    /// A recorded state is looked for about its first samples, and one that is not recorded where the rates of those that are tell it,
    /// as a velocity that is the rate of a displacement. One of which the record says nothing is looked for about the start of the
    /// study, three times as far as the motion from there goes. What drifts and is not recorded has no effect and stays.
    ///
    /// Fails where a recorded state does not vary.
    pub fn new(recorded: &'r TextRecord) -> Result<Self, String> {
        for (place, sensed) in &recorded.states {
            varies(recorded.channel(*place).name, &sensed.values)?;
        }
        let scatters: Vec<Scatter> =
            recorded.states.iter().map(|it| scatter_of(&it.1.values)).collect();
        let readings = readings(recorded, &scatters);
        let mut values = recorded.start.values().to_vec();
        for (value, reading) in values.iter_mut().zip(&readings) {
            *value = reading.map_or(*value, |it| it.value);
        }
        let model = recorded.parameters.model();
        let start = State::new(model, &values);
        let (parameters, phase, time) =
            (recorded.parameters.clone(), recorded.phase, recorded.first);
        let guess = beside_bounds(recorded, Started { parameters, start, phase, time }, &readings);
        let (mut unknown, mut is_hidden) = (Vec::new(), Vec::new());
        for (place, reading) in readings.iter().enumerate() {
            if reading.is_none() && model.drift == Some(place) {
                continue;
            }
            let bounds = reading.map_or_else(|| far(recorded, &guess, place), Reading::bounds);
            unknown.push((place, bounds));
            is_hidden.push(reading.is_none());
        }
        Ok(TextCourse { recorded, guess, unknown, is_hidden, scatters })
    }

    /// The values that the parameters to be fitted were set to.
    pub fn set(&self, free: &[Free]) -> Vec<f64> {
        free.iter().map(|it| self.guess.parameters[it.parameter]).collect()
    }

    /// What is unknown of the start as it is estimated; of states of which the record says nothing the best of some values within their
    /// bounds, at these values of the parameters.
    pub fn best_start(&self, free: &[Free], parameters: &[f64], loss: Loss) -> Vec<f64> {
        let guessed: Vec<f64> =
            self.unknown.iter().map(|it| self.guess.start.values()[it.0]).collect();
        let hidden: Vec<usize> = (0..guessed.len()).filter(|&it| self.is_hidden[it]).collect();
        let bounds: Vec<Bounds> = hidden.iter().map(|&it| self.unknown[it].1).collect();
        let mut best = guessed.clone();
        let mut least = f64::INFINITY;
        for index in 0..if hidden.is_empty() { 0 } else { TRIED } {
            let mut start = guessed.clone();
            if index > 0 {
                let values = halton_point(index, &bounds);
                hidden.iter().zip(values).for_each(|(&place, value)| start[place] = value);
            }
            let misfit = self.misfit(free, parameters, &start, loss);
            if misfit < least {
                (best, least) = (start, misfit);
            }
        }
        best
    }

    /// What the residuals of a motion add to the sum that is made least; infinite where it cannot be followed.
    fn misfit(&self, free: &[Free], parameters: &[f64], start: &[f64], loss: Loss) -> f64 {
        let motion = self.motion(free, parameters, start);
        let TextRecord { times, states, .. } = self.recorded;
        let columns: Vec<usize> = states.iter().map(|it| it.0).collect();
        let Ok(found) = sampled(&motion, times, &columns, &[], TOLERANCE) else {
            return f64::INFINITY;
        };
        let mut sum = 0.0;
        for (i, (_, recorded)) in states.iter().enumerate() {
            let unit = self.scatters[i].unit;
            let pairs = recorded.beside(&found.values[i]);
            sum += pairs.map(|(recorded, found)| loss.of((found - recorded) / unit)).sum::<f64>();
        }
        sum
    }

    /// The motion at these values of the parameters and of what is unknown of the start.
    fn motion(&self, free: &[Free], parameters: &[f64], start: &[f64]) -> Started {
        let mut motion = self.guess.clone();
        for (free, value) in free.iter().zip(parameters) {
            motion.parameters[free.parameter] = *value;
        }
        for ((place, _), value) in self.unknown.iter().zip(start) {
            motion = motion.with(Direction::Start(*place), *value);
        }
        motion
    }
}

impl History for TextCourse<'_> {
    fn times(&self) -> Vec<Vec<f64>> {
        let TextRecord { times, states, .. } = self.recorded;
        states.iter().map(|(_, sensed)| sensed.at(times)).collect()
    }

    fn channels(&self) -> Vec<Channel> {
        self.recorded.states.iter().map(|it| self.recorded.channel(it.0)).collect()
    }

    fn scatters(&self) -> &[Scatter] {
        &self.scatters
    }

    fn scatters_mut(&mut self) -> &mut [Scatter] {
        &mut self.scatters
    }

    fn bounds(&self) -> Vec<Bounds> {
        self.unknown.iter().map(|it| it.1).collect()
    }

    fn fits_phase(&self) -> bool {
        false
    }

    fn residuals(&self, free: &[Free], parameters: &[f64], start: &[f64]) -> Option<Residuals> {
        let motion = self.motion(free, parameters, start);
        if !motion.parameters.faults().is_empty() {
            return None;
        }
        let mut directions: Vec<Direction> =
            free.iter().map(|it| Direction::Parameter(it.parameter)).collect();
        directions.extend(self.unknown.iter().map(|it| Direction::Start(it.0)));
        let TextRecord { times, states, .. } = self.recorded;
        let columns: Vec<usize> = states.iter().map(|it| it.0).collect();
        let found = sampled(&motion, times, &columns, &directions, TOLERANCE).ok()?;
        let mut all = Residuals { values: Vec::new(), slopes: Vec::new() };
        for (i, (_, recorded)) in states.iter().enumerate() {
            let (scatter, slopes) = (&self.scatters[i], &found.slopes[i]);
            scatter.add_residuals(&mut all, recorded, &found.values[i], slopes);
        }
        Some(all)
    }
}

/// What the record says of each state at its first sample: by itself, or by the rates of others that are linear in it.
fn readings(recorded: &TextRecord, scatters: &[Scatter]) -> Vec<Option<Reading>> {
    let mut readings = vec![None; recorded.start.values().len()];
    let mut rates = Vec::new();
    for ((place, sensed), scatter) in recorded.states.iter().zip(scatters) {
        let (times, values) = (sensed.at(&recorded.times), &sensed.values);
        let Some(begins) = Beginning::of(&times, values, scatter.noise) else { continue };
        let slope = (values[1] - values[0]) / (times[1] - times[0]);
        // What the first values by themselves say of the first sample of the record.
        readings[*place] = Some(as_far_as(begins.level, values[0] - slope * times[0]));
        rates.push((*place, as_far_as(begins.rate, slope)));
    }
    let linear = linear_rates(recorded.parameters.model());
    // What a rate tells of one state another may need, each at most once.
    for _ in 0..readings.len() {
        for (place, rate) in &rates {
            let told = linear[*place].as_ref().and_then(|it| told_by(it, *rate, &readings));
            if let Some((other, reading)) = told {
                readings[other] = Some(reading);
            }
        }
    }
    readings
}

/// A reading whose bounds reach as far as another estimate of it.
fn as_far_as(reading: Reading, other: f64) -> Reading {
    Reading { error: reading.error.max((reading.value - other).abs() / EVENT), ..reading }
}

/// The one state in a rate of which nothing is known yet, as the others and the rate tell it.
fn told_by(
    linear: &LinearRate,
    rate: Reading,
    known: &[Option<Reading>],
) -> Option<(usize, Reading)> {
    let mut open = linear.factors.iter().filter(|it| known[it.0].is_none());
    let (state, factor) = *open.next().filter(|it| it.1 != 0.0)?;
    if open.next().is_some() {
        return None;
    }
    let mut left = Reading { value: rate.value - linear.constant, ..rate };
    for (other, factor) in linear.factors.iter().filter(|it| it.0 != state) {
        let it = known[*other]?;
        left = left.less(Reading { value: factor * it.value, error: (factor * it.error).abs() });
    }
    Some((state, Reading { value: left.value / factor, error: (left.error / factor).abs() }))
}

/// A start from which a motion can be followed: the estimate, or one beside it by some errors of one state.
fn beside_bounds(recorded: &TextRecord, guess: Started, readings: &[Option<Reading>]) -> Started {
    let starts = |it: &Started| sampled(it, &recorded.times[..1], &[0], &[], TOLERANCE).is_ok();
    if starts(&guess) {
        return guess;
    }
    for by in BESIDE.into_iter().flat_map(|it| [it, -it]) {
        for (place, reading) in readings.iter().enumerate() {
            let Some(reading) = reading else { continue };
            let beside = guess.with(Direction::Start(place), reading.value + by * reading.error);
            if starts(&beside) {
                return beside;
            }
        }
    }
    guess
}

/// Where a state is looked for of which the record says nothing.
fn far(recorded: &TextRecord, guess: &Started, place: usize) -> Bounds {
    let start = guess.start.values()[place];
    let found = sampled(guess, &recorded.times, &[place], &[], TOLERANCE);
    let values = found.map_or_else(|_| Vec::new(), |it| it.values[0].clone());
    let apart = values.iter().fold(0.0, |most: f64, it| most.max((it - start).abs()));
    let reach = if apart > 0.0 { FAR * apart } else { start.abs().max(1.0) };
    Bounds { least: start - reach, greatest: start + reach }
}
