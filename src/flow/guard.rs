//! Where a guard first falls through zero: decided from its polynomial, never sampled.

use crate::lane::{Lane, Mask, ORDER, Series, series};

/// A polynomial is halved at most this often before it is taken to be flat.
const HALVINGS: usize = 60;
/// Bracketed Newton steps to a root; bisection alone would need 53.
const REFINEMENTS: usize = 80;

/// What was found on a step.
#[derive(Debug, Clone, Copy)]
pub struct Fall<L: Lane> {
    /// How far the guard is known: up to its fall, or up to where no fall could be excluded.
    pub length: L,
    /// Whether it falls through zero at `length`.
    pub falls: L::Mask,
}

/// The first fall of `guard` through zero within `length`, in the lanes that are `watched`.
///
/// Method: on [0, h] the polynomial is positive if its quadratic part exceeds the sum of the
/// magnitudes of the rest; else, if its first or its second derivative provably keeps its sign, the
/// sign at the end (or at the one minimum) tells whether there is exactly one first fall, which Newton
/// steps inside a bracket then find to rounding; else h is halved. A guard at or below zero at the
/// start falls there if it is falling, and counts as zero if it is rising. Guarantee: between 0 and
/// the returned length the polynomial has no other fall; a minimum below zero by no more than the
/// rounding of the polynomial is a tangency, not a fall.
#[inline(always)]
pub fn first_fall<L: Lane>(guard: &Series<L>, length: L, watched: L::Mask) -> Fall<L> {
    let zero = L::splat(0.0);
    let mut guard = *guard;
    for _ in 0..3 {
        let at_zero = watched & guard[0].le(zero) & zero.le(guard[1]);
        if !at_zero.any() {
            break;
        }
        divide_by_time(&mut guard, at_zero);
    }
    let due_now = watched & (guard[0].lt(zero) | (guard[0].le(zero) & guard[1].lt(zero)));
    let mut h = L::select(due_now, zero, length);
    let mut falls = due_now;
    let mut open = watched & !due_now;
    for _ in 0..HALVINGS {
        if !open.any() {
            break;
        }
        let sums = Sums::new(&guard, h);
        open = open & !sums.quadratic_part_positive(&guard, h);
        if !open.any() {
            break;
        }
        let (decided, end, margin) = sums.candidate(&guard, h, open);
        let below = open & decided & series::value(&guard, end).lt(-margin);
        if below.any() {
            h = L::select(below, root(&guard, end, below), h);
            falls = falls | below;
        }
        open = open & !decided;
        h = L::select(open, h * L::splat(0.5), h);
    }
    Fall { length: h, falls }
}

/// Divides the polynomial by time where `mask`, dropping its constant term.
#[inline(always)]
pub fn divide_by_time<L: Lane>(guard: &mut Series<L>, mask: L::Mask) {
    for k in 0..ORDER {
        guard[k] = L::select(mask, guard[k + 1], guard[k]);
    }
    guard[ORDER] = L::select(mask, L::splat(0.0), guard[ORDER]);
}

/// Magnitudes of the terms beyond the quadratic part, over a step.
struct Sums<L> {
    /// Sum of `|g_k| h^k`, k >= 3.
    value: L,
    /// Sum of `k |g_k| h^(k-1)`, k >= 3.
    slope: L,
    /// Sum of `k (k-1) |g_k| h^(k-2)`, k >= 3.
    curvature: L,
}

impl<L: Lane> Sums<L> {
    #[inline(always)]
    fn new(guard: &Series<L>, h: L) -> Self {
        let zero = L::splat(0.0);
        let (mut value, mut slope, mut curvature) = (zero, zero, zero);
        for k in (3..=ORDER).rev() {
            let a = guard[k].abs();
            value = value * h + a;
            slope = slope * h + a * L::splat(k as f64);
            curvature = curvature * h + a * L::splat((k * (k - 1)) as f64);
        }
        Sums { value: value * h * h * h, slope: slope * h * h, curvature: curvature * h }
    }

    /// Whether the least value of the quadratic part on [0, h] exceeds all the rest.
    #[inline(always)]
    fn quadratic_part_positive(&self, guard: &Series<L>, h: L) -> L::Mask {
        let two = L::splat(2.0);
        let [g0, g1, g2, ..] = *guard;
        let at_end = g0 + h * (g1 + h * g2);
        let ends = g0.min(at_end);
        let vertex_inside = g1.lt(L::splat(0.0)) & L::splat(0.0).lt(g1 + two * g2 * h);
        // The minimum is g0 - g1^2 / (4 g2), compared without the division.
        let excess = (g0 - self.value) * (L::splat(4.0) * g2);
        let vertex_clear = (g1 * g1).lt(excess);
        self.value.lt(ends) & (!vertex_inside | vertex_clear)
    }

    /// Whether the guard's course on [0, h] is decided, the one point whose sign tells whether it
    /// falls, and the rounding that a minimum must exceed.
    #[inline(always)]
    fn candidate(&self, guard: &Series<L>, h: L, open: L::Mask) -> (L::Mask, L, L) {
        let zero = L::splat(0.0);
        let two = L::splat(2.0);
        let [_, g1, g2, ..] = *guard;
        let monotone = (self.slope + (two * g2 * h).abs()).le(g1.abs());
        let bent_one_way = self.curvature.le((two * g2).abs());
        let decided = monotone | bent_one_way;
        let slope_at_end = series::value_and_slope(guard, h).1;
        let minimum_inside =
            decided & !monotone & zero.lt(g2) & g1.lt(zero) & zero.lt(slope_at_end) & open;
        if !minimum_inside.any() {
            return (decided, h, zero);
        }
        let falling = series::derivative(guard).map(|a| -a);
        let minimum = root(&falling, h, minimum_inside);
        let magnitude = guard[0].abs() + (g1 * minimum).abs() + (g2 * minimum * minimum).abs();
        let rounding = magnitude * L::splat(4.0 * f64::EPSILON);
        (decided, L::select(minimum_inside, minimum, h), L::select(minimum_inside, rounding, zero))
    }
}

