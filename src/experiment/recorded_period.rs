//! After how many cycles a record repeats itself.

use super::noise::noise;

/// The longest period that is looked for in a record [cycles].
pub const LONGEST: u64 = 8;

/// The fewest cycles after which a record repeats itself, up to [`LONGEST`]; none where it does not, or is too short.
///
/// Method: the record is compared with itself so many cycles later, by interpolation between samples. It repeats where the root
/// mean square of the difference is below three times what the noise alone gives, or a fiftieth of the record's standard
/// deviation.
pub fn period_of(times: &[f64], values: &[f64], cycle: f64) -> Option<u64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let deviation =
        (values.iter().map(|it| (it - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt();
    let allowed = (3.0 * std::f64::consts::SQRT_2 * noise(values)).max(0.02 * deviation);
    (1..=LONGEST).find(|&count| {
        let shift = count as f64 * cycle;
        let last = times[times.len() - 1];
        let pairs = times.iter().zip(values).filter(|(time, _)| **time + shift <= last);
        let apart = pairs.map(|(time, value)| interpolated(times, values, time + shift) - value);
        let squares: Vec<f64> = apart.map(|it| it.powi(2)).collect();
        // A comparison over less than a cycle would say nothing.
        let is_long = last - shift >= cycle;
        is_long && (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() < allowed
    })
}

/// The value at a time, on the straight line between the samples about it.
fn interpolated(times: &[f64], values: &[f64], time: f64) -> f64 {
    let after = times.partition_point(|it| *it < time).max(1);
    let (a, b) = (after - 1, after);
    let share = (time - times[a]) / (times[b] - times[a]);
    values[a] + share * (values[b] - values[a])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn periods_of_records_are_found() {
        let times: Vec<f64> = (0..2000).map(|i| 1e-3 * f64::from(i)).collect();
        let noise = |i: usize| 0.01 * ((i * i * 31 % 101) as f64 / 50.0 - 1.0);
        let record = |of: &dyn Fn(f64) -> f64| -> Vec<f64> {
            times.iter().enumerate().map(|(i, t)| of(*t) + noise(i)).collect()
        };
        let cycle = 0.11;
        let wave = |t: f64| (TAU * t / cycle).cos();
        assert_eq!(period_of(&times, &record(&wave), cycle), Some(1));
        let third = |t: f64| wave(t) + 0.2 * (TAU * t / (3.0 * cycle)).sin();
        assert_eq!(period_of(&times, &record(&third), cycle), Some(3));
        let never = |t: f64| {
            wave(t) + 0.3 * (TAU * t / (2f64.sqrt() * cycle)).sin() + 0.3 * (5.0 * t * t).sin()
        };
        assert_eq!(period_of(&times, &record(&never), cycle), None);
    }
}
