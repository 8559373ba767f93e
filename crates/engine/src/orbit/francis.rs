//! Eigenvalues of a matrix of any size, by the shifted QR iteration of Francis.

/// Steps of the iteration that one eigenvalue, or one pair, is given.
const PATIENCE: usize = 60;
/// So often the shifts are drawn from elsewhere, so that a cycle of the iteration is left.
const UNUSUAL: usize = 10;

/// An eigenvalue: its real and its imaginary part.
pub(super) type Eigenvalue = (f64, f64);

const UNKNOWN: Eigenvalue = (f64::NAN, f64::NAN);

/// The eigenvalues of a real matrix, unsorted; the two of a complex pair are exactly conjugate.
///
/// Method: the matrix is divided by a power of two, balanced, reduced to Hessenberg form by reflections, and
/// iterated by implicit double QR steps whose shifts are the eigenvalues of the last two rows; where a
/// number below the diagonal is negligible beside its neighbours on it, the matrix falls into two.
/// Source: balancing by Parlett and Reinsch, Numer. Math. 13 (1969) 293; the iteration by Francis,
/// Comput. J. 4 (1962) 332, in the form of Martin, Peters and Wilkinson, Numer. Math. 14 (1970) 219.
/// Error: that of a matrix that differs from the balanced one by some roundings of its norm; so an eigenvalue
/// that is defective to order n is known to the n-th root of a rounding.
/// Breaks: NaN for all where an entry is not finite, and for those that 60 steps did not find.
pub(super) fn eigenvalues<const D: usize>(matrix: &[[f64; D]; D]) -> [Eigenvalue; D] {
    let largest = matrix.as_flattened().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if !matrix.as_flattened().iter().all(|x| x.is_finite()) {
        return [UNKNOWN; D];
    }
    let (_, exponent) = libm::frexp(largest);
    let mut a = matrix.map(|row| row.map(|x| libm::ldexp(x, -exponent)));
    let size = isolate(&mut a);
    balance(&mut a, size);
    reduce(&mut a, size);
    iterate(&mut a, size).map(|(re, im)| (libm::ldexp(re, exponent), libm::ldexp(im, exponent)))
}

/// Moves to the end of the diagonal what is alone in its row or column, which makes it an eigenvalue as it
/// stands; how many rows are left.
fn isolate<const D: usize>(a: &mut [[f64; D]; D]) -> usize {
    let mut size = D;
    let alone = |a: &[[f64; D]; D], i: usize, size: usize| {
        let others = || (0..size).filter(|&j| j != i);
        others().all(|j| a[i][j] == 0.0) || others().all(|j| a[j][i] == 0.0)
    };
    while let Some(i) = (0..size).rev().find(|&i| alone(a, i, size)) {
        size -= 1;
        a.swap(i, size);
        a.iter_mut().for_each(|row| row.swap(i, size));
    }
    size
}

/// Makes rows and columns of like size, by a similarity with powers of two.
fn balance<const D: usize>(a: &mut [[f64; D]; D], size: usize) {
    // Beyond, a factor or its square might overflow.
    const LARGEST_FACTOR: f64 = 1e100;
    // Few are needed; each makes the matrix smaller.
    const MOST_SWEEPS: usize = 100;
    for _ in 0..MOST_SWEEPS {
        let mut changed = false;
        for i in 0..size {
            let others = || (0..size).filter(|&j| j != i);
            let row: f64 = others().map(|j| a[i][j].abs()).sum();
            let column: f64 = others().map(|j| a[j][i].abs()).sum();
            let mut factor = 1.0;
            while column * factor * factor < row / 2.0 && factor < LARGEST_FACTOR {
                factor *= 2.0;
            }
            while column * factor * factor >= row * 2.0 && factor > 1.0 / LARGEST_FACTOR {
                factor /= 2.0;
            }
            if column * factor + row / factor < 0.95 * (column + row) {
                changed = true;
                a[i].iter_mut().for_each(|x| *x /= factor);
                a.iter_mut().for_each(|row| row[i] *= factor);
            }
        }
        if !changed {
            return;
        }
    }
}

