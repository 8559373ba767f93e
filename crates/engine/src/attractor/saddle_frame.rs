//! A saddle with the directions of its one multiplier beyond 1, from the right and from the left.

use super::edge::Saddle;
use super::manifold::SectionMap;
use crate::orbit::matrix::{Matrix, eigenvalues, solve};

/// Inverse iterations for a vector: each brings it nearer by the distance of the multipliers times a billion.
const ITERATIONS: usize = 6;
/// The multiplier is shifted by this share, so that the matrix is not singular.
const SHIFT: f64 = 1e-9;
/// How far a saddle is pushed along its unstable direction to see where it leads, relative to the motion.
const PUSH: f64 = 1e-6;

/// A section point of a saddle with its directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct SaddlePoint<const D: usize> {
    /// The point.
    pub point: [f64; D],
    /// The unstable direction, of size one in the units of the metric.
    pub unstable: [f64; D],
    /// The left direction, which is zero on the stable subspace and one on the unstable direction.
    pub left: [f64; D],
}

/// A saddle with its directions at each of its section points.
#[derive(Debug, Clone)]
pub(super) struct SaddleFrame<const D: usize> {
    /// Its points, each the image of the one before.
    pub points: Vec<SaddlePoint<D>>,
    /// The multiplier beyond 1.
    pub multiplier: f64,
    /// The attractors to which pushes along the unstable direction and against it lead.
    pub sides: [u32; 2],
    /// The size of the motion [units of the metric].
    pub size: f64,
}

impl<const D: usize> SaddleFrame<D> {
    /// That of a saddle beside motions of a size; none where its multiplier is not above 1, or where pushes to the two sides do
    /// not lead to two known attractors.
    pub fn of(map: &SectionMap<'_, D>, saddle: &Saddle<[f64; D]>, size: f64) -> Option<Self> {
        let images = saddle.points.iter().map(|point| Some((map.image)(point)?.jacobian));
        let jacobians: Vec<Matrix<D>> = images.collect::<Option<_>>()?;
        let size = size.max(map.metric.largest(&saddle.points));
        let multiplier = eigenvalues(&over_period(&jacobians, 0))[0].re;
        if multiplier.is_nan() || multiplier <= 1.0 {
            return None;
        }
        let mut unstable = eigenvector(&over_period(&jacobians, 0), multiplier)?;
        let mut points = Vec::with_capacity(jacobians.len());
        for (place, point) in saddle.points.iter().enumerate() {
            let length = map.metric.length(&unstable);
            unstable = unstable.map(|it| it / length);
            let left = eigenvector(&transposed(&over_period(&jacobians, place)), multiplier)?;
            let along = product_of(&left, &unstable);
            let left = left.map(|it| it / along);
            points.push(SaddlePoint { point: *point, unstable, left });
            unstable = applied(&jacobians[place], &unstable);
        }
        let first = &points[0];
        let pushes = [1.0, -1.0].map(|side| first.moved(side * PUSH * size));
        let leads = (map.leads)(&pushes);
        let sides = [leads[0]?, leads[1]?];
        (sides[0] != sides[1]).then_some(SaddleFrame { points, multiplier, sides, size })
    }

    /// The section point that is nearest to a point, by its place, and how far it is.
    pub fn nearest(&self, map: &SectionMap<'_, D>, point: &[f64; D]) -> (usize, f64) {
        let mut nearest = (0, f64::INFINITY);
        for (place, own) in self.points.iter().enumerate() {
            let distance = map.metric.distance(point, &own.point);
            if distance < nearest.1 {
                nearest = (place, distance);
            }
        }
        nearest
    }

    /// Whether it is the orbit of this saddle.
    pub fn is(&self, map: &SectionMap<'_, D>, saddle: &Saddle<[f64; D]>, within: f64) -> bool {
        self.points.len() == saddle.points.len()
            && saddle.points.iter().all(|it| self.nearest(map, it).1 <= within * self.size)
    }
}

impl<const D: usize> SaddlePoint<D> {
    /// The point so far along the unstable direction [units of the metric].
    pub fn moved(&self, by: f64) -> [f64; D] {
        std::array::from_fn(|i| self.point[i] + by * self.unstable[i])
    }
}

/// The derivative over the period from one of the points on.
fn over_period<const D: usize>(jacobians: &[Matrix<D>], from: usize) -> Matrix<D> {
    let mut all: Matrix<D> = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
    for step in 0..jacobians.len() {
        let next = &jacobians[(from + step) % jacobians.len()];
        all = std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..D).map(|k| next[i][k] * all[k][j]).sum())
        });
    }
    all
}

/// The vector that a matrix turns into itself times a simple real eigenvalue, by inverse iteration.
fn eigenvector<const D: usize>(matrix: &Matrix<D>, value: f64) -> Option<[f64; D]> {
    let mut shifted = *matrix;
    (0..D).for_each(|i| shifted[i][i] -= value * (1.0 + SHIFT));
    let mut vector: [f64; D] = std::array::from_fn(|i| 1.0 / (1.0 + 0.1 * i as f64));
    for _ in 0..ITERATIONS {
        let next = solve(shifted, vector)?;
        let size = next.iter().fold(0.0, |size: f64, it| size.max(it.abs()));
        vector = next.map(|it| it / size);
    }
    Some(vector)
}

fn transposed<const D: usize>(a: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// The image of a vector under a matrix.
pub(super) fn applied<const D: usize>(a: &Matrix<D>, vector: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| (0..D).map(|j| a[i][j] * vector[j]).sum())
}

/// The inner product.
pub(super) fn product_of<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
