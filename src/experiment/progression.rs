//! How fast a record or a simulation advances, with a standard error where one is known.

use std::ops::Range;

use super::estimate::Estimate;
use super::recording::{GAP, median};

/// Batches of cycles that the error of a motion that does not repeat is taken from.
pub const BATCHES: usize = 10;
/// Cycles that a batch has at least.
const LEAST_BATCH: usize = 2;
/// Means that a line is fitted to at least.
const LEAST_MEANS: usize = 3;

/// A mean progression.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progression {
    /// The speed [m/s].
    pub value: f64,
    /// Its standard error [m/s]; none where the record is too short for one.
    pub standard_error: Option<f64>,
    /// Batches that the error is taken from; none where it is that of the noise.
    pub batches: Option<usize>,
}

/// The mean progression of a displacement `x` [m] at `times` [s] under a drive of this `cycle` [s], of a motion that repeats itself
/// after `period` cycles, or never; none for fewer than three whole cycles.
///
/// # Method
///
/// Of a motion that repeats itself: the slope of the line through the means over whole periods, each the integral between the
/// samples' straight lines, with the error from the scatter about the line, which is that of the noise. Of one that does not, the
/// displacement over all whole cycles, with the standard error of the means of ten batches of as many whole cycles.
///
/// # Source
///
/// Schmeiser, Operations Research 30 (1982), 556-568: between ten and thirty batches, as more of them shorten each and correlate
/// the means; the fewest are taken here, for the longest batches.
///
/// # Assumes
///
/// Batches that are long against the memory of the motion, and noise that is far below what the motion advances in a batch.
///
/// # Breaks
///
/// No error is given where a batch would have a single cycle, or where fewer than three periods are recorded.
pub fn progression(
    times: &[f64],
    x: &[f64],
    cycle: f64,
    period: Option<u64>,
) -> Option<Progression> {
    let record = Integrated::new(times, x);
    if let Some(period) = period {
        let means = record.means(period as f64 * cycle);
        if means.len() >= LEAST_MEANS {
            let slope = slope(&means);
            let standard_error = Some(slope.standard_error);
            return Some(Progression { value: slope.value, standard_error, batches: None });
        }
    }
    // The last cycle may lack a sample, or a fiftieth as the frequency is not exact.
    let last = times[times.len() - 1];
    let cycles = ((last + record.interval) / cycle + 0.02).floor() as usize;
    if cycles < LEAST_MEANS {
        return None;
    }
    let length = cycles / BATCHES;
    let batches = if length < LEAST_BATCH { 0 } else { cycles / length };
    let each = (0..batches).map(|i| i * length..(i + 1) * length);
    let speeds: Vec<f64> = each.map(|cycles| record.speed_over(cycles, cycle)).collect();
    let is_known = period.is_none() && batches >= BATCHES;
    Some(Progression {
        value: record.speed_over(0..cycles, cycle),
        standard_error: is_known.then(|| Estimate::mean(&speeds).standard_error),
        batches: is_known.then_some(batches),
    })
}

/// The mean progression of a displacement as it is taken off a record: by the means over whole cycles, or by all samples where
/// fewer than three cycles are recorded.
pub fn own_progression(times: &[f64], x: &[f64], cycle: f64) -> f64 {
    let means = Integrated::new(times, x).means(cycle);
    if means.len() >= LEAST_MEANS {
        return slope(&means).value;
    }
    let samples: Vec<(f64, f64)> = times.iter().copied().zip(x.iter().copied()).collect();
    slope(&samples).value
}

/// The slope of the line through at least three points that differ in their abscissae, by least squares.
fn slope(points: &[(f64, f64)]) -> Estimate {
    let count = points.len() as f64;
    let at = points.iter().map(|it| it.0).sum::<f64>() / count;
    let level = points.iter().map(|it| it.1).sum::<f64>() / count;
    let square: f64 = points.iter().map(|it| (it.0 - at).powi(2)).sum();
    let slope = points.iter().map(|it| (it.0 - at) * (it.1 - level)).sum::<f64>() / square;
    let left: f64 = points.iter().map(|it| (it.1 - level - slope * (it.0 - at)).powi(2)).sum();
    let freedom = points.len().saturating_sub(2).max(1);
    Estimate::of_student(slope, (left / freedom as f64 / square).sqrt(), freedom)
}

