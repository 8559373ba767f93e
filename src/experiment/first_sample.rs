//! What the capsule may do at the first sample of a recording: rest, or slide at one of several speeds.

use super::course::Course;
use super::course_residuals::{misfit_of, motions};
use super::effort::{Effort, search};
use super::free_parameter::Free;
use super::history::Recordings;
use super::in_threads::in_threads;
use super::least_squares::{Fit, Loss, fit_once};
use crate::capsule::sampled::{Direction, Started};

/// A capsule that is taken to rest may add so many variances of the residuals to what is made least.
const MOVES: f64 = 4.0;
/// Speeds that are fitted from, of those that describe the record better than their neighbours.
const FITTED_FROM: usize = 4;

/// A speed of the capsule at the first sample, and how well it describes the record.
#[derive(Debug, Clone, Copy)]
pub(super) struct Speed {
    /// The speed [m/s].
    pub speed: f64,
    /// What the residuals add to the sum that is made least.
    pub misfit: f64,
}

/// A motion that begins with another speed of the capsule and the same relative velocity, which r tells.
pub(super) fn with_speed(motion: &Started, speed: f64) -> Started {
    let mut other = motion.clone();
    other.start.y1 += speed - other.start.y2;
    other.start.y2 = speed;
    other
}

/// How well the speeds that are tried describe a recording, all else as in a motion.
pub(super) fn misfits_at_speeds(course: &Course<'_>, motion: &Started, loss: Loss) -> Vec<Speed> {
    let speeds = course.speeds.iter().map(|&speed| {
        let misfit = misfit_of(course, &with_speed(motion, speed), loss);
        Speed { speed, misfit }
    });
    speeds.collect()
}

/// The best of a fit and of those that begin at other speeds of the capsule, one recording after the other.
///
/// # Method
///
/// The misfit of a recording has several minima over the velocity of the capsule at its first sample: one of a capsule that slides
/// forward, one of one that slides backward, and more of one that stops soon. From each minimum over the speeds of
/// [`Course::speeds`], with all else as fitted, everything is fitted again.
///
/// # Guarantees
///
/// The sum that is made least does not grow.
///
/// # Breaks
///
/// A minimum that is narrower than the distance of two speeds that are tried may be passed over.
pub(super) fn other_speeds(
    courses: &[Course<'_>],
    free: &[Free],
    effort: &Effort,
    mut best: Fit,
) -> Fit {
    let search = search(courses, free, effort);
    let model = Recordings { courses, free };
    for index in 0..courses.len() {
        let motion = &motions(courses, free, &best.parameters)[index];
        let tried = misfits_at_speeds(&courses[index], motion, effort.loss);
        let from: Vec<Vec<f64>> = minima(&tried)
            .into_iter()
            .map(|it| unknowns(courses, index, &best.parameters, &with_speed(motion, it.speed)))
            .collect();
        let fits = in_threads(&from, effort.threads, |start| fit_once(&model, start, &search, 1.0));
        for fit in fits.into_iter().flatten() {
            if fit.sum_of_squares < best.sum_of_squares {
                best = fit;
            }
        }
    }
    best
}

/// The lowest of the speeds that describe a record better than both neighbours.
fn minima(tried: &[Speed]) -> Vec<Speed> {
    let mut found = Vec::new();
    for (i, this) in tried.iter().enumerate() {
        let after = tried.get(i + 1).map_or(f64::INFINITY, |it| it.misfit);
        if this.misfit < after && (i == 0 || this.misfit <= tried[i - 1].misfit) {
            found.push(*this);
        }
    }
    found.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    found.truncate(FITTED_FROM);
    found
}

/// The unknowns with those of the start of one recording as in a motion.
fn unknowns(courses: &[Course<'_>], index: usize, all: &[f64], motion: &Started) -> Vec<f64> {
    let mut unknowns = all.to_vec();
    let first = first_of(courses, index, all.len());
    for (place, (direction, bounds)) in courses[index].unknown.iter().enumerate() {
        unknowns[first + place] = motion.value(*direction).clamp(bounds.least, bounds.greatest);
    }
    unknowns
}

/// Where the unknowns of the start of a recording are among all, of which there are `count`.
fn first_of(courses: &[Course<'_>], index: usize, count: usize) -> usize {
    count - courses[index..].iter().map(|it| it.unknown.len()).sum::<usize>()
}

/// Takes the capsule to rest at the start of each recording that is described as well so; returns the fit that is left.
///
/// A capsule that rests has no velocity to be fitted, and one that is left free would stand for it in the errors of others. Rest is
/// tried as such, as it is no limit of a fit: the motions of a capsule that stops soon hardly depend on its speed.
pub(super) fn at_rest(
    courses: &mut [Course<'_>],
    free: &[Free],
    effort: &Effort,
    mut best: Fit,
) -> Fit {
    for index in 0..courses.len() {
        let place = courses[index].unknown.iter().position(|it| it.0 == Direction::StartY2);
        let Some(place) = place else { continue };
        let resting = with_speed(&motions(courses, free, &best.parameters)[index], 0.0);
        let mut start = unknowns(courses, index, &best.parameters, &resting);
        start.remove(first_of(courses, index, start.len()) + place);
        let moving = courses[index].unknown.remove(place);
        let speed = std::mem::replace(&mut courses[index].guess.start.y2, 0.0);
        let search = search(courses, free, effort);
        let model = Recordings { courses, free };
        let rests = fit_once(&model, &start, &search, 1.0);
        let allowed = best.sum_of_squares + MOVES * best.covariance.growth;
        match rests.filter(|it| it.sum_of_squares <= allowed) {
            Some(rests) => best = rests,
            None => {
                courses[index].unknown.insert(place, moving);
                courses[index].guess.start.y2 = speed;
            }
        }
    }
    best
}
