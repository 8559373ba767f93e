//! The arc between two neighbouring solutions, and the special solutions on it.

use super::arclength::{CurvePoint, Equations, Plane, between, corrected, dot, moved, norm};

/// Trials of a search at most.
const TRIALS: usize = 120;
/// A bracket this narrow, relative to the arc, is not narrowed further.
pub const NARROW: f64 = 1e-14;
/// A sign that changes while the test stays above this share of its size at the ends is a jump, not a zero.
const JUMP: f64 = 1e-5;

/// Solutions between two others, one for each distance along the tangent of the first.
pub struct Arc<'a, const U: usize, E: Equations<U>> {
    equations: &'a E,
    start: [f64; U],
    normal: [f64; U],
}

/// A solution at a distance along an arc.
pub type Placed<const U: usize, T> = (f64, CurvePoint<U, T>);

impl<'a, const U: usize, E: Equations<U>> Arc<'a, U, E> {
    /// The arc that leaves a solution along its tangent.
    pub fn from(equations: &'a E, point: &CurvePoint<U, E::Seen>) -> Self {
        Arc { equations, start: point.at, normal: point.tangent }
    }

    /// A solution with its distance along the arc.
    pub fn place(&self, point: &CurvePoint<U, E::Seen>) -> Placed<U, E::Seen> {
        (dot(&self.normal, &between(&self.start, &point.at)), point.clone())
    }

    /// The solution at a distance near a guess.
    fn at(&self, distance: f64, guess: &[f64; U]) -> Option<Placed<U, E::Seen>> {
        let offset = dot(&self.normal, &self.start) + distance;
        let plane = Plane { normal: self.normal, offset };
        let (point, _) = corrected(self.equations, &plane, guess, &self.normal)?;
        Some((distance, point))
    }

    /// The solution at a distance between two others, near the straight line from one to the other.
    pub fn within(
        &self,
        [a, b]: [&Placed<U, E::Seen>; 2],
        distance: f64,
    ) -> Option<Placed<U, E::Seen>> {
        let share = (distance - a.0) / (b.0 - a.0);
        self.at(distance, &moved(&a.1.at, share, &between(&a.1.at, &b.1.at)))
    }

    /// The solution in the middle of two others, with its distance from the cubic through these along their tangents.
    ///
    /// None where there is none near, as between two solutions of different curves.
    pub fn middle(&self, [a, b]: [&Placed<U, E::Seen>; 2]) -> Option<(Placed<U, E::Seen>, f64)> {
        let chord = between(&a.1.at, &b.1.at);
        let bend = between(&b.1.tangent, &a.1.tangent);
        let expected = moved(&moved(&a.1.at, 0.5, &chord), 0.125 * norm(&chord), &bend);
        let distance = dot(&self.normal, &between(&self.start, &expected));
        let middle = self.at(distance, &expected)?;
        let away = norm(&between(&expected, &middle.1.at));
        Some((middle, away))
    }

    /// The solution at a distance beyond another, near its tangent.
    fn beyond(&self, a: &Placed<U, E::Seen>, distance: f64) -> Option<Placed<U, E::Seen>> {
        let share = (distance - a.0) / dot(&self.normal, &a.1.tangent);
        self.at(distance, &moved(&a.1.at, share, &a.1.tangent))
    }

    /// The solution so far beyond the first of two others, and no farther than the second.
    pub fn onward(&self, [a, b]: [&Placed<U, E::Seen>; 2], by: f64) -> Option<Placed<U, E::Seen>> {
        if b.0 - a.0 <= by {
            return Some(b.clone());
        }
        self.beyond(a, a.0 + by).or_else(|| self.within([a, b], a.0 + by))
    }

    /// Where `test` changes its sign between two solutions, to rounding, with the distance of the last two
    /// trials.
    ///
    /// Method: the secant, with the older end's value halved when it stays (the Illinois rule), and
    /// bisection where that does not halve the bracket in three trials. None where the test jumps.
    pub fn zero(
        &self,
        ends: [&Placed<U, E::Seen>; 2],
        test: impl Fn(&CurvePoint<U, E::Seen>) -> f64,
    ) -> Option<(Placed<U, E::Seen>, f64)> {
        let [mut a, mut b] = ends.map(Clone::clone);
        let (mut at_a, mut at_b) = (test(&a.1), test(&b.1));
        let size = at_a.abs().max(at_b.abs());
        let length = b.0 - a.0;
        let (mut best, mut least) = (a.clone(), f64::INFINITY);
        let (mut last, mut apart) = (a.0, length);
        let mut goal = length;
        let mut moved_before = None;
        for trial in 0..TRIALS {
            if b.0 - a.0 <= NARROW * length || least == 0.0 {
                break;
            }
            let late = trial % 4 == 3 && b.0 - a.0 > 0.5 * goal;
            if trial % 4 == 3 {
                goal = b.0 - a.0;
            }
            let share = if late { 0.5 } else { at_a / (at_a - at_b) };
            let next = self.within([&a, &b], a.0 + share * (b.0 - a.0))?;
            let value = test(&next.1);
            (last, apart) = (next.0, (next.0 - last).abs());
            if value.abs() < least {
                (best, least) = (next.clone(), value.abs());
            }
            let upper = (value < 0.0) == (at_b < 0.0);
            let kept = if moved_before == Some(upper) { 0.5 } else { 1.0 };
            if upper {
                (b, at_b, at_a) = (next, value, kept * at_a);
            } else {
                (a, at_a, at_b) = (next, value, kept * at_b);
            }
            moved_before = Some(upper);
        }
        (least <= JUMP * size).then_some((best, apart))
    }

    /// The last solution that is `as_before` and the first that is not, to the share `narrow` of their distance.
    ///
    /// Method: bisection, with the tangent of the last solution as predictor, as solutions may jump where they
    /// change; where none is found there, the last one is still before it.
    pub fn change(
        &self,
        ends: [&Placed<U, E::Seen>; 2],
        as_before: impl Fn(&CurvePoint<U, E::Seen>) -> bool,
        narrow: f64,
    ) -> [Placed<U, E::Seen>; 2] {
        let [mut a, mut b] = ends.map(Clone::clone);
        let narrow = narrow * (b.0 - a.0);
        while b.0 - a.0 > narrow {
            let middle = a.0 + 0.5 * (b.0 - a.0);
            if middle <= a.0 || middle >= b.0 {
                break;
            }
            let next = self.beyond(&a, middle).or_else(|| self.within([&a, &b], middle));
            match next {
                Some(next) if as_before(&next.1) => a = next,
                Some(next) => b = next,
                None => b.0 = middle,
            }
        }
        [a, b]
    }
}
