//! The residuals of recorded histories at some parameters and starts, with their slopes.

use super::course::{Course, Recorded};
use super::free_parameter::Free;
use super::least_squares::{Fit, Loss, Residuals};
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
        let of_parameters = free.iter().map(|it| Direction::Parameter(it.parameter));
        let of_start = course.unknown.iter().map(|it| it.0);
        let directions: Vec<Direction> = of_parameters.chain(of_start).collect();
        let Recorded { times, signals, .. } = course.recorded;
        let names: Vec<Signal> = signals.iter().map(|it| it.0).collect();
        let found = sampled(&motion, times, &names, &directions, TOLERANCE).ok()?;
        for (i, (_, recorded)) in signals.iter().enumerate() {
            let unit = 1.0 / course.units[i];
            for (k, recorded) in recorded.iter().enumerate() {
                all.values.push((found.values[i][k] - recorded) * unit);
                let mut row = vec![0.0; unknowns.len()];
                for (j, slope) in found.slopes[i][k].iter().enumerate() {
                    let place = if j < free.len() { j } else { before + j - free.len() };
                    row[place] = slope * unit;
                }
                all.slopes.push(row);
            }
        }
        // What the record of the drive says of its phase is one more datum.
        if let Some(place) = course.unknown.iter().position(|it| it.0 == Direction::StartPhase) {
            let unit = 1.0 / course.recorded.phase_error;
            all.values.push((motion.phase - course.recorded.phase) * unit);
            let mut row = vec![0.0; unknowns.len()];
            row[before + place] = unit;
            all.slopes.push(row);
        }
        before += course.unknown.len();
    }
    Some(all)
}

/// What the residuals of one recording in this motion add to the sum that is made least; infinite where it cannot be followed.
pub(super) fn misfit_of(course: &Course<'_>, motion: &Started, loss: Loss) -> f64 {
    let Recorded { times, signals, .. } = course.recorded;
    let names: Vec<Signal> = signals.iter().map(|it| it.0).collect();
    let Ok(found) = sampled(motion, times, &names, &[], TOLERANCE) else { return f64::INFINITY };
    let of_signal = |(i, (_, recorded)): (usize, &(Signal, Vec<f64>))| -> f64 {
        let pairs = found.values[i].iter().zip(recorded);
        pairs.map(|(found, recorded)| loss.of((found - recorded) / course.units[i])).sum()
    };
    signals.iter().enumerate().map(of_signal).sum()
}

/// How many residuals in turn are those of one signal, or of the phase of a drive.
pub(super) fn groups(courses: &[Course<'_>]) -> Vec<usize> {
    let of = |course: &Course<'_>| {
        let signals = vec![course.recorded.times.len(); course.units.len()];
        signals.into_iter().chain(course.fits_phase().then_some(1)).collect::<Vec<usize>>()
    };
    courses.iter().flat_map(of).collect()
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
    let signal = |(own, (unit, noise)): (Vec<f64>, (&f64, &[f64; 2]))| SignalResiduals {
        values: own.iter().map(|it| it * unit).collect(),
        record_noise: noise[0],
        least_noise: noise[1],
    };
    by_signal(courses, free, fit).into_iter().zip(units).map(signal).collect()
}
