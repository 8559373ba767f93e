//! Fits chosen parameters to recorded histories of the motion, several recordings at once.

use nalgebra::DMatrix;

use super::course::{Course, Recorded, Weights};
use super::course_residuals::{Recordings, by_signal, motions, signals};
use super::drift::{Drift, drifts};
pub use super::effort::Effort;
use super::effort::search;
use super::estimate::Estimate;
use super::first_sample::{at_rest, other_speeds};
pub use super::free_parameter::{Free, Side};
use super::in_threads::in_threads;
use super::least_squares::{Fit, Loss, fit_once};
use super::misfit::{Misfit, misfit, robust_deviation};
use super::profile::{Profile, Verdict, profile_points};
use super::search_starts::starts;
use crate::capsule::Parameter;
use crate::capsule::sampled::Started;

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
    /// Of each recording, whether its capsule is taken to rest at the first sample, as that describes it as well.
    pub rests: Vec<bool>,
    /// The drift of each signal of each recording, where the data tell it.
    pub drifts: Vec<Drift>,
}

/// The parameters within their bounds that bring the simulation nearest to the `recordings`.
///
/// # Method
///
/// Least squares of all samples, each divided by the noise of its signal: first that of third differences of the record, then that
/// of the residuals. Unknowns
/// besides the parameters are the start of each recording: r, y1, y2 and, where x1 or x2 is recorded, x2, each looked for about its
/// estimate from the smoothed record, or among all speeds that the capsule can have where the record has none ([`Course`]); a capsule
/// whose rest at the first sample describes the record as well is taken to rest (see `first_sample`). And the phase of the drive, of which the estimate from the record
/// of the drive, with its standard error, is one datum more. The derivatives are exact, through every impact, slip
/// and stick ([`sampled`]). The search begins at several starts: the values at hand, and points of a Halton sequence within the
/// bounds. Intervals are those of the profile likelihood, with the scatter estimated from the residuals; where outliers count little,
/// it and the standard errors are Huber's ([`Covariance::new`](super::covariance::Covariance::new)).
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
    let model = Recordings { courses: &courses, free };
    let which: Vec<usize> = (0..free.len()).collect();
    let profiles =
        in_threads(&which, effort.threads, |&which| profile_points(&model, &fit, &search, which));
    let (profiles, points): (Vec<Profile>, Vec<_>) = profiles.into_iter().unzip();
    let fitted = free.iter().zip(profiles).enumerate();
    let all = 0..free.len();
    let covariance = &fit.covariance.covariance;
    let correlations = all.clone().map(|i| all.clone().map(move |j| correlation(covariance, i, j)));
    let covariances = all.clone().map(|i| all.clone().map(move |j| covariance[(i, j)]));
    Ok(MotionFit {
        fitted: fitted
            .map(|(i, (free, profile))| fitted_parameter(&fit, i, free, profile))
            .collect(),
        motions: motions(&courses, free, &fit.parameters),
        combined: all.clone().filter(|&i| fit.is_open(i)).map(|i| free[i].parameter).collect(),
        correlations: correlations.map(Iterator::collect).collect(),
        covariance: covariances.map(Iterator::collect).collect(),
        profiles: points,
        misfit: misfit(&signals(&courses, free, &fit), fit.degrees_of_freedom),
        samples: fit.degrees_of_freedom + fit.parameters.len(),
        starts,
        rests: courses.iter().map(Course::rests).collect(),
        drifts: drifts(&courses, free, effort, &fit),
    })
}

/// Parameter `i` of a fit with its profile.
fn fitted_parameter(fit: &Fit, i: usize, free: &Free, profile: Profile) -> Fitted {
    Fitted {
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
    }
}

/// The correlation of two parameters; NaN where one is not determined.
fn correlation(covariance: &DMatrix<f64>, i: usize, j: usize) -> f64 {
    match [i, j].iter().all(|&it| covariance[(it, it)].is_finite()) {
        true => covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt(),
        false => f64::NAN,
    }
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
    let starts = starts(&courses, free, effort.starts, effort.loss);
    let search = search(&courses, free, effort);
    let model = Recordings { courses: &courses, free };
    let fits = in_threads(&starts, effort.threads, |start| fit_once(&model, start, &search, 1.0));
    let found: Vec<Fit> =
        fits.into_iter().flatten().filter(|it| it.sum_of_squares.is_finite()).collect();
    let best = found.iter().min_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
    let best = best.ok_or("the simulation cannot be followed from any start")?;
    let same =
        found.iter().filter(|it| it.sum_of_squares <= best.sum_of_squares * (1.0 + 1e-4)).count();
    let fit = other_speeds(&courses, free, effort, best.clone());
    let misfit = fit.residual_deviation();
    let fit = match effort.weights {
        Weights::Noise => weighed_anew(&mut courses, free, effort, fit),
        Weights::Spread => fit,
    };
    let fit = at_rest(&mut courses, free, effort, fit);
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
    let model = Recordings { courses, free };
    fit_once(&model, &best.parameters, &search, 1.0).unwrap_or(best)
}
