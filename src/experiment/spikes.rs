//! Impacts of a record: pulses of the accelerometer on the mass, and where the relative displacement reaches the gap.

use std::f64::consts::TAU;

use super::noise::noise;
use super::recording::median;
use super::smoothing::{Window, smoothed};
use crate::capsule::Parameter;
use crate::description::Parameters;

/// A pulse stands out by this many standard errors of its height at least.
const CLEAR: f64 = 6.0;
/// And by this share of the standard deviation of the record more: the motion between impacts is no parabola.
const OF_RECORD: f64 = 0.2;
/// And by this share of the highest.
const SHARE: f64 = 0.25;
/// A pulse is sought in a window of so many periods of the mass on the stop.
const WINDOW: f64 = 1.5;
/// Pulses that follow each other within so many of these periods are of one contact.
const ONE_CONTACT: f64 = 1.1;
/// Samples in a period of the mass on the stop: fewer show no pulse, and more are averaged to fewer.
const SAMPLES: [f64; 2] = [6.0, 80.0];
/// The window is this share of a cycle at most.
const LONGEST_WINDOW: f64 = 0.8;

/// A pulse of the acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spike {
    /// When it is highest [s].
    pub time: f64,
    /// How far it goes beyond the motion about it, with its sign, in the unit of the record.
    pub height: f64,
}

/// The pulses of a record, and the time at its end in which none is sought.
#[derive(Debug, Clone, PartialEq)]
pub struct Spikes {
    /// One per contact, in their order.
    pub found: Vec<Spike>,
    /// None is sought so near to the first and the last sample [s].
    pub margin: f64,
}

/// The period of the mass on the spring and the stop, the capsule being held [s].
pub fn contact_period(parameters: &Parameters) -> f64 {
    let stiffness = parameters[Parameter::K1] + parameters[Parameter::K2];
    TAU / (stiffness / parameters[Parameter::M1]).sqrt()
}

/// The pulses of an acceleration that impacts give, on the side on which they are higher; none where the record cannot show them.
///
/// # Method
///
/// A contact lasts about half the `period` T of the mass on spring and stop, [`contact_period`]. About each sample a parabola and half
/// a wave of that length are fitted together to a window of 1.5 T; the height of the half wave is that of a pulse. A maximum of the
/// height is a pulse if it is at least a quarter of the highest, and above six of its standard errors and a fifth of the standard
/// deviation of the record together. On the stop the mass rings with the period T or, as the capsule gives way, a shorter one;
/// pulses that follow each other within 1.1 T are of one contact and count once.
///
/// # Source
///
/// The matched filter in white noise: Turin, IRE Transactions on Information Theory 6 (1960); the noise is that of third differences.
///
/// # Assumes
///
/// The stiffness of the stop is that of the study to some ten per cent.
///
/// # Breaks
///
/// None is returned where the window is longer than 0.8 of the `cycle`, as such a contact is no pulse, or where fewer than six
/// samples fall in T. A contact whose force is below the thresholds is not seen, and a mass that leaves the stop for less
/// than 0.6 T is seen once for two.
pub fn spikes(times: &[f64], acceleration: &[f64], period: f64, cycle: f64) -> Option<Spikes> {
    let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if intervals.is_empty() || WINDOW * period > LONGEST_WINDOW * cycle {
        return None;
    }
    let interval = median(&intervals);
    let together = (period / interval / SAMPLES[1]).floor().max(1.0);
    let even = averaged(times, acceleration, interval * together);
    let samples = period / (interval * together);
    let pulse = Pulse::new(samples);
    if samples < SAMPLES[0] || even.len() < 2 * pulse.weights.len() {
        return None;
    }
    let step = interval * together;
    let margin = (pulse.half() as f64 + 0.5) * step;
    let mut heights = pulse.heights(&even);
    let above = heights.iter().copied().fold(0.0, f64::max);
    let below = heights.iter().map(|it| -it).fold(0.0, f64::max);
    let (sign, highest) = if above >= below { (1.0, above) } else { (-1.0, below) };
    heights.iter_mut().for_each(|it| *it *= sign);
    let clear = CLEAR * noise(&even) * pulse.unit_error + OF_RECORD * deviation(&even);
    let tops = tops(&heights, clear.max(SHARE * highest), samples);
    let found = tops.into_iter().map(|(at, height)| Spike {
        time: times[0] + (at + pulse.half() as f64) * step + 0.5 * (step - interval),
        height: sign * height,
    });
    Some(Spikes { found: found.collect(), margin })
}

/// The maxima above a threshold, in samples, one per contact.
fn tops(heights: &[f64], least: f64, samples: f64) -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = Vec::new();
    for i in 1..heights.len().saturating_sub(1) {
        let [before, top, after] = [heights[i - 1], heights[i], heights[i + 1]];
        if top < least || top <= before || top < after {
            continue;
        }
        // Where the parabola through the three is highest.
        let at = i as f64 + 0.5 * (before - after) / (before - 2.0 * top + after);
        match all.last_mut() {
            Some(last) if at - last.0 < 0.5 * samples => {
                if top > last.1 {
                    *last = (at, top);
                }
            }
            _ => all.push((at, top)),
        }
    }
    let mut firsts = Vec::new();
    for (i, top) in all.iter().enumerate() {
        if i == 0 || top.0 - all[i - 1].0 > ONE_CONTACT * samples {
            firsts.push(*top);
        }
    }
    firsts
}

