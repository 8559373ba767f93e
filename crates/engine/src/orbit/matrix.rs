//! Small square matrices: the solution of linear equations, and eigenvalues.

use crate::lane::Lane;

use super::francis;

/// Rows of a square matrix.
pub type Matrix<const D: usize> = [[f64; D]; D];

/// A complex number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// Magnitude.
    pub fn abs(self) -> f64 {
        libm::hypot(self.re, self.im)
    }
}

/// The least distance of a multiplier from one, over which a residual is how far the orbit is.
pub fn least_from_one(multipliers: &[Complex]) -> f64 {
    let from_one = multipliers.iter().map(|it| libm::hypot(1.0 - it.re, it.im));
    from_one.fold(f64::INFINITY, f64::min)
}

/// The solution x of `a x = b`, by elimination with the largest pivot; none where a pivot vanishes.
pub fn solve<const D: usize>(mut a: Matrix<D>, mut b: [f64; D]) -> Option<[f64; D]> {
    for column in 0..D {
        let size = |row: &usize| a[*row][column].abs();
        let pivot = (column..D).max_by(|i, j| size(i).total_cmp(&size(j)))?;
        a.swap(column, pivot);
        b.swap(column, pivot);
        if a[column][column] == 0.0 || !a[column][column].is_finite() {
            return None;
        }
        for row in column + 1..D {
            let factor = a[row][column] / a[column][column];
            let (above, below) = a.split_at_mut(row);
            for (value, upper) in below[0].iter_mut().zip(&above[column]).skip(column) {
                *value -= factor * upper;
            }
            b[row] -= factor * b[column];
        }
    }
    for row in (0..D).rev() {
        let known: f64 = (row + 1..D).map(|j| a[row][j] * b[j]).sum();
        b[row] = (b[row] - known) / a[row][row];
    }
    b.iter().all(|x| x.is_finite()).then_some(b)
}

/// The inner product.
pub fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The length of a vector.
pub fn norm<const D: usize>(vector: &[f64; D]) -> f64 {
    dot(vector, vector).sqrt()
}

/// A matrix less the identity.
pub fn less_identity<const D: usize>(a: &Matrix<D>) -> Matrix<D> {
    let mut result = *a;
    for (i, row) in result.iter_mut().enumerate() {
        row[i] -= 1.0;
    }
    result
}

/// The determinant, by the same elimination.
pub fn determinant<const D: usize>(mut a: Matrix<D>) -> f64 {
    let mut product = 1.0;
    for column in 0..D {
        let size = |row: &usize| a[*row][column].abs();
        let pivot = (column..D).max_by(|i, j| size(i).total_cmp(&size(j))).unwrap_or(column);
        if pivot != column {
            a.swap(column, pivot);
            product = -product;
        }
        product *= a[column][column];
        if product == 0.0 {
            return 0.0;
        }
        for row in column + 1..D {
            let factor = a[row][column] / a[column][column];
            let (above, below) = a.split_at_mut(row);
            for (value, upper) in below[0].iter_mut().zip(&above[column]).skip(column) {
                *value -= factor * upper;
            }
        }
    }
    product
}

/// The determinant of as many `columns` as there are rows, expanded along the first row.
///
/// Without divisions and choices, so that it serves numbers with derivatives, and a matrix that is singular.
///
/// # Panics
/// Where there are fewer columns than rows.
pub fn expanded_determinant<L: Lane, const D: usize>(rows: &[[L; D]], columns: &[usize]) -> L {
    let Some((first, below)) = rows.split_first() else { return L::splat(1.0) };
    let term = |column: usize| {
        let others: Vec<usize> = columns.iter().copied().filter(|other| *other != column).collect();
        first[column] * expanded_determinant(below, &others)
    };
    let mut sum = term(columns[0]);
    for (place, column) in columns.iter().enumerate().skip(1) {
        let term = term(*column);
        sum = if place.is_multiple_of(2) { sum + term } else { sum - term };
    }
    sum
}

/// The eigenvalues of a square matrix, the largest magnitude first, then the larger real part, then the
/// larger imaginary part.
///
/// Method: with at most three rows the roots of the characteristic polynomial in closed form, a real root
/// polished by Newton's method before it is divided out; with more the double-shift QR iteration of Francis on
/// the balanced matrix. Source: of the iteration, the file `francis`.
/// Error: rounding relative to the largest magnitude, larger where roots coincide (an eigenvalue that is
/// defective to order n is known to the n-th root of a rounding); a matrix that loses rank has roots which are
/// exactly or nearly zero. Guarantees: the two of a complex pair are exactly conjugate.
/// Breaks: NaN for all where an entry is not finite, and for those that the iteration does not find, which did
/// not occur among two million random matrices; they come first.
pub fn eigenvalues<const D: usize>(a: &Matrix<D>) -> [Complex; D] {
    if D <= 3 {
        return in_closed_form(a);
    }
    let mut roots = francis::eigenvalues(a).map(|(re, im)| Complex { re, im });
    sort(&mut roots);
    roots
}

fn sort(roots: &mut [Complex]) {
    roots.sort_by(|a, b| {
        b.abs().total_cmp(&a.abs()).then(b.re.total_cmp(&a.re)).then(b.im.total_cmp(&a.im))
    });
}

