//! The exponential and the sine and cosine that a step starts from, with the same bits everywhere.

use std::f64::consts::{FRAC_2_PI, LOG2_E};

use super::Lane;

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
/// whose remainder is below 5e-18.
#[inline(always)]
pub fn exp_decay<L: Lane>(x: L) -> L {
    // ln 2 in two parts, the first with trailing zeros so that its multiples by n are exact.
    const LN_2_HIGH: f64 = f64::from_bits(0x3FE6_2E42_FEE0_0000);
    const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    let x = x.max(L::splat(-700.0));
    let n = (x * L::splat(LOG2_E)).nearest_whole();
    let s = (x - n * L::splat(LN_2_HIGH)) - n * L::splat(LN_2_LOW);
    let mut sum = L::splat(INVERSE_FACTORIAL[13]);
    for k in (0..13).rev() {
        sum = sum * s + L::splat(INVERSE_FACTORIAL[k]);
    }
    sum * n.exp2_whole()
}

/// `(sin x, cos x)` for `0 <= x <= 2 pi` (and a little beyond), within two units in the last place.
///
/// Method: `x = q pi/2 + s` with `|s| <= pi/4`, then Taylor polynomials of degree 17 and 16,
/// whose remainders are below 3e-18.
#[inline(always)]
pub fn sin_cos<L: Lane>(x: L) -> (L, L) {
    // pi/2 in three parts; the multiples by q <= 5 of the first two are exact.
    const PARTS: [f64; 3] = [
        f64::from_bits(0x3FF9_21FB_5440_0000),
        f64::from_bits(0x3DD0_B461_1A60_0000),
        f64::from_bits(0x3BA3_198A_2E03_7073),
    ];
    let q = (x * L::splat(FRAC_2_PI)).nearest_whole();
    let s = ((x - q * L::splat(PARTS[0])) - q * L::splat(PARTS[1])) - q * L::splat(PARTS[2]);
    let square = s * s;
    let (mut sine, mut cosine) = (L::splat(INVERSE_FACTORIAL[17]), L::splat(INVERSE_FACTORIAL[16]));
    for k in (0..8).rev() {
        sine = L::splat(INVERSE_FACTORIAL[2 * k + 1]) - square * sine;
        cosine = L::splat(INVERSE_FACTORIAL[2 * k]) - square * cosine;
    }
    sine = s * sine;
    let swapped = is(q, 1.0) | is(q, 3.0) | is(q, 5.0);
    let (first, second) = (L::select(swapped, cosine, sine), L::select(swapped, sine, cosine));
    let sine_negative = is(q, 2.0) | is(q, 3.0);
    let cosine_negative = is(q, 1.0) | is(q, 2.0) | is(q, 5.0);
    (L::select(sine_negative, -first, first), L::select(cosine_negative, -second, second))
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

    fn units_apart(a: f64, b: f64) -> u64 {
        a.to_bits().abs_diff(b.to_bits())
    }

    #[test]
    fn exponential_agrees_with_an_independent_one() {
        for i in 0..200_000 {
            let x = -f64::from(i) * 0.0013 - 1e-5 * f64::from(i % 7);
            assert!(units_apart(exp_decay(x), libm::exp(x)) <= 2, "x = {x}");
        }
        assert_eq!(exp_decay(0.0), 1.0);
        assert_eq!(exp_decay(-1e-300), 1.0);
    }

    #[test]
    fn sine_and_cosine_agree_with_independent_ones() {
        for i in 0..=200_000 {
            let x = f64::from(i) * (2.0 * std::f64::consts::PI / 200_000.0);
            let (sine, cosine) = sin_cos(x);
            assert!((sine - libm::sin(x)).abs() <= 2.3e-16, "sin {x}");
            assert!((cosine - libm::cos(x)).abs() <= 2.3e-16, "cos {x}");
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
    }

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
