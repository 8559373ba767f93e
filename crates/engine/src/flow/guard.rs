//! Where a guard first falls through zero: decided from its polynomial, never sampled.

use crate::lane::{Lane, Mask, ORDER, Series, series};

/// A polynomial is halved at most this often before it is taken to be flat.
const HALVINGS: usize = 60;
/// Steps to a root at most; three are usual, and bisection alone would need 53.
const REFINEMENTS: usize = 80;
/// A step of third order this short, relative to the interval and to the bend, is the last one.
const NEAR: f64 = 3e-6;

/// k and k (k - 1), the factors of the terms of the first two derivatives.
const FACTORS: [[f64; 2]; ORDER + 1] = {
    let mut factors = [[0.0; 2]; ORDER + 1];
    let mut k = 1;
    while k <= ORDER {
        factors[k] = [k as f64, (k * (k - 1)) as f64];
        k += 1;
    }
    factors
};

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
/// signs of value and slope at the end tell whether there is one fall, none, or a dip that may reach
/// zero, and a search for the root finds it to rounding; else h is halved. A guard at or below zero at the
/// start falls there if it is falling, and counts as zero if it is rising. Guarantee: between 0 and
/// the returned length the polynomial has no other fall; a minimum below zero by no more than the
/// rounding of the polynomial is a tangency, not a fall. `guard` is left divided by the power of time
/// that vanishes with it.
#[inline(always)]
pub fn first_fall<L: Lane>(guard: &mut Series<L>, length: L, watched: L::Mask) -> Fall<L> {
    let zero = L::splat(0.0);
    for _ in 0..3 {
        let at_zero = watched & guard[0].le(zero) & zero.le(guard[1]);
        if !at_zero.any() {
            break;
        }
        divide_by_time(guard, at_zero);
    }
    let due_now = watched & (guard[0].lt(zero) | (guard[0].le(zero) & guard[1].lt(zero)));
    let mut h = L::select(due_now, zero, length);
    let mut falls = due_now;
    let mut open = watched & !due_now;
    let none = L::Mask::splat(false);
    let (mut crosses, mut dips) = (none, none);
    let mut at_end = (zero, zero);
    for _ in 0..HALVINGS {
        if !open.any() {
            break;
        }
        let sums = Sums::new(|k| guard[k], h);
        let firsts = [guard[0], guard[1], guard[2]];
        open = open & !sums.quadratic_part_positive(firsts, h);
        if !open.any() {
            break;
        }
        let (monotone, bent_to_one_side) = sums.keep_their_signs(guard, h);
        let decided = open & (monotone | bent_to_one_side);
        let (value, slope) = series::value_and_slope(guard, h);
        let below = decided & value.lt(zero);
        let convex = zero.lt(guard[2]) & guard[1].lt(zero) & zero.lt(slope);
        crosses = crosses | below;
        dips = dips | (decided & convex & !(below | monotone));
        at_end = (L::select(decided, value, at_end.0), L::select(decided, slope, at_end.1));
        open = open & !decided;
        h = L::select(open, h * L::splat(0.5), h);
    }
    if (crosses | dips).any() {
        let (root, found) = first_root(guard, h, at_end, crosses, dips);
        h = L::select(found, root, h);
        falls = falls | found;
    }
    Fall { length: h, falls }
}

