//! A signal smoothed on its own times, each part between gaps and changes of the interval by itself.

use std::ops::Range;

use super::recording::{GAP, median};
use super::smoothing::{Unsuitable, Window, smoothed};

/// Intervals on either side of a sample whose medians tell whether the interval changes there.
const BESIDE: usize = 5;
/// A gap that is no longer than this share of the window does not cut a part: polynomials reach over it.
const REACHED_OVER: f64 = 0.5;

/// How a signal is smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothing {
    /// Length of the window [s].
    pub length: f64,
    /// Order of the polynomial.
    pub order: usize,
    /// Which derivative is taken; 0 is the signal itself.
    pub derivative: usize,
}

/// A part of a signal that is smoothed by itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its samples.
    pub samples: Range<usize>,
    /// When it begins [s].
    pub begins: f64,
    /// The median time between its samples [s].
    pub interval: f64,
    /// Its window.
    pub window: Window,
    /// Its values; why there are none.
    pub values: Result<Vec<f64>, Unsuitable>,
}

/// The parts of a signal, smoothed at its times.
///
/// # Method
///
/// A part ends at a gap, which is longer than one and a half times the intervals about it and than half the window, and where the median
/// of five intervals changes by a factor of one and a half. The window of a part has the odd number of its samples whose time is nearest
/// to the length; so samples that were dropped, uneven times and other intervals change how many samples a polynomial has, and
/// not how far it reaches.
///
/// # Breaks
///
/// A part with fewer samples than its window, or a window of too few samples for the order, has no values and says so.
pub fn smoothed_parts(times: &[f64], values: &[f64], how: Smoothing) -> Vec<Part> {
    let mut parts = Vec::new();
    for samples in parts_of(times, how.length) {
        let own = &times[samples.clone()];
        let intervals: Vec<f64> = own.windows(2).map(|it| it[1] - it[0]).collect();
        let interval = if intervals.is_empty() { how.length } else { median(&intervals) };
        let window = window(how, interval);
        let values = smoothed(own, &values[samples.clone()], window, how.derivative);
        parts.push(Part { begins: own[0], samples, interval, window, values });
    }
    parts
}

/// The window whose time is nearest to the length, at samples so far apart [s].
pub fn window(how: Smoothing, interval: f64) -> Window {
    let half = (0.5 * (how.length / interval - 1.0)).round().max(0.0);
    // A number too large for a size is the largest one.
    Window { samples: (half as usize).saturating_mul(2) | 1, order: how.order }
}

/// The samples of each part.
fn parts_of(times: &[f64], length: f64) -> Vec<Range<usize>> {
    let intervals: Vec<f64> = times.windows(2).map(|it| it[1] - it[0]).collect();
    let mut cuts: Vec<usize> = gaps(&intervals, length).map(|it| it + 1).collect();
    let mut i = BESIDE;
    while i + BESIDE <= intervals.len() {
        match changes_before(&intervals, i) {
            true => {
                let cut = steepest(&intervals, i);
                cuts.push(cut);
                i = cut + BESIDE;
            }
            false => i += 1,
        }
    }
    cuts.extend([0, times.len()]);
    cuts.sort_unstable();
    cuts.dedup();
    cuts.windows(2).map(|ends| ends[0]..ends[1]).collect()
}

/// The intervals that are gaps, which polynomials do not reach over.
fn gaps(intervals: &[f64], length: f64) -> impl Iterator<Item = usize> {
    let is_gap = move |i: &usize| {
        let about = i.saturating_sub(BESIDE)..(i + BESIDE + 1).min(intervals.len());
        intervals[*i] > (GAP * median(&intervals[about])).max(REACHED_OVER * length)
    };
    (0..intervals.len()).filter(is_gap)
}

/// Whether the median of some intervals changes before this one.
fn changes_before(intervals: &[f64], i: usize) -> bool {
    let [before, after] = [i - BESIDE..i, i..i + BESIDE].map(|it| median(&intervals[it]));
    (after / before).ln().abs() > GAP.ln()
}

/// The interval about this one before which intervals change most.
fn steepest(intervals: &[f64], i: usize) -> usize {
    let about = i..(i + BESIDE).min(intervals.len());
    let change = |j: &usize| (intervals[*j] / intervals[*j - 1]).ln().abs();
    about.max_by(|a, b| change(a).total_cmp(&change(b))).unwrap_or(i)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOW: Smoothing = Smoothing { length: 0.11, order: 3, derivative: 1 };

    fn cubic(t: f64) -> f64 {
        3.0 - t + 0.2 * t * t - 0.01 * t * t * t
    }

    fn slope(t: f64) -> f64 {
        -1.0 + 0.4 * t - 0.03 * t * t
    }

    fn assert_slopes(times: &[f64], parts: &[Part]) {
        for part in parts {
            let found = part.values.as_ref().expect("smoothed");
            for (value, time) in found.iter().zip(&times[part.samples.clone()]) {
                assert!((value - slope(*time)).abs() < 1e-9, "{time}");
            }
        }
    }

    fn parts(times: &[f64]) -> Vec<Part> {
        let values: Vec<f64> = times.iter().map(|t| cubic(*t)).collect();
        smoothed_parts(times, &values, HOW)
    }

    #[test]
    fn dropped_samples_and_jitter_do_not_cut_a_record() {
        let jitter = |i: usize| 2e-3 * (1.7 * i as f64).sin();
        let kept = (0..400).filter(|i| i % 37 != 0 && i % 101 > 2);
        let times: Vec<f64> = kept.map(|i| 0.01 * i as f64 + jitter(i)).collect();
        let found = parts(&times);
        assert_eq!((found.len(), found[0].window.samples), (1, 11));
        assert_slopes(&times, &found);
    }

    #[test]
    fn another_interval_has_a_window_of_its_own() {
        let first = (0..100).map(|i| 0.01 * f64::from(i));
        let second = (1..60).map(|i| 0.99 + 0.03 * f64::from(i));
        let third = (1..100).map(|i| 2.76 + 0.001 * f64::from(i));
        let times: Vec<f64> = first.chain(second).chain(third).collect();
        let found = parts(&times);
        let cut: Vec<_> = found.iter().map(|it| (it.samples.start, it.window.samples)).collect();
        assert_eq!(cut.len(), 3, "{cut:?}");
        assert_eq!(cut[0], (0, 11));
        // The sample at the change may be of either part.
        assert!(cut[1].0.abs_diff(100) <= 1 && cut[1].1 == 3, "{cut:?}");
        assert!(cut[2].0.abs_diff(159) <= 1 && cut[2].1 == 111, "{cut:?}");
        assert_eq!(found[1].values, Err(Unsuitable::OrderTooHigh));
        assert_eq!(found[2].values, Err(Unsuitable::TooShort));
        assert_slopes(&times, &found[..1]);
    }

    #[test]
    fn a_gap_cuts_a_record_and_a_short_part_is_told() {
        let times: Vec<f64> = (0..60).map(|i| 0.01 * f64::from(i) + f64::from(i / 25)).collect();
        let found = parts(&times);
        let lengths: Vec<usize> = found.iter().map(|it| it.samples.len()).collect();
        assert_eq!(lengths, [25, 25, 10]);
        assert_eq!(found[2].values, Err(Unsuitable::TooShort));
        assert_slopes(&times, &found[..2]);
    }
}
