//! What is true of every curve of periodic orbits: an orbit has as many section points as its period has
//! cycles, and any of them may stand for it.

use super::arclength::{
    CurvePoint, Equations, Linear, Plane, between, corrected, dot, moved, norm, unit,
};

/// Half a period leads this far from where it began, or the orbit has half the period.
pub const HALVES: f64 = 1e-8;
/// A curve passes a solution that it comes by this near, or by a smaller share of a short step.
const SAME: f64 = 1e-6;
const SHARE: f64 = 1e-2;
/// Steps before a curve may close.
const LEAST_STEPS: usize = 3;

/// Equations of periodic orbits, whose first `D` unknowns are the section point.
pub trait Periodic<const D: usize, const U: usize>: Equations<U> + Sized {
    /// Their period [cycles].
    fn period(&self) -> u64;

    /// The same with another period.
    fn with_period(&self, period: u64) -> Self;

    /// How far the return is from a point, in units of the section.
    fn displacement(&self, at: &[f64; U]) -> Option<[f64; D]>;

    /// How far an orbit moves in half its period, in units of the section; none for an odd period.
    fn halfway(&self, at: &[f64; U]) -> Option<[f64; D]> {
        let even = self.period().is_multiple_of(2);
        even.then(|| self.with_period(self.period() / 2).displacement(at))?
    }

    /// Whether an orbit repeats after no part of its period.
    fn is_whole(&self, at: &[f64; U]) -> bool {
        let mut divisors = (2..=self.period()).filter(|parts| self.is_prime_divisor(*parts));
        !divisors.any(|parts| {
            let apart = self.with_period(self.period() / parts).displacement(at);
            apart.is_some_and(|apart| norm(&apart) <= HALVES)
        })
    }

    /// Whether a number is a prime divisor of the period.
    fn is_prime_divisor(&self, number: u64) -> bool {
        self.period().is_multiple_of(number) && !(2..number).any(|part| number.is_multiple_of(part))
    }

    /// Whether between two orbits of an even period the curve passes one of half the period: what follows
    /// are the same orbits, half a period later.
    fn halves(&self, from: &[f64; U], to: &[f64; U]) -> bool {
        let sides = [from, to].map(|at| self.halfway(at));
        matches!(sides, [Some(before), Some(after)] if dot(&before, &after) < 0.0)
    }

    /// An orbit from each of its section points in turn.
    fn images(&self, point: &CurvePoint<U, Self::Seen>) -> Vec<CurvePoint<U, Self::Seen>> {
        let later = (1..self.period()).filter_map(|cycles| self.image(point, cycles));
        std::iter::once(point.clone()).chain(later).collect()
    }

    /// An orbit from the section point that it reaches after so many cycles.
    fn image(
        &self,
        point: &CurvePoint<U, Self::Seen>,
        cycles: u64,
    ) -> Option<CurvePoint<U, Self::Seen>> {
        let Linear { residual, rows, .. } = self.with_period(cycles).at(&point.at).ok()?;
        let (mut at, mut tangent) = (point.at, point.tangent);
        for i in 0..D {
            at[i] += residual[i];
            tangent[i] += dot(&rows[i], &point.tangent);
        }
        let Linear { rows, seen, .. } = self.at(&at).ok()?;
        Some(CurvePoint { at, tangent: unit(&tangent), rows, seen })
    }
}

/// Whether the curve passes a point between two neighbouring solutions.
///
/// Method: the plane through the point, at right angles to the chord, cuts the curve in a solution that is
/// the point or is not.
pub fn passes<const U: usize, E: Equations<U>>(
    equations: &E,
    [from, to]: [&[f64; U]; 2],
    point: &[f64; U],
) -> bool {
    let chord = between(from, to);
    let step = norm(&chord);
    if step == 0.0 {
        return false;
    }
    let same = SAME.min(SHARE * step);
    let ahead = unit(&chord);
    let along = dot(&ahead, &between(from, point));
    let foot = moved(from, along, &ahead);
    if !(-same..=step + same).contains(&along) || norm(&between(&foot, point)) > step {
        return false;
    }
    let met = corrected(equations, &Plane::through(point, ahead), &foot, &ahead);
    met.is_some_and(|(met, _)| norm(&between(&met.at, point)) <= same)
}

/// Where a curve closes: at a solution known to lie on it, from whichever of its section points.
#[derive(Debug, Clone)]
pub struct Goal<const U: usize, T>(Vec<CurvePoint<U, T>>);

impl<const U: usize, T: Clone> Goal<U, T> {
    /// No goal: the curve is not followed until it closes.
    pub fn none() -> Self {
        Goal(Vec::new())
    }

    /// The goal at a solution whose tangent is the direction of arrival.
    pub fn at<const D: usize, E: Periodic<D, U, Seen = T>>(
        equations: &E,
        point: &CurvePoint<U, T>,
    ) -> Self {
        Goal(equations.images(point))
    }

    /// The solution at which the curve has closed between two that are `steps` from its beginning.
    pub fn met<const D: usize, E: Periodic<D, U, Seen = T>>(
        &self,
        equations: &E,
        [from, to]: [&CurvePoint<U, T>; 2],
        steps: usize,
    ) -> Option<CurvePoint<U, T>> {
        let ahead = between(&from.at, &to.at);
        let met = self.0.iter().find(|goal| {
            dot(&goal.tangent, &ahead) > 0.0 && passes(equations, [&from.at, &to.at], &goal.at)
        });
        met.filter(|_| steps >= LEAST_STEPS).cloned()
    }
}
