//! Where the search for the parameters of recorded histories begins.

use super::course::Course;
use super::first_sample::{misfits_at_speeds, with_speed};
use super::free_parameter::Free;
use super::least_squares::{Bounds, Loss};
use crate::capsule::sampled::Started;

/// Bases of the Halton sequence.
const PRIMES: [u32; 14] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43];

/// Where the search begins: the values of the first recording, then points of a Halton sequence within the bounds.
pub(super) fn starts(
    courses: &[Course<'_>],
    free: &[Free],
    count: usize,
    loss: Loss,
) -> Vec<Vec<f64>> {
    let bounds: Vec<Bounds> = free.iter().map(|it| it.bounds).collect();
    let mut starts = Vec::new();
    for index in 0..count.max(1) {
        let parameters = match index {
            0 => first_parameters(&courses[0], free),
            _ => halton_point(index as u32, &bounds),
        };
        let mut unknowns = parameters.clone();
        for course in courses {
            let motion = begun(course, free, &parameters, loss);
            unknowns.extend(course.unknown.iter().map(|(direction, _)| motion.value(*direction)));
        }
        starts.push(unknowns);
    }
    starts
}

/// The values that a recording has, within the bounds.
fn first_parameters(course: &Course<'_>, free: &[Free]) -> Vec<f64> {
    let values = free.iter().map(|Free { parameter, bounds }| {
        course.guess.parameters[*parameter].clamp(bounds.least, bounds.greatest)
    });
    values.collect()
}

/// A point of a Halton sequence within the bounds.
pub(super) fn halton_point(index: u32, bounds: &[Bounds]) -> Vec<f64> {
    let values = bounds.iter().zip(PRIMES.iter().cycle()).map(|(bounds, prime)| {
        let Bounds { least, greatest } = *bounds;
        least + (greatest - least) * radical_inverse(index, *prime)
    });
    values.collect()
}

/// The motion of a recording as its search begins with these parameters: at the speed that describes it best, where none is measured.
fn begun(course: &Course<'_>, free: &[Free], parameters: &[f64], loss: Loss) -> Started {
    let mut motion = course.guess.clone();
    for (free, value) in free.iter().zip(parameters) {
        motion.parameters[free.parameter] = *value;
    }
    if course.is_speed_measured {
        return motion;
    }
    let misfits = misfits_at_speeds(course, &motion, loss);
    let best = misfits.iter().min_by(|a, b| a.misfit.total_cmp(&b.misfit));
    best.map_or(motion.clone(), |it| with_speed(&motion, it.speed))
}

/// The digits of `index` in a base, mirrored at the point.
fn radical_inverse(mut index: u32, base: u32) -> f64 {
    let (mut value, mut unit) = (0.0, 1.0);
    while index > 0 {
        unit /= f64::from(base);
        value += unit * f64::from(index % base);
        index /= base;
    }
    value
}
