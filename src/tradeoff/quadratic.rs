//! The least value of a quadratic function within a box, below some planes.

use crate::orbit::matrix::{dot, solve};

/// Free parameters at most.
pub const MOST: usize = 6;
/// Limits of outputs at most, each a plane.
pub const LIMITS: usize = 4;
/// Surfaces on which events change at most, each a plane.
pub const SURFACES: usize = 2;
/// Planes at most.
pub const PLANES: usize = LIMITS + SURFACES;
/// Unknowns of the equations of a face: the step and the multipliers of the planes.
const UNKNOWNS: usize = MOST + PLANES;
/// A step may leave the box or pass the plane by so much, as rounding.
const ROUNDING: f64 = 1e-12;

/// A vector over the free parameters; what is beyond them is zero.
pub type Vector = [f64; MOST];

/// Where a quadratic function g d + d H d / 2 is to be least.
#[derive(Debug, Clone, PartialEq)]
pub struct Quadratic {
    /// Free parameters.
    pub count: usize,
    /// The gradient g.
    pub gradient: Vector,
    /// The symmetric matrix H.
    pub hessian: [Vector; MOST],
    /// The box, from its lower to its upper corner; it holds the origin.
    pub bounds: [Vector; 2],
    /// The normal a and the height b of each plane that is not passed, a d <= b; [`PLANES`] at most.
    pub planes: Vec<(Vector, f64)>,
}

/// Where it is least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Least {
    /// The step.
    pub step: Vector,
    /// The value there, relative to the origin.
    pub value: f64,
    /// The multipliers of the planes, zero for those that do not hold the step.
    pub multipliers: [f64; PLANES],
}

impl Quadratic {
    /// The least value; none where the box does not reach below every plane.
    ///
    /// # Method
    ///
    /// On every face of the box, within any of the planes and outside them, the one point at which the function is stationary is
    /// found by linear equations; the best of those that lie in the box and below the planes is the least. H need not be
    /// definite, as corners are faces, too. There are 2^m 3^n faces of n parameters and m planes.
    pub fn least(&self) -> Option<Least> {
        let faces = 3_usize.pow(self.count as u32);
        let mut best: Option<Least> = None;
        for face in 0..faces {
            for held in 0..1_usize << self.planes.len() {
                let Some(found) = self.stationary(face, held) else { continue };
                if best.is_none_or(|best| found.value < best.value) {
                    best = Some(found);
                }
            }
        }
        best
    }

    /// The stationary point of a face within the planes that the bits of `held` name; none outside the box or above a plane.
    fn stationary(&self, face: usize, held: usize) -> Option<Least> {
        let solution = self.solution(face, held)?;
        let step: Vector = std::array::from_fn(|i| solution[i]);
        if !self.allows(&step) {
            return None;
        }
        let step: Vector = std::array::from_fn(|i| match i < self.count {
            true => step[i].clamp(self.bounds[0][i], self.bounds[1][i]),
            false => 0.0,
        });
        let bent: Vector = std::array::from_fn(|i| dot(&self.hessian[i], &step));
        let value = dot(&self.gradient, &step) + 0.5 * dot(&bent, &step);
        let multipliers = std::array::from_fn(|place| solution[MOST + place]);
        Some(Least { step, value, multipliers })
    }

    /// The step and the multipliers of the planes that solve the equations of a face, whose digits to base three say which
    /// parameters are free or at which bound, within the planes that the bits of `held` name.
    fn solution(&self, face: usize, held: usize) -> Option<[f64; UNKNOWNS]> {
        let (mut rows, mut right) = ([[0.0; UNKNOWNS]; UNKNOWNS], [0.0; UNKNOWNS]);
        let mut digits = face;
        for i in 0..MOST {
            let side = if i < self.count { digits % 3 } else { 1 };
            digits /= 3;
            if side == 0 {
                rows[i][..MOST].copy_from_slice(&self.hessian[i]);
                for (place, (normal, _)) in self.planes.iter().enumerate() {
                    rows[i][MOST + place] = if held >> place & 1 == 1 { normal[i] } else { 0.0 };
                }
                right[i] = -self.gradient[i];
            } else {
                rows[i][i] = 1.0;
                right[i] = if i < self.count { self.bounds[side - 1][i] } else { 0.0 };
            }
        }
        for place in 0..PLANES {
            match self.planes.get(place).filter(|_| held >> place & 1 == 1) {
                Some((normal, height)) => {
                    rows[MOST + place][..MOST].copy_from_slice(normal);
                    right[MOST + place] = *height;
                }
                None => rows[MOST + place][MOST + place] = 1.0,
            }
        }
        solve(rows, right)
    }

    /// Whether a step is in the box and below the planes, but for rounding.
    fn allows(&self, step: &Vector) -> bool {
        let inside = (0..self.count).all(|i| {
            step[i] >= self.bounds[0][i] - ROUNDING && step[i] <= self.bounds[1][i] + ROUNDING
        });
        let mut planes = self.planes.iter();
        inside
            && planes.all(|(normal, height)| {
                dot(normal, step) <= height + ROUNDING * (1.0 + height.abs())
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A repeatable number between -1 and 1.
    fn draw(state: &mut u64) -> f64 {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn no_point_of_a_fine_grid_is_below_the_least() {
        let mut state = 7;
        for _ in 0..200 {
            let mut hessian = [[0.0; MOST]; MOST];
            let mut gradient = [0.0; MOST];
            let mut normal = [0.0; MOST];
            for i in 0..2 {
                (gradient[i], normal[i]) = (draw(&mut state), draw(&mut state));
                hessian[i][i] = 3.0 * draw(&mut state);
            }
            let across = std::array::from_fn(|i| if i < 2 { draw(&mut state) } else { 0.0 });
            hessian[0][1] = 3.0 * draw(&mut state);
            hessian[1][0] = hessian[0][1];
            let bounds = [[-0.7, -0.2, 0.0, 0.0, 0.0, 0.0], [0.4, 0.9, 0.0, 0.0, 0.0, 0.0]];
            let height = 0.1 * (1.0 + draw(&mut state));
            let planes = vec![(normal, height), (across, 0.05)];
            let below = |at: &Vector, by: f64| planes.iter().all(|it| dot(&it.0, at) <= it.1 + by);
            let quadratic =
                Quadratic { count: 2, gradient, hessian, bounds, planes: planes.clone() };
            let least = quadratic.least().expect("the origin is allowed");
            assert!(below(&least.step, 1e-9));
            for i in 0..=100 {
                for j in 0..=100 {
                    let mut at = [0.0; MOST];
                    at[0] = -0.7 + 0.011 * f64::from(i);
                    at[1] = -0.2 + 0.011 * f64::from(j);
                    let bent: Vector = std::array::from_fn(|i| dot(&hessian[i], &at));
                    let value = dot(&gradient, &at) + 0.5 * dot(&bent, &at);
                    assert!(
                        !below(&at, 0.0) || value >= least.value - 1e-12,
                        "{quadratic:?} {least:?} {at:?}"
                    );
                }
            }
        }
    }
}
