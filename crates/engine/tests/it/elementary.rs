//! Elementary functions of lanes: against another library, alike by all instructions, with their derivatives.

use std::f64::consts::{FRAC_PI_2, PI};

use capsulemap_engine::lane::elementary::{
    LARGEST_ANGLE, exp, exp_decay, log, power, sin_cos, sin_cos_of_a_turn,
};
use capsulemap_engine::lane::{Dual, Instructions, Lane, Work};

/// Uniform random numbers.
struct Draws(fastrand::Rng);

impl Draws {
    fn new(seed: u64) -> Self {
        Draws(fastrand::Rng::with_seed(seed))
    }
    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }
}

/// Units in the last place between two numbers; none between two that are not known.
fn units_apart(a: f64, b: f64) -> u64 {
    // Bits in the order of the numbers, across zero.
    let ordered = |x: f64| (x.abs().to_bits() as i64) * if x.is_sign_negative() { -1 } else { 1 };
    if a.is_nan() && b.is_nan() { 0 } else { ordered(a).abs_diff(ordered(b)) }
}

#[track_caller]
fn assert_within(units: u64, what: &str, x: f64, found: f64, exact: f64) {
    let apart = units_apart(found, exact);
    assert!(apart <= units, "{what} {x:e}: {found:e}, not {exact:e}, {apart} units apart");
}

/// Numbers of every magnitude and sign, and those at which a function changes its formula.
fn all_magnitudes(count: usize) -> Vec<f64> {
    let mut draws = Draws::new(71);
    let mut numbers = vec![
        0.0,
        1.0,
        5e-324,
        f64::MIN_POSITIVE,
        f64::MAX,
        f64::EPSILON,
        f64::INFINITY,
        f64::NAN,
        std::f64::consts::SQRT_2,
        std::f64::consts::FRAC_1_SQRT_2,
    ];
    numbers.extend((0..count).map(|_| f64::from_bits(draws.0.u64(0..f64::INFINITY.to_bits()))));
    let negative: Vec<f64> = numbers.iter().map(|x| -x).collect();
    numbers.extend(negative);
    numbers
}

/// Angles of all sizes, and those next to the zeros of sine and cosine.
fn angles() -> Vec<f64> {
    let mut draws = Draws::new(72);
    let mut angles: Vec<f64> = (0..200_000).map(|_| draws.within(-1e5, 1e5)).collect();
    angles.extend((0..100_000).map(|_| draws.within(-LARGEST_ANGLE, LARGEST_ANGLE)));
    angles.extend((0..100_000).map(|_| draws.within(-10.0, 10.0)));
    angles.extend((0..50_000).map(|_| libm::exp(draws.within(-50.0, 0.0))));
    for quarters in 1..(LARGEST_ANGLE / FRAC_PI_2) as i32 {
        let near = f64::from(quarters) * FRAC_PI_2;
        angles.extend([near, near.next_up(), near.next_down()]);
    }
    angles
}

#[test]
fn the_exponential_agrees_with_an_independent_one() {
    let mut draws = Draws::new(70);
    for _ in 0..400_000 {
        let x = draws.within(-760.0, 720.0);
        assert_within(2, "exp", x, exp(x), libm::exp(x));
        let small = x * 1e-3;
        assert_within(2, "exp", small, exp(small), libm::exp(small));
    }
    for x in all_magnitudes(20_000) {
        assert_within(2, "exp", x, exp(x), libm::exp(x));
    }
    assert_eq!((exp(0.0), exp(710.0), exp(-746.0)), (1.0, f64::INFINITY, 0.0));
}

#[test]
fn the_exponential_of_a_decay_is_the_same_one() {
    for i in 0..200_000 {
        let x = -f64::from(i) * 0.0035;
        assert_eq!(exp_decay(x).to_bits(), exp(x).to_bits(), "x = {x}");
    }
    assert_eq!((exp_decay(0.0), exp_decay(-1e-300)), (1.0, 1.0));
    assert_eq!(exp_decay(-1e9), exp(-700.0));
}

#[test]
fn the_logarithm_agrees_with_an_independent_one() {
    let mut draws = Draws::new(73);
    for _ in 0..400_000 {
        let x = draws.within(0.0, 4.0);
        assert_within(2, "log", x, log(x), libm::log(x));
        let near_one = 1.0 + (x - 2.0) * 1e-6;
        assert_within(2, "log", near_one, log(near_one), libm::log(near_one));
    }
    for x in all_magnitudes(200_000) {
        assert_within(2, "log", x, log(x), libm::log(x));
    }
    assert_eq!((log(1.0), log(0.0)), (0.0, f64::NEG_INFINITY));
    assert!(log(-1.0).is_nan() && log(f64::NEG_INFINITY).is_nan());
}

