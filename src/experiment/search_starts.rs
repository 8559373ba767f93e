//! Where the search for the parameters of recorded histories begins.

use super::course::Course;
use super::free_parameter::Free;
use super::least_squares::Bounds;

/// Where the search begins: the values of the first recording, then points of a Halton sequence within the bounds.
pub(super) fn starts(courses: &[Course<'_>], free: &[Free], count: usize) -> Vec<Vec<f64>> {
    const PRIMES: [u32; 14] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43];
    let of_starts: Vec<f64> = courses
        .iter()
        .flat_map(|course| {
            course.unknown.iter().map(|(direction, _)| course.guess.value(*direction))
        })
        .collect();
    let start = |index: usize| {
        let value = |(i, free): (usize, &Free)| {
            let Bounds { least, greatest } = free.bounds;
            match index {
                0 => courses[0].guess.parameters[free.parameter].clamp(least, greatest),
                _ => {
                    least
                        + (greatest - least)
                            * radical_inverse(index as u32, PRIMES[i % PRIMES.len()])
                }
            }
        };
        let parameters = free.iter().enumerate().map(value);
        parameters.chain(of_starts.iter().copied()).collect()
    };
    (0..count.max(1)).map(start).collect()
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
