//! Elementary functions with the same bits everywhere: exponential, logarithm, sine and cosine, powers.

use std::f64::consts::{FRAC_2_PI, LOG2_E, SQRT_2};

use super::{Differentiable, Lane};

/// The largest magnitude of an angle that [`sin_cos`] takes [rad].
pub const LARGEST_ANGLE: f64 = 1e6;

/// ln 2 in two parts, the first with trailing zeros so that its multiples by exponents are exact.
const LN_2: [f64; 2] = [f64::from_bits(0x3FE6_2E42_FEE0_0000), 1.908_214_929_270_587_7e-10];

/// pi/2 in three parts; the multiples of the first two by whole numbers below 2^21 are exact.
const HALF_PI: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];

/// `1/n!` for n = 0..=17.
const INVERSE_FACTORIAL: [f64; 18] = {
    let mut table = [1.0; 18];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < table.len() {
        factorial *= n as f64; // exact up to 18!
        table[n] = 1.0 / factorial;
        n += 1;
    }
    table
};

/// `exp(x)` for `x <= 0`, within two units in the last place; arguments below -700 count as -700.
///
/// Method: `x = n ln 2 + s` with `|s| <= ln 2 / 2`, then the Taylor polynomial of degree 13,
/// whose remainder is below 5e-18. Guarantees: the bits of [`exp`] from -700 to 0; derivatives are those of
/// the polynomial, within 2e-16 of their size and rounding. Breaks: beyond 709, where [`exp`] is infinite.
#[inline(always)]
pub fn exp_decay<L: Lane>(x: L) -> L {
    let (sum, n) = exp_parts(x.max(L::splat(-700.0)));
    sum * n.exp2_whole()
}

/// `exp(x)` for every `x`.
///
/// Method: as [`exp_decay`], the power of two in two factors.
/// Guarantees: within two units in the last place; below 2^-1022, where numbers have fewer digits, within
/// two of their last units; infinite above 709.8, zero below -745.2, NaN for NaN. The derivative is the
/// value itself.
#[inline(always)]
pub fn exp<L: Lane>(x: L) -> L {
    let [value] = x.apply(&Exp);
    value
}

struct Exp;

impl Differentiable<1> for Exp {
    #[inline(always)]
    fn values<L: Lane>(&self, x: L) -> [L; 1] {
        let (sum, n) = exp_parts(x.max(L::splat(-750.0)).min(L::splat(710.0)));
        let half = (n * L::splat(0.5)).nearest_whole();
        [sum * half.exp2_whole() * (n - half).exp2_whole()]
    }
    #[inline(always)]
    fn slopes<L: Lane>(&self, _x: L, values: [L; 1]) -> [L; 1] {
        values
    }
}

/// `exp(s)` and `n`, where `x = n ln 2 + s`.
#[inline(always)]
fn exp_parts<L: Lane>(x: L) -> (L, L) {
    let n = (x * L::splat(LOG2_E)).nearest_whole();
    let s = (x - n * L::splat(LN_2[0])) - n * L::splat(LN_2[1]);
    let mut sum = L::splat(INVERSE_FACTORIAL[13]);
    for k in (0..13).rev() {
        sum = sum * s + L::splat(INVERSE_FACTORIAL[k]);
    }
    (sum, n)
}

/// The natural logarithm.
///
/// Method: `x = 2^n (1 + f)` with `1 + f` between the roots of 1/2 and 2, and with `s = f/(2 + f)`
/// `ln(1 + f) = 2 artanh(s) = f - s (f - r)`, `r = 2 (s^2/3 + s^4/5 + ...)` cut after `s^22`, whose remainder
/// is below 1e-19 of `f`; `f - s (f - r)` is summed as `f - (f^2/2 - s (f^2/2 + r))`, in which the largest term
/// is exact (Tang, ACM Trans. Math. Softw. 16 (1990) 378, gives the same sum).
/// Guarantees: within two units in the last place; `log(0)` is minus infinity, that of negative numbers NaN.
/// The derivative is `1/x`.
#[inline(always)]
pub fn log<L: Lane>(x: L) -> L {
    let [value] = x.apply(&Log);
    value
}

