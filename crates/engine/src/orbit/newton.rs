//! Newton's method on the return map: from a section point near a periodic orbit onto it.

use crate::flow::{Metric, Reason};

use super::matrix::{Matrix, less_identity, solve};
use super::precision::{NEARBY, ROUNDING};
use super::return_map::Image;

/// Corrections at most: from where the section repeats, two are usual.
const CORRECTIONS: usize = 8;

/// A point of a periodic orbit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closed<const D: usize> {
    /// The point.
    pub point: [f64; D],
    /// How far its image is from it, relative to the motion [-].
    pub residual: f64,
    /// The derivative of the image.
    pub jacobian: Matrix<D>,
    /// How far it is from where the search began, relative to the motion [-].
    pub moved: f64,
    /// How far the image of the point where the search began is from that point, relative to the motion [-].
    pub first_residual: f64,
    /// How far the true orbit may be: the next correction, relative to the motion [-].
    pub error: f64,
    /// Cycles followed in all.
    pub cycles: u64,
}

/// The periodic orbit nearest to `start` under a map over `cycles`, or the point nearest to one that was
/// met before Newton's method left the neighbourhood; none where the first derivative is singular already.
///
/// `size` is that of the motion, in the units of the metric. Method: s <- s + (I - J)^-1 (P(s) -
/// s) with the exact Jacobian, until the residual is at rounding or no longer halved; the best point is
/// kept. Error: see [`Closed::error`]. Where the map has a kink (an event falls on another) the steps need
/// not converge, and the residual says so.
pub fn close<const D: usize>(
    image_of: impl Fn(&[f64; D]) -> Result<Image<D>, Reason>,
    cycles: u64,
    metric: &Metric<D>,
    start: &[f64; D],
    size: f64,
) -> Result<Option<Closed<D>>, Reason> {
    let mut point = *start;
    let mut best: Option<Closed<D>> = None;
    let mut followed = 0;
    let mut first_residual = f64::INFINITY;
    for correction in 0..=CORRECTIONS {
        let Image { end, jacobian } = image_of(&point)?;
        followed += cycles;
        let gap = metric.difference(&end, &point);
        let residual = metric.relative(&gap, size);
        if correction == 0 {
            first_residual = residual;
        }
        let Some(step) = solve(less_identity(&jacobian), gap.map(|x| -x)) else { break };
        let error = metric.relative(&step, size);
        let before = best.map_or(f64::INFINITY, |best| best.residual);
        if residual < before {
            let away = std::array::from_fn(|i| point[i] - start[i]);
            let moved = metric.relative(&away, size);
            best =
                Some(Closed { point, residual, jacobian, moved, first_residual, error, cycles: 0 });
        }
        let away = std::array::from_fn(|i| point[i] + step[i] - start[i]);
        let leaves =
            metric.relative(&away, size).partial_cmp(&NEARBY) != Some(std::cmp::Ordering::Less);
        if residual <= ROUNDING || residual > 0.5 * before || leaves {
            break;
        }
        point = std::array::from_fn(|i| point[i] + step[i]);
    }
    Ok(best.map(|best| Closed { cycles: followed, ..best }))
}
