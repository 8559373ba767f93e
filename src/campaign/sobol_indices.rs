//! Sobol indices of numbers on Saltelli's design, with intervals by resampling its rows.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::study::Saltelli;

/// How intervals are found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resampling {
    /// How often as many rows as there are are drawn from them, with replacement.
    pub resamples: usize,
    /// The share of intervals that are to hold the true value.
    pub confidence: f64,
    /// The number by which rows are drawn.
    pub seed: u64,
}

impl Default for Resampling {
    fn default() -> Self {
        Resampling { resamples: 1000, confidence: 0.95, seed: 1 }
    }
}

/// An index, or a sum of such.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SobolIndex {
    /// Its estimate.
    pub value: f64,
    /// Half the width of its interval.
    pub half_width: f64,
}

/// What the variance of an output comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct SobolIndices {
    /// The mean over A and B (unit of the output).
    pub mean: f64,
    /// The variance over A and B (unit of the output squared).
    pub variance: f64,
    /// The share of the variance that a quantity makes by itself, for each.
    pub first: Vec<SobolIndex>,
    /// The share that it takes part in, with others too, for each.
    pub total: Vec<SobolIndex>,
    /// The sum of the first.
    pub first_sum: SobolIndex,
    /// The sum of the total ones.
    pub total_sum: SobolIndex,
}

/// Why there are no indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoIndices {
    /// There are fewer than two rows.
    TooFewRows,
    /// All values are the same to rounding: the variance is zero.
    Constant,
}

impl NoIndices {
    /// In words.
    pub fn reason(self) -> &'static str {
        match self {
            NoIndices::TooFewRows => "fewer than two base samples have values",
            NoIndices::Constant => "the variance is zero: all values are the same to rounding",
        }
    }
}

/// Differences below this, relative to the largest magnitude, are rounding.
const ROUNDING: f64 = 1e-12;

/// The Sobol indices of `values`, those of the cases of whole rows of `design` in their order, all of them finite.
///
/// # Method
///
/// Of values that are shifted and scaled to mean 0 and variance 1 over all cases, with V their variance over A and B: first order
/// mean(B (AB - A)) / V, total order mean((A - AB)^2) / 2V. An interval is the estimate -+ z times the standard deviation of the estimates
/// from resampled rows, where z is the quantile of the normal distribution. These are what SALib's `sobol.analyze` computes without
/// second order; its rows are resampled by other random numbers.
///
/// # Source
///
/// First order: A. Saltelli and others, Comput. Phys. Commun. 181, 259-270, 2010. Total order: M. J. W. Jansen, Comput. Phys. Commun.
/// 117, 35-43, 1999. Intervals: G. E. B. Archer, A. Saltelli, I. M. Sobol', J. Stat. Comput. Simul. 58, 99-120, 1997.
///
/// # Assumes
///
/// The quantities are independent. For the intervals, that rows are: those of the design are more even than independent ones, so that
/// its intervals are too wide rather than too narrow where the output is smooth.
///
/// # Guarantees
///
/// The same bits for the same values and the same [`Resampling`].
///
/// # Breaks
///
/// Estimates may be below 0 or above 1 by as much as the intervals say. From a few tens of rows, and of outputs with few values far from
/// all others, intervals are too narrow.
pub fn sobol_indices(
    values: &[f64],
    design: Saltelli,
    resampling: Resampling,
) -> Result<SobolIndices, NoIndices> {
    let rows = values.len() / design.row_length();
    if rows < 2 {
        return Err(NoIndices::TooFewRows);
    }
    let (mean, deviation) = mean_and_deviation(values.iter().copied());
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let terms = Terms::of(values, design, mean, deviation);
    let found = terms.estimates(&vec![1; rows]);
    let varies =
        deviation > ROUNDING * largest && found.variance.sqrt() * deviation > ROUNDING * largest;
    if !varies {
        return Err(NoIndices::Constant);
    }
    let halves = half_widths(&terms, resampling);
    let both = found.all.iter().zip(halves);
    let all = both.map(|(value, half_width)| SobolIndex { value: *value, half_width });
    let all: Vec<SobolIndex> = all.collect();
    let (each, sums) = all.split_at(2 * design.quantities);
    let (first, total) = each.split_at(design.quantities);
    Ok(SobolIndices {
        mean: mean + deviation * found.mean,
        variance: deviation * deviation * found.variance,
        first: first.to_vec(),
        total: total.to_vec(),
        first_sum: sums[0],
        total_sum: sums[1],
    })
}