/// Where the polynomial falls through zero in (0, end], for the lanes of `mask`.
///
/// Assumes that it is positive just after 0, negative at `end`, and changes sign once. Newton steps,
/// replaced by bisection where they leave the bracket; a lane that has converged is frozen, so that
/// its bits do not depend on its neighbours. Error: the rounding of the polynomial over its slope.
#[inline(always)]
fn root<L: Lane>(polynomial: &Series<L>, end: L, mask: L::Mask) -> L {
    let zero = L::splat(0.0);
    let half = L::splat(0.5);
    let resolution = end * L::splat(f64::EPSILON);
    let (mut low, mut high) = (zero, end);
    let mut t = end * half;
    let mut open = mask;
    for _ in 0..REFINEMENTS {
        let (value, slope) = series::value_and_slope(polynomial, t);
        let beyond = value.le(zero);
        high = L::select(open & beyond, t, high);
        low = L::select(open & !beyond, t, low);
        let newton = t - value / slope;
        let inside = low.le(newton) & newton.le(high);
        let next = L::select(inside, newton, low + (high - low) * half);
        let settled = (next - t).abs().le(resolution);
        t = L::select(open, next, t);
        open = open & !settled;
        if !open.any() {
            break;
        }
    }
    t
}

/// Shows `found` each time in (0, length] at which the polynomial changes sign, and whether it falls.
///
/// Method: [`first_fall`] again and again, on the polynomial shifted to where it is known to, and
/// turned over after each crossing.
pub fn crossings(polynomial: &Series<f64>, length: f64, mut found: impl FnMut(f64, bool)) {
    let mut rest = *polynomial;
    let mut positive = rest.iter().find(|&&a| a != 0.0).is_none_or(|&a| a > 0.0);
    if !positive {
        rest = rest.map(|a| -a);
    }
    let mut start = 0.0;
    // A polynomial has no more crossings than its degree; the rest are intervals without one.
    for _ in 0..HALVINGS * ORDER {
        let fall = first_fall(&rest, length - start, true);
        start += fall.length;
        if fall.falls {
            found(start, positive);
        }
        if start >= length {
            return;
        }
        rest = series::shifted(&rest, fall.length);
        if fall.falls {
            rest[0] = 0.0;
            rest = rest.map(|a| -a);
            positive = !positive;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guard(coefficients: &[f64]) -> Series<f64> {
        std::array::from_fn(|k| coefficients.get(k).copied().unwrap_or(0.0))
    }

    /// Advances as the integrator does, until the polynomial is known up to 1.
    fn fall_of(coefficients: &[f64]) -> Option<f64> {
        let (mut polynomial, mut start) = (guard(coefficients), 0.0);
        loop {
            let fall = first_fall(&polynomial, 1.0 - start, true);
            if fall.falls {
                return Some(start + fall.length);
            }
            if start + fall.length >= 1.0 {
                return None;
            }
            start += fall.length;
            polynomial = series::shifted(&polynomial, fall.length);
        }
    }

    #[test]
    fn finds_the_first_of_two_close_roots() {
        // (t - 0.3)(t - 0.3 - 1e-6): positive, below zero for a millionth, positive again.
        let (a, b) = (0.3, 0.3 + 1e-6);
        let fall = fall_of(&[a * b, -(a + b), 1.0]).expect("falls");
        assert!((fall - a).abs() < 1e-10, "{fall}");
    }

    #[test]
    fn finds_every_crossing_with_its_direction() {
        // Chebyshev's T4 on [0, 1] has its roots at (1 - cos((2j - 1) pi / 8)) / 2.
        let mut seen = Vec::new();
        crossings(&guard(&[1.0, -32.0, 160.0, -256.0, 128.0]), 1.0, |t, falls| {
            seen.push((t, falls));
        });
        assert_eq!(seen.len(), 4);
        for (j, (t, falls)) in seen.into_iter().enumerate() {
            let angle = (2 * j + 1) as f64 * std::f64::consts::PI / 8.0;
            assert!((t - (1.0 - libm::cos(angle)) / 2.0).abs() < 1e-13);
            assert_eq!(falls, j % 2 == 0);
        }
    }

    #[test]
    fn a_tangency_is_no_fall() {
        assert_eq!(fall_of(&[0.25, -1.0, 1.0]), None);
        assert_eq!(fall_of(&[0.0; 3]), None);
    }

    #[test]
    fn a_guard_at_zero_falls_only_if_falling() {
        assert_eq!(fall_of(&[0.0, -1.0]), Some(0.0));
        assert_eq!(fall_of(&[0.0, 1.0]), None);
        assert_eq!(fall_of(&[0.0, 0.0, -1.0]), Some(0.0));
        let fall = fall_of(&[-1e-20, 1.0, -2.0]).expect("falls at one half");
        assert!((fall - 0.5).abs() < 1e-15);
    }

    #[test]
    fn finds_what_sampling_the_ends_would_miss() {
        // Chebyshev's T4 shifted up: dips below zero twice within (0, 1).
        let up = 0.5;
        let fall = fall_of(&[1.0 + up, -32.0, 160.0, -256.0, 128.0]).expect("falls");
        // First root of cos(4 acos(2t - 1)) = -1/2, from the right end downward by symmetry.
        let exact = (1.0 - libm::cos(2.0 * std::f64::consts::PI / 12.0)) / 2.0;
        assert!((fall - exact).abs() < 1e-14, "{fall} {exact}");
    }
}
