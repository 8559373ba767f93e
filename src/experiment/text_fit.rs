//! Fits chosen parameters to recorded histories of an oscillator given as text, several recordings at once.

use super::effort::Effort;
use super::fit_outcome::{Found, MotionFit, best_of, outcome, weighed_anew};
use super::free_parameter::Free;
use super::least_squares::{Bounds, Fit, Loss};
use super::search_starts::halton_point;
use super::text_course::TextCourse;
use super::text_record::TextRecord;

/// Residuals are weighed anew so often at most.
const WEIGHED: usize = 3;
/// Their units are right where their standard deviation is one to this.
const SETTLED: f64 = 0.1;

/// The parameters within their bounds that bring the simulation nearest to the `recordings`, all of one text.
///
/// # Method
///
/// As of the capsule ([`fit_motion`](super::motion_fit::fit_motion)): least squares of all samples of all states, each divided by its
/// noise. Unknowns besides the parameters are the states at the start of each recording ([`TextCourse`]). The phase of the drive at
/// time zero of a record is known. The search begins at the values of the first recording, and at points of a Halton sequence
/// within the bounds, each with the best of some values of the states of which a record says nothing.
///
/// # Assumes
///
/// Independent noise, exact times and an exact phase of the drive.
///
/// # Breaks
///
/// An error says so where a recorded state does not vary, or where no motion can be followed. Where a record begins while a friction
/// holds, the velocity at the start has little effect, and its errors stand in those of others.
pub fn fit_text(
    recordings: &[TextRecord],
    free: &[Free],
    effort: &Effort,
) -> Result<MotionFit, String> {
    let mut courses: Vec<TextCourse<'_>> =
        recordings.iter().map(TextCourse::new).collect::<Result<_, _>>()?;
    let from: Vec<Vec<f64>> =
        (0..effort.starts.max(1)).map(|index| start(&courses, free, index, effort.loss)).collect();
    let Found { fit, starts } = best_of(&courses, free, effort, &from)?;
    let fit = weighed(&mut courses, free, effort, fit);
    let as_set = recordings.iter().map(|it| it.parameters.clone()).collect();
    Ok(outcome(&courses, free, effort, Found { fit, starts }, as_set))
}

/// The fit with residuals in units of what they are, see [`weighed_anew`].
///
/// A search that has ended beside the minimum leaves units that are too large, with which it goes on to the minimum: then they are
/// taken once more.
fn weighed(courses: &mut [TextCourse<'_>], free: &[Free], effort: &Effort, mut best: Fit) -> Fit {
    for _ in 0..WEIGHED {
        best = weighed_anew(courses, free, effort, best);
        if (best.residual_deviation() - 1.0).abs() < SETTLED {
            break;
        }
    }
    best
}

/// Where a search begins, by its number: the first at the values of the first recording, others at points of a Halton sequence.
fn start(courses: &[TextCourse<'_>], free: &[Free], index: usize, loss: Loss) -> Vec<f64> {
    let bounds: Vec<Bounds> = free.iter().map(|it| it.bounds).collect();
    let parameters: Vec<f64> = match index {
        0 => {
            let pairs = courses[0].set(free).into_iter().zip(&bounds);
            pairs.map(|(value, bounds)| value.clamp(bounds.least, bounds.greatest)).collect()
        }
        _ => halton_point(index as u32, &bounds),
    };
    let mut unknowns = parameters.clone();
    for course in courses {
        unknowns.extend(course.best_start(free, &parameters, loss));
    }
    unknowns
}
