//! Taylor series of a step: truncated polynomials in the time since the step began.

use super::Lane;

/// Degree at which every series is cut.
pub const ORDER: usize = 16;

/// Coefficients of the powers 0..=ORDER of the time since the step began.
pub type Series<L> = [L; ORDER + 1];

/// `1/n`, so that the recurrences multiply rather than divide.
pub const INVERSE: [f64; ORDER + 2] = {
    let mut table = [0.0; ORDER + 2];
    let mut n = 1;
    while n < table.len() {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// Zero in every coefficient.
#[inline(always)]
pub fn zero<L: Lane>() -> Series<L> {
    [L::splat(0.0); ORDER + 1]
}

/// The polynomial at time `h`.
#[inline(always)]
pub fn value<L: Lane>(series: &Series<L>, h: L) -> L {
    let mut sum = series[ORDER];
    for k in (0..ORDER).rev() {
        sum = sum * h + series[k];
    }
    sum
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

/// Coefficient `k` of the product of two series.
#[inline(always)]
pub fn product_term<L: Lane>(a: &Series<L>, b: &Series<L>, k: usize) -> L {
    let mut sum = a[0] * b[k];
    for j in 1..=k {
        sum = sum + a[j] * b[k - j];
    }
    sum
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
pub fn shifted(series: &Series<f64>, shift: f64) -> Series<f64> {
    let mut result = *series;
    for first in 0..ORDER {
        for k in (first..ORDER).rev() {
            result[k] += shift * result[k + 1];
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

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
