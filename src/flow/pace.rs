//! How long a step may be: where the last terms of its series fall below the tolerance.

use crate::lane::{Lane, ORDER, Series, series};

/// The longest step whose last two terms stay below `tolerance` times the series itself.
///
/// Method: after Jorba and Zou (2005), with the size of a series over the step taken as the largest of
/// its first three terms, so that no scale has to be given and a start from rest costs nothing.
/// Solves `|a_p| h^p = tolerance max_j |a_j| h^j` for p = ORDER - 1 and ORDER, j = 0, 1, 2.
/// Infinite where the last terms vanish.
#[inline(always)]
pub fn longest_step<L: Lane>(series: &Series<L>, tolerance: f64) -> L {
    let log_tolerance = L::splat(tolerance.rough_log());
    let mut firsts = [L::splat(0.0); 3];
    for j in 0..3 {
        firsts[j] = series[j].abs().rough_log() + log_tolerance;
    }
    let mut longest = L::splat(f64::INFINITY);
    for last in [ORDER - 1, ORDER] {
        let tail = series[last].abs();
        let log_tail = tail.rough_log();
        let mut log = L::splat(-1000.0);
        for (j, &first) in firsts.iter().enumerate() {
            log = log.max((first - log_tail) * L::splat(series::INVERSE[last - j]));
        }
        let vanishes = tail.le(L::splat(f64::MIN_POSITIVE));
        longest = longest.min(L::select(vanishes, L::splat(f64::INFINITY), log.rough_exp()));
    }
    longest
}
