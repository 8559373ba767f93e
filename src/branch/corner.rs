//! Round a corner: where the return map has a kink, a branch may go on in a direction that nothing before
//! it shows.

use super::arclength::{Equations, Station, between, dot, tangent, unit};
use super::walk::{Stride, Walk};

/// How far from the corner the map is looked at.
const RADII: [f64; 4] = [1e-8, 1e-7, 1e-6, 1e-5];
/// Lengths of the first step, in these radii.
const FIRST_STEPS: [f64; 2] = [100.0, 10.0];
/// A direction this close to the one behind leads back.
const BACK: f64 = -0.99;

/// A corner with its new tangent, and the first step from it.
pub type Rounded<S> = (S, Stride<S>);

/// The solution at which the branch goes on, with the first step beyond it.
///
/// Method: around the corner the map is looked at on every side; the tangents that its derivatives have
/// there are tried, ahead and behind. None where each of them leads back or nowhere.
pub fn rounded<const U: usize, E: Equations<U>>(
    equations: &E,
    walk: &Walk<U>,
    corner: &Station<U, E::Seen>,
) -> Option<Rounded<Station<U, E::Seen>>> {
    for radius in RADII {
        for side in 0..2 * U {
            let by = if side < U { radius } else { -radius };
            let mut beside = corner.at;
            beside[side % U] += by;
            let Ok(linear) = equations.at(&beside) else { continue };
            let Some(ahead) = tangent(linear.rows, &corner.tangent) else { continue };
            let goes_on = [1.0, -1.0].into_iter().find_map(|sign| {
                let start = Station { tangent: ahead.map(|part| sign * part), ..corner.clone() };
                let step = first_step(equations, walk, &start, radius, &corner.tangent)?;
                Some((start, step))
            });
            if goes_on.is_some() {
                return goes_on;
            }
        }
    }
    None
}

fn first_step<const U: usize, E: Equations<U>>(
    equations: &E,
    walk: &Walk<U>,
    start: &Station<U, E::Seen>,
    radius: f64,
    arrived: &[f64; U],
) -> Option<Stride<Station<U, E::Seen>>> {
    FIRST_STEPS.into_iter().find_map(|length| {
        let (stride, _) = walk.attempt(equations, start, length * radius)?;
        let (Stride::Inside(met) | Stride::AtBound(met)) = &stride else { return None };
        let leaves = unit(&between(&start.at, &met.at));
        let far = dot(&between(&start.at, &met.at), &leaves) > radius;
        (far && dot(&leaves, arrived) > BACK).then_some(stride)
    })
}
