//! Jumps of the motion along a ramp.

use crate::description::Section;

/// Means are taken over this share of the points of the ramp, and over [`FEWEST`] at least.
const SHARE: usize = 200;
/// Points that a mean is taken over at least, a number that short periods divide.
const FEWEST: usize = 12;
/// A step of the mean is a jump from this share of the extent of the whole ramp on.
const LEAST_SIZE: f64 = 0.1;
/// And from so many of its standard errors on.
const CERTAINTY: f64 = 5.0;

/// A jump of the motion to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// The point of the ramp at which the step of the mean is largest.
    pub point: usize,
    /// That step, relative to the extent of all points of the ramp [-].
    pub size: f64,
}

/// Where the motion along a ramp jumps, by its section points in units in which their coordinates are compared.
///
/// Method: the step at a point is the mean of the section over the points from it on less that over as many before it, less the mean
/// of the same differences on its two sides, which is how the motion changes without a jump. Where the step is more than a tenth
/// of the extent of the ramp, and more than five standard errors of the mean (of the calmer side), the motion jumps, at the point
/// where the step is larger than at all others within two stretches.
/// Source: the errors are von Neumann's (1941), from the differences of points that follow each other, which no trend disturbs.
/// Assumes: a jump takes a time that is short against the ramp, and the motion between jumps changes evenly.
/// Breaks: a change of pace within a 200th of the ramp is a jump, be it one of the attractor or not; within the first and the last
/// hundredth none is seen.
pub fn jumps(points: &[Section]) -> Vec<Jump> {
    let window = (points.len() / SHARE).max(FEWEST);
    let extent = extent(points);
    let first = 2 * window;
    let all = first..(points.len() + 1).saturating_sub(first);
    let steps: Vec<f64> = all.map(|point| step(points, point, window, extent)).collect();
    let mut found = Vec::new();
    for (place, &size) in steps.iter().enumerate().filter(|(_, size)| **size > 0.0) {
        let (begin, end) = (place.saturating_sub(first), (place + first + 1).min(steps.len()));
        let is_largest = steps[begin..place].iter().all(|other| *other < size)
            && steps[place..end].iter().all(|other| *other <= size);
        if is_largest {
            found.push(Jump { point: first + place, size: size / extent });
        }
    }
    found
}

/// The step at a point; zero where it is none of a jump.
fn step(points: &[Section], point: usize, window: usize, extent: f64) -> f64 {
    let begins = [point - 2 * window, point - window, point, point + window];
    let means = begins.map(|begin| Mean::of(&points[begin..begin + window]));
    let step = beyond_trend(&means);
    let error = means[1].error.min(means[2].error);
    if step > LEAST_SIZE * extent && step > CERTAINTY * error { step } else { 0.0 }
}

/// The step in the middle of four means that follow each other, beyond what the differences on its sides show.
fn beyond_trend([first, before, after, last]: &[Mean; 4]) -> f64 {
    let parts = (0..before.value.len()).map(|place| {
        let [first, before, after, last] =
            [first, before, after, last].map(|mean| mean.value[place]);
        (after - before) - 0.5 * ((before - first) + (last - after))
    });
    parts.map(|part| part * part).sum::<f64>().sqrt()
}

/// The largest difference of a coordinate.
fn extent(points: &[Section]) -> f64 {
    let extents = (0..points.first().map_or(0, |point| point.len())).map(|place| {
        let values = points.iter().map(|point| point[place]);
        let low = values.clone().fold(f64::INFINITY, f64::min);
        values.fold(f64::NEG_INFINITY, f64::max) - low
    });
    extents.fold(0.0, f64::max)
}

/// The mean of some points with its standard error, the points less their trend taken as independent.
struct Mean {
    value: Section,
    error: f64,
}

impl Mean {
    fn of(points: &[Section]) -> Mean {
        let count = points.len() as f64;
        let coordinates = 0..points.first().map_or(0, |point| point.len());
        let mean = |place: usize| points.iter().map(|it| it[place]).sum::<f64>() / count;
        let value = coordinates.clone().map(mean).collect();
        let squares = |place: usize| {
            points.windows(2).map(|pair| (pair[1][place] - pair[0][place]).powi(2)).sum::<f64>()
        };
        let scatter = 0.5 * coordinates.map(squares).sum::<f64>();
        Mean { value, error: (scatter / (count * (count - 1.0))).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn jumps_of(of: impl Fn(usize) -> f64) -> Vec<Jump> {
        let points: Vec<Section> = (0..1000).map(|n| Section::new(&[of(n)])).collect();
        jumps(&points)
    }

    #[test]
    fn steps_are_jumps_and_slopes_and_noise_are_none() {
        let slope = |n: usize| 0.003 * n as f64;
        assert_eq!(jumps_of(slope), []);
        let found = jumps_of(|n| slope(n) + if n < 400 { 0.0 } else { 2.0 });
        assert_eq!(found.iter().map(|it| it.point).collect::<Vec<_>>(), [400]);
        assert!((found[0].size - 2.0 / 4.997).abs() < 1e-3, "{found:?}");
        // A logistic map in chaos, whose means scatter, and a motion of period two.
        let mut x = 0.3;
        let chaos: Vec<f64> = (0..1000)
            .map(|_| {
                x = 3.9 * x * (1.0 - x);
                x
            })
            .collect();
        assert_eq!(jumps_of(|n| chaos[n]), []);
        assert_eq!(jumps_of(|n| (n % 2) as f64), []);
        // From chaos to a larger value that repeats.
        let found = jumps_of(|n| if n < 700 { chaos[n] } else { 2.0 });
        assert_eq!(found.iter().map(|it| it.point).collect::<Vec<_>>(), [700]);
    }
}
