//! Curves of solutions by pseudo-arclength: the corrector and the tangent.

use crate::flow::Reason;
use crate::orbit::matrix::{Matrix, solve};

pub use crate::orbit::matrix::{dot, norm};

/// Newton's steps at most.
const PATIENCE: usize = 12;
/// A residual below this is not worth another step.
pub const EXACT: f64 = 1e-14;
/// A residual that has ceased to shrink is rounding below this.
pub const ROUNDING: f64 = 1e-11;
/// A residual has ceased to shrink if it keeps this share.
const SHRINKS: f64 = 0.3;
/// No unknown may move farther than this from the guess.
pub const FARTHEST: f64 = 0.5;

/// U - 1 equations for `U` unknowns, whose solutions are a curve.
pub trait Equations<const U: usize> {
    /// What else is seen of a solution.
    type Seen: Clone;

    /// A residual below this is not worth another step of Newton's method.
    fn exact(&self) -> f64 {
        EXACT
    }

    /// The equations at these unknowns.
    fn at(&self, unknowns: &[f64; U]) -> Result<Linear<U, Self::Seen>, Reason>;

    /// Whether a solution belongs to the curve of another rather than to one that crosses it.
    fn belongs(&self, from: &CurvePoint<U, Self::Seen>, met: &CurvePoint<U, Self::Seen>) -> bool;
}

/// Equations with their derivatives at a point.
#[derive(Debug, Clone)]
pub struct Linear<const U: usize, T> {
    /// What the equations leave; the last place is free for a condition.
    pub residual: [f64; U],
    /// Their derivatives; the last row is free for the condition's.
    pub rows: Matrix<U>,
    /// What else is seen.
    pub seen: T,
}

/// The condition that picks one solution: `normal . unknowns = offset`.
#[derive(Debug, Clone, Copy)]
pub struct Plane<const U: usize> {
    /// Its normal.
    pub normal: [f64; U],
    /// Its place along the normal.
    pub offset: f64,
}

impl<const U: usize> Plane<U> {
    /// The plane with this normal through a point.
    pub fn through(point: &[f64; U], normal: [f64; U]) -> Self {
        Plane { normal, offset: dot(&normal, point) }
    }

    /// The plane on which one unknown has a value.
    pub fn fixing(unknown: usize, value: f64) -> Self {
        let mut normal = [0.0; U];
        normal[unknown] = 1.0;
        Plane { normal, offset: value }
    }
}

/// A solution with the direction of the curve there.
#[derive(Debug, Clone)]
pub struct CurvePoint<const U: usize, T> {
    /// The unknowns.
    pub at: [f64; U],
    /// The unit tangent.
    pub tangent: [f64; U],
    /// Derivatives of the equations.
    pub rows: Matrix<U>,
    /// What else is seen.
    pub seen: T,
}

/// The solution in `plane` near `guess`, its tangent on the side of `ahead`, and the steps that it took.
pub fn corrected<const U: usize, E: Equations<U>>(
    equations: &E,
    plane: &Plane<U>,
    guess: &[f64; U],
    ahead: &[f64; U],
) -> Option<(CurvePoint<U, E::Seen>, usize)> {
    corrected_within(equations, plane, Guess { at: guess, farthest: FARTHEST }, ahead)
}

/// Where Newton's method begins.
#[derive(Debug, Clone, Copy)]
pub struct Guess<'a, const U: usize> {
    /// The unknowns there.
    pub at: &'a [f64; U],
    /// No unknown may move farther from there on the way.
    pub farthest: f64,
}

/// The same from a guess that says how far an unknown may move.
pub fn corrected_within<const U: usize, E: Equations<U>>(
    equations: &E,
    plane: &Plane<U>,
    guess: Guess<'_, U>,
    ahead: &[f64; U],
) -> Option<(CurvePoint<U, E::Seen>, usize)> {
    corrected_by(
        equations,
        |at, _| Some((dot(&plane.normal, at) - plane.offset, plane.normal)),
        guess,
        ahead,
    )
}

/// The solution near `guess` at which a condition vanishes that is given with its derivatives.
///
/// Method: Newton's with exact derivatives, until the residual no longer shrinks. None where it does not get
/// below rounding, or where an unknown gets [`Guess::farthest`] from the guess.
pub fn corrected_by<const U: usize, E: Equations<U>>(
    equations: &E,
    condition: impl Fn(&[f64; U], &E::Seen) -> Option<(f64, [f64; U])>,
    guess: Guess<'_, U>,
    ahead: &[f64; U],
) -> Option<(CurvePoint<U, E::Seen>, usize)> {
    let mut at = *guess.at;
    let mut best: Option<(f64, CurvePoint<U, E::Seen>, usize)> = None;
    for taken in 0..PATIENCE {
        let Ok(Linear { mut residual, mut rows, seen }) = equations.at(&at) else { break };
        let Some((offside, normal)) = condition(&at, &seen) else { break };
        residual[U - 1] = offside;
        let left = residual.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        if !left.is_finite() {
            break;
        }
        let before = best.as_ref().map_or(f64::INFINITY, |(before, ..)| *before);
        if left < before {
            let tangent = tangent(rows, ahead).unwrap_or(*ahead);
            best = Some((left, CurvePoint { at, tangent, rows, seen }, taken));
        }
        if left <= equations.exact() || (before <= ROUNDING && left > SHRINKS * before) {
            break;
        }
        rows[U - 1] = normal;
        let step = solve(rows, residual)?;
        at = std::array::from_fn(|i| at[i] - step[i]);
        if between(guess.at, &at).iter().any(|part| part.abs() > guess.farthest) {
            break;
        }
    }
    let (left, point, taken) = best?;
    (left <= ROUNDING).then_some((point, taken))
}

/// The unit vector that the derivatives send to zero, on the side of `ahead`.
pub fn tangent<const U: usize>(mut rows: Matrix<U>, ahead: &[f64; U]) -> Option<[f64; U]> {
    rows[U - 1] = *ahead;
    let mut right = [0.0; U];
    right[U - 1] = 1.0;
    solve(rows, right).map(|tangent| unit(&tangent))
}

/// The vector at length one.
pub fn unit<const U: usize>(vector: &[f64; U]) -> [f64; U] {
    let length = norm(vector);
    vector.map(|part| part / length)
}

/// The point so far from another in a direction.
pub fn moved<const U: usize>(from: &[f64; U], by: f64, direction: &[f64; U]) -> [f64; U] {
    std::array::from_fn(|i| from[i] + by * direction[i])
}

/// The difference of two points.
pub fn between<const U: usize>(from: &[f64; U], to: &[f64; U]) -> [f64; U] {
    std::array::from_fn(|i| to[i] - from[i])
}