/// A reflection `1 - 2 v v^T/(v^T v)` of a few coordinates, which takes `x` to a multiple of the first.
struct Reflection<const N: usize> {
    v: [f64; N],
    /// `2/(v^T v)`.
    weight: f64,
    /// What is left in the first coordinate.
    image: f64,
}

impl<const N: usize> Reflection<N> {
    /// None where `x` is that multiple already.
    fn of(x: [f64; N]) -> Option<Self> {
        let scale: f64 = x.iter().map(|x| x.abs()).sum();
        if x[1..].iter().all(|&x| x == 0.0) {
            return None;
        }
        let mut v = x.map(|x| x / scale);
        let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt().copysign(v[0]);
        v[0] += norm;
        // v^T v is 2 norm v[0].
        Some(Reflection { v, weight: 1.0 / (norm * v[0]), image: -norm * scale })
    }

    /// Reflects the coordinates from `first` on of these columns; where the matrix ends before them, they are
    /// zero in `v`.
    fn rows<const D: usize>(
        &self,
        a: &mut [[f64; D]; D],
        first: usize,
        columns: std::ops::Range<usize>,
    ) {
        for j in columns {
            let with = self.v.iter().zip(&a[first..]).map(|(v, row)| v * row[j]).sum::<f64>();
            for (v, row) in self.v.iter().zip(&mut a[first..]) {
                row[j] -= self.weight * with * v;
            }
        }
    }

    /// Reflects the coordinates from `first` on of these rows.
    fn columns<const D: usize>(
        &self,
        a: &mut [[f64; D]; D],
        first: usize,
        rows: std::ops::Range<usize>,
    ) {
        for row in &mut a[rows] {
            let with = self.v.iter().zip(&row[first..]).map(|(v, x)| v * x).sum::<f64>();
            for (v, x) in self.v.iter().zip(&mut row[first..]) {
                *x -= self.weight * with * v;
            }
        }
    }
}

/// Makes everything below the first subdiagonal zero, by reflections on both sides.
fn reduce<const D: usize>(a: &mut [[f64; D]; D], size: usize) {
    for column in 0..size.saturating_sub(2) {
        // Coordinates up to the column do not take part: zeros of `x` stay zeros of `v`.
        let mut x = [0.0; D];
        for (i, x) in x.iter_mut().enumerate().take(size - 1 - column) {
            *x = a[column + 1 + i][column];
        }
        let Some(reflection) = Reflection::of(x) else { continue };
        let first = column + 1;
        reflection.rows(a, first, first..size);
        reflection.columns(a, first, 0..size);
        a[first][column] = reflection.image;
        a[first + 1..size].iter_mut().for_each(|row| row[column] = 0.0);
    }
}

/// The eigenvalues of a matrix of which the first `size` rows are in Hessenberg form and iterated, from their
/// end to their beginning.
fn iterate<const D: usize>(h: &mut [[f64; D]; D], size: usize) -> [Eigenvalue; D] {
    let mut found = [UNKNOWN; D];
    for i in size..D {
        found[i] = (h[i][i], 0.0);
    }
    let (mut end, mut steps) = (size, 0);
    while end > 0 {
        let start = block_start(h, end, steps);
        match end - start {
            1 => found[start] = (h[start][start], 0.0),
            2 => [found[start], found[start + 1]] = of_two_rows(h, start),
            _ if steps == PATIENCE => return found,
            _ => {
                steps += 1;
                double_step(h, start, end, &Shifts::new(h, end, steps));
                continue;
            }
        }
        (end, steps) = (start, 0);
    }
    found
}

/// Where the last block begins that does not fall into two; the negligible number before it becomes zero.
///
/// After many steps, which defective eigenvalues take, some roundings more are negligible: there the steps
/// leave as much.
fn block_start<const D: usize>(h: &mut [[f64; D]; D], end: usize, steps: usize) -> usize {
    let negligible = f64::EPSILON * steps.saturating_sub(8).max(1) as f64;
    for k in (1..end).rev() {
        let beside = h[k - 1][k - 1].abs() + h[k][k].abs();
        let around = if beside > 0.0 { beside } else { norm(h, end) };
        if h[k][k - 1].abs() <= negligible * around {
            h[k][k - 1] = 0.0;
            return k;
        }
    }
    0
}

