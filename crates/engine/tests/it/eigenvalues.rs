//! Eigenvalues of matrices of every size: sums, products, known spectra, and those that are hard to find.

use capsulemap_engine::orbit::matrix::{Complex, Matrix, determinant, eigenvalues};

fn product<const D: usize>(a: &Matrix<D>, b: &Matrix<D>) -> Matrix<D> {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..D).map(|k| a[i][k] * b[k][j]).sum()))
}

fn trace<const D: usize>(a: &Matrix<D>) -> f64 {
    (0..D).map(|i| a[i][i]).sum()
}

/// The largest sum of magnitudes in a row.
fn size<const D: usize>(a: &Matrix<D>) -> f64 {
    a.iter().map(|row| row.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
}

fn times(a: Complex, b: Complex) -> Complex {
    Complex { re: a.re * b.re - a.im * b.im, im: a.re * b.im + a.im * b.re }
}

fn apart(a: Complex, b: Complex) -> f64 {
    libm::hypot(a.re - b.re, a.im - b.im)
}

fn real(re: f64) -> Complex {
    Complex { re, im: 0.0 }
}

/// Uniform in -1..1.
fn uniform(rng: &mut fastrand::Rng) -> f64 {
    2.0 * rng.f64() - 1.0
}

fn random<const D: usize>(rng: &mut fastrand::Rng) -> Matrix<D> {
    std::array::from_fn(|_| std::array::from_fn(|_| uniform(rng)))
}

/// A random orthogonal matrix: a product of reflections.
fn orthogonal<const D: usize>(rng: &mut fastrand::Rng) -> Matrix<D> {
    let mut q: Matrix<D> = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
    for _ in 0..D {
        let v: [f64; D] = std::array::from_fn(|_| uniform(rng));
        let square: f64 = v.iter().map(|x| x * x).sum();
        let mirror = std::array::from_fn(|i| {
            std::array::from_fn(|j| f64::from(i == j) - 2.0 * v[i] * v[j] / square)
        });
        q = product(&q, &mirror);
    }
    q
}

/// Sorted as promised, complex ones in exact pairs.
#[track_caller]
fn assert_in_order(roots: &[Complex]) {
    for pair in roots.windows(2) {
        let key = |root: Complex| (root.abs(), root.re, root.im);
        assert!(key(pair[0]) >= key(pair[1]), "{roots:?}");
    }
    for root in roots.iter().filter(|root| root.im != 0.0) {
        let mirrored = Complex { re: root.re, im: -root.im };
        assert!(roots.contains(&mirrored), "{roots:?}");
    }
}

/// Each of `found` is the nearest one left of `exact`, within `allowed`.
#[track_caller]
fn assert_spectrum(found: &[Complex], exact: &[Complex], allowed: f64) {
    let mut left = exact.to_vec();
    for root in found {
        let distance = |other: &Complex| apart(*root, *other);
        let nearest = (0..left.len())
            .min_by(|&i, &j| distance(&left[i]).total_cmp(&distance(&left[j])))
            .expect("as many as found");
        let error = distance(&left.swap_remove(nearest));
        assert!(error <= allowed, "{found:?}\nand not {exact:?}: {error:e}");
    }
}

/// Power sums of the eigenvalues are traces of powers, and their product is the determinant.
#[track_caller]
fn assert_sums<const D: usize>(a: &Matrix<D>) {
    let roots = eigenvalues(a);
    if roots[0].re.is_nan() {
        panic!("{a:?}");
    }
    assert_in_order(&roots);
    let scale = size(a);
    let (mut powers, mut power_of_a) = (roots, *a);
    for order in 1..=4 {
        let (re, im) = powers.iter().fold((0.0, 0.0), |(re, im), p| (re + p.re, im + p.im));
        let allowed = 2e-14 * scale.powi(order);
        assert!((re - trace(&power_of_a)).abs() <= allowed, "order {order}: {a:?} {roots:?}");
        assert!(im.abs() <= allowed, "order {order}: {a:?}");
        for (power, root) in powers.iter_mut().zip(&roots) {
            *power = times(*power, *root);
        }
        power_of_a = product(&power_of_a, a);
    }
    let whole = roots.iter().fold(real(1.0), |whole, root| times(whole, *root));
    let allowed = 2e-14 * scale.powi(D as i32);
    assert!(apart(whole, real(determinant(*a))) <= allowed, "{a:?} {roots:?}");
}

fn check_random<const D: usize>() {
    let mut rng = fastrand::Rng::with_seed(90 + D as u64);
    for draw in 0..40_000 {
        let mut a = random::<D>(&mut rng);
        match draw % 5 {
            // Of rank one less, or nearly.
            1 => a[D - 1] = a[0].map(|x| x * if draw % 2 == 0 { 0.7 } else { 1e-9 }),
            // Badly scaled, which balancing undoes.
            2 => {
                for i in 0..D {
                    let scale = libm::exp2((draw % 7 * i) as f64);
                    a[i].iter_mut().for_each(|x| *x *= scale);
                    a.iter_mut().for_each(|row| row[i] /= scale);
                }
            }
            // Sparse, with whole numbers, many of whose eigenvalues coincide.
            3 => a = a.map(|row| row.map(|x| (2.4 * x).trunc())),
            // Nearly symmetric.
            4 => {
                let turned = a;
                for (i, row) in a.iter_mut().enumerate() {
                    for (j, x) in row.iter_mut().enumerate() {
                        *x += turned[j][i] * (1.0 - 1e-10);
                    }
                }
            }
            _ => {}
        }
        assert_sums(&a);
    }
}

#[test]
fn power_sums_and_products_are_traces_and_determinants() {
    check_random::<1>();
    check_random::<2>();
    check_random::<4>();
    check_random::<5>();
    check_random::<6>();
    check_random::<7>();
    check_random::<8>();
}

/// Turned blocks: real eigenvalues and complex pairs that are known beforehand.
fn check_known<const D: usize>() {
    let mut rng = fastrand::Rng::with_seed(190 + D as u64);
    for _ in 0..10_000 {
        let mut blocks = [[0.0; D]; D];
        let mut exact = Vec::new();
        while exact.len() < D {
            let i = exact.len();
            let (re, im) = (uniform(&mut rng), uniform(&mut rng));
            blocks[i][i] = re;
            if i + 1 < D && rng.bool() {
                let stretch = 0.5 + rng.f64();
                blocks[i + 1][i + 1] = re;
                (blocks[i][i + 1], blocks[i + 1][i]) = (im * stretch, -im / stretch);
                exact.extend([Complex { re, im }, Complex { re, im: -im }]);
            } else {
                exact.push(real(re));
            }
        }
        let q = orthogonal(&mut rng);
        let transposed = std::array::from_fn(|i| std::array::from_fn(|j| q[j][i]));
        let found = eigenvalues(&product(&product(&q, &blocks), &transposed));
        assert_in_order(&found);
        // A pair that is nearly defective is known less well: im beside 1.
        assert_spectrum(&found, &exact, 1e-13);
    }
}

#[test]
fn known_spectra_are_found() {
    check_known::<4>();
    check_known::<5>();
    check_known::<6>();
    check_known::<7>();
    check_known::<8>();
}

/// Two matrices on the diagonal of a larger one, and what couples the first to the second.
fn joined<const A: usize, const B: usize, const D: usize>(
    a: &Matrix<A>,
    b: &Matrix<B>,
    mut whole: Matrix<D>,
) -> Matrix<D> {
    for i in 0..D {
        for j in 0..D {
            match (i < A, j < A) {
                (true, true) => whole[i][j] = a[i][j],
                (false, false) => whole[i][j] = b[i - A][j - A],
                (false, true) => whole[i][j] = 0.0,
                (true, false) => {}
            }
        }
    }
    whole
}

fn check_joined<const A: usize, const B: usize, const D: usize>() {
    let mut rng = fastrand::Rng::with_seed(290 + D as u64);
    for _ in 0..20_000 {
        let (a, b) = (random::<A>(&mut rng), random::<B>(&mut rng));
        let exact: Vec<Complex> = eigenvalues(&a).into_iter().chain(eigenvalues(&b)).collect();
        let apart_by_blocks = joined::<A, B, D>(&a, &b, [[0.0; D]; D]);
        let found = eigenvalues(&apart_by_blocks);
        assert_in_order(&found);
        // Random matrices come as near to a double root as their number allows.
        assert_spectrum(&found, &exact, 1e-9);
    }
}

#[test]
fn blocks_have_the_eigenvalues_of_the_closed_form() {
    check_joined::<3, 1, 4>();
    check_joined::<2, 2, 4>();
    check_joined::<3, 2, 5>();
    check_joined::<2, 3, 5>();
    check_joined::<3, 3, 6>();
}

#[test]
fn defective_matrices_are_known_to_the_root_of_a_rounding() {
    fn check<const D: usize>() {
        let mut rng = fastrand::Rng::with_seed(390 + D as u64);
        for _ in 0..2_000 {
            let root = uniform(&mut rng);
            let chain: Matrix<D> = std::array::from_fn(|i| {
                std::array::from_fn(|j| if i == j { root } else { f64::from(j == i + 1) })
            });
            let q = orthogonal(&mut rng);
            let transposed = std::array::from_fn(|i| std::array::from_fn(|j| q[j][i]));
            let found = eigenvalues(&product(&product(&q, &chain), &transposed));
            let allowed = 3.0 * libm::pow(1e-15, 1.0 / D as f64);
            assert_spectrum(&found, &[real(root); D], allowed);
            // Their mean is known to rounding.
            let mean = found.iter().map(|it| it.re).sum::<f64>() / D as f64;
            assert!((mean - root).abs() < 1e-14, "{mean} {root}");
            // In its own form nothing is iterated.
            assert_eq!(eigenvalues(&chain), [real(root); D]);
        }
    }
    check::<4>();
    check::<5>();
    check::<8>();
}

#[test]
fn ranks_that_are_lost_leave_zeros() {
    fn check<const D: usize>() {
        let mut rng = fastrand::Rng::with_seed(490 + D as u64);
        for _ in 0..5_000 {
            // An outer product: one eigenvalue, v . w, and zeros.
            let v: [f64; D] = std::array::from_fn(|_| uniform(&mut rng));
            let w: [f64; D] = std::array::from_fn(|_| uniform(&mut rng));
            let inner: f64 = v.iter().zip(&w).map(|(v, w)| v * w).sum();
            let found = eigenvalues(&v.map(|v| w.map(|w| v * w)));
            let mut exact = [real(0.0); D];
            exact[0] = real(inner);
            // Near a vanishing inner product the first joins the zeros, defective to order two.
            assert_spectrum(&found, &exact, if inner.abs() > 0.1 { 2e-14 } else { 1e-6 });
            // A row and a column of zeros give an exact zero.
            let mut a = random::<D>(&mut rng);
            a[1] = [0.0; D];
            a.iter_mut().for_each(|row| row[1] = 0.0);
            assert_eq!(eigenvalues(&a)[D - 1], real(0.0));
        }
    }
    check::<4>();
    check::<6>();
    check::<8>();
    assert_eq!(eigenvalues(&[[0.0; 5]; 5]), [real(0.0); 5]);
}

/// The cyclic shift of the coordinates: its eigenvalues are the roots of one, which the usual shifts of the
/// iteration never separate.
#[test]
fn cyclic_shifts_are_no_trap() {
    fn check<const D: usize>() {
        let shift: Matrix<D> =
            std::array::from_fn(|i| std::array::from_fn(|j| f64::from((i + 1) % D == j)));
        let exact: [Complex; D] = std::array::from_fn(|k| {
            let (im, re) = libm::sincos(2.0 * std::f64::consts::PI * k as f64 / D as f64);
            Complex { re, im }
        });
        assert_spectrum(&eigenvalues(&shift), &exact, 1e-14);
        let transposed: Matrix<D> = std::array::from_fn(|i| std::array::from_fn(|j| shift[j][i]));
        assert_spectrum(&eigenvalues(&transposed), &exact, 1e-14);
    }
    check::<4>();
    check::<5>();
    check::<6>();
    check::<7>();
    check::<8>();
}

#[test]
fn scales_do_not_matter_and_what_is_not_finite_is_unknown() {
    let mut rng = fastrand::Rng::with_seed(7);
    for _ in 0..1_000 {
        let a = random::<6>(&mut rng);
        let roots = eigenvalues(&a);
        for exponent in [-900, 1000] {
            let scaled = eigenvalues(&a.map(|row| row.map(|x| libm::ldexp(x, exponent))));
            let back = |x: f64| libm::ldexp(x, -exponent);
            assert_eq!(scaled.map(|it| Complex { re: back(it.re), im: back(it.im) }), roots);
        }
        for unknown in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut a = a;
            a[rng.usize(0..6)][rng.usize(0..6)] = unknown;
            assert!(eigenvalues(&a).iter().all(|root| root.abs().is_nan()));
        }
    }
}
