//! The map from one section point to a later one, with its derivatives.

use crate::flow::{Motion, Observer, Reason, STEPS_PER_CYCLE, Step, Stroboscopic, System, cycle};
use crate::lane::{Dual, Lane};

use super::matrix::Matrix;

/// A point of the section that is differentiated along `N` directions.
pub type DualPoint<const D: usize, const N: usize> = [Dual<f64, N>; D];

/// How the return map is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycles {
    /// So many of them.
    pub count: u64,
    /// Relative local error of a step.
    pub tolerance: f64,
}

/// The image of a section point, with the derivative of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Image<const D: usize> {
    /// Where the motion returns to.
    pub end: [f64; D],
    /// The Jacobian.
    pub jacobian: Matrix<D>,
}

/// Where `system` is after whole cycles from a point of the section, in any numbers, of which the first lane
/// counts; every step is shown to `see`.
///
/// With numbers that carry derivatives along the point and along the system's parameters it is differentiated
/// along them. Method: the motion is followed in such numbers, event times included; nested derivatives
/// are derivatives of the Jacobian. Error: that of the motion. Where an event falls on another or a guard is
/// only touched, the map has a kink or a corner, and the derivatives are those of the side that the motion
/// takes.
pub fn returned<L, S, const D: usize>(
    system: &S,
    from: [L; D],
    cycles: &Cycles,
    mut see: impl FnMut(&Step<L, S>),
) -> Result<[L; D], Reason>
where
    L: Lane,
    S: Stroboscopic<L, D>,
{
    let mut motion = Motion::new(system, L::splat(0.0), S::state(from));
    let mut step = Step::default();
    for _ in 0..cycles.count {
        cycle(system, &mut motion, &mut step, (STEPS_PER_CYCLE, cycles.tolerance), &mut see)?;
    }
    Ok(S::point(&motion.state))
}

/// The same, every step shown to an observer.
pub fn observed<L, S, const D: usize>(
    system: &S,
    from: [L; D],
    cycles: &Cycles,
    observer: &mut impl Observer<L, S>,
) -> Result<[L; D], Reason>
where
    L: Lane,
    S: Stroboscopic<L, D>,
{
    returned(system, from, cycles, |step| observer.see(system, step))
}

/// Follows a motion from the last of its section points until there are so many; none where it cannot be followed so far.
pub fn append_points<M: System<D>, const D: usize>(
    system: &M,
    points: &mut Vec<[f64; D]>,
    wanted: usize,
    tolerance: f64,
) -> Option<()> {
    let system = system.single();
    let cycles = Cycles { count: 1, tolerance };
    while points.len() < wanted {
        points.push(returned(&system, points[points.len() - 1], &cycles, |_| ()).ok()?);
    }
    Some(())
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
