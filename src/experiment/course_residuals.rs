//! The residuals of recorded histories at some parameters and starts, with their slopes.

use super::course::{Course, Recorded};
use super::free_parameter::Free;
use super::least_squares::{Fit, Loss, Model, Residuals};
use super::misfit::SignalResiduals;
use crate::capsule::sampled::{Direction, Signal, Started, sampled};

/// Relative local error of the steps of the simulation.
const TOLERANCE: f64 = 1e-11;

/// The motions of all recordings at these unknowns: the parameters, then what is unknown of each start.
pub(super) fn motions(courses: &[Course<'_>], free: &[Free], unknowns: &[f64]) -> Vec<Started> {
    let (values, mut rest) = unknowns.split_at(free.len());
    courses
        .iter()
        .map(|course| {
            let mut motion = course.guess.clone();
            for (free, value) in free.iter().zip(values) {
                motion.parameters[free.parameter] = *value;
            }
            for (direction, _) in &course.unknown {
                motion = motion.with(*direction, rest[0]);
                rest = &rest[1..];
            }
            motion
        })
        .collect()
}

/// Recordings with the parameters that are fitted to them, as a model of all unknowns: see [`motions`].
pub(super) struct Recordings<'c> {
    /// The recordings.
    pub courses: &'c [Course<'c>],
    /// The parameters.
    pub free: &'c [Free],
}

impl Model for Recordings<'_> {
    fn residuals(&self, unknowns: &[f64]) -> Option<Residuals> {
        residuals(self.courses, self.free, unknowns)
    }
}

/// All residuals at these unknowns, with their slopes.
pub(super) fn residuals(
    courses: &[Course<'_>],
    free: &[Free],
    unknowns: &[f64],
) -> Option<Residuals> {
    let mut all = Residuals { values: Vec::new(), slopes: Vec::new() };
    let mut before = free.len();
    for (course, motion) in courses.iter().zip(motions(courses, free, unknowns)) {
        if !motion.parameters.faults().is_empty() {
            return None;
        }
        let Recorded { times, signals, .. } = course.recorded;
        let names: Vec<Signal> = signals.iter().map(|it| it.0).collect();
        let found = sampled(&motion, times, &names, &directions(course, free), TOLERANCE).ok()?;
        for (i, (_, recorded)) in signals.iter().enumerate() {
            let unit = 1.0 / course.units[i];
            for (k, recorded) in recorded.iter().enumerate() {
                let mut row = vec![0.0; unknowns.len()];
                for (j, slope) in found.slopes[i][k].iter().enumerate() {
                    let place = if j < free.len() { j } else { before + j - free.len() };
                    row[place] = slope * unit;
                }
                all.push((found.values[i][k] - recorded) * unit, row);
            }
        }
        // What the record of the drive says of its phase is one more datum.
        if let Some(place) = course.unknown.iter().position(|it| it.0 == Direction::StartPhase) {
            let unit = 1.0 / course.recorded.phase_error;
            let mut row = vec![0.0; unknowns.len()];
            row[before + place] = unit;
            all.push((motion.phase - course.recorded.phase) * unit, row);
        }
        before += course.unknown.len();
    }
    Some(all)
}

/// What the motion of a recording depends on: the parameters, then what is unknown of its start.
fn directions(course: &Course<'_>, free: &[Free]) -> Vec<Direction> {
    let of_parameters = free.iter().map(|it| Direction::Parameter(it.parameter));
    of_parameters.chain(course.unknown.iter().map(|it| it.0)).collect()
}

/// What the residuals of one recording in this motion add to the sum that is made least; infinite where it cannot be followed.
pub(super) fn misfit_of(course: &Course<'_>, motion: &Started, loss: Loss) -> f64 {
    let Recorded { times, signals, .. } = course.recorded;
    let names: Vec<Signal> = signals.iter().map(|it| it.0).collect();
    let Ok(found) = sampled(motion, times, &names, &[], TOLERANCE) else { return f64::INFINITY };
    let of_signals = signals.iter().enumerate().map(|(i, (_, recorded))| {
        let pairs = found.values[i].iter().zip(recorded);
        pairs.map(|(found, recorded)| loss.of((found - recorded) / course.units[i])).sum::<f64>()
    });
    of_signals.sum()
}

/// How many residuals in turn are those of one signal, or of the phase of a drive.
pub(super) fn groups(courses: &[Course<'_>]) -> Vec<usize> {
    let mut groups = Vec::new();
    for course in courses {
        groups.extend(vec![course.recorded.times.len(); course.units.len()]);
        groups.extend(course.fits_phase().then_some(1));
    }
    groups
}

/// The residuals of each signal of each recording in its unit; empty where the motion cannot be followed.
pub(super) fn by_signal(courses: &[Course<'_>], free: &[Free], fit: &Fit) -> Vec<Vec<f64>> {
    let Some(found) = residuals(courses, free, &fit.parameters) else { return Vec::new() };
    let (mut all, mut rest) = (Vec::new(), found.values.as_slice());
    for course in courses {
        for _ in &course.units {
            let (own, others) = rest.split_at(course.recorded.times.len());
            all.push(own.to_vec());
            rest = others;
        }
        rest = &rest[usize::from(course.fits_phase())..];
    }
    all
}

/// The residuals of all signals with the noise of their records.
pub(super) fn signals(courses: &[Course<'_>], free: &[Free], fit: &Fit) -> Vec<SignalResiduals> {
    let units = courses.iter().flat_map(|it| it.units.iter().zip(&it.noise));
    let signals = by_signal(courses, free, fit).into_iter().zip(units);
    let residuals = signals.map(|(own, (unit, noise))| SignalResiduals {
        values: own.iter().map(|it| it * unit).collect(),
        record_noise: noise[0],
        least_noise: noise[1],
    });
    residuals.collect()
}
