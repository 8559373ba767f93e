//! Functions of Taylor series, term by term: closed forms, identities, lanes and derivatives.

use capsulemap_engine::lane::series::{
    SquareRoot, exp_term, log_term, power_term, product_term, quotient_term, sin_cos_terms,
    square_term, value, zero,
};
use capsulemap_engine::lane::{Dual, Instructions, Lane, ORDER, Series, Work};

/// The series found term by term.
fn by_terms<L: Lane>(term: impl Fn(&Series<L>, usize) -> L) -> Series<L> {
    let mut found = zero();
    for k in 0..=ORDER {
        found[k] = term(&found, k);
    }
    found
}

fn linear(constant: f64, slope: f64) -> Series<f64> {
    let mut series = zero();
    (series[0], series[1]) = (constant, slope);
    series
}

/// Coefficients of random size whose series converges beyond 1.
fn random(rng: &mut fastrand::Rng, constant: f64) -> Series<f64> {
    let mut series: Series<f64> =
        std::array::from_fn(|k| (rng.f64() - 0.5) * 0.5_f64.powi(k as i32));
    series[0] = constant;
    series
}

/// Terms equal to a few roundings of their own.
#[track_caller]
fn assert_near(what: &str, found: &Series<f64>, exact: &Series<f64>) {
    for (k, (found, exact)) in found.iter().zip(exact).enumerate() {
        let error = (found - exact).abs();
        assert!(error <= 4e-15 * exact.abs(), "{what}, term {k}: {found:e}, not {exact:e}");
    }
}

/// Terms equal to roundings of what was summed in them.
#[track_caller]
fn assert_alike(what: &str, found: &Series<f64>, exact: &Series<f64>) {
    for (k, (found, exact)) in found.iter().zip(exact).enumerate() {
        let allowed = 1e-14 * exact.abs().max(1.0);
        assert!((found - exact).abs() <= allowed, "{what}, term {k}: {found:e}, not {exact:e}");
    }
}

#[test]
fn series_of_known_functions_are_found() {
    let t = linear(0.0, 1.0);
    let one_and_t = linear(1.0, 1.0);
    let mut factorial = 1.0;
    let (mut exponential, mut sine, mut cosine) = (zero(), zero(), zero());
    let (mut geometric, mut root, mut logarithm, mut power) = (zero(), zero(), zero(), zero());
    let (mut of_root, mut of_power) = (1.0, 1.0);
    for k in 0..=ORDER {
        let n = k as f64;
        if k > 0 {
            factorial *= n;
            // Binomial coefficients of 1/2 and of -1.7.
            of_root *= (0.5 - (n - 1.0)) / n;
            of_power *= (-1.7 - (n - 1.0)) / n;
            logarithm[k] = if k % 2 == 1 { 1.0 / n } else { -1.0 / n };
        }
        exponential[k] = 1.0 / factorial;
        let sign = if k % 4 < 2 { 1.0 } else { -1.0 };
        (if k % 2 == 1 { &mut sine } else { &mut cosine })[k] = sign / factorial;
        geometric[k] = if k % 2 == 0 { 1.0 } else { -1.0 };
        (root[k], power[k]) = (of_root, of_power);
    }
    assert_near("exp", &by_terms(|e, k| exp_term(&t, e, k)), &exponential);
    let of_one = SquareRoot::of(1.0);
    assert_near("sqrt", &by_terms(|r, k| of_one.term(&one_and_t, r, k)), &root);
    assert_near("log", &by_terms(|l, k| log_term(&one_and_t, l, k)), &logarithm);
    assert_near("power", &by_terms(|p, k| power_term(&one_and_t, -1.7, p, k)), &power);
    let one = linear(1.0, 0.0);
    assert_near("1/(1 + t)", &by_terms(|q, k| quotient_term(&one, &one_and_t, q, k)), &geometric);
    let (mut s, mut c) = (zero(), zero());
    for k in 0..=ORDER {
        (s[k], c[k]) = sin_cos_terms(&t, &s, &c, k);
    }
    assert_near("sin", &s, &sine);
    assert_near("cos", &c, &cosine);
    assert_near("square", &by_terms(|_, k| square_term(&exponential, k)), &{
        let mut twice = 1.0;
        std::array::from_fn(|k| {
            let term = twice * exponential[k];
            twice *= 2.0;
            term
        })
    });
}

