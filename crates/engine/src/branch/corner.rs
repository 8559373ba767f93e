//! Round a corner: where the return map has a kink, a branch may go on in a direction that nothing before
//! it shows, or end.

use super::arclength::{CurvePoint, Equations, between, dot, tangent, unit};
use super::step_control::{Advance, StepControl};

/// How far from the corner the map is looked at.
const RADII: [f64; 4] = [1e-8, 1e-7, 1e-6, 1e-5];
/// Lengths of the first step, in these radii.
const FIRST_STEPS: [f64; 2] = [100.0, 10.0];
/// A direction this close to the one behind leads back.
const BACK: f64 = -0.99;
/// Derivatives that change by more than this share of the largest so close by have a jump there.
const JUMP: f64 = 1e-2;

/// Whether the equations have a kink or a jump at a solution: whether beside it their derivatives are
/// others.
pub fn is_corner<const U: usize, E: Equations<U>>(
    equations: &E,
    at: &CurvePoint<U, E::Seen>,
) -> bool {
    let rows = at.rows[..U - 1].iter().flatten();
    let size = rows.fold(1.0_f64, |most, x| most.max(x.abs()));
    (0..2 * U).any(|side| {
        let Ok(linear) = equations.at(&beside(&at.at, side, RADII[2])) else { return true };
        let pairs = linear.rows.iter().zip(&at.rows).take(U - 1);
        let changes: Vec<[f64; U]> = pairs.map(|(there, here)| between(here, there)).collect();
        let apart = changes.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        apart > JUMP * size
    })
}

/// A point on one of the sides of another, at a distance.
fn beside<const U: usize>(at: &[f64; U], side: usize, radius: f64) -> [f64; U] {
    let mut beside = *at;
    beside[side % U] += if side < U { radius } else { -radius };
    beside
}

/// A corner with its new tangent, and the first step from it.
pub type Rounded<S> = (S, Advance<S>);

/// The solution at which the branch goes on, with the first step beyond it.
///
/// Method: around the corner the map is looked at on every side; the tangents that its derivatives have
/// there are tried, ahead and behind. None where each of them leads back or nowhere.
pub fn rounded<const U: usize, E: Equations<U>>(
    equations: &E,
    control: &StepControl<U>,
    corner: &CurvePoint<U, E::Seen>,
) -> Option<Rounded<CurvePoint<U, E::Seen>>> {
    for radius in RADII {
        for side in 0..2 * U {
            let Ok(linear) = equations.at(&beside(&corner.at, side, radius)) else { continue };
            let Some(ahead) = tangent(linear.rows, &corner.tangent) else { continue };
            let goes_on = [1.0, -1.0].into_iter().find_map(|sign| {
                let start = CurvePoint { tangent: ahead.map(|part| sign * part), ..corner.clone() };
                let step = first_step(equations, control, &start, radius, &corner.tangent)?;
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
    control: &StepControl<U>,
    start: &CurvePoint<U, E::Seen>,
    radius: f64,
    arrived: &[f64; U],
) -> Option<Advance<CurvePoint<U, E::Seen>>> {
    FIRST_STEPS.into_iter().find_map(|length| {
        let (advance, _) = control.attempt(equations, start, length * radius)?;
        let (Advance::Inside(met) | Advance::AtBound(met)) = &advance else { return None };
        let leaves = unit(&between(&start.at, &met.at));
        let far = dot(&between(&start.at, &met.at), &leaves) > radius;
        (far && dot(&leaves, arrived) > BACK).then_some(advance)
    })
}
