//! The map from one section point to a later one, with its derivatives.

use crate::flow::{Motion, Step};
use crate::lane::{Dual, Lane};
use crate::model::Stroboscopic;

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
/// Method: the motion is followed in numbers that carry their derivatives, event times included. Error: that of the
/// motion. Where an event falls on another or a guard is only touched, the map has a kink or a corner, and
/// the derivatives are those of the side that the motion takes.
pub fn returned<S, const D: usize, const N: usize>(
    system: &S,
    from: DualPoint<D, N>,
    cycles: &Cycles<N>,
    mut see: impl FnMut(&Step<Dual<f64, N>, S>),
) -> Result<DualPoint<D, N>, Reason>
where
    S: Stroboscopic<Dual<f64, N>, D>,
{
    let mut motion = Motion::new(system, Dual::splat(0.0), S::state(from));
    let mut step = Step::default();
    for _ in 0..cycles.count {
        cycle(system, &mut motion, &mut step, cycles, &mut see)?;
    }
    Ok(S::point(&motion.state))
}

/// Follows a motion to the end of a cycle.
pub(super) fn cycle<S, const D: usize, const N: usize>(
    system: &S,
    motion: &mut Motion<Dual<f64, N>, S>,
    step: &mut Step<Dual<f64, N>, S>,
    cycles: &Cycles<N>,
    see: &mut impl FnMut(&Step<Dual<f64, N>, S>),
) -> Result<(), Reason>
where
    S: Stroboscopic<Dual<f64, N>, D>,
{
    for _ in 0..STEPS_PER_CYCLE {
        motion.step(system, cycles.drive_period, cycles.tolerance, step);
        see(step);
        if let Some(breakdown) = motion.breakdown(system, 0) {
            return Err(breakdown.into());
        }
        if cycles.drive_period.le(motion.time) {
            motion.begin_cycle(true);
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
