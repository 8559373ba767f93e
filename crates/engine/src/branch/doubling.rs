//! From a period doubling onto the branch of twice the period.

use crate::flow::System;
use crate::orbit::matrix::{Matrix, expanded_determinant};

use super::arclength::{CurvePoint, Equations, Plane, between, corrected, dot, moved, norm, unit};
use super::orbits::{OrbitPoint, Orbits, shifted};
use super::periodic::Periodic;

/// The orbits of twice the period, and the first two of them.
pub type Doubled<'a, M, const D: usize, const U: usize> =
    (Orbits<'a, M, D, U>, [OrbitPoint<<M as System<D>>::Event, D, U>; 2]);

/// First steps off the branch that are tried: short, so that nothing happens on them.
const FIRST_STEPS: [f64; 9] = [1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-4, 1e-3, 3e-3, 1e-2];
/// How far the first orbit is from where the step leads, as a share of the step: where no step is so short that the branch
/// hardly bends on it, the shortest on which it is found at all is taken.
const CORRECTIONS: [f64; 2] = [0.1, 1.0];
/// On an orbit of twice the period half of it leads to the other side: nearly two steps away.
const OTHER_SIDE: f64 = 1.0;

/// The orbits of twice the period near a period doubling, and the first two: that at the doubling and one
/// off it.
///
/// Method: a step along the eigenvector of -1 at constant parameter, corrected at right angles to it, and
/// accepted if the orbit needs both halves of its period.
pub fn doubled<'a, M: System<D>, const D: usize, const U: usize>(
    orbits: &Orbits<'a, M, D, U>,
    at: &OrbitPoint<M::Event, D, U>,
) -> Option<Doubled<'a, M, D, U>> {
    let direction = annihilated(&shifted(&at.seen.jacobian, 1.0))?;
    let twice = orbits.with_period(2 * orbits.family.period);
    let tangent: [f64; U] = std::array::from_fn(|i| *direction.get(i).unwrap_or(&0.0));
    let linear = twice.at(&at.at).ok()?;
    let start = CurvePoint { at: at.at, tangent, rows: linear.rows, seen: linear.seen };
    CORRECTIONS.into_iter().find_map(|most| {
        FIRST_STEPS.into_iter().find_map(|length| {
            let predicted = moved(&at.at, length, &tangent);
            let plane = Plane::through(&predicted, tangent);
            let (met, _) = corrected(&twice, &plane, &predicted, &tangent)?;
            let near = norm(&between(&predicted, &met.at)) <= most * length;
            let apart = twice.halfway(&met.at)?;
            let across = -dot(&apart, &direction) >= OTHER_SIDE * length;
            (near && across).then(|| (twice.clone(), [start.clone(), met]))
        })
    })
}

/// The unit vector that a singular matrix sends to zero: the longest row of cofactors.
fn annihilated<const D: usize>(matrix: &Matrix<D>) -> Option<[f64; D]> {
    // Begun with the last row, of rows of equal length the last counts.
    let rows = (0..D).map(|i| cofactors(matrix, (i + D - 1) % D));
    let longest = rows.max_by(|a, b| norm(a).total_cmp(&norm(b)))?;
    (norm(&longest) > 0.0).then(|| unit(&longest))
}

/// The cofactors of a row.
fn cofactors<const D: usize>(matrix: &Matrix<D>, row: usize) -> [f64; D] {
    let rows: Vec<[f64; D]> = (0..D).filter(|i| *i != row).map(|i| matrix[i]).collect();
    std::array::from_fn(|column| {
        let columns: Vec<usize> = (0..D).filter(|j| *j != column).collect();
        let minor = expanded_determinant(&rows, &columns);
        if (row + column).is_multiple_of(2) { minor } else { -minor }
    })
}
