//! Products of pairs of multipliers, by the second compound of a return map's derivative.

use crate::lane::{Dual, Lane};
use crate::orbit::matrix::{Complex, Matrix};

/// A pair of multipliers is so near to the unit circle where it is found to pass it.
const NEAR: f64 = 1e-5;

/// The product of one less each product of two multipliers of a return map, up to its sign, which vanishes where a complex pair
/// passes the unit circle: det(C - I), C the second compound of its derivative (the bialternate product of it with itself).
///
/// Source: Kuznetsov, Elements of Applied Bifurcation Theory (2004), chapter 10; Govaerts, Numerical Methods for Bifurcations of
/// Dynamical Equilibria (2000), chapter 4. Breaks: it vanishes, too, where two real multipliers have the product one (a neutral
/// saddle); [`turns`] tells which.
pub fn torus<L: Lane, const D: usize>(jacobian: &[[L; D]; D]) -> L {
    let j = jacobian;
    let pairs: Vec<(usize, usize)> = (0..D).flat_map(|a| (a + 1..D).map(move |b| (a, b))).collect();
    let rows = pairs.iter().enumerate().map(|(row, &(a, b))| {
        let minors = pairs.iter().map(|&(c, d)| j[a][c] * j[b][d] - j[a][d] * j[b][c]);
        let mut minors: Vec<L> = minors.collect();
        minors[row] = minors[row] - L::splat(1.0);
        minors
    });
    pivoted_determinant(rows.collect())
}

/// The sum of the two multipliers whose product is one, of an orbit that has two such.
///
/// Method: with the derivative J + e I that product changes by e times the sum, with (1 + e) J by 2 e, and det(C - I) by as much times
/// the same number.
pub fn pair_sum<const D: usize>(jacobian: &Matrix<D>) -> f64 {
    let seeded: [[Dual<f64, 2>; D]; D] = std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let value = jacobian[i][j];
            Dual { value, gradient: [f64::from(u8::from(i == j)), value] }
        })
    });
    let [added, scaled] = torus(&seeded).gradient;
    2.0 * added / scaled
}

/// The product of all multipliers but one, each less `one`, of an orbit that has the multiplier `one`.
pub fn others_less<const D: usize>(jacobian: &Matrix<D>, one: f64) -> f64 {
    let rows = (0..D).map(|i| {
        let row = (0..D).map(|j| {
            let diagonal = f64::from(u8::from(i == j));
            Dual { value: jacobian[i][j] - one * diagonal, gradient: [diagonal] }
        });
        row.collect()
    });
    let [slope] = pivoted_determinant(rows.collect()).gradient;
    slope
}

/// Whether the pair of multipliers whose product is nearest to one is complex.
pub fn turns(multipliers: &[Complex]) -> bool {
    let complex = multipliers.iter().filter(|multiplier| multiplier.im != 0.0);
    complex.map(|multiplier| (multiplier.abs() - 1.0).abs()).any(|away| away < NEAR)
}

/// The determinant, by elimination with the largest pivot of all rows and columns that are left.
///
/// Serves numbers with derivatives, of a matrix that is singular, too: the pivot that vanishes comes last, and is divided by nothing.
/// Where two vanish, so do all derivatives.
fn pivoted_determinant<L: Lane>(mut rows: Vec<Vec<L>>) -> L {
    let count = rows.len();
    let mut product = L::splat(1.0);
    for place in 0..count {
        let places = (place..count).flat_map(|i| (place..count).map(move |j| (i, j)));
        let size = |(i, j): (usize, usize)| rows[i][j].lane(0).abs();
        let pivot = places.max_by(|a, b| size(*a).total_cmp(&size(*b)));
        let Some((row, column)) = pivot else { break };
        if size((row, column)) == 0.0 && place + 1 < count {
            return L::splat(0.0);
        }
        rows.swap(place, row);
        rows.iter_mut().for_each(|row| row.swap(place, column));
        let is_odd = (row != place) != (column != place);
        let pivot = if is_odd { -rows[place][place] } else { rows[place][place] };
        product = product * pivot;
        let (above, below) = rows.split_at_mut(place + 1);
        let upper = &above[place];
        for row in below {
            let factor = row[place] / upper[place];
            for (value, upper) in row.iter_mut().zip(upper).skip(place + 1) {
                *value = *value - factor * *upper;
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::matrix::expanded_determinant;

    /// A matrix of four rows with the multipliers of the diagonal block of a rotation, and two others, in other coordinates.
    fn mixed(modulus: f64, angle: f64, others: [f64; 2]) -> Matrix<4> {
        let (sin, cos) = (modulus * libm::sin(angle), modulus * libm::cos(angle));
        let rows = [
            [cos, -sin, 0.3, 0.1],
            [sin, cos, -0.2, 0.7],
            [0.0, 0.0, others[0], 0.4],
            [0.0, 0.0, 0.0, others[1]],
        ];
        // x_0 += 2 x_3, x_3 -= x_1: shears keep the multipliers.
        sheared(&sheared(&rows, (0, 3), 2.0), (3, 1), -1.0)
    }

    /// S A S^-1 with S = I + `by` at one place.
    fn sheared(a: &Matrix<4>, (to, from): (usize, usize), by: f64) -> Matrix<4> {
        let mut a = *a;
        let other = a[from];
        for (own, other) in a[to].iter_mut().zip(other) {
            *own += by * other;
        }
        for row in &mut a {
            row[from] -= by * row[to];
        }
        a
    }

    #[test]
    fn products_of_pairs_are_those_of_the_multipliers() {
        let (modulus, angle, [a, b]) = (1.2, 0.7, [0.4, -1.7]);
        let j = mixed(modulus, angle, [a, b]);
        let square = modulus * modulus;
        let with =
            |other: f64| 1.0 - 2.0 * modulus * libm::cos(angle) * other + square * other * other;
        let expected = (square - 1.0) * (a * b - 1.0) * with(a) * with(b);
        assert!((torus(&j) - expected).abs() < 1e-13, "{} {expected}", torus(&j));
    }

    #[test]
    fn the_sum_of_a_pair_is_known_where_its_product_is_one() {
        let j = mixed(1.0, 0.7, [0.4, -1.7]);
        assert!((pair_sum(&j) - 2.0 * libm::cos(0.7)).abs() < 1e-13);
        // Where the two coincide the multipliers are known to half the digits alone, and their sum to all.
        let j = mixed(1.0, 1e-9, [0.4, -1.7]);
        assert!((pair_sum(&j) - 2.0).abs() < 1e-13);
    }

    #[test]
    fn the_other_multipliers_are_told_from_one_that_vanishes() {
        let j = mixed(0.8, 0.7, [1.0, -1.7]);
        let pair = 0.64 - 1.6 * libm::cos(0.7) + 1.0;
        assert!((others_less(&j, 1.0) - pair * -2.7).abs() < 1e-13);
    }

    #[test]
    fn a_pivot_of_any_place_serves() {
        let a = [[0.0, 2.0, 1.0], [0.0, 0.5, -3.0], [4.0, 1.0, 0.0]];
        let by_rows = expanded_determinant(&a, &[0, 1, 2]);
        let rows = a.iter().map(|row| row.to_vec()).collect();
        assert!((pivoted_determinant(rows) - by_rows).abs() < 1e-14);
        assert_eq!(pivoted_determinant(vec![vec![0.0, 0.0], vec![0.0, 0.0]]), 0.0);
    }
}