/// The mean of numbers and the root of their variance.
fn mean_and_deviation(values: impl ExactSizeIterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares = values.map(|value| (value - mean) * (value - mean)).sum::<f64>();
    (mean, (squares / count).sqrt())
}

/// The terms whose means over rows make the estimates: of each row A + B, A^2 + B^2, B (AB - A) and (A - AB)^2 of each quantity.
struct Terms {
    quantities: usize,
    /// Row by row.
    all: Vec<f64>,
}

/// What some rows give.
struct Estimates {
    /// The mean over A and B.
    mean: f64,
    /// The variance over A and B.
    variance: f64,
    /// First and total order of each quantity, and the sums of both.
    all: Vec<f64>,
}

impl Terms {
    /// Those of values that are shifted by a mean and scaled by a deviation.
    fn of(values: &[f64], design: Saltelli, mean: f64, deviation: f64) -> Terms {
        let mut all = Vec::new();
        for row in values.chunks_exact(design.row_length()) {
            let row: Vec<f64> = row.iter().map(|value| (value - mean) / deviation).collect();
            let ([a, mixed @ .., b], true) = (&row[..], row.len() > 1) else { continue };
            all.extend([a + b, a * a + b * b]);
            all.extend(mixed.iter().map(|ab| b * (ab - a)));
            all.extend(mixed.iter().map(|ab| (a - ab) * (a - ab)));
        }
        Terms { quantities: design.quantities, all }
    }

    /// Terms of a row.
    fn width(&self) -> usize {
        2 + 2 * self.quantities
    }

    /// What the rows give, each as often as `counts` says.
    fn estimates(&self, counts: &[u32]) -> Estimates {
        let mut sums = vec![0.0; self.width()];
        for (row, count) in self.all.chunks_exact(self.width()).zip(counts) {
            let count = f64::from(*count);
            sums.iter_mut().zip(row).for_each(|(sum, term)| *sum += count * term);
        }
        let rows: f64 = counts.iter().map(|count| f64::from(*count)).sum();
        let mean = sums[0] / (2.0 * rows);
        let variance = sums[1] / (2.0 * rows) - mean * mean;
        let (first, total) = sums[2..].split_at(self.quantities);
        let first = first.iter().map(|sum| sum / rows / variance);
        let total = total.iter().map(|sum| 0.5 * sum / rows / variance);
        let sums = [first.clone().sum(), total.clone().sum()];
        Estimates { mean, variance, all: first.chain(total).chain(sums).collect() }
    }
}

/// Half the width of the interval of each estimate.
fn half_widths(terms: &Terms, resampling: Resampling) -> Vec<f64> {
    let rows = terms.all.len() / terms.width();
    let mut random = fastrand::Rng::with_seed(resampling.seed);
    let mut columns = vec![Vec::new(); 2 * terms.quantities + 2];
    let mut counts = vec![0; rows];
    for _ in 0..resampling.resamples {
        counts.fill(0);
        (0..rows).for_each(|_| counts[random.usize(..rows)] += 1);
        let found = terms.estimates(&counts);
        columns.iter_mut().zip(found.all).for_each(|(column, it)| column.push(it));
    }
    // With this factor it is the deviation of a sample.
    let bessel = resampling.resamples as f64 / (resampling.resamples as f64 - 1.0);
    let quantile = Normal::standard().inverse_cdf(0.5 + 0.5 * resampling.confidence);
    let factor = quantile * bessel.sqrt();
    columns.iter().map(|column| factor * mean_and_deviation(column.iter().copied()).1).collect()
}
