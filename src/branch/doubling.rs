//! From a period doubling onto the branch of twice the period.

use crate::orbit::matrix::Matrix;

use super::arclength::{Equations, Plane, Station, between, corrected, dot, moved, norm, unit};
use super::orbits::{OrbitStation, Orbits, shifted};
use super::periodic::Periodic;

/// First steps off the branch that are tried, as shares of the longest.
const FIRST_STEPS: [f64; 7] = [0.1, 0.03, 0.3, 0.01, 1e-3, 1e-4, 1e-5];
/// On an orbit of twice the period half of it leads to the other side: nearly two steps away.
const OTHER_SIDE: f64 = 1.0;

/// The orbits of twice the period near a period doubling, and the first two: that at the doubling and one
/// off it.
///
/// Method: a step along the eigenvector of -1 at constant parameter, corrected at right angles to it, and
/// accepted if the orbit needs both halves of its period.
pub fn doubled(
    orbits: &Orbits,
    at: &OrbitStation,
    longest: f64,
) -> Option<(Orbits, [OrbitStation; 2])> {
    let [r, y1, y2] = annihilated(&shifted(&at.seen.jacobian, 1.0))?;
    let twice = orbits.with_period(2 * orbits.family.period);
    let tangent = [r, y1, y2, 0.0];
    let linear = twice.at(&at.at).ok()?;
    let start = Station { at: at.at, tangent, rows: linear.rows, seen: linear.seen };
    FIRST_STEPS.into_iter().find_map(|share| {
        let length = share * longest;
        let predicted = moved(&at.at, length, &tangent);
        let plane = Plane::through(&predicted, tangent);
        let (met, _) = corrected(&twice, &plane, &predicted, &tangent)?;
        let near = norm(&between(&predicted, &met.at)) <= length;
        let apart = twice.halfway(&met.at)?;
        let across = -dot(&apart, &[r, y1, y2]) >= OTHER_SIDE * length;
        (near && across).then(|| (twice.clone(), [start.clone(), met]))
    })
}

/// The unit vector that a singular matrix sends to zero: the longest product of two of its rows.
fn annihilated(matrix: &Matrix<3>) -> Option<[f64; 3]> {
    let [a, b, c] = matrix;
    let products = [crossed(a, b), crossed(b, c), crossed(c, a)];
    let longest = products.into_iter().max_by(|a, b| norm(a).total_cmp(&norm(b)))?;
    (norm(&longest) > 0.0).then(|| unit(&longest))
}

fn crossed(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