/// The sum of the magnitudes in the first `end` rows and columns.
fn norm<const D: usize>(h: &[[f64; D]; D], end: usize) -> f64 {
    h[..end].iter().flat_map(|row| &row[..end]).map(|x| x.abs()).sum()
}

/// The eigenvalues of two rows on the diagonal, from `start`.
fn of_two_rows<const D: usize>(h: &[[f64; D]; D], start: usize) -> [Eigenvalue; 2] {
    let last = start + 1;
    let (x, y) = (h[last][last], h[start][start]);
    let product = h[last][start] * h[start][last];
    let half = 0.5 * (y - x);
    let under = half * half + product;
    let root = under.abs().sqrt();
    if under < 0.0 {
        return [(x + half, root), (x + half, -root)];
    }
    let far = half + root.copysign(half);
    let near = if far == 0.0 { x } else { x - product / far };
    [(x + far, 0.0), (near, 0.0)]
}

/// Two shifts `x - z`, `y - z` with a coupling `w`: the roots z of `(x - z)(y - z) = w`.
struct Shifts {
    x: f64,
    y: f64,
    w: f64,
}

impl Shifts {
    /// The eigenvalues of the last two rows; now and then others of like size.
    fn new<const D: usize>(h: &[[f64; D]; D], end: usize, step: usize) -> Self {
        let (last, before) = (end - 1, end - 2);
        if step.is_multiple_of(UNUSUAL) {
            let size = h[last][before].abs() + h[before][before - 1].abs();
            let x = h[last][last] + 0.75 * size;
            return Shifts { x, y: x, w: -0.4375 * size * size };
        }
        let w = h[last][before] * h[before][last];
        Shifts { x: h[last][last], y: h[before][before], w }
    }

    /// The first column of the product of the shifted matrices from row `m` on, up to a factor.
    fn column<const D: usize>(&self, h: &[[f64; D]; D], m: usize) -> [f64; 3] {
        let (r, s) = (self.x - h[m][m], self.y - h[m][m]);
        let size = r.abs() + s.abs() + h[m + 1][m].abs();
        let below = h[m + 1][m] / size;
        [
            r * (s / size) - self.w / size + h[m][m + 1] * below,
            below * (h[m + 1][m + 1] - h[m][m] - r - s),
            below * h[m + 2][m + 1],
        ]
    }
}

/// One implicit double step on the rows from `start` to `end`, at least three.
fn double_step<const D: usize>(h: &mut [[f64; D]; D], start: usize, end: usize, shifts: &Shifts) {
    let first = step_start(h, start, end, shifts);
    for k in first..end - 1 {
        let x = match k {
            _ if k == first => shifts.column(h, first),
            _ if k + 2 < end => [h[k][k - 1], h[k + 1][k - 1], h[k + 2][k - 1]],
            _ => [h[k][k - 1], h[k + 1][k - 1], 0.0],
        };
        let Some(reflection) = Reflection::of(x) else { continue };
        reflection.rows(h, k, k..end);
        reflection.columns(h, k, start..end.min(k + 4));
        if k > first {
            h[k][k - 1] = reflection.image;
            h[k + 1..end.min(k + 3)].iter_mut().for_each(|row| row[k - 1] = 0.0);
        } else if k > start {
            // What the reflection leaves of a number that is negligible beside the column.
            h[k][k - 1] = -h[k][k - 1];
        }
    }
}

/// The row from which a step may begin: two small numbers in a row below the diagonal count as one zero.
fn step_start<const D: usize>(
    h: &[[f64; D]; D],
    start: usize,
    end: usize,
    shifts: &Shifts,
) -> usize {
    for m in (start + 1..end - 2).rev() {
        let [p, q, r] = shifts.column(h, m);
        let beside = h[m - 1][m - 1].abs() + h[m][m].abs() + h[m + 1][m + 1].abs();
        if h[m][m - 1].abs() * (q.abs() + r.abs()) <= f64::EPSILON * p.abs() * beside {
            return m;
        }
    }
    start
}