#[test]
fn sine_and_cosine_agree_with_independent_ones() {
    for x in angles() {
        let (sine, cosine) = sin_cos(x);
        let units = if x.abs() <= 2.0 * PI { 2 } else { 3 };
        assert_within(units, "sin", x, sine, libm::sin(x));
        assert_within(units, "cos", x, cosine, libm::cos(x));
    }
    assert_eq!(sin_cos(0.0), (0.0, 1.0));
    for x in [LARGEST_ANGLE.next_up(), -1e7, 1e300, f64::INFINITY, f64::NAN] {
        let (sine, cosine) = sin_cos(x);
        assert!(sine.is_nan() && cosine.is_nan(), "{x}");
    }
}

#[test]
fn sine_and_cosine_of_a_turn_are_the_same_ones() {
    for i in -15_000..=200_000 {
        let x = f64::from(i) * (2.0 * PI / 150_000.0);
        let bits = |(sine, cosine): (f64, f64)| [sine.to_bits(), cosine.to_bits()];
        assert_eq!(bits(sin_cos_of_a_turn(x)), bits(sin_cos(x)), "x = {x}");
    }
}

#[test]
fn powers_are_as_accurate_as_promised() {
    let mut draws = Draws::new(74);
    for _ in 0..300_000 {
        let x = libm::exp(draws.within(-30.0, 30.0));
        let a = draws.within(-20.0, 20.0);
        let error = (power(x, a) / libm::pow(x, a) - 1.0).abs();
        assert!(error <= 5e-16 * (1.0 + (a * libm::log(x)).abs()), "{x}^{a}: {error:e}");
    }
    assert_eq!((power(0.0, 1.5), power(0.0, 0.0), power(1.0, 0.3)), (0.0, 1.0, 1.0));
    assert_eq!((power(0.0, -1.0), power(f64::INFINITY, 2.0)), (f64::INFINITY, f64::INFINITY));
    assert!(power(-1.0, 2.0).is_nan());
}

/// All functions at all points, as bits.
struct All<'a>(&'a [f64]);

impl Work for All<'_> {
    type Output = Vec<[u64; 9]>;

    #[inline(always)]
    fn run<L: Lane>(self) -> Self::Output {
        let mut found = Vec::new();
        for points in self.0.chunks(L::WIDTH) {
            let x = L::from_fn(|lane| *points.get(lane).unwrap_or(&0.0));
            let (sine, cosine) = sin_cos(x);
            let (near_sine, near_cosine) = sin_cos_of_a_turn(x);
            let (fraction, exponent) = x.fraction_and_exponent();
            let root = x.sqrt();
            let all = [sine, cosine, exp(x), log(x), root, fraction, exponent];
            for lane in 0..points.len() {
                let mut bits = [0; 9];
                for (bits, value) in bits.iter_mut().zip(all) {
                    *bits = value.lane(lane).to_bits();
                }
                let known = x.lane(lane).abs() < 6.0;
                bits[7] = if known { near_sine.lane(lane).to_bits() } else { 0 };
                bits[8] = if known { near_cosine.lane(lane).to_bits() } else { 0 };
                found.push(bits);
            }
        }
        found
    }
}

#[test]
fn functions_have_the_same_bits_by_all_instructions() {
    let mut points = all_magnitudes(100_000);
    // What is not a number has no bits to be compared.
    points.retain(|x| !x.is_nan());
    points.extend(angles().iter().step_by(17));
    let canonical = |found: Vec<[u64; 9]>| -> Vec<[u64; 9]> {
        let one = |bits: u64| if f64::from_bits(bits).is_nan() { u64::MAX } else { bits };
        found.into_iter().map(|row| row.map(one)).collect()
    };
    let expected = canonical(Instructions::Scalar.run(All(&points)));
    for (x, bits) in points.iter().zip(&expected) {
        if *x > 0.0 {
            assert_eq!(f64::from_bits(bits[4]).to_bits(), x.sqrt().to_bits(), "sqrt {x:e}");
        }
        if *x >= f64::MIN_POSITIVE && x.is_finite() {
            let [fraction, exponent] = [bits[5], bits[6]].map(f64::from_bits);
            assert!((1.0..2.0).contains(&fraction), "{x:e}: {fraction}");
            assert_eq!(libm::ldexp(fraction, exponent as i32), *x);
        }
    }
    for instructions in Instructions::available() {
        let found = canonical(instructions.run(All(&points)));
        for ((x, found), expected) in points.iter().zip(&found).zip(&expected) {
            assert_eq!(found, expected, "{x:e} by {}", instructions.name());
        }
    }
}

