//! Fits chosen parameters to recorded histories of the motion, several recordings at once.

use std::thread;

use super::course::{Course, Recorded, Weights};
use super::estimate::Estimate;
pub use super::free_parameter::{Free, Side};
use super::least_squares::{Fit, Loss, Residuals, Search, fit_once};
use super::misfit::{Misfit, SignalResiduals, misfit, robust_deviation};
use super::profile::{Profile, Verdict, profile_points};
use super::sampled::{Direction, Signal, Started, sampled};
use super::search_starts::starts;
use crate::capsule::Parameter;

/// Relative local error of the steps of the simulation.
const TOLERANCE: f64 = 1e-11;
/// A capsule that is taken to rest may add so many variances of the residuals to the sum of squares.
const MOVES: f64 = 4.0;
/// A search ends where the sum of squares changes by less than this share.
const CONVERGED: f64 = 1e-9;
/// Evaluations of the model per parameter and start.
const PATIENCE: usize = 20;

/// A parameter as fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// Which.
    pub parameter: Parameter,
    /// Its value, standard error and interval by the profile likelihood, within its bounds (SI).
    pub estimate: Estimate,
    /// What the data say of it.
    pub verdict: Verdict,
    /// What limits its best value, where that is one of its bounds.
    pub bound: Option<Side>,
}

/// The outcome of a fit to motion.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionFit {
    /// The fitted parameters.
    pub fitted: Vec<Fitted>,
    /// The fitted motion of each recording.
    pub motions: Vec<Started>,
    /// Parameters of which only combinations are determined, as together they have no effect.
    pub combined: Vec<Parameter>,
    /// The correlation of the fitted parameters with each other; NaN where one is not determined.
    pub correlations: Vec<Vec<f64>>,
    /// The covariance of the fitted parameters (SI); infinite and zero where one is not determined.
    pub covariance: Vec<Vec<f64>>,
    /// Points of the profile of each parameter: its value (SI), and what the sum of squares has grown by with the others fitted, in
    /// units of what ends the interval.
    pub profiles: Vec<Vec<[f64; 2]>>,
    /// The residuals in units of the noise of the records.
    pub misfit: Misfit,
    /// Samples that were used.
    pub samples: usize,
    /// How many of the starts of the search ended in this minimum, and how many there were.
    pub starts: [usize; 2],
}

/// How a fit to motion is searched for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// How residuals are weighed.
    pub loss: Loss,
    /// What they are divided by.
    pub weights: Weights,
    /// Starts within the bounds, the first at the values that the recordings have.
    pub starts: usize,
    /// Threads to use.
    pub threads: usize,
}

/// The parameters within their bounds that bring the simulation nearest to the `recordings`.
///
/// # Method
///
/// Least squares of all samples, each divided by the noise of its signal: first that of third differences of the record, then that
/// of the residuals. Unknowns
/// besides the parameters are the start of each recording: r, y1, x2 and y2, unless a capsule at rest describes it as well,
/// each looked for about its estimate from the smoothed record; and the phase of the drive, of which the estimate from the record
/// of the drive, with its standard error, is one datum more. The derivatives are exact, through every impact, slip
/// and stick ([`sampled`]). The search begins at several starts: the values at hand, and points of a Halton sequence within the
/// bounds. Intervals are those of the profile likelihood, with the scatter estimated from the residuals.
///
/// # Assumes
///
/// Independent noise, exact times, and a phase of the drive whose error is normal.
///
/// # Breaks
///
/// An error says so where a recording lacks what the start needs, or where no motion can be followed.
pub fn fit_motion(
    recordings: &[Recorded],
    free: &[Free],
    effort: &Effort,
) -> Result<MotionFit, String> {
    let Best { courses, fit, starts, .. } = best(recordings, free, effort)?;
    let search = search(&courses, free, effort);
    let model = |unknowns: &[f64]| residuals(&courses, free, unknowns);
    let which: Vec<usize> = (0..free.len()).collect();
    let profiles =
        in_threads(&which, effort.threads, |&which| profile_points(&model, &fit, &search, which));
    let (profiles, points): (Vec<Profile>, Vec<_>) = profiles.into_iter().unzip();
    let fitted = free.iter().zip(profiles).enumerate().map(|(i, (free, profile))| Fitted {
        parameter: free.parameter,
        estimate: Estimate {
            value: fit.parameters[i],
            standard_error: fit.standard_error(i),
            interval: profile.interval,
        },
        verdict: match fit.is_open(i) {
            true => Verdict::NotDetermined,
            false => profile.verdict(),
        },
        bound: Side::of(fit.parameters[i], free.bounds),
    });
    let covariance = &fit.unit_covariance;
    let variance = fit.residual_deviation().powi(2);
    let covariances = |i: usize| (0..free.len()).map(|j| covariance[(i, j)] * variance).collect();
    let correlation =
        |i: usize, j: usize| match [i, j].iter().all(|&it| covariance[(it, it)].is_finite()) {
            true => covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt(),
            false => f64::NAN,
        };
    let row = |i: usize| (0..free.len()).map(|j| correlation(i, j)).collect();
    Ok(MotionFit {
        fitted: fitted.collect(),
        motions: motions(&courses, free, &fit.parameters),
        combined: (0..free.len()).filter(|&i| fit.is_open(i)).map(|i| free[i].parameter).collect(),
        correlations: (0..free.len()).map(row).collect(),
        covariance: (0..free.len()).map(covariances).collect(),
        profiles: points,
        misfit: misfit(&signals(&courses, free, &fit), fit.degrees_of_freedom),
        samples: fit.degrees_of_freedom + fit.parameters.len(),
        starts,
    })
}

