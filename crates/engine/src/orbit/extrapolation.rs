//! Where a sequence of section points tends to, from the rates at which its differences shrink.

/// Points that a limit is told from.
pub const WINDOW: usize = 6;
/// Directions in which an approach is told: of a section with more coordinates the others have died out.
const DIRECTIONS: usize = 3;
/// Coordinates of a section at most.
const MOST: usize = 8;
/// The rates must hold from one difference to the next this well.
const CONSTANCY: f64 = 1e-4;
/// A direction that adds less than this share to those before it is none of its own.
const INDEPENDENT: f64 = 1e-7;
/// The error of a limit, relative to the distance, at which it is worth going there.
const GAIN: f64 = 0.01;

/// The limit of evenly spaced `points`, oldest first, of an orbit that approaches it in one, two or three
/// directions at steady rates; none where no such rates fit or the points move apart.
///
/// Method: minimal polynomial extrapolation (Cabay and Jackson 1976), which is Newton's method on the
/// return map with the derivative read from the differences u_i of the points themselves. With m
/// directions, c_0 u_i + ... + c_{m-1} u_{i+m-1} + u_{i+m} = 0 for every i; the c fitted to all of
/// them give the limit as the mean of the points weighted with c, and the rates as roots of the
/// polynomial with these coefficients. The least m that fits is used, and all its roots must lie inside
/// the unit circle: an orbit that repels in a direction which the points show is not their limit.
/// Error: the misfit times the distance, over the product of 1 minus each rate.
pub fn limit<const D: usize>(points: &[[f64; D]; WINDOW]) -> Option<[f64; D]> {
    const { assert!(D <= MOST) };
    let differences: [[f64; D]; WINDOW - 1] =
        std::array::from_fn(|i| std::array::from_fn(|j| points[i + 1][j] - points[i][j]));
    let mut fits = (1..=DIRECTIONS.min(D)).filter_map(|m| Fit::new(&differences, m));
    let fit = fits.find(|fit| fit.misfit <= CONSTANCY)?;
    let worth_it = fit.contracts() && fit.misfit <= GAIN * fit.sum();
    worth_it.then(|| fit.mean(&points[WINDOW - 1 - fit.directions..]))
}

/// The relation that the differences fit best with so many directions.
struct Fit {
    /// c_0 to c_{m-1}; c_m is one, and those beyond are zero.
    coefficients: [f64; DIRECTIONS + 1],
    directions: usize,
    /// What is left of the relations, relative to their last terms.
    misfit: f64,
}

impl Fit {
    /// Least squares over all relations, each relative to its last term, by orthogonal columns.
    fn new<const D: usize>(differences: &[[f64; D]; WINDOW - 1], m: usize) -> Option<Fit> {
        let relations = differences.len() - m;
        // Columns 0..m are u_i to u_{i+m-1} of each relation i, column m is u_{i+m}.
        let mut columns = [[0.0; MOST * (WINDOW - 2)]; DIRECTIONS + 1];
        for i in 0..relations {
            let last = norm(&differences[i + m]);
            if last == 0.0 {
                return None;
            }
            for (j, column) in columns.iter_mut().enumerate().take(m + 1) {
                for (k, value) in differences[i + j].iter().enumerate() {
                    column[D * i + k] = value / last;
                }
            }
        }
        let mut triangle = [[0.0; DIRECTIONS + 1]; DIRECTIONS];
        for j in 0..m {
            let length = norm(&columns[j]);
            for before in 0..j {
                let (done, rest) = columns.split_at_mut(j);
                triangle[before][j] = dot(&done[before], &rest[0]);
                subtract(&mut rest[0], triangle[before][j], &done[before]);
            }
            triangle[j][j] = norm(&columns[j]);
            if triangle[j][j] <= INDEPENDENT * length {
                return None;
            }
            let inverse = 1.0 / triangle[j][j];
            columns[j].iter_mut().for_each(|value| *value *= inverse);
        }
        for j in 0..m {
            let (done, rest) = columns.split_at_mut(m);
            triangle[j][m] = dot(&done[j], &rest[0]);
            subtract(&mut rest[0], triangle[j][m], &done[j]);
        }
        let misfit = norm(&columns[m]) / (relations as f64).sqrt();
        let mut coefficients = [0.0; DIRECTIONS + 1];
        coefficients[m] = 1.0;
        for j in (0..m).rev() {
            let known: f64 = (j + 1..m).map(|k| triangle[j][k] * coefficients[k]).sum();
            coefficients[j] = (-triangle[j][m] - known) / triangle[j][j];
        }
        Some(Fit { coefficients, directions: m, misfit })
    }

