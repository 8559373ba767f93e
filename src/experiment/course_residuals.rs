//! The residuals of recorded histories of the capsule at some parameters and starts, with their slopes.

use super::course::{Course, Recorded};
use super::free_parameter::Free;
use super::history::{Channel, History, Scatter};
use super::least_squares::{Bounds, Loss, Residuals};
use crate::capsule::Parameter;
use crate::capsule::sampled::{Direction, Signal, Started, sampled};

/// Relative local error of the steps of the simulation.
const TOLERANCE: f64 = 1e-11;

/// The motions of all recordings at these unknowns: the parameters, then what is unknown of each start.
pub(super) fn motions(courses: &[Course<'_>], free: &[Free], unknowns: &[f64]) -> Vec<Started> {
    let (values, mut rest) = unknowns.split_at(free.len());
    courses
        .iter()
        .map(|course| {
            let (start, others) = rest.split_at(course.unknown.len());
            rest = others;
            motion(course, free, values, start)
        })
        .collect()
}

/// The motion of a recording at these values of the parameters and of what is unknown of its start.
fn motion(course: &Course<'_>, free: &[Free], values: &[f64], start: &[f64]) -> Started {
    let mut motion = course.guess.clone();
    for (free, value) in free.iter().zip(values) {
        motion.parameters[free.parameter] = *value;
    }
    for ((direction, _), value) in course.unknown.iter().zip(start) {
        motion = motion.with(*direction, *value);
    }
    motion
}

impl History for Course<'_> {
    fn times(&self) -> Vec<Vec<f64>> {
        let Recorded { times, signals, .. } = self.recorded;
        signals.iter().map(|(_, sensed)| sensed.at(times)).collect()
    }

    fn channels(&self) -> Vec<Channel> {
        let signals = self.recorded.signals.iter().map(|it| it.0);
        signals.map(|it| Channel { name: it.name(), dimension: it.dimension() }).collect()
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
        self.unknown.iter().any(|it| it.0 == Direction::StartPhase)
    }

    fn residuals(&self, free: &[Free], parameters: &[f64], start: &[f64]) -> Option<Residuals> {
        let motion = motion(self, free, parameters, start);
        if !motion.parameters.faults().is_empty() {
            return None;
        }
        let mut all = Residuals { values: Vec::new(), slopes: Vec::new() };
        let Recorded { times, signals, .. } = self.recorded;
        let names: Vec<Signal> = signals.iter().map(|it| it.0).collect();
        let found = sampled(&motion, times, &names, &directions(self, free), TOLERANCE).ok()?;
        for (i, (_, recorded)) in signals.iter().enumerate() {
            let (scatter, slopes) = (&self.scatters[i], &found.slopes[i]);
            scatter.add_residuals(&mut all, recorded, &found.values[i], slopes);
        }
        // What the record of the drive says of its phase is one more datum.
        if let Some(place) = self.unknown.iter().position(|it| it.0 == Direction::StartPhase) {
            let unit = 1.0 / self.recorded.phase_error;
            let mut row = vec![0.0; free.len() + self.unknown.len()];
            row[free.len() + place] = unit;
            all.push((motion.phase - self.recorded.phase) * unit, row);
        }
        Some(all)
    }
}

/// What the motion of a recording depends on: the parameters, then what is unknown of its start.
fn directions(course: &Course<'_>, free: &[Free]) -> Vec<Direction> {
    let of_parameters = free.iter().map(|it| Direction::Parameter(Parameter::which(it.parameter)));
    of_parameters.chain(course.unknown.iter().map(|it| it.0)).collect()
}

/// What the residuals of one recording in this motion add to the sum that is made least; infinite where it cannot be followed.
pub(super) fn misfit_of(course: &Course<'_>, motion: &Started, loss: Loss) -> f64 {
    let Recorded { times, signals, .. } = course.recorded;
    let names: Vec<Signal> = signals.iter().map(|it| it.0).collect();
    let Ok(found) = sampled(motion, times, &names, &[], TOLERANCE) else { return f64::INFINITY };
    let of_signals = signals.iter().enumerate().map(|(i, (_, recorded))| {
        let pairs = recorded.beside(&found.values[i]);
        let unit = course.scatters[i].unit;
        pairs.map(|(recorded, found)| loss.of((found - recorded) / unit)).sum::<f64>()
    });
    of_signals.sum()
}
