//! How long a step may be: where the last terms of its series fall below the tolerance.

use crate::lane::{Lane, ORDER, Series};

/// The longest step whose last two terms stay below `tolerance` times the series itself.
///
/// Method: after Jorba and Zou (2005), with the size of a series over the step taken as the largest of
/// its first three terms, so that no scale has to be given and a start from rest costs nothing.
/// Solves `|a_p| h^p = tolerance max_j |a_j| h^j` for p = ORDER - 1 and ORDER, j = 0, 1, 2.
/// Infinite where the last terms vanish.
#[inline(always)]
pub fn longest_step<L: Lane>(series: &Series<L>, tolerance: f64) -> L {
    let mut longest = L::splat(f64::INFINITY);
    for last in [ORDER - 1, ORDER] {
        let tail = series[last].abs();
        let mut h = L::splat(0.0);
        for (first, term) in series.iter().enumerate().take(3) {
            let ratio = L::splat(tolerance) * term.abs() / tail;
            h = h.max(ratio.rough_root((last - first) as f64));
        }
        let vanishes = tail.le(L::splat(f64::MIN_POSITIVE));
        longest = longest.min(L::select(vanishes, L::splat(f64::INFINITY), h));
    }
    longest
}