/// Where `guard` provably is positive on all of [0, length], which one that is not finite nowhere is.
#[inline(always)]
pub fn stays_positive<L: Lane>(guard: &Series<L>, length: L::Plain) -> L::Mask {
    let sums = Sums::new(|k| guard[k].plain(), length);
    let firsts = [guard[0].plain(), guard[1].plain(), guard[2].plain()];
    sums.quadratic_part_positive(firsts, length)
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
    fn new(guard: impl Fn(usize) -> L, h: L) -> Self {
        let zero = L::splat(0.0);
        let (mut value, mut slope, mut curvature) = (zero, zero, zero);
        for k in (3..ORDER + 1).rev() {
            let a = guard(k).abs();
            value = value * h + a;
            slope = slope * h + a * L::splat(FACTORS[k][0]);
            curvature = curvature * h + a * L::splat(FACTORS[k][1]);
        }
        Sums { value: value * h * h * h, slope: slope * h * h, curvature: curvature * h }
    }

    /// Whether the least value of the quadratic part on [0, h] exceeds all the rest.
    #[inline(always)]
    fn quadratic_part_positive(&self, [g0, g1, g2]: [L; 3], h: L) -> L::Mask {
        let two = L::splat(2.0);
        let at_end = g0 + h * (g1 + h * g2);
        // The lesser of two numbers would pass over one that is not a number.
        let ends_clear =
            self.value.lt(g0) & self.value.lt(at_end) & at_end.lt(L::splat(f64::INFINITY));
        let vertex_inside = g1.lt(L::splat(0.0)) & L::splat(0.0).lt(g1 + two * g2 * h);
        // The minimum is g0 - g1^2 / (4 g2), compared without the division.
        let excess = (g0 - self.value) * (L::splat(4.0) * g2);
        let vertex_clear = (g1 * g1).lt(excess);
        ends_clear & (!vertex_inside | vertex_clear)
    }

    /// Whether the first and whether the second derivative keeps its sign on [0, h].
    #[inline(always)]
    fn keep_their_signs(&self, guard: &Series<L>, h: L) -> (L::Mask, L::Mask) {
        let [_, g1, g2, ..] = *guard;
        let g2 = L::splat(2.0) * g2;
        let monotone = (self.slope + (g2 * h).abs()).le(g1.abs());
        (monotone, self.curvature.le(g2.abs()))
    }
}

/// The first root in (0, end] of a polynomial that is positive just after 0, and where there is one.
///
/// A lane either `crosses`, with one change of sign and `value` < 0 at `end`, or `dips`, convex and positive
/// at `end` with its minimum between. Method: Halley's steps towards a crossing, from a
/// guess by both ends, replaced by bisection where they leave the bracket; Newton's into a dip from the left,
/// which cannot pass a root of a convex polynomial, so that a rising slope means that there is none.
/// A lane that has converged is frozen, so that its bits do not depend on its neighbours. Error: the
/// rounding of the polynomial over its slope.
#[inline(always)]
fn first_root<L: Lane>(
    polynomial: &Series<L>,
    end: L,
    (value, slope): (L, L),
    crosses: L::Mask,
    dips: L::Mask,
) -> (L, L::Mask) {
    let zero = L::splat(0.0);
    let half = L::splat(0.5);
    let resolution = end * L::splat(f64::EPSILON);
    let near = L::splat(NEAR);
    let near_end = end * near;
    let [g0, g1, g2, ..] = *polynomial;
    let (mut low, mut high) = (zero, end);
    let mut t = L::select(crosses, guess([g0, g1], [value, slope], end), zero);
    let mut open = crosses | dips;
    let mut found = crosses;
    for _ in 0..REFINEMENTS {
        let (value, slope, curvature) = series::value_slope_curvature(polynomial, t);
        let beyond = value.le(zero);
        high = L::select(crosses & beyond, t, high);
        low = L::select(crosses & !beyond, t, low);
        let bend = L::select(crosses, half * value * curvature, zero);
        let next = t - value * slope / (slope * slope - bend);
        let inside = low.le(next) & next.le(high);
        let middle = low + (high - low) * half;
        let next = L::select(crosses & !inside, middle, next);
        let move_by = (next - t).abs();
        // What the next step would move: Halley's error is of third order, Newton's of second.
        let bent = curvature.abs() * move_by;
        let cubed = crosses & inside & move_by.le(near_end) & bent.le(slope.abs() * near);
        let squared = dips & (bent * move_by).le(slope.abs() * resolution);
        let settled = move_by.le(resolution) | cubed | squared;
        if dips.any() {
            // A dip no deeper than the rounding of its value is a tangency.
            let misses = dips & (zero.le(slope) | high.lt(next));
            let magnitude = g0.abs() + (g1 * t).abs() + (g2 * t * t).abs();
            let margin = magnitude * L::splat(4.0 * f64::EPSILON);
            let deep = ((value + margin) * curvature).lt(half * slope * slope);
            let ends = open & dips & (misses | settled | beyond);
            found = found | (ends & deep & !misses);
            t = L::select(ends & settled & !beyond, next, t);
            open = open & !ends;
        }
        t = L::select(open, next, t);
        open = open & !settled;
        if !open.any() {
            break;
        }
    }
    (t, found)
}

