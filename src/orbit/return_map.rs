//! The map from one section point to a later one, with its derivatives.

use crate::capsule::{Stroboscopic, Switched};
use crate::flow::{Motion, Step};
use crate::lane::{Dual, Lane, Mask};

use super::Reason;
use super::matrix::Matrix;
use super::trajectory::STEPS_PER_CYCLE;

/// A point of the section that is differentiated along `N` directions.
pub type DualPoint<const D: usize, const N: usize> = [Dual<f64, N>; D];

/// How the return map is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycles<const N: usize> {
    /// Duration of a cycle of the drive [s]; it has derivatives where the frequency is a direction.
    pub drive_period: Dual<f64, N>,
    /// So many of them.
    pub count: u64,
    /// Relative local error of a step.
    pub tolerance: f64,
}

/// Where `system` is after whole cycles from a point of the section, differentiated along the `N` directions
/// of the point and of the system's parameters; every step is shown to `see`.
///
/// Method: the motion is followed in numbers that carry their derivatives, event times included. Error:
/// that of the motion. Where an event falls on another or a guard is only touched, the map has a kink or a
/// corner, and the derivatives are those of the side that the motion takes.
pub fn returned<S, const D: usize, const N: usize>(
    system: &S,
    from: DualPoint<D, N>,
    cycles: &Cycles<N>,
    see: impl FnMut(&Step<Dual<f64, N>, S>),
) -> Result<DualPoint<D, N>, Reason>
where
    S: Stroboscopic<Dual<f64, N>, D>,
{
    let Cycles { drive_period, count, tolerance } = *cycles;
    returned_in(system, from, (drive_period, count), tolerance, see)
}

/// The same in any numbers, of which the first lane counts; nested derivatives are derivatives of the
/// Jacobian.
pub fn returned_in<L, S, const D: usize>(
    system: &S,
    from: [L; D],
    (drive_period, count): (L, u64),
    tolerance: f64,
    mut see: impl FnMut(&Step<L, S>),
) -> Result<[L; D], Reason>
where
    L: Lane,
    S: Stroboscopic<L, D>,
{
    let mut motion = Motion::new(system, L::splat(0.0), S::state(from));
    let mut step = Step::default();
    for _ in 0..count {
        cycle(system, &mut motion, &mut step, (drive_period, tolerance), &mut see)?;
    }
    Ok(S::point(&motion.state))
}

/// Follows a motion to the end of a cycle.
pub(super) fn cycle<L: Lane, S: Switched<L>>(
    system: &S,
    motion: &mut Motion<L, S>,
    step: &mut Step<L, S>,
    (drive_period, tolerance): (L, f64),
    see: &mut impl FnMut(&Step<L, S>),
) -> Result<(), Reason> {
    for _ in 0..STEPS_PER_CYCLE {
        motion.step(system, drive_period, tolerance, step);
        see(step);
        if let Some(breakdown) = motion.breakdown(system, 0) {
            return Err(breakdown.into());
        }
        if drive_period.le(motion.time).lane(0) {
            motion.begin_cycle(L::Mask::splat(true));
            return Ok(());
        }
    }
    Err(Reason::TooManySteps)
}

/// A point of the section, every coordinate a direction; directions beyond are left to parameters.
pub fn seeded<const D: usize, const N: usize>(point: &[f64; D]) -> DualPoint<D, N> {
    std::array::from_fn(|i| Dual::variable(point[i], i))
}

/// The numbers of a point.
pub fn values<const D: usize, const N: usize>(point: &DualPoint<D, N>) -> [f64; D] {
    point.map(|coordinate| coordinate.value)
}

/// The derivatives of a point along the first `D` directions: the Jacobian where those are the coordinates.
pub fn jacobian<const D: usize, const N: usize>(point: &DualPoint<D, N>) -> Matrix<D> {
    point.map(|coordinate| std::array::from_fn(|i| coordinate.gradient[i]))
}
