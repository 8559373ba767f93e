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
    let mut multipliers = vec![0.0; normals.len()];
    let mut holds = vec![false; normals.len()];
    // Those that rounding alone would let in.
    let mut refused = vec![false; normals.len()];
    let with = |multipliers: &[f64]| -> Vector {
        std::array::from_fn(|i| {
            gradient[i] + normals.iter().zip(multipliers).map(|(a, m)| a[i] * m).sum::<f64>()
        })
    };
    // A set that has been left does not come back, so that there are fewer steps than sets.
    for _ in 0..1_usize << HOLDING {
        let slope = with(&multipliers);
        let gain = |place: usize| -dot(&slope, &normals[place]);
        let least = ROUNDING * norm(gradient);
        let next = (0..normals.len())
            .filter(|&place| {
                !holds[place] && !refused[place] && gain(place) > least * norm(&normals[place])
            })
            .max_by(|&a, &b| gain(a).total_cmp(&gain(b)));
        let Some(next) = next else { break };
        holds[next] = true;
        loop {
            let Some(wanted) = stationary(gradient, normals, &holds) else {
                (holds[next], refused[next]) = (false, true);
                break;
            };
            let stops = (0..normals.len()).filter(|&i| holds[i] && wanted[i] <= 0.0);
            let share = |i: usize| multipliers[i] / (multipliers[i] - wanted[i]);
            let Some(first) = stops.min_by(|&a, &b| share(a).total_cmp(&share(b))) else {
                multipliers = wanted;
                break;
            };
            let by = share(first);
            for i in 0..normals.len() {
                multipliers[i] += by * (wanted[i] - multipliers[i]);
            }
            multipliers[first] = 0.0;
            holds[first] = false;
            if first == next {
                refused[next] = true;
                break;
            }
        }
    }
    (with(&multipliers), multipliers)
}

/// The multipliers of those that hold which leave the least slope, whatever their signs.
fn stationary(gradient: &Vector, normals: &[Vector], holds: &[bool]) -> Option<Vec<f64>> {
    let held: Vec<usize> = (0..normals.len()).filter(|&place| holds[place]).collect();
    let (mut rows, mut right) = ([[0.0; HOLDING]; HOLDING], [0.0; HOLDING]);
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for (i, &a) in held.iter().enumerate() {
        for (j, &b) in held.iter().enumerate() {
            rows[i][j] = dot(&normals[a], &normals[b]);
        }
        right[i] = -dot(&normals[a], gradient);
    }
    let solution = solve(rows, right)?;
    let mut wanted = vec![0.0; normals.len()];
    for (value, place) in solution.iter().zip(held) {
        wanted[place] = *value;
    }
    Some(wanted)
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
