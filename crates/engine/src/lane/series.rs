//! Taylor series of a step: truncated polynomials in the time since the step began.
//!
//! The functions `..._term` give coefficient `k` of a function of series, from the coefficients of the
//! arguments up to `k` and those of the result below `k`. So they serve a recurrence in which the argument
//! is itself found term by term.
//! Source: Griewank and Walther, Evaluating Derivatives, 2nd ed. (SIAM 2008), section 13.2.
//! Loops run to `k + 1` exclusively: an inclusive range counts and compares more in each turn.

use super::{Lane, elementary};

pub use super::order::{INVERSE, ORDER, Series, product_term};

/// Zero in every coefficient.
#[inline(always)]
pub fn zero<L: Lane>() -> Series<L> {
    const { [L::ZERO; ORDER + 1] }
}

/// Where every coefficient is a finite number.
#[inline(always)]
pub fn is_finite<L: Lane>(series: &Series<L>) -> L::Mask {
    let zero = L::splat(0.0);
    // Zero times what is not finite is not a number, nor is a sum with it.
    let sum = series.iter().fold(zero, |sum, term| sum + *term * zero);
    sum.le(zero)
}

/// The polynomial at time `h`.
#[inline(always)]
pub fn value<L: Lane>(series: &Series<L>, h: L) -> L {
    L::value_at(series, h)
}

/// What the polynomial changes by until time `h`; its first coefficient takes no part, so that no digit is lost to it.
#[inline(always)]
pub fn change<L: Lane>(series: &Series<L>, h: L) -> L {
    let mut sum = series[ORDER];
    for k in (1..ORDER).rev() {
        sum = sum * h + series[k];
    }
    sum * h
}

/// The polynomial and its derivative at time `h`.
#[inline(always)]
pub fn value_and_slope<L: Lane>(series: &Series<L>, h: L) -> (L, L) {
    let (mut sum, mut slope) = (series[ORDER], L::splat(0.0));
    for k in (0..ORDER).rev() {
        slope = slope * h + sum;
        sum = sum * h + series[k];
    }
    (sum, slope)
}

/// The polynomial and its first two derivatives at time `h`.
#[inline(always)]
pub fn value_slope_curvature<L: Lane>(series: &Series<L>, h: L) -> (L, L, L) {
    let (mut sum, mut slope, mut half) = (series[ORDER], L::splat(0.0), L::splat(0.0));
    for k in (0..ORDER).rev() {
        half = half * h + slope;
        slope = slope * h + sum;
        sum = sum * h + series[k];
    }
    (sum, slope, half + half)
}

/// The derivative, as a series.
#[inline(always)]
pub fn derivative<L: Lane>(series: &Series<L>) -> Series<L> {
    let mut slope = zero();
    for k in 1..=ORDER {
        slope[k - 1] = series[k] * L::splat(k as f64);
    }
    slope
}

/// A series without its derivatives.
#[inline(always)]
pub fn plain<L: Lane>(series: &Series<L>) -> Series<L::Plain> {
    let mut plain = zero();
    for (plain, term) in plain.iter_mut().zip(series) {
        *plain = term.plain();
    }
    plain
}

/// The sign that a series takes just after its start, that of its first term which is not zero; `of_zero` where
/// all terms vanish.
#[inline(always)]
pub fn sign_after_start<L: Lane>(series: &Series<L>, of_zero: L) -> L {
    let zero = L::splat(0.0);
    let mut sign = of_zero;
    for term in series.iter().rev() {
        sign = L::select(zero.lt(*term), L::splat(1.0), sign);
        sign = L::select(term.lt(zero), L::splat(-1.0), sign);
    }
    sign
}

/// A series times a number.
#[inline(always)]
pub fn scaled<L: Lane>(series: &Series<L>, by: L) -> Series<L> {
    let mut scaled = *series;
    for term in &mut scaled {
        *term = by * *term;
    }
    scaled
}

/// Coefficient `k` of the square of a series, by half the multiplications of a product.
///
/// Method: `2 (a_0 a_k + a_1 a_(k-1) + ...)`, the middle term once.
#[inline(always)]
pub fn square_term<L: Lane>(a: &Series<L>, k: usize) -> L {
    let mut half = L::splat(0.0);
    for j in 0..k.div_ceil(2) {
        half = half + a[j] * a[k - j];
    }
    let sum = half + half;
    if k.is_multiple_of(2) { sum + a[k / 2] * a[k / 2] } else { sum }
}

/// Coefficient `k` of the quotient `q = a/b`.
///
/// Method: `q_k = (a_k - sum_{j=1..k} b_j q_(k-j)) / b_0`. Breaks: where `b_0` is zero.
#[inline(always)]
pub fn quotient_term<L: Lane>(a: &Series<L>, b: &Series<L>, q: &Series<L>, k: usize) -> L {
    let mut rest = a[k];
    for j in 1..k + 1 {
        rest = rest - b[j] * q[k - j];
    }
    rest / b[0]
}

/// The square root `r` of a series `a`, term by term, with one division for all terms.
///
/// Method: `r_k = (a_k - sum_{j=1..k-1} r_j r_(k-j)) / (2 r_0)`, by half the multiplications, as of a square.
/// Breaks: where `a_0` is not positive.
#[derive(Debug, Clone, Copy)]
pub struct SquareRoot<L> {
    root: L,
    inverse: L,
}

impl<L: Lane> SquareRoot<L> {
    /// That of a series which begins with `first`.
    #[inline(always)]
    pub fn of(first: L) -> Self {
        let root = first.sqrt();
        SquareRoot { root, inverse: L::splat(1.0) / root }
    }

