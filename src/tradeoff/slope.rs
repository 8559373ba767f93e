//! The slope that constraints leave.

use crate::orbit::matrix::{dot, norm, solve};

use super::quadratic::{MOST, PLANES, Vector};

/// Constraints that hold at once at most: a bound of each parameter, and the planes.
const HOLDING: usize = MOST + PLANES;
/// A constraint that would take less than this off the square of the slope, relative to it, does not hold.
const ROUNDING: f64 = 1e-15;

/// What constraints with these normals leave of a gradient: g + sum of m a with multipliers m >= 0, the least in length,
/// and the multipliers.
///
/// # Method
///
/// The active sets of Lawson and Hanson (Solving Least Squares Problems, 1974, chapter 23).
pub fn left(gradient: &Vector, normals: &[Vector]) -> (Vector, Vec<f64>) {
    let mut set = ActiveSet::empty(gradient, normals);
    // A set that has been left does not come back, so that there are fewer steps than sets.
    for _ in 0..1_usize << HOLDING {
        let Some(next) = set.entering() else { break };
        set.enter(next);
    }
    (set.slope(), set.multipliers)
}

/// The constraints that hold, on the way to those that leave the least slope.
struct ActiveSet<'a> {
    gradient: &'a Vector,
    normals: &'a [Vector],
    /// The multiplier of each constraint, zero of one that does not hold.
    multipliers: Vec<f64>,
    /// Which constraints hold.
    holds: Vec<bool>,
    /// Those that rounding alone would let in.
    refused: Vec<bool>,
}

impl<'a> ActiveSet<'a> {
    /// None yet of the constraints with these normals.
    fn empty(gradient: &'a Vector, normals: &'a [Vector]) -> Self {
        let count = normals.len();
        let (holds, refused) = (vec![false; count], vec![false; count]);
        ActiveSet { gradient, normals, multipliers: vec![0.0; count], holds, refused }
    }

    /// The slope that is left.
    fn slope(&self) -> Vector {
        std::array::from_fn(|i| {
            let held = self.normals.iter().zip(&self.multipliers);
            self.gradient[i] + held.map(|(a, m)| a[i] * m).sum::<f64>()
        })
    }

    /// The constraint that takes most off the slope; none where none takes any.
    fn entering(&self) -> Option<usize> {
        let slope = self.slope();
        let gains: Vec<f64> = self.normals.iter().map(|normal| -dot(&slope, normal)).collect();
        let least = ROUNDING * norm(self.gradient);
        (0..gains.len())
            .filter(|&place| {
                let is_out = !self.holds[place] && !self.refused[place];
                is_out && gains[place] > least * norm(&self.normals[place])
            })
            .max_by(|&a, &b| gains[a].total_cmp(&gains[b]))
    }

    /// Lets a constraint in, and those out that then would pull instead of push.
    fn enter(&mut self, next: usize) {
        self.holds[next] = true;
        loop {
            let Some(wanted) = self.stationary() else {
                (self.holds[next], self.refused[next]) = (false, true);
                return;
            };
            let stops = (0..wanted.len()).filter(|&i| self.holds[i] && wanted[i] <= 0.0);
            let shares = stops.map(|i| {
                let from = self.multipliers[i];
                (i, from / (from - wanted[i]))
            });
            let Some((first, by)) = shares.min_by(|a, b| a.1.total_cmp(&b.1)) else {
                self.multipliers = wanted;
                return;
            };
            for (multiplier, wanted) in self.multipliers.iter_mut().zip(&wanted) {
                *multiplier += by * (wanted - *multiplier);
            }
            self.multipliers[first] = 0.0;
            self.holds[first] = false;
            if first == next {
                self.refused[next] = true;
                return;
            }
        }
    }

    /// The multipliers of those that hold which leave the least slope, whatever their signs.
    fn stationary(&self) -> Option<Vec<f64>> {
        let normals = self.normals;
        let held: Vec<usize> = (0..normals.len()).filter(|&place| self.holds[place]).collect();
        let (mut rows, mut right) = ([[0.0; HOLDING]; HOLDING], [0.0; HOLDING]);
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        for (i, &a) in held.iter().enumerate() {
            for (j, &b) in held.iter().enumerate() {
                rows[i][j] = dot(&normals[a], &normals[b]);
            }
            right[i] = -dot(&normals[a], self.gradient);
        }
        let solution = solve(rows, right)?;
        let mut wanted = vec![0.0; normals.len()];
        for (value, place) in solution.iter().zip(held) {
            wanted[place] = *value;
        }
        Some(wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The vector with these first parts.
    fn vector(parts: &[f64]) -> Vector {
        std::array::from_fn(|i| parts.get(i).copied().unwrap_or(0.0))
    }

    #[test]
    fn what_is_left_is_at_right_angles_to_what_holds_and_downhill_of_nothing() {
        let mut random = fastrand::Rng::with_seed(11);
        for _ in 0..2000 {
            let mut draw = || vector(&[0.0; 4].map(|_| 2.0 * random.f64() - 1.0));
            let gradient = draw();
            let normals: Vec<Vector> = (0..3).map(|_| draw()).collect();
            let (slope, multipliers) = left(&gradient, &normals);
            for (normal, multiplier) in normals.iter().zip(&multipliers) {
                let along = dot(&slope, normal);
                assert!(*multiplier >= 0.0 && along >= -1e-12, "{multiplier} {along}");
                assert!((multiplier * along).abs() < 1e-11, "{multiplier} {along}");
            }
        }
    }

    #[test]
    fn a_gradient_between_two_normals_is_held_by_both() {
        let normals = [vector(&[1.0, 0.0]), vector(&[0.0, 2.0])];
        let (slope, multipliers) = left(&vector(&[-3.0, -4.0]), &normals);
        assert_eq!((slope, multipliers), (vector(&[]), vec![3.0, 2.0]));
        let (slope, multipliers) = left(&vector(&[3.0, -4.0]), &normals);
        assert_eq!((slope, multipliers), (vector(&[3.0]), vec![0.0, 2.0]));
    }
}
