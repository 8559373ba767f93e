//! Impacts of a record: spikes of the accelerometer on the mass, and where the relative displacement reaches the gap.

use super::free_vibration::noise;
use super::recording::median;
use super::smoothing::{Window, smoothed};

/// A spike stands out by this many standard deviations of the noise at least.
const CLEAR: f64 = 8.0;
/// And by this share of the largest.
const SHARE: f64 = 0.25;

/// A spike of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spike {
    /// When its peak is [s].
    pub time: f64,
    /// Its peak, with its sign, in the unit of the record.
    pub peak: f64,
    /// How far it stands out of what is around it.
    pub prominence: f64,
}

/// The spikes of an acceleration towards the side on which they are higher.
///
/// # Method
///
/// Impacts push the mass to one side: that on which the record goes farther from its median. A local extremum there is a
/// spike if its prominence, the height above the higher of the lowest points between it and a higher one on either side, is
/// at least eight standard deviations of the noise and a quarter of the largest prominence.
///
/// # Breaks
///
/// A soft stop, in contact for much of the cycle, makes no spike: an impact is then seen in r alone. Where the mass is
/// driven harder than the stop pushes, the extrema of the drive are spikes too.
pub fn spikes(times: &[f64], acceleration: &[f64]) -> Vec<Spike> {
    if acceleration.len() < 5 {
        return Vec::new();
    }
    let middle = median(acceleration);
    let farthest = |end: fn(f64, f64) -> f64| {
        acceleration.iter().copied().reduce(end).unwrap_or(middle) - middle
    };
    let sign = if farthest(f64::max) >= -farthest(f64::min) { 1.0 } else { -1.0 };
    let height: Vec<f64> = acceleration.iter().map(|it| sign * (it - middle)).collect();
    let tops =
        (1..height.len() - 1).filter(|&i| height[i] > height[i - 1] && height[i] >= height[i + 1]);
    let found: Vec<Spike> = tops
        .map(|i| Spike {
            time: times[i],
            peak: acceleration[i],
            prominence: prominence(&height, i),
        })
        .collect();
    let largest = found.iter().map(|it| it.prominence).fold(0.0, f64::max);
    let least = (CLEAR * noise(acceleration)).max(SHARE * largest);
    found.into_iter().filter(|it| it.prominence > 0.0 && it.prominence >= least).collect()
}

/// How far the point `top` stands above the higher of the lowest points between it and a higher one on either side.
fn prominence(height: &[f64], top: usize) -> f64 {
    let lowest = |side: &mut dyn Iterator<Item = &f64>| {
        side.take_while(|it| **it <= height[top]).fold(height[top], |least, it| least.min(*it))
    };
    let before = lowest(&mut height[..top].iter().rev());
    let after = lowest(&mut height[top + 1..].iter());
    height[top] - before.max(after)
}

/// The times at which the relative displacement `r` rises through the gap `delta` and stays beyond it by three standard
/// deviations of its noise for a moment [s].
///
/// A record that only touches the stop within its noise shows no impact; one that leaves the stop within its noise shows one for two.
pub fn contacts(times: &[f64], r: &[f64], delta: f64) -> Vec<f64> {
    let window = Window { samples: 5, order: 2 };
    let Ok(smooth) = smoothed(times, r, window, 0) else { return Vec::new() };
    // A parabola through five points keeps 0.7 of the deviation of the noise.
    let clear = 3.0 * 0.7 * noise(r);
    let (mut is_closed, mut rises) = (smooth[0] > delta, None);
    let mut found = Vec::new();
    for (i, value) in smooth.iter().enumerate().skip(1) {
        if smooth[i - 1] < delta && *value >= delta {
            rises = Some(times[i]);
        }
        if !is_closed && *value > delta + clear {
            is_closed = true;
            found.extend(rises);
        }
        is_closed &= *value > delta - clear;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spikes_on_a_wave_are_found_with_their_sign() {
        let times: Vec<f64> = (0..2000).map(|i| 1e-3 * f64::from(i)).collect();
        let noise = |i: usize| 0.05 * ((i * i * 31 % 101) as f64 / 50.0 - 1.0);
        let spike = |t: f64| {
            let from = (t % 0.4) - 0.1;
            -20.0 * (-(from / 2e-3).powi(2)).exp()
        };
        let record: Vec<f64> = times
            .iter()
            .enumerate()
            .map(|(i, t)| 1.5 * (15.7 * t).sin() + spike(*t) + noise(i))
            .collect();
        let found = spikes(&times, &record);
        assert_eq!(found.len(), 5, "{found:?}");
        for (i, spike) in found.iter().enumerate() {
            assert!((spike.time - 0.4 * i as f64 - 0.1).abs() < 2e-3, "{spike:?}");
            assert!(spike.peak < -15.0 && spike.prominence > 15.0, "{spike:?}");
        }
        assert!(spikes(&times[..3], &record[..3]).is_empty());
        assert!(spikes(&times, &vec![1.0; 2000]).is_empty());
    }
}
