//! Fits chosen parameters to recorded histories of an oscillator given as text, several recordings at once.

use super::effort::Effort;
use super::fit_outcome::{Found, MotionFit, best_of, outcome, weighed_anew};
use super::free_parameter::Free;
use super::history::History;
use super::least_squares::Bounds;
use super::search_starts::halton_point;
use super::text_course::TextCourse;
use super::text_record::TextRecord;

/// The parameters within their bounds that bring the simulation nearest to the `recordings`, all of one text.
///
/// # Method
///
/// As of the capsule ([`fit_motion`](super::motion_fit::fit_motion)): least squares of all samples of all states, each divided by its
/// noise. Unknowns besides the parameters are the states at the start of each recording ([`TextCourse`]). The phase of the drive at
/// time zero of a record is known. The search begins at the values of the first recording, and at points of a Halton sequence
/// within the bounds of the parameters and of the states of which the records say nothing.
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
        (0..effort.starts.max(1)).map(|index| start(&courses, free, index)).collect();
    let Found { fit, starts } = best_of(&courses, free, effort, &from)?;
    let fit = weighed_anew(&mut courses, free, effort, fit);
    let as_set = recordings.iter().map(|it| it.parameters.clone()).collect();
    Ok(outcome(&courses, free, effort, Found { fit, starts }, as_set))
}

/// Where the search begins for the time of this index.
fn start(courses: &[TextCourse<'_>], free: &[Free], index: usize) -> Vec<f64> {
    let mut bounds: Vec<Bounds> = free.iter().map(|it| it.bounds).collect();
    let set = courses[0].set(free);
    let mut unknowns: Vec<f64> = set
        .iter()
        .zip(&bounds)
        .map(|(value, bounds)| value.clamp(bounds.least, bounds.greatest))
        .collect();
    let mut is_open = vec![true; free.len()];
    for course in courses {
        bounds.extend(course.bounds());
        unknowns.extend(course.guessed());
        is_open.extend(course.is_hidden());
    }
    if index == 0 {
        return unknowns;
    }
    let open = |place: &usize| is_open[*place];
    let places: Vec<usize> = (0..unknowns.len()).filter(open).collect();
    let of_open: Vec<Bounds> = places.iter().map(|place| bounds[*place]).collect();
    for (place, value) in places.iter().zip(halton_point(index as u32, &of_open)) {
        unknowns[*place] = value;
    }
    unknowns
}
