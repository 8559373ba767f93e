//! What a fit to recorded histories gives: parameters with their intervals, misfit, drifts.

use nalgebra::DMatrix;

use super::drift::{Drift, drifts};
use super::effort::{Effort, search};
use super::estimate::Estimate;
use super::free_parameter::{Free, Side};
use super::history::{History, Recordings, by_signal, signals};
use super::in_threads::in_threads;
use super::least_squares::{Fit, Loss, fit_once};
use super::misfit::{Misfit, misfit, robust_deviation};
use super::profile::{Profile, Verdict, profile_points};
use crate::description::{Parameter, Parameters};

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
    /// The parameters of each recording as fitted.
    pub parameters: Vec<Parameters>,
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
    /// Of each recording of a capsule, whether it is taken to rest at the first sample, as that describes it as well.
    pub rests: Vec<bool>,
    /// The drift of each signal of each recording, where the data tell it.
    pub drifts: Vec<Drift>,
}

/// A fit of all unknowns, and how many of the starts of the search ended there, and how many there were.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The fit.
    pub fit: Fit,
    /// The starts.
    pub starts: [usize; 2],
}

/// What is told of a fit to some recordings, whose parameters are these where nothing is fitted.
pub(super) fn outcome<H: History>(
    courses: &[H],
    free: &[Free],
    effort: &Effort,
    found: Found,
    as_set: Vec<Parameters>,
) -> MotionFit {
    let Found { fit, starts } = found;
    let search = search(courses, free, effort);
    let model = Recordings { courses, free };
    let which: Vec<usize> = (0..free.len()).collect();
    let profiles =
        in_threads(&which, effort.threads, |&which| profile_points(&model, &fit, &search, which));
    let (profiles, points): (Vec<Profile>, Vec<_>) = profiles.into_iter().unzip();
    let fitted = free.iter().zip(profiles).enumerate();
    let all = 0..free.len();
    let covariance = &fit.covariance.covariance;
    let correlations = all.clone().map(|i| all.clone().map(move |j| correlation(covariance, i, j)));
    let covariances = all.clone().map(|i| all.clone().map(move |j| covariance[(i, j)]));
    MotionFit {
        fitted: fitted
            .map(|(i, (free, profile))| fitted_parameter(&fit, i, free, profile))
            .collect(),
        parameters: as_set.into_iter().map(|it| with_fitted(it, free, &fit)).collect(),
        combined: all.clone().filter(|&i| fit.is_open(i)).map(|i| free[i].parameter).collect(),
        correlations: correlations.map(Iterator::collect).collect(),
        covariance: covariances.map(Iterator::collect).collect(),
        profiles: points,
        misfit: misfit(&signals(courses, free, &fit), fit.degrees_of_freedom),
        samples: fit.degrees_of_freedom + fit.parameters.len(),
        starts,
        rests: Vec::new(),
        drifts: drifts(courses, free, effort, &fit),
    }
}

/// Parameters with the values that were fitted.
fn with_fitted(mut parameters: Parameters, free: &[Free], fit: &Fit) -> Parameters {
    for (free, value) in free.iter().zip(&fit.parameters) {
        parameters[free.parameter] = *value;
    }
    parameters
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

/// The best of fits from some starts.
///
/// Fails where none of them leads anywhere.
pub(super) fn best_of<H: History>(
    courses: &[H],
    free: &[Free],
    effort: &Effort,
    starts: &[Vec<f64>],
) -> Result<Found, String> {
    let search = search(courses, free, effort);
    let model = Recordings { courses, free };
    let fits = in_threads(starts, effort.threads, |start| fit_once(&model, start, &search, 1.0));
    let found: Vec<Fit> =
        fits.into_iter().flatten().filter(|it| it.sum_of_squares.is_finite()).collect();
    let best = found.iter().min_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
    let best = best.ok_or("the simulation cannot be followed from any start")?;
    let same =
        found.iter().filter(|it| it.sum_of_squares <= best.sum_of_squares * (1.0 + 1e-4)).count();
    Ok(Found { fit: best.clone(), starts: [same, starts.len()] })
}

/// Divides the residuals of each signal by what they are, rather than by an estimate of its noise, and fits again.
///
/// A signal with sharp features has larger third differences than its noise alone; with one scatter for all signals the intervals of
/// what it determines would be too wide, and others too narrow.
pub(super) fn weighed_anew<H: History>(
    courses: &mut [H],
    free: &[Free],
    effort: &Effort,
    best: Fit,
) -> Fit {
    let found = by_signal(courses, free, &best);
    let scatters = courses.iter_mut().flat_map(|it| it.scatters_mut());
    for (scatter, own) in scatters.zip(found) {
        let size = match effort.loss {
            Loss::Squares => (own.iter().map(|it| it * it).sum::<f64>() / own.len() as f64).sqrt(),
            // Outliers, which are to count little, would make the unit of their signal large.
            Loss::SoftL1(_) => robust_deviation(&own),
        };
        scatter.unit *= size.max(1e-3);
    }
    let search = search(courses, free, effort);
    let model = Recordings { courses: &*courses, free };
    fit_once(&model, &best.parameters, &search, 1.0).unwrap_or(best)
}
