//! Fits chosen parameters to recorded histories of the capsule, several recordings at once.

use super::course::{Course, Recorded, Weights};
pub use super::effort::Effort;
use super::first_sample::{at_rest, other_speeds};
pub use super::fit_outcome::{Fitted, MotionFit};
use super::fit_outcome::{Found, best_of, outcome, weighed_anew};
pub use super::free_parameter::{Free, Side};
use super::search_starts::starts;

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
    let Best { courses, found, .. } = best(recordings, free, effort)?;
    let as_set = recordings.iter().map(|it| it.parameters.clone()).collect();
    let rests = courses.iter().map(Course::rests).collect();
    Ok(MotionFit { rests, ..outcome(&courses, free, effort, found, as_set) })
}

/// The best values of the parameters alone, without intervals, and the standard deviation of the residuals as they are weighed; see
/// [`fit_motion`].
pub fn best_values(
    recordings: &[Recorded],
    free: &[Free],
    effort: &Effort,
) -> Result<(Vec<f64>, f64), String> {
    let Best { found, misfit, .. } = best(recordings, free, effort)?;
    Ok((found.fit.parameters[..free.len()].to_vec(), misfit))
}

/// The best fit, with what is unknown in it.
struct Best<'r> {
    courses: Vec<Course<'r>>,
    found: Found,
    /// Standard deviation of its residuals, before they were weighed anew.
    misfit: f64,
}

fn best<'r>(
    recordings: &'r [Recorded],
    free: &[Free],
    effort: &Effort,
) -> Result<Best<'r>, String> {
    let mut courses: Vec<Course<'_>> =
        recordings.iter().map(|it| Course::new(it, effort.weights)).collect::<Result<_, _>>()?;
    let from = starts(&courses, free, effort.starts, effort.loss);
    let Found { fit, starts } = best_of(&courses, free, effort, &from)?;
    let fit = other_speeds(&courses, free, effort, fit);
    let misfit = fit.residual_deviation();
    let fit = match effort.weights {
        Weights::Noise => weighed_anew(&mut courses, free, effort, fit),
        Weights::Spread => fit,
    };
    let fit = at_rest(&mut courses, free, effort, fit);
    Ok(Best { courses, found: Found { fit, starts }, misfit })
}
