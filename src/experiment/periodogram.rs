//! The strongest frequency of a record, in time that grows hardly faster than the record.

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Frequencies that are tried, per resolvable difference of frequencies.
const PER_LINE: usize = 4;
/// Bins of a record at most.
const MOST_BINS: usize = 1 << 18;
/// Frequencies on either side of the strongest of which the power is computed exactly.
const NEIGHBOURS: usize = 2;

/// The frequency [rad/s] of the strongest harmonic of `values` at `times` that need not be even; none where they do not vary.
///
/// # Method
///
/// The values, less their mean, are summed into even bins of at most half the mean interval; a fast Fourier transform of four
/// times their span gives the power at four frequencies per resolvable one, from one cycle in the record to a quarter of the
/// mean sampling rate. About the strongest the power is computed from the samples at their own times.
///
/// # Source
///
/// Press and Rybicki, Astrophysical Journal 338 (1989), with bins rather than extirpolation, as only the place of the maximum is
/// needed.
///
/// # Breaks
///
/// Of more than 131072 samples, frequencies above a quarter of the rate of 262144 bins are not found.
pub fn strongest(times: &[f64], values: &[f64]) -> Option<f64> {
    let count = times.len();
    let span = times[count - 1] - times[0];
    let mean = values.iter().sum::<f64>() / count as f64;
    let bins = (2 * count).next_power_of_two().min(MOST_BINS);
    let mut binned = vec![Complex::new(0.0, 0.0); PER_LINE * bins];
    for (time, value) in times.iter().zip(values) {
        let bin = ((time - times[0]) / span * bins as f64).round() as usize;
        binned[bin].re += value - mean;
    }
    FftPlanner::new().plan_fft_forward(binned.len()).process(&mut binned);
    let greatest = count.min(bins / 2);
    let near = (PER_LINE..=greatest)
        .max_by(|&a, &b| binned[a].norm_sqr().total_cmp(&binned[b].norm_sqr()))
        .filter(|&i| binned[i].norm_sqr() > 0.0)?;
    let least = near.saturating_sub(NEIGHBOURS).max(PER_LINE);
    let candidates = (least..=near + NEIGHBOURS).map(|i| {
        let omega = TAU * i as f64 / (PER_LINE as f64 * span);
        let pairs = times.iter().zip(values);
        let terms =
            pairs.map(|(time, value)| Complex::from_polar(value - mean, omega * (time - times[0])));
        (terms.sum::<Complex<f64>>().norm_sqr(), omega)
    });
    candidates.max_by(|a, b| a.0.total_cmp(&b.0)).map(|it| it.1)
}