/// The best values of the parameters alone, without intervals, and the standard deviation of the residuals as they are weighed; see
/// [`fit_motion`].
pub fn best_values(
    recordings: &[Recorded],
    free: &[Free],
    effort: &Effort,
) -> Result<(Vec<f64>, f64), String> {
    let Best { fit, misfit, .. } = best(recordings, free, effort)?;
    Ok((fit.parameters[..free.len()].to_vec(), misfit))
}

/// The best fit, with what is unknown in it, and how many of the starts led there.
struct Best<'r> {
    courses: Vec<Course<'r>>,
    fit: Fit,
    /// Standard deviation of its residuals, before they were weighed anew.
    misfit: f64,
    starts: [usize; 2],
}

fn best<'r>(
    recordings: &'r [Recorded],
    free: &[Free],
    effort: &Effort,
) -> Result<Best<'r>, String> {
    let mut courses: Vec<Course<'_>> =
        recordings.iter().map(|it| Course::new(it, effort.weights)).collect::<Result<_, _>>()?;
    let starts = starts(&courses, free, effort.starts);
    let search = search(&courses, free, effort);
    let model = |unknowns: &[f64]| residuals(&courses, free, unknowns);
    let fits = in_threads(&starts, effort.threads, |start| fit_once(&model, start, &search, 1.0));
    let found: Vec<Fit> =
        fits.into_iter().flatten().filter(|it| it.sum_of_squares.is_finite()).collect();
    let least = |a: &&Fit, b: &&Fit| a.sum_of_squares.total_cmp(&b.sum_of_squares);
    let best =
        found.iter().min_by(least).ok_or("the simulation cannot be followed from any start")?;
    let same =
        found.iter().filter(|it| it.sum_of_squares <= best.sum_of_squares * (1.0 + 1e-4)).count();
    let fit = at_rest(&mut courses, free, effort, best.clone());
    let misfit = fit.residual_deviation();
    let fit = match effort.weights {
        Weights::Noise => weighed_anew(&mut courses, free, effort, fit),
        Weights::Spread => fit,
    };
    Ok(Best { courses, fit, misfit, starts: [same, starts.len()] })
}

