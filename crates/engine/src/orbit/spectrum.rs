//! All Lyapunov exponents, from multipliers or from rates of stretching, and the dimension that follows from them.

use super::exponent::{Exponent, exponents_of};
use super::matrix::Complex;

/// A multiplier that is so much smaller than the largest is rounding to a part of it.
const RESOLVED: f64 = 1e-6;

/// The exponents of the section, the largest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum<const D: usize> {
    /// As many as the section has coordinates [1/s]; minus infinity of directions that are lost.
    pub exponents: [Exponent; D],
    /// The dimension of the attractor on the section [-].
    pub dimension: Exponent,
}

/// The largest first.
pub(super) fn sorted<const D: usize>(mut exponents: [Exponent; D]) -> [Exponent; D] {
    exponents.sort_by(|one, other| other.value.total_cmp(&one.value));
    exponents
}

/// The exponents of a periodic orbit of this duration [s] by its multipliers, the largest magnitude first, and the rates of stretching
/// in each of several periods.
///
/// Method: the logarithms of the multipliers. Those that are far smaller than the largest are rounding to a part of it: of one the
/// exponent is what is left of the rate at which volumes shrink; of more they are the means of the rates, with their standard
/// errors. Which directions are lost is told by the rates.
pub(super) fn of_multipliers<const D: usize>(
    multipliers: &[Complex],
    duration: f64,
    periods: &[[f64; D]],
) -> Spectrum<D> {
    let mut exponents = sorted(exponents_of(periods));
    let alive = exponents.iter().filter(|it| it.value > f64::NEG_INFINITY).count();
    let least = RESOLVED * multipliers[0].abs();
    let resolved = multipliers.iter().take_while(|it| it.abs() > least).count().min(alive);
    for (own, multiplier) in exponents.iter_mut().zip(&multipliers[..resolved]) {
        *own = Exponent { value: libm::log(multiplier.abs()) / duration, uncertainty: 0.0 };
    }
    if resolved + 1 == alive {
        let last = periods.last().expect("there are periods");
        let all: f64 = last.iter().filter(|rate| rate.is_finite()).sum();
        let others: f64 = exponents[..resolved].iter().map(|it| it.value).sum();
        exponents[resolved] = Exponent { value: all - others, uncertainty: 0.0 };
    }
    // The section of an orbit is a set of points.
    Spectrum { exponents, dimension: Exponent { value: 0.0, uncertainty: 0.0 } }
}

/// The dimension of an attractor by the rates of stretching in batches of cycles, with its standard error; rates up to `zero` in
/// magnitude are those of directions that neither grow nor shrink.
///
/// Method: [`kaplan_yorke`] of the means; the error is that of the jackknife, which leaves out one batch after the other.
pub(super) fn dimension<const D: usize>(batches: &[[f64; D]], zero: f64) -> Exponent {
    let of = |left_out: Option<usize>| {
        let kept: Vec<[f64; D]> = (0..batches.len())
            .filter(|batch| Some(*batch) != left_out)
            .map(|batch| batches[batch])
            .collect();
        let rates = sorted(exponents_of(&kept)).map(|it| it.value);
        kaplan_yorke(&rates.map(|rate| if rate.abs() <= zero { 0.0 } else { rate }))
    };
    let count = batches.len() as f64;
    let without: Vec<f64> = (0..batches.len()).map(|batch| of(Some(batch))).collect();
    let mean = without.iter().sum::<f64>() / count;
    let squares: f64 = without.iter().map(|it| (it - mean) * (it - mean)).sum();
    Exponent { value: of(None), uncertainty: (squares * (count - 1.0) / count).sqrt() }
}

/// The dimension that follows from exponents, the largest first: as many as do not shrink volumes together, and the share of the next
/// that brings the sum to zero. A direction that is lost has no share.
///
/// Source: Kaplan and Yorke (1979).
pub fn kaplan_yorke(exponents: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (number, exponent) in exponents.iter().enumerate() {
        if sum + exponent < 0.0 {
            return number as f64 - sum / exponent;
        }
        sum += exponent;
    }
    exponents.len() as f64
}