/// Where a polynomial meets zero in (0, end), guessed from its values and slopes at both ends.
///
/// Method: time as the cubic in the value that both ends give; the chord where that leaves the interval.
#[inline(always)]
fn guess<L: Lane>([g0, g1]: [L; 2], [value, slope]: [L; 2], end: L) -> L {
    let fall = g0 - value;
    let chord = g0 / fall;
    let rest = L::splat(1.0) - chord;
    // The slopes of time over value, relative to the chord's.
    let scale = -(fall / end);
    let (at_start, at_end) = (scale / g1, scale / slope);
    let bend = rest * (at_start - L::splat(1.0)) + chord * (L::splat(1.0) - at_end);
    let cubic = end * (chord + chord * rest * bend);
    let inside = L::splat(0.0).lt(cubic) & cubic.lt(end);
    L::select(inside, cubic, end * chord)
}

/// The times in (0, length] at which a polynomial changes its sign, one after the other in each lane.
///
/// Method: [`first_fall`] again and again, on the polynomial shifted to where it is known to, and
/// turned over after each crossing.
#[derive(Debug, Clone, Copy)]
pub struct Crossings<L: Lane> {
    rest: Series<L>,
    length: L,
    start: L,
    positive: L::Mask,
    /// Where the end has not been reached.
    open: L::Mask,
}

impl<L: Lane> Crossings<L> {
    /// Those of a polynomial, in the lanes that take part.
    #[inline(always)]
    pub fn new(polynomial: &Series<L>, length: L, taking_part: L::Mask) -> Self {
        let zero = L::splat(0.0);
        let sign = series::sign_after_start(polynomial, L::splat(1.0));
        let rest = series::scaled(polynomial, sign);
        let positive = zero.lt(sign);
        Crossings { rest, length, start: zero, positive, open: taking_part }
    }

    /// The next crossing in the lanes of `wanted`: where there is one, its time, and where it falls there.
    ///
    /// In the lanes that are wanted and have no further crossing the time is the length.
    #[inline(always)]
    pub fn next(&mut self, wanted: L::Mask) -> Crossing<L> {
        let zero = L::splat(0.0);
        let none = L::Mask::splat(false);
        let (mut found, mut falls, mut time) = (none, none, self.length);
        // A polynomial has no more crossings than its degree; the rest are intervals without one.
        for _ in 0..HALVINGS * ORDER {
            let seeking = wanted & self.open & !found;
            if !seeking.any() {
                break;
            }
            let fall = first_fall(&mut self.rest.clone(), self.length - self.start, seeking);
            let here = seeking & fall.falls;
            let start = self.start + fall.length;
            self.start = L::select(seeking, start, self.start);
            time = L::select(here, self.start, time);
            falls = falls | (here & self.positive);
            found = found | here;
            let ended = self.length.le(self.start);
            self.open = self.open & !(seeking & ended);
            let moved = seeking & !ended;
            if moved.any() {
                let shifted = series::shifted(&self.rest, fall.length);
                let turned = moved & fall.falls;
                for (term, new) in self.rest.iter_mut().zip(shifted) {
                    *term = L::select(moved, L::select(turned, -new, new), *term);
                }
                self.rest[0] = L::select(turned, zero, self.rest[0]);
                self.positive = (self.positive & !turned) | (!self.positive & turned);
            }
        }
        Crossing { found, falls, time }
    }
}

/// A change of sign, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Crossing<L: Lane> {
    /// Where there is one.
    pub found: L::Mask,
    /// Where the polynomial falls through zero there; elsewhere it rises.
    pub falls: L::Mask,
    /// When.
    pub time: L,
}

/// Shows `found` each time in (0, length] at which the polynomial changes sign, and whether it falls.
pub fn crossings(polynomial: &Series<f64>, length: f64, mut found: impl FnMut(f64, bool)) {
    let mut crossings = Crossings::new(polynomial, length, true);
    loop {
        let crossing = crossings.next(true);
        if !crossing.found {
            return;
        }
        found(crossing.time, crossing.falls);
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
            let fall = first_fall(&mut polynomial.clone(), 1.0 - start, true);
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
    fn a_guard_that_is_not_finite_is_nowhere_positive() {
        assert!(stays_positive(&guard(&[1.0, 0.5]), 1.0));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for terms in [[bad, 0.5, 0.0], [1.0, bad, 0.0], [1.0, 0.5, bad]] {
                assert!(!stays_positive(&guard(&terms), 1.0), "{terms:?}");
            }
        }
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