#[test]
fn functions_of_series_obey_their_identities() {
    let mut rng = fastrand::Rng::with_seed(81);
    for _ in 0..5_000 {
        let (a0, b0) = (0.5 + 2.0 * rng.f64(), 0.8 + rng.f64());
        let (a, b) = (random(&mut rng, a0), random(&mut rng, b0));
        let product = |a: &Series<f64>, b: &Series<f64>| by_terms(|_, k| product_term(a, b, k));
        assert_alike("a^2", &by_terms(|_, k| square_term(&a, k)), &product(&a, &a));
        let quotient = by_terms(|q, k| quotient_term(&a, &b, q, k));
        assert_alike("a/b b", &product(&quotient, &b), &a);
        let root = SquareRoot::of(a[0]);
        let root = by_terms(|r, k| root.term(&a, r, k));
        assert_alike("sqrt(a)^2", &product(&root, &root), &a);
        assert_alike("a^0.5", &by_terms(|p, k| power_term(&a, 0.5, p, k)), &root);
        let cube = by_terms(|p, k| power_term(&a, 3.0, p, k));
        assert_alike("a^3", &cube, &product(&product(&a, &a), &a));
        let logarithm = by_terms(|l, k| log_term(&a, l, k));
        assert_alike("exp(log a)", &by_terms(|e, k| exp_term(&logarithm, e, k)), &a);
        let (mut s, mut c) = (zero(), zero());
        for k in 0..=ORDER {
            (s[k], c[k]) = sin_cos_terms(&a, &s, &c, k);
        }
        let (squares, others) = (product(&s, &s), product(&c, &c));
        let mut one = zero();
        for (sum, (a, b)) in one.iter_mut().zip(squares.iter().zip(&others)) {
            *sum = a + b;
        }
        assert_alike("sin^2 + cos^2", &one, &linear(1.0, 0.0));
        // The sum of the series is the function of the sum.
        let (t, at) = (0.05, value(&a, 0.05));
        assert!((value(&s, t) - libm::sin(at)).abs() < 1e-15, "sin {at}");
        assert!((value(&c, t) - libm::cos(at)).abs() < 1e-15, "cos {at}");
        assert!((value(&cube, t) / (at * at * at) - 1.0).abs() < 1e-14, "cube {at}");
    }
}

/// A recurrence that uses every function, x' = -y/sqrt(1 + x^2) and so on, its terms as bits.
struct Recurrence<'a>(&'a [f64]);

impl Work for Recurrence<'_> {
    type Output = Vec<Vec<u64>>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let mut found = Vec::new();
        for points in self.0.chunks(L::WIDTH) {
            let x = all_terms(L::from_fn(|lane| *points.get(lane).unwrap_or(&0.5)));
            for lane in 0..points.len() {
                found.push(x.iter().map(|x| x.lane(lane).to_bits()).collect());
            }
        }
        found
    }
}

/// The series of `x' = exp(sin(log a) + cos(log a)) / sqrt(a)`, where `a = (1 + x^2)^(3/4)`, from `start`.
#[inline(always)]
fn all_terms<L: Lane>(start: L) -> Series<L> {
    let (mut x, mut square, mut a, mut root) = (zero::<L>(), zero::<L>(), zero::<L>(), zero::<L>());
    let (mut logarithm, mut s, mut c) = (zero::<L>(), zero::<L>(), zero::<L>());
    let (mut sum, mut exponential, mut rate) = (zero::<L>(), zero::<L>(), zero::<L>());
    x[0] = start;
    for k in 0..ORDER {
        let one = L::splat(if k == 0 { 1.0 } else { 0.0 });
        square[k] = square_term(&x, k) + one;
        a[k] = power_term(&square, L::splat(0.75), &a, k);
        root[k] = SquareRoot::of(a[0]).term(&a, &root, k);
        logarithm[k] = log_term(&a, &logarithm, k);
        (s[k], c[k]) = sin_cos_terms(&logarithm, &s, &c, k);
        sum[k] = s[k] + c[k];
        exponential[k] = exp_term(&sum, &exponential, k);
        rate[k] = quotient_term(&exponential, &root, &rate, k);
        x[k + 1] = rate[k] * L::splat(1.0 / (k + 1) as f64);
    }
    x
}

fn rate(x: f64) -> f64 {
    let a = libm::pow(1.0 + x * x, 0.75);
    let logarithm = libm::log(a);
    libm::exp(libm::sin(logarithm) + libm::cos(logarithm)) / libm::sqrt(a)
}

/// The solution at a short `time`, by small steps of the classical method of fourth order.
fn solution(start: f64, time: f64) -> f64 {
    let (mut x, steps) = (start, 400);
    let h = time / f64::from(steps);
    for _ in 0..steps {
        let first = rate(x);
        let second = rate(x + 0.5 * h * first);
        let third = rate(x + 0.5 * h * second);
        let fourth = rate(x + h * third);
        x += h * (first + 2.0 * (second + third) + fourth) / 6.0;
    }
    x
}

#[test]
fn a_recurrence_of_all_functions_solves_its_equation_in_all_lanes() {
    let starts: Vec<f64> = (0..203).map(|i| 0.3 + 0.01 * f64::from(i)).collect();
    let expected = Instructions::Scalar.run(Recurrence(&starts));
    for instructions in Instructions::available() {
        assert_eq!(instructions.run(Recurrence(&starts)), expected, "{}", instructions.name());
    }
    for (start, bits) in starts.iter().zip(&expected) {
        let x: Series<f64> = std::array::from_fn(|k| f64::from_bits(bits[k]));
        let exact = solution(*start, 0.05);
        assert!((value(&x, 0.05) - exact).abs() < 1e-14, "{start}: {exact}");
    }
}

#[test]
fn a_recurrence_of_all_functions_carries_derivatives() {
    for i in 0..200 {
        let start = 0.3 + 0.01 * f64::from(i);
        let x = all_terms(Dual::<f64, 1>::variable(start, 0));
        // An autonomous flow carries its own rate: dx(t)/dx(0) = rate(x(t))/rate(x(0)).
        let end = value(&x, Dual::constant(0.05));
        let exact = rate(end.value) / rate(start);
        assert!((end.gradient[0] - exact).abs() < 2e-14, "{start}: {} {exact}", end.gradient[0]);
    }
}