    /// Whether all roots of the polynomial lie inside the unit circle, by the Schur-Cohn conditions.
    fn contracts(&self) -> bool {
        let [c0, c1, c2, _] = self.coefficients;
        match self.directions {
            1 => c0.abs() < 1.0,
            2 => c0.abs() < 1.0 && c1.abs() < 1.0 + c0,
            _ => {
                c0.abs() < 1.0
                    && 1.0 + c2 + c1 + c0 > 0.0
                    && 1.0 - c2 + c1 - c0 > 0.0
                    && (c0 * c2 - c1).abs() < 1.0 - c0 * c0
            }
        }
    }

    /// The polynomial at one: the product of 1 minus each rate.
    fn sum(&self) -> f64 {
        self.coefficients.iter().sum()
    }

    /// The mean of the last points, weighted with the coefficients.
    fn mean<const D: usize>(&self, points: &[[f64; D]]) -> [f64; D] {
        let sum = self.sum();
        let newest = points[self.directions];
        // Relative to the newest point, so that coordinates which stand still keep their bits.
        std::array::from_fn(|j| {
            let weighted = points.iter().zip(&self.coefficients);
            let shift: f64 = weighted.map(|(point, c)| c * (point[j] - newest[j])).sum();
            newest[j] + shift / sum
        })
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn subtract(from: &mut [f64], factor: f64, what: &[f64]) {
    for (value, other) in from.iter_mut().zip(what) {
        *value -= factor * other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of s -> limit + A (s - limit), with the eigenvalues of A on its diagonal.
    fn points(rates: [f64; 3]) -> [[f64; 3]; WINDOW] {
        let a = [[rates[0], 0.3, -0.2], [0.0, rates[1], 0.4], [0.0, 0.0, rates[2]]];
        let mut deviation = [1e-4, -2e-4, 1.5e-4];
        std::array::from_fn(|_| {
            let point = std::array::from_fn(|j| LIMIT[j] + deviation[j]);
            deviation = std::array::from_fn(|i| dot(&a[i], &deviation));
            point
        })
    }

    const LIMIT: [f64; 3] = [0.5, -1.0, 2.0];

    #[test]
    fn a_linear_approach_is_followed_to_its_end() {
        for rates in [[0.9, 0.0, 0.0], [0.9, -0.7, 0.0], [0.95, -0.8, 0.3]] {
            let found = limit(&points(rates)).expect("a limit");
            for (found, exact) in found.iter().zip(LIMIT) {
                assert!((found - exact).abs() < 1e-9, "{rates:?}: {found} {exact}");
            }
        }
    }

    #[test]
    fn a_repelling_direction_has_no_limit() {
        for rates in [[1.1, 0.0, 0.0], [0.5, -1.05, 0.0], [0.9, 0.8, 1.01]] {
            assert_eq!(limit(&points(rates)), None, "{rates:?}");
        }
    }

    #[test]
    fn an_unsteady_approach_has_no_limit_yet() {
        // 1/n shrinks at no steady rate.
        let points = std::array::from_fn(|n| [1.0 / (5.0 + n as f64), 0.0, 0.0]);
        assert_eq!(limit(&points), None);
        assert_eq!(limit(&[[1.0; 3]; WINDOW]), None);
    }
}