/// Divides the residuals of each signal by what they are, rather than by an estimate of its noise, and fits again.
///
/// A signal with sharp features has larger third differences than its noise alone; with one scatter for all signals the intervals of
/// what it determines would be too wide, and others too narrow.
fn weighed_anew(courses: &mut [Course<'_>], free: &[Free], effort: &Effort, best: Fit) -> Fit {
    let found = by_signal(courses, free, &best);
    let units = courses.iter_mut().flat_map(|it| &mut it.units);
    for (unit, own) in units.zip(found) {
        let scatter = match effort.loss {
            Loss::Squares => (own.iter().map(|it| it * it).sum::<f64>() / own.len() as f64).sqrt(),
            // Outliers, which are to count little, would make the unit of their signal large.
            Loss::SoftL1(_) => robust_deviation(&own),
        };
        *unit *= scatter.max(1e-3);
    }
    let search = search(courses, free, effort);
    let model = |unknowns: &[f64]| residuals(courses, free, unknowns);
    fit_once(&model, &best.parameters, &search, 1.0).unwrap_or(best)
}

/// The residuals of each signal of each recording in its unit; empty where the motion cannot be followed.
fn by_signal(courses: &[Course<'_>], free: &[Free], fit: &Fit) -> Vec<Vec<f64>> {
    let Some(found) = residuals(courses, free, &fit.parameters) else { return Vec::new() };
    let (mut all, mut rest) = (Vec::new(), found.values.as_slice());
    for course in courses {
        for _ in &course.units {
            let (own, others) = rest.split_at(course.recorded.times.len());
            all.push(own.to_vec());
            rest = others;
        }
        rest = &rest[usize::from(course.recorded.phase_error > 0.0)..];
    }
    all
}

/// The residuals of all signals with the noise of their records.
fn signals(courses: &[Course<'_>], free: &[Free], fit: &Fit) -> Vec<SignalResiduals> {
    let units = courses.iter().flat_map(|it| it.units.iter().zip(&it.noise));
    let signal = |(own, (unit, noise)): (Vec<f64>, (&f64, &[f64; 2]))| SignalResiduals {
        values: own.iter().map(|it| it * unit).collect(),
        record_noise: noise[0],
        least_noise: noise[1],
    };
    by_signal(courses, free, fit).into_iter().zip(units).map(signal).collect()
}

fn search(courses: &[Course<'_>], free: &[Free], effort: &Effort) -> Search {
    let of_starts = courses.iter().flat_map(|it| it.unknown.iter().map(|it| it.1));
    Search {
        bounds: free.iter().map(|it| it.bounds).chain(of_starts).collect(),
        loss: effort.loss,
        patience: PATIENCE,
        tolerance: CONVERGED,
    }
}

/// Takes the capsule to rest at the start of each recording that is described as well so; returns the fit that is left.
///
/// A capsule that rests has no velocity to be fitted, and one that is left free would stand for it in the errors of others.
fn at_rest(courses: &mut [Course<'_>], free: &[Free], effort: &Effort, mut best: Fit) -> Fit {
    for index in 0..courses.len() {
        let before: usize = courses[..index].iter().map(|it| it.unknown.len()).sum();
        let place = courses[index].unknown.iter().position(|it| it.0 == Direction::StartY2);
        let Some(place) = place else { continue };
        let moving = courses[index].unknown.remove(place);
        let guess = courses[index].guess.clone();
        courses[index].guess.start.y2 = 0.0;
        let mut start = best.parameters.clone();
        start.remove(free.len() + before + place);
        let search = search(courses, free, effort);
        let model = |unknowns: &[f64]| residuals(courses, free, unknowns);
        let rests = fit_once(&model, &start, &search, 1.0);
        let allowed = best.sum_of_squares * (1.0 + MOVES / best.degrees_of_freedom as f64);
        match rests.filter(|it| it.sum_of_squares <= allowed) {
            Some(rests) => best = rests,
            None => {
                courses[index].unknown.insert(place, moving);
                courses[index].guess = guess;
            }
        }
    }
    best
}

/// The motions of all recordings at these unknowns: the parameters, then what is unknown of each start.
fn motions(courses: &[Course<'_>], free: &[Free], unknowns: &[f64]) -> Vec<Started> {
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
fn residuals(courses: &[Course<'_>], free: &[Free], unknowns: &[f64]) -> Option<Residuals> {
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

/// A function of each of some things, in their order, by so many threads.
fn in_threads<T: Sync, R: Send>(
    things: &[T],
    threads: usize,
    function: impl Fn(&T) -> R + Sync,
) -> Vec<R> {
    let each = things.len().div_ceil(threads.max(1)).max(1);
    let function = &function;
    thread::scope(|scope| {
        let parts: Vec<_> = things
            .chunks(each)
            .map(|part| scope.spawn(move || part.iter().map(function).collect::<Vec<R>>()))
            .collect();
        let join =
            |part: thread::ScopedJoinHandle<'_, Vec<R>>| part.join().expect("no thread panics");
        parts.into_iter().flat_map(join).collect()
    })
}