/// The eigenvalues of a matrix with at most three rows.
fn in_closed_form<const D: usize>(a: &Matrix<D>) -> [Complex; D] {
    let mut whole = [[0.0; 3]; 3];
    for (row, of_a) in whole.iter_mut().zip(a) {
        row[..D].copy_from_slice(of_a);
    }
    // What stands beyond D rows adds zeros, which are dropped as the last of the sorted roots.
    let trace = whole[0][0] + whole[1][1] + whole[2][2];
    let minor = |i: usize, j: usize| whole[i][i] * whole[j][j] - whole[i][j] * whole[j][i];
    let minors = minor(0, 1) + minor(0, 2) + minor(1, 2);
    let mut roots = cubic_roots([-determinant(whole), minors, -trace]);
    sort(&mut roots);
    std::array::from_fn(|i| roots[i])
}

/// The roots of `x^3 + c[2] x^2 + c[1] x + c[0]`.
fn cubic_roots(c: [f64; 3]) -> [Complex; 3] {
    let real = |re: f64| Complex { re, im: 0.0 };
    if c[0] == 0.0 {
        let [first, second] = quadratic_roots(c[1], c[2]);
        return [first, second, real(0.0)];
    }
    let root = one_real_root(c);
    // Dividing from the end at which the quotient's rounding is least.
    let (linear, constant) = if root.abs() > libm::cbrt(c[0].abs()) {
        let constant = -c[0] / root;
        ((constant - c[1]) / root, constant)
    } else {
        let linear = c[2] + root;
        (linear, c[1] + linear * root)
    };
    let [first, second] = quadratic_roots(constant, linear);
    [real(root), first, second]
}

/// The roots of `x^2 + linear x + constant`.
fn quadratic_roots(constant: f64, linear: f64) -> [Complex; 2] {
    let half = -0.5 * linear;
    let under = half * half - constant;
    if under < 0.0 {
        let im = (-under).sqrt();
        return [Complex { re: half, im }, Complex { re: half, im: -im }];
    }
    let first = half + under.sqrt().copysign(half);
    let second = if first == 0.0 { 0.0 } else { constant / first };
    [Complex { re: first, im: 0.0 }, Complex { re: second, im: 0.0 }]
}

/// A real root of a cubic, by bisection between bounds and Newton's steps to the end.
fn one_real_root([c0, c1, c2]: [f64; 3]) -> f64 {
    if !(c0 + c1 + c2).is_finite() {
        return f64::NAN;
    }
    let value = |x: f64| ((x + c2) * x + c1) * x + c0;
    let slope = |x: f64| (3.0 * x + 2.0 * c2) * x + c1;
    // Cauchy's bound; the cubic is negative at its lower end and positive at its upper one.
    let bound = 1.0 + c0.abs().max(c1.abs()).max(c2.abs());
    let (mut low, mut high) = (-bound, bound);
    // Beginning at the point of inflection, Newton's method cannot be caught between two extrema for long.
    let mut x = (-c2 / 3.0).clamp(low, high);
    for _ in 0..200 {
        let here = value(x);
        if here > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let next = x - here / slope(x);
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if next == x || (next - x).abs() <= f64::EPSILON * x.abs() {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_are_roots_with_the_right_sum_and_product() {
        let mut seed = 1u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for i in 0..200_000 {
            let scale = if i % 3 == 0 { 1e-6 } else { 1.0 };
            let a: Matrix<3> = std::array::from_fn(|row| {
                std::array::from_fn(|_| random() * if row == 2 { scale } else { 1.0 })
            });
            let roots = eigenvalues(&a);
            let sum: f64 = roots.iter().map(|root| root.re).sum();
            assert!((sum - (a[0][0] + a[1][1] + a[2][2])).abs() < 1e-13);
            let magnitude: f64 = roots.iter().map(|root| root.abs()).product();
            let determinant = determinant(a).abs();
            assert!((magnitude - determinant).abs() < 1e-13 * roots[0].abs().powi(3), "{a:?}");
            assert!(roots[0].abs() >= roots[1].abs() && roots[1].abs() >= roots[2].abs());
        }
    }

    #[test]
    fn of_what_is_not_finite_the_eigenvalues_are_unknown() {
        for unknown in [f64::NAN, f64::INFINITY] {
            let roots = eigenvalues(&[[unknown; 3]; 3]);
            assert!(roots.iter().all(|root| root.abs().is_nan()), "{roots:?}");
        }
    }

    #[test]
    fn a_rotation_that_shrinks_keeps_its_angle() {
        let (sin, cos) = (0.6, 0.8);
        let a = [[0.5 * cos, -0.5 * sin, 0.0], [0.5 * sin, 0.5 * cos, 0.0], [0.0, 0.0, 0.0]];
        let [first, second, last] = eigenvalues(&a);
        assert!((first.re - 0.4).abs() < 1e-15 && (first.im - 0.3).abs() < 1e-15, "{first:?}");
        assert_eq!((second.im, last.abs()), (-first.im, 0.0));
        let [first, second] = eigenvalues(&[[0.0, 1.0], [-0.06, 0.5]]);
        assert!((first.re - 0.3).abs() < 1e-15 && (second.re - 0.2).abs() < 1e-15);
    }

    #[test]
    fn linear_equations_are_solved() {
        let a = [[0.0, 2.0, 1.0], [1.0, -1.0, 0.0], [3.0, 0.0, -2.0]];
        let x = solve(a, [7.0, -1.0, -3.0]).expect("a solution");
        for (found, exact) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - exact).abs() < 1e-14);
        }
        assert_eq!(solve([[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0]), None);
    }
}