/// Half a wave in a window, without its parts along the parabolas of the window.
struct Pulse {
    weights: Vec<f64>,
    /// The standard error of a height over that of a sample.
    unit_error: f64,
}

impl Pulse {
    /// Of a contact of half so many samples.
    fn new(samples: f64) -> Pulse {
        let half = (0.5 * WINDOW * samples).round().max(4.0) as i32;
        let at: Vec<f64> = (-half..=half).map(f64::from).collect();
        let wave = at.iter().map(|u| match u.abs() < 0.25 * samples {
            true => (TAU * u / samples).cos(),
            false => 0.0,
        });
        let mut weights: Vec<f64> = wave.collect();
        // The wave is even in time, so of a cubic only the constant and the square are not orthogonal to it.
        let square = at.iter().map(|u| u * u).sum::<f64>() / at.len() as f64;
        let parabolas: [Vec<f64>; 2] =
            [vec![1.0; at.len()], at.iter().map(|u| u * u - square).collect()];
        for parabola in parabolas {
            let share = product(&parabola, &weights) / product(&parabola, &parabola);
            weights.iter_mut().zip(&parabola).for_each(|(it, p)| *it -= share * p);
        }
        let norm: f64 = weights.iter().map(|it| it * it).sum();
        weights.iter_mut().for_each(|it| *it /= norm);
        Pulse { weights, unit_error: 1.0 / norm.sqrt() }
    }

    /// Half the samples of the window.
    fn half(&self) -> usize {
        self.weights.len() / 2
    }

    /// The height of the pulse about each sample that has a whole window.
    fn heights(&self, values: &[f64]) -> Vec<f64> {
        values.windows(self.weights.len()).map(|part| product(part, &self.weights)).collect()
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The means of a record over even intervals of this length; where one has no sample, the mean before it.
fn averaged(times: &[f64], values: &[f64], length: f64) -> Vec<f64> {
    let (mut means, mut from) = (Vec::new(), 0);
    let count = ((times[times.len() - 1] - times[0]) / length + 0.5).floor() as usize;
    for i in 0..count {
        // Samples lie in the middle of their interval.
        let ends = times[0] + ((i + 1) as f64 - 1e-6) * length;
        let to = from + times[from..].iter().take_while(|time| **time < ends).count();
        let mean = match to > from {
            true => values[from..to].iter().sum::<f64>() / (to - from) as f64,
            false => means.last().copied().unwrap_or(values[0]),
        };
        means.push(mean);
        from = to;
    }
    means
}

fn deviation(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|it| (it - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Events per cycle up to a time, over as many whole cycles as follow the middle of the longest interval without one in the first
/// three.
///
/// A window that begins there cuts none in half, which one that begins with the record may.
pub fn per_cycle(events: &[f64], cycle: f64, until: f64) -> f64 {
    let early: Vec<f64> = events.iter().copied().take_while(|time| *time < 3.0 * cycle).collect();
    let longest = early.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    let begins = longest.map_or(0.0, |pair| 0.5 * (pair[0] + pair[1]));
    let whole = ((until - begins) / cycle).floor().max(1.0);
    let window = begins..begins + whole * cycle;
    events.iter().filter(|time| window.contains(time)).count() as f64 / whole
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
    use crate::experiment::synthesis::Noise;

    /// A wave of the drive with a contact of half a wave of 20 ms in each cycle of 0.4 s, and noise.
    fn record(height: f64, rate: f64, seed: u64) -> (Vec<f64>, Vec<f64>) {
        let mut noise = Noise::new(seed);
        let times: Vec<f64> = (0..(2.0 * rate) as u32).map(|i| f64::from(i) / rate).collect();
        let contact = |t: f64| {
            let from = (t % 0.4) - 0.1;
            if from.abs() < 5e-3 { height * (TAU * from / 20e-3).cos() } else { 0.0 }
        };
        let at = |t: &f64| 1.5 * (15.7 * t).sin() + contact(*t) + noise.normal(0.1);
        let values = times.iter().map(at).collect();
        (times, values)
    }

    #[test]
    fn pulses_on_a_wave_are_found_with_their_sign() {
        for rate in [1e3, 1.7e3, 2e4] {
            for height in [-20.0, 20.0] {
                let (times, record) = record(height, rate, 1);
                let found = spikes(&times, &record, 20e-3, 0.4).expect("long enough").found;
                assert_eq!(found.len(), 5, "{rate}: {found:?}");
                for (i, spike) in found.iter().enumerate() {
                    assert!((spike.time - 0.4 * i as f64 - 0.1).abs() < 1e-3, "{rate}: {spike:?}");
                    assert!((spike.height / height - 1.0).abs() < 0.1, "{rate}: {spike:?}");
                }
            }
        }
    }

    #[test]
    fn a_wave_has_no_pulses_and_a_soft_contact_shows_none() {
        for seed in 0..20 {
            let (times, record) = record(0.0, 1e3, seed);
            let found = spikes(&times, &record, 20e-3, 0.4).expect("long enough").found;
            assert_eq!(found, []);
            assert_eq!(spikes(&times, &record, 0.3, 0.4), None);
            assert_eq!(spikes(&times, &record, 4e-3, 0.4), None);
        }
    }
}