    /// Coefficient `k`.
    #[inline(always)]
    pub fn term(&self, a: &Series<L>, r: &Series<L>, k: usize) -> L {
        if k == 0 {
            return self.root;
        }
        let half = L::splat(0.5);
        let mut rest = half * a[k];
        for j in 1..k.div_ceil(2) {
            rest = rest - r[j] * r[k - j];
        }
        if k.is_multiple_of(2) {
            rest = rest - half * (r[k / 2] * r[k / 2]);
        }
        rest * self.inverse
    }
}

/// Coefficient `k` of the exponential `e` of a series.
///
/// Method: `e_k = (1/k) sum_{j=1..k} j a_j e_(k-j)`, from `e' = a' e`.
#[inline(always)]
pub fn exp_term<L: Lane>(a: &Series<L>, e: &Series<L>, k: usize) -> L {
    if k == 0 { elementary::exp(a[0]) } else { slope_product_term(a, e, k) }
}

/// Coefficient `k` of the natural logarithm `l` of a series.
///
/// Method: `l_k = (a_k - (1/k) sum_{j=1..k-1} j l_j a_(k-j)) / a_0`, from `a l' = a'`.
/// Breaks: where `a_0` is not positive.
#[inline(always)]
pub fn log_term<L: Lane>(a: &Series<L>, l: &Series<L>, k: usize) -> L {
    if k == 0 {
        return elementary::log(a[0]);
    }
    let mut sum = L::splat(0.0);
    for j in 1..k {
        sum = sum + L::splat(j as f64) * l[j] * a[k - j];
    }
    (a[k] - sum * L::splat(INVERSE[k])) / a[0]
}

/// Coefficient `k` of the sine `s` and of the cosine `c` of a series.
///
/// Method: `s_k = (1/k) sum_{j=1..k} j a_j c_(k-j)`, `c_k = -(1/k) sum_{j=1..k} j a_j s_(k-j)`, from
/// `s' = a' c`, `c' = -a' s`. Breaks: as [`elementary::sin_cos`] for large `a_0`.
#[inline(always)]
pub fn sin_cos_terms<L: Lane>(a: &Series<L>, s: &Series<L>, c: &Series<L>, k: usize) -> (L, L) {
    match k {
        0 => elementary::sin_cos(a[0]),
        _ => (slope_product_term(a, c, k), -slope_product_term(a, s, k)),
    }
}

/// Coefficient `k` of `p`, a series to the power `exponent`.
///
/// Method: `p_k = sum_{j=1..k} (j exponent - (k - j)) a_j p_(k-j) / (k a_0)`, from `a p' = exponent a' p`.
/// Breaks: where `a_0` is not positive; for whole exponents products are valid there too.
#[inline(always)]
pub fn power_term<L: Lane>(a: &Series<L>, exponent: L, p: &Series<L>, k: usize) -> L {
    if k == 0 {
        return elementary::power(a[0], exponent);
    }
    let mut sum = L::splat(0.0);
    for j in 1..k + 1 {
        let weight = L::splat(j as f64) * exponent - L::splat((k - j) as f64);
        sum = sum + weight * a[j] * p[k - j];
    }
    sum * L::splat(INVERSE[k]) / a[0]
}

/// Coefficient `k > 0` of the integral of `a' b`: `(1/k) sum_{j=1..k} j a_j b_(k-j)`.
#[inline(always)]
pub fn slope_product_term<L: Lane>(a: &Series<L>, b: &Series<L>, k: usize) -> L {
    let mut sum = L::splat(0.0);
    for j in 1..k + 1 {
        sum = sum + L::splat(j as f64) * a[j] * b[k - j];
    }
    sum * L::splat(INVERSE[k])
}

/// The integral of a polynomial from 0 to `h`.
#[inline(always)]
pub fn integral<L: Lane>(polynomial: &Series<L>, h: L) -> L {
    let mut sum = L::splat(0.0);
    for (k, &a) in polynomial.iter().enumerate().rev() {
        sum = sum * h + a * L::splat(INVERSE[k + 1]);
    }
    sum * h
}

/// The same polynomial in the time since `shift`, by repeated synthetic division.
#[inline(always)]
pub fn shifted<L: Lane>(series: &Series<L>, shift: L) -> Series<L> {
    let mut result = *series;
    for first in 0..ORDER {
        for k in (first..ORDER).rev() {
            result[k] = result[k] + shift * result[k + 1];
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_coefficient_that_is_not_finite_is_seen() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for place in 0..=ORDER {
                let mut series: Series<f64> = [1e300; ORDER + 1];
                assert!(is_finite(&series));
                series[place] = bad;
                assert!(!is_finite(&series), "{place} {bad}");
            }
        }
    }

    #[test]
    fn polynomial_algebra_agrees_with_itself_by_another_route() {
        let series: Series<f64> = std::array::from_fn(|k| 1.0 / (1.0 + k as f64 * k as f64));
        let h = 0.7;
        let (sum, slope) = value_and_slope(&series, h);
        assert!((sum - value(&series, h)).abs() < 1e-15);
        assert!((slope - value(&derivative(&series), h)).abs() < 1e-14);
        assert!((value(&shifted(&series, 0.3), 0.4) - sum).abs() < 1e-15);
        let exact: f64 =
            (0..=ORDER).map(|k| series[k] * h.powi(k as i32 + 1) / (k + 1) as f64).sum();
        assert!((integral(&series, h) - exact).abs() < 1e-15);
    }
}