struct Log;

impl Differentiable<1> for Log {
    #[inline(always)]
    fn values<L: Lane>(&self, x: L) -> [L; 1] {
        let (f, n) = log_parts(x);
        let half_square = L::splat(0.5) * f * f;
        let s = f / (L::splat(2.0) + f);
        let square = s * s;
        let mut r = L::splat(2.0 / 23.0);
        for k in (1..11).rev() {
            r = r * square + L::splat(2.0 / (2 * k + 1) as f64);
        }
        let correction = s * (half_square + r * square) + n * L::splat(LN_2[1]);
        let sum = n * L::splat(LN_2[0]) - ((half_square - correction) - f);
        let sum = L::select(x.le(L::splat(0.0)), L::splat(f64::NEG_INFINITY), sum);
        let sum = L::select(x.lt(L::splat(0.0)), L::splat(f64::NAN), sum);
        [L::select(x.le(L::splat(f64::MAX)), sum, x)]
    }
    #[inline(always)]
    fn slopes<L: Lane>(&self, x: L, _values: [L; 1]) -> [L; 1] {
        let inverse = L::splat(1.0) / x.abs();
        [L::select(x.lt(L::splat(0.0)), L::splat(f64::NAN), inverse)]
    }
}

/// `f` and `n`, where a positive `x` is `2^n (1 + f)` with `1 + f` between the roots of 1/2 and 2.
#[inline(always)]
fn log_parts<L: Lane>(x: L) -> (L, L) {
    const LIFT: f64 = 18_014_398_509_481_984.0; // 2^54
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let subnormal = x.lt(L::splat(f64::MIN_POSITIVE));
    let lifted = L::select(subnormal, x * L::splat(LIFT), x);
    let (fraction, n) = lifted.fraction_and_exponent();
    let n = n - L::select(subnormal, L::splat(54.0), zero);
    let upper = L::splat(SQRT_2).lt(fraction);
    let fraction = L::select(upper, fraction * L::splat(0.5), fraction);
    (fraction - one, n + L::select(upper, one, zero))
}

/// `x` to the power `exponent`, for `x >= 0`; the lanes may have different exponents.
///
/// Method: `exp(exponent log x)`.
/// Error: relative, `(1 + |exponent log x|)` times 5e-16; a square root or a product of a few factors is
/// more accurate. Guarantees: derivatives in `x` and in `exponent`; at zero a positive power is zero, with
/// the derivative that it has at 2e-308. Breaks: NaN for negative `x`; infinite for a negative power of zero.
#[inline(always)]
pub fn power<L: Lane>(x: L, exponent: L) -> L {
    let zero = L::splat(0.0);
    let at_zero = x.abs().le(zero);
    let away = L::select(at_zero, x + L::splat(f64::MIN_POSITIVE), x);
    let value = exp(exponent * log(away));
    let value = L::select(at_zero & zero.lt(exponent), value - L::from_plain(value.plain()), value);
    L::select(at_zero & exponent.lt(zero), L::splat(f64::INFINITY), value)
}

/// `(sin x, cos x)` for `0 <= x <= 2 pi` (and up to 8.6), within two units in the last place.
///
/// Method: `x = q pi/2 + s` with `|s| <= pi/4`, then Taylor polynomials of degree 17 and 16,
/// whose remainders are below 3e-18. Guarantees: the bits of [`sin_cos`]; derivatives are those of the
/// polynomials, within 1e-16 and rounding. Breaks: beyond 8.6 and below -0.7 the result is wrong;
/// [`sin_cos`] takes any angle.
#[inline(always)]
pub fn sin_cos_of_a_turn<L: Lane>(x: L) -> (L, L) {
    let q = (x * L::splat(FRAC_2_PI)).nearest_whole();
    let (sine, cosine) = sin_cos_near_zero(less_quarters(x, q));
    let swapped = is(q, 1.0) | is(q, 3.0) | is(q, 5.0);
    let (first, second) = (L::select(swapped, cosine, sine), L::select(swapped, sine, cosine));
    let sine_negative = is(q, 2.0) | is(q, 3.0);
    let cosine_negative = is(q, 1.0) | is(q, 2.0) | is(q, 5.0);
    (L::select(sine_negative, -first, first), L::select(cosine_negative, -second, second))
}

