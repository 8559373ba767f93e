//! The strongest frequency of a record, in time that grows hardly faster than the record.

use std::f64::consts::TAU;

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
    let mut binned = vec![[0.0, 0.0]; PER_LINE * bins];
    for (time, value) in times.iter().zip(values) {
        let bin = ((time - times[0]) / span * bins as f64).round() as usize;
        binned[bin][0] += value - mean;
    }
    transform(&mut binned);
    let omega = |i: usize| TAU * i as f64 / (PER_LINE as f64 * span);
    let power = |[re, im]: [f64; 2]| re * re + im * im;
    let greatest = count.min(bins / 2);
    let near = (PER_LINE..=greatest)
        .max_by(|&a, &b| power(binned[a]).total_cmp(&power(binned[b])))
        .filter(|&i| power(binned[i]) > 0.0)?;
    let exact = |i: usize| {
        let terms = times.iter().zip(values).map(|(time, value)| {
            let (sin, cos) = (omega(i) * (time - times[0])).sin_cos();
            [(value - mean) * cos, (value - mean) * sin]
        });
        power(terms.fold([0.0, 0.0], |sum, it| [sum[0] + it[0], sum[1] + it[1]]))
    };
    let least = near.saturating_sub(NEIGHBOURS).max(PER_LINE);
    let candidates = (least..=near + NEIGHBOURS).map(|i| (exact(i), omega(i)));
    candidates.max_by(|a, b| a.0.total_cmp(&b.0)).map(|it| it.1)
}

/// The discrete Fourier transform of a power of two of numbers, in place.
///
/// Source: Cooley and Tukey, Mathematics of Computation 19 (1965), by decimation in time.
fn transform(values: &mut [[f64; 2]]) {
    let count = values.len();
    let shift = usize::BITS - count.trailing_zeros();
    for i in 0..count {
        let mirrored = i.reverse_bits() >> shift;
        if i < mirrored {
            values.swap(i, mirrored);
        }
    }
    let mut length = 2;
    while length <= count {
        let half = length / 2;
        let turns: Vec<(f64, f64)> =
            (0..half).map(|k| (-TAU * k as f64 / length as f64).sin_cos()).collect();
        for part in values.chunks_exact_mut(length) {
            let (low, high) = part.split_at_mut(half);
            for ((a, b), (sin, cos)) in low.iter_mut().zip(high).zip(&turns) {
                let turned = [b[0] * cos - b[1] * sin, b[0] * sin + b[1] * cos];
                *b = [a[0] - turned[0], a[1] - turned[1]];
                *a = [a[0] + turned[0], a[1] + turned[1]];
            }
        }
        length *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_sum_that_it_stands_for() {
        let values: Vec<f64> = (0..64).map(|i| f64::from(i * i * 7 % 23)).collect();
        let mut found: Vec<[f64; 2]> = values.iter().map(|it| [*it, 0.0]).collect();
        transform(&mut found);
        for (k, found) in found.iter().enumerate() {
            let angle = |i: usize| -TAU * (i * k) as f64 / 64.0;
            let of = |part: fn(f64) -> f64| {
                values.iter().enumerate().map(|(i, it)| it * part(angle(i))).sum::<f64>()
            };
            assert!(
                (found[0] - of(f64::cos)).abs() < 1e-10 && (found[1] - of(f64::sin)).abs() < 1e-10
            );
        }
    }
}
