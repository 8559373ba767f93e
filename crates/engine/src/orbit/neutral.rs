//! Families of periodic orbits: a multiplier of one belongs to a direction along which the neighbours are
//! periodic too.

use crate::flow::{Metric, Reason};

use super::matrix::{Complex, Matrix, least_from_one, solve};
use super::precision::{NEARBY, ONE, ROUNDING};
use super::return_map::Image;

/// Neighbours this far away, relative to the motion, must be periodic too.
const BESIDE: f64 = 1e-4;
/// Corrections at most.
const CORRECTIONS: usize = 6;
/// Steps of the inverse iteration: each brings a direction nearer by the ratio of two multipliers' distances
/// from one.
const ITERATIONS: usize = 4;

/// A periodic orbit that belongs to a family.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neutral<const D: usize> {
    /// Its point of the section.
    pub point: [f64; D],
    /// How far its image is from it, relative to the motion [-].
    pub residual: f64,
    /// The derivative of the image.
    pub jacobian: Matrix<D>,
    /// How far it is from where the search began, relative to the motion [-].
    pub moved: f64,
    /// How far the image of the point where the search began is from that point, relative to the motion [-].
    pub first_residual: f64,
    /// The direction of the family, of length one in units of the metric.
    pub direction: [f64; D],
    /// Cycles followed in all.
    pub cycles: u64,
}

/// Whether these are the multipliers of an orbit that may belong to a family.
pub fn may_be_neutral<const D: usize>(multipliers: &[Complex; D]) -> bool {
    least_from_one(multipliers) < ONE
}

/// The periodic orbit nearest to `start` that belongs to a family, whose members repeat to `tolerance`
/// relative to `size`; none where there is no such orbit, or no family.
///
/// Method: Newton's method with the neutral direction v taken out, (I - J + v w^T) d = P(s) - s, where w is
/// that of the transposed matrix (Keller 1977). The neighbours at s +- 1e-4 v are closed in the same
/// way: at a fold, where a multiplier is one without a family, they are left with a residual that grows
/// with the square of the distance.
/// Assumes: the multiplier one is simple; where two coincide, none is returned.
pub fn close_neutral<const D: usize>(
    image_of: impl Fn(&[f64; D]) -> Result<Image<D>, Reason>,
    cycles: u64,
    metric: &Metric<D>,
    start: &[f64; D],
    (size, tolerance): (f64, f64),
) -> Result<Option<Neutral<D>>, Reason> {
    let mut search = Search { image_of, metric, cycles, size, followed: 0 };
    let repeats = |it: &Neutral<D>| it.residual <= tolerance;
    let Some(member) = search.closed(start)?.filter(repeats) else { return Ok(None) };
    for side in [BESIDE, -BESIDE] {
        let beside = std::array::from_fn(|i| {
            member.point[i] + side * size * member.direction[i] / metric.scales[i]
        });
        if search.closed(&beside)?.filter(repeats).is_none() {
            return Ok(None);
        }
    }
    Ok(Some(Neutral { cycles: search.followed, ..member }))
}

/// A search for members of a family.
struct Search<'a, F, const D: usize> {
    image_of: F,
    metric: &'a Metric<D>,
    cycles: u64,
    size: f64,
    followed: u64,
}

impl<F, const D: usize> Search<'_, F, D>
where
    F: Fn(&[f64; D]) -> Result<Image<D>, Reason>,
{
    /// The point nearest to a periodic orbit that was met, with the direction in which it is neutral.
    fn closed(&mut self, start: &[f64; D]) -> Result<Option<Neutral<D>>, Reason> {
        let Metric { scales, .. } = self.metric;
        let mut point = *start;
        let mut best: Option<Neutral<D>> = None;
        let mut first_residual = f64::INFINITY;
        for correction in 0..CORRECTIONS {
            let Image { end, jacobian } = (self.image_of)(&point)?;
            self.followed += self.cycles;
            let gap = self.metric.difference(&end, &point);
            let residual = self.metric.relative(&gap, self.size);
            if correction == 0 {
                first_residual = residual;
            }
            let less: Matrix<D> = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    f64::from(u8::from(i == j)) - jacobian[i][j] * scales[i] / scales[j]
                })
            });
            let Some([direction, across]) = null_directions(&less) else { break };
            let deflated: Matrix<D> = std::array::from_fn(|i| {
                std::array::from_fn(|j| less[i][j] + direction[i] * across[j])
            });
            let scaled = std::array::from_fn(|i| gap[i] * scales[i]);
            let Some(step) = solve(deflated, scaled) else { break };
            let before = best.map_or(f64::INFINITY, |best| best.residual);
            let away = std::array::from_fn(|i| point[i] - start[i]);
            let moved = self.metric.relative(&away, self.size);
            if residual < before {
                best = Some(Neutral {
                    point,
                    residual,
                    jacobian,
                    moved,
                    first_residual,
                    direction,
                    cycles: 0,
                });
            }
            let leaves = moved.partial_cmp(&NEARBY) != Some(std::cmp::Ordering::Less);
            if residual <= ROUNDING || residual > 0.5 * before || leaves {
                break;
            }
            point = std::array::from_fn(|i| point[i] + step[i] / scales[i]);
        }
        Ok(best)
    }
}

/// The directions v and w, of length one, that a nearly singular matrix takes nearest to zero from the right
/// and from the left; none where they are at right angles, so that the zero is not simple.
///
/// Method: inverse iteration with the matrix moved by a little more than its rounding.
fn null_directions<const D: usize>(a: &Matrix<D>) -> Option<[[f64; D]; 2]> {
    let largest = a.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let shift = ONE * ONE * largest.max(1.0);
    let transposed: Matrix<D> = std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]));
    let iterate = |matrix: &Matrix<D>| {
        let moved: Matrix<D> = std::array::from_fn(|i| {
            std::array::from_fn(|j| matrix[i][j] + if i == j { shift } else { 0.0 })
        });
        // Not at right angles to any direction that is likely to be wanted.
        let mut x: [f64; D] = std::array::from_fn(|i| 1.0 / (1.0 + 0.37 * i as f64));
        for _ in 0..ITERATIONS {
            let next = solve(moved, x)?;
            let length = next.iter().map(|x| x * x).sum::<f64>().sqrt();
            x = next.map(|x| x / length);
        }
        Some(x)
    };
    let (v, w) = (iterate(a)?, iterate(&transposed)?);
    let along: f64 = v.iter().zip(&w).map(|(v, w)| v * w).sum();
    let largest =
        v.iter().fold(0.0_f64, |largest, &x| if x.abs() > largest.abs() { x } else { largest });
    // Its largest part is positive, so that the direction does not depend on how it was found.
    (along.abs() > ONE.sqrt()).then_some([v.map(|x| x * largest.signum()), w])
}