/// `(sin x, cos x)` for every angle of magnitude up to [`LARGEST_ANGLE`], NaN beyond.
///
/// Method: as [`sin_cos_of_a_turn`], the quarter from the remainder of `q` by 4. Source of the reduction:
/// Cody and Waite, Software Manual for the Elementary Functions (1980), chapter 8.
/// Guarantees: within two units in the last place up to 2 pi, and within three beyond, next to the zeros too.
/// The derivatives are `(cos x, -sin x)`.
#[inline(always)]
pub fn sin_cos<L: Lane>(x: L) -> (L, L) {
    let [sine, cosine] = x.apply(&SinCos);
    (sine, cosine)
}

struct SinCos;

impl Differentiable<2> for SinCos {
    #[inline(always)]
    fn values<L: Lane>(&self, x: L) -> [L; 2] {
        let known = x.abs().le(L::splat(LARGEST_ANGLE));
        let x = L::select(known, x, L::splat(f64::NAN));
        let q = (x * L::splat(FRAC_2_PI)).nearest_whole();
        let (sine, cosine) = sin_cos_near_zero(less_quarters(x, q));
        // -2, -1, 0, 1 or 2.
        let quarter = q - L::splat(4.0) * (q * L::splat(0.25)).nearest_whole();
        let opposite = L::splat(1.5).lt(quarter.abs());
        let swapped = L::splat(0.5).lt(quarter.abs()) & !opposite;
        let (first, second) = (L::select(swapped, cosine, sine), L::select(swapped, sine, cosine));
        let sine_negative = opposite | quarter.lt(L::splat(-0.5));
        let cosine_negative = opposite | L::splat(0.5).lt(quarter);
        [L::select(sine_negative, -first, first), L::select(cosine_negative, -second, second)]
    }
    #[inline(always)]
    fn slopes<L: Lane>(&self, _x: L, [sine, cosine]: [L; 2]) -> [L; 2] {
        [cosine, -sine]
    }
}

/// `x - q pi/2`, for whole `q`.
#[inline(always)]
fn less_quarters<L: Lane>(x: L, q: L) -> L {
    let [first, second, third] = HALF_PI;
    ((x - q * L::splat(first)) - q * L::splat(second)) - q * L::splat(third)
}

/// `(sin s, cos s)` for `|s| <= pi/4`.
#[inline(always)]
fn sin_cos_near_zero<L: Lane>(s: L) -> (L, L) {
    let square = s * s;
    let (mut sine, mut cosine) = (L::splat(INVERSE_FACTORIAL[17]), L::splat(INVERSE_FACTORIAL[16]));
    for k in (0..8).rev() {
        sine = L::splat(INVERSE_FACTORIAL[2 * k + 1]) - square * sine;
        cosine = L::splat(INVERSE_FACTORIAL[2 * k]) - square * cosine;
    }
    (s * sine, cosine)
}

/// Whether a whole number is this one.
#[inline(always)]
fn is<L: Lane>(whole: L, number: f64) -> L::Mask {
    (whole - L::splat(number)).abs().lt(L::splat(0.5))
}

/// Where `x` is not a finite number.
#[inline(always)]
pub fn not_finite<L: Lane>(x: L) -> L::Mask {
    // The comparison is false for NaN too.
    !x.abs().le(L::splat(f64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_logarithm_and_exponential_are_within_their_promises() {
        for i in -600..600 {
            let x = libm::exp(f64::from(i) * 0.37);
            assert!((x.rough_log() - libm::log2(x)).abs() < 0.09, "{x}");
            assert!((x.rough_log().rough_exp() / x - 1.0).abs() < 2e-6, "{x}");
        }
        assert!(0.0_f64.rough_log() <= -1022.0);
    }
}
