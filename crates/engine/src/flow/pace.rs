//! How long a step may be: where the last terms of its series fall below the tolerance.

use crate::lane::{Lane, ORDER, Series, series};

/// The longest step whose last two terms stay below `tolerance` times the series itself.
///
/// Method: after Jorba and Zou (2005), with the size of a series over the step taken as the largest of
/// its first three terms, so that no scale has to be given and a start from rest costs nothing.
/// Solves `|a_p| h^p = tolerance max_j |a_j| h^j` for p = ORDER - 1 and ORDER, j = 0, 1, 2.
/// Infinite where the last terms vanish.
///
/// Derivatives have series of their own, which may decay more slowly: the shortest of all steps is taken.
#[inline(always)]
pub fn longest_step<L: Lane>(series: &Series<L>, tolerance: f64) -> L::Plain {
    let mut longest = L::Plain::splat(f64::INFINITY);
    for part in 0..L::PARTS {
        longest = longest.min(longest_step_of::<L>(series, part, tolerance));
    }
    longest
}

/// The longest step that one part of the numbers allows.
#[inline(always)]
fn longest_step_of<L: Lane>(series: &Series<L>, part: usize, tolerance: f64) -> L::Plain {
    let series = |k: usize| series[k].part(part);
    let log_tolerance = L::Plain::splat(tolerance.rough_log());
    let mut firsts = const { [L::Plain::ZERO; 3] };
    for (j, first) in firsts.iter_mut().enumerate() {
        *first = series(j).abs().rough_log() + log_tolerance;
    }
    let mut longest = L::Plain::splat(f64::INFINITY);
    for last in [ORDER - 1, ORDER] {
        let tail = series(last).abs();
        let log_tail = tail.rough_log();
        let mut log = L::Plain::splat(-1000.0);
        for (j, &first) in firsts.iter().enumerate() {
            log = log.max((first - log_tail) * L::Plain::splat(series::INVERSE[last - j]));
        }
        let vanishes = tail.le(L::Plain::splat(f64::MIN_POSITIVE));
        let step = L::Plain::select(vanishes, L::Plain::splat(f64::INFINITY), log.rough_exp());
        longest = longest.min(step);
    }
    longest
}