/// A record as straight lines between its samples, with its integral.
struct Integrated<'r> {
    times: &'r [f64],
    values: &'r [f64],
    /// The integral up to each sample.
    sums: Vec<f64>,
    /// The median time between two samples [s].
    interval: f64,
}

impl<'r> Integrated<'r> {
    fn new(times: &'r [f64], values: &'r [f64]) -> Self {
        let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let mut sums = vec![0.0];
        for (i, interval) in intervals.iter().enumerate() {
            sums.push(sums[i] + 0.5 * interval * (values[i] + values[i + 1]));
        }
        Integrated { times, values, sums, interval: median(&intervals) }
    }

    /// The sample before a time, and the value then.
    fn at(&self, time: f64) -> (usize, f64) {
        let after = self.times.partition_point(|it| *it <= time).clamp(1, self.times.len() - 1);
        let before = after - 1;
        let share = (time - self.times[before]) / (self.times[after] - self.times[before]);
        (before, self.values[before] + share * (self.values[after] - self.values[before]))
    }

    fn value(&self, time: f64) -> f64 {
        self.at(time).1
    }

    /// The mean speed over some cycles, as far as they are recorded.
    fn speed_over(&self, cycles: Range<usize>, cycle: f64) -> f64 {
        let last = self.times[self.times.len() - 1];
        let [begins, ends] = [cycles.start, cycles.end].map(|it| (it as f64 * cycle).min(last));
        (self.value(ends) - self.value(begins)) / (ends - begins)
    }

    fn integral(&self, time: f64) -> f64 {
        let (before, value) = self.at(time);
        self.sums[before] + 0.5 * (time - self.times[before]) * (self.values[before] + value)
    }

    /// The middles of the parts of this length from the first sample on that have no gap, and the means over them.
    fn means(&self, length: f64) -> Vec<(f64, f64)> {
        let first = self.times[0];
        let count = ((self.times[self.times.len() - 1] - first) / length).floor() as usize;
        let pairs = self.times.windows(2);
        let gaps: Vec<&[f64]> =
            pairs.filter(|pair| pair[1] - pair[0] > GAP * self.interval).collect();
        let mut means = Vec::new();
        for i in 0..count {
            let [from, to] = [i, i + 1].map(|it| first + it as f64 * length);
            let next = gaps.partition_point(|it| it[1] <= from);
            if gaps.get(next).is_none_or(|it| it[0] >= to) {
                let mean = (self.integral(to) - self.integral(from)) / (to - from);
                means.push((0.5 * (from + to), mean));
            }
        }
        means
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::synthesis::Noise;

    /// A displacement that repeats itself in 0.0807 s and advances by 10 mm/s, with noise of 10 um.
    fn record(seed: u64) -> (Vec<f64>, Vec<f64>) {
        let mut noise = Noise::new(seed);
        let times: Vec<f64> = (0..1612).map(|i| 1e-3 * f64::from(i)).collect();
        let at = |t: &f64| 0.01 * t + 5e-4 * (77.9 * t).sin() + noise.normal(1e-5);
        let values = times.iter().map(at).collect();
        (times, values)
    }

    #[test]
    fn the_error_of_a_motion_that_repeats_itself_is_that_of_its_noise() {
        let cycle = std::f64::consts::TAU / 77.9;
        let shares = (0..200).map(|seed| {
            let (times, values) = record(seed);
            let found = progression(&times, &values, cycle, Some(1)).expect("a speed");
            (found.value - 0.01) / found.standard_error.expect("known")
        });
        let square = shares.map(|it| it * it).sum::<f64>() / 200.0;
        assert!((0.85..1.2).contains(&square.sqrt()), "{}", square.sqrt());
    }

    #[test]
    fn short_records_have_no_error() {
        let (times, values) = record(1);
        let found = |count: usize, period| {
            progression(&times[..count], &values[..count], std::f64::consts::TAU / 77.9, period)
        };
        assert_eq!(found(200, Some(1)), None);
        assert_eq!(found(800, None).expect("a speed").standard_error, None);
        assert_eq!(found(1612, None).expect("a speed").batches, Some(10));
        assert_eq!(found(400, Some(2)).expect("a speed").standard_error, None);
    }
}