#[test]
fn derivatives_are_those_of_the_functions() {
    let mut draws = Draws::new(75);
    for _ in 0..200_000 {
        let x = draws.within(0.001, 600.0);
        let at = Dual::<f64, 2> { value: x, gradient: [1.0, -3.0] };
        let near = |what, found: Dual<f64, 2>, value: f64, slope: f64| {
            assert_eq!(found.value.to_bits(), value.to_bits(), "{what} {x}");
            assert_within(4, what, x, found.gradient[0], slope);
            assert_within(6, what, x, found.gradient[1], -3.0 * slope);
        };
        near("exp", exp(at), exp(x), libm::exp(x));
        near("log", log(at), log(x), 1.0 / x);
        near("sqrt", at.sqrt(), x.sqrt(), 0.5 / libm::sqrt(x));
        let ((sine, cosine), (of_sine, of_cosine)) = (sin_cos(at), sin_cos(x));
        near("sin", sine, of_sine, libm::cos(x));
        near("cos", cosine, of_cosine, -libm::sin(x));
    }
}

#[test]
fn derivatives_of_what_the_drive_computes_are_those_of_the_functions() {
    for i in 0..=200_000 {
        let x = f64::from(i) * (2.0 * PI / 200_000.0);
        let (sine, cosine) = sin_cos_of_a_turn(Dual::<f64, 1>::variable(x, 0));
        assert!((sine.gradient[0] - libm::cos(x)).abs() < 3e-16, "{x}");
        assert!((cosine.gradient[0] + libm::sin(x)).abs() < 3e-16, "{x}");
        let decay = exp_decay(Dual::<f64, 1>::variable(-x, 0));
        assert!((decay.gradient[0] / libm::exp(-x) - 1.0).abs() < 7e-16, "{x}");
    }
}

#[test]
fn powers_have_derivatives_in_base_and_exponent() {
    let mut draws = Draws::new(76);
    for _ in 0..100_000 {
        let (x, a) = (draws.within(0.01, 10.0), draws.within(-4.0, 4.0));
        let found = power(Dual::<f64, 2>::variable(x, 0), Dual::variable(a, 1));
        let exact = [a * libm::pow(x, a - 1.0), libm::log(x) * libm::pow(x, a)];
        for (found, exact) in found.gradient.into_iter().zip(exact) {
            assert!((found - exact).abs() <= 2e-14 * exact.abs(), "{x}^{a}: {found} {exact}");
        }
    }
    let at_zero = |a: f64| {
        let found = power(Dual::<f64, 1>::variable(0.0, 0), Dual::constant(a));
        (found.value, found.gradient[0])
    };
    assert_eq!((at_zero(1.5).0, at_zero(1.0).0), (0.0, 0.0));
    assert!(at_zero(1.5).1.abs() < 1e-100 && (at_zero(1.0).1 - 1.0).abs() < 1e-12);
}

#[test]
fn second_derivatives_are_right_too() {
    type Twice = Dual<Dual<f64, 1>, 1>;
    let mut draws = Draws::new(77);
    for _ in 0..50_000 {
        let x = draws.within(0.1, 8.0);
        let at = Twice { value: Dual::variable(x, 0), gradient: [Dual::constant(1.0)] };
        let second = |found: Twice| found.gradient[0].gradient[0];
        let near = |what, found: Twice, exact: f64| {
            let (found, scale) = (second(found), exact.abs().max(0.1));
            assert!((found - exact).abs() < 4e-15 * scale, "{what} {x}: {found} {exact}");
        };
        near("exp", exp(at), libm::exp(x));
        near("log", log(at), -1.0 / (x * x));
        near("sqrt", at.sqrt(), -0.25 / (x * libm::sqrt(x)));
        near("sin", sin_cos(at).0, -libm::sin(x));
        near("cos", sin_cos(at).1, -libm::cos(x));
        near("power", power(at, Twice::splat(2.5)), 3.75 * libm::sqrt(x));
    }
}

#[test]
fn a_constant_stays_one_where_a_slope_is_infinite() {
    let zero = Dual::<f64, 1>::constant(0.0);
    assert_eq!((zero.sqrt().value, zero.sqrt().gradient), (0.0, [0.0]));
    assert_eq!((log(zero).value, log(zero).gradient), (f64::NEG_INFINITY, [0.0]));
    assert_eq!(Dual::<f64, 1>::variable(0.0, 0).sqrt().gradient, [f64::INFINITY]);
    assert!(log(Dual::<f64, 1>::variable(-2.0, 0)).gradient[0].is_nan());
}
