//! The degree of all series, and what numbers of every kind need of series.

use std::ops::{Add, Mul};

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

/// Coefficient `k` of the product of two series.
#[inline(always)]
pub fn product_term<T>(a: &Series<T>, b: &Series<T>, k: usize) -> T
where
    T: Copy + Add<Output = T> + Mul<Output = T>,
{
    let mut sum = a[0] * b[k];
    for j in 1..k + 1 {
        sum = sum + a[j] * b[k - j];
    }
    sum
}
