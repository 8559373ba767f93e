//! What a record says of a signal and its rate at the first sample, whatever outliers are near it.

use super::least_squares::Bounds;
use super::smoothing::{Window, smoothed};

/// Standard deviations within which the start is looked for about its estimate from the record.
pub(super) const REACH: f64 = 60.0;
/// Samples among which outliers are looked for, and of those how many a parabola has to pass near.
const FIRST: [usize; 2] = [9, 6];
/// An outlier is so many times as far from the parabola as the noise and as the samples that it passes near.
const FAR: f64 = 10.0;

/// What a record says of a quantity at its first sample, with its standard error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    /// The value (SI).
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

impl Reading {
    /// The sum of two.
    pub fn plus(self, other: Reading) -> Reading {
        Reading { value: self.value + other.value, error: self.error.hypot(other.error) }
    }

    /// The difference of two.
    pub fn less(self, other: Reading) -> Reading {
        self.plus(Reading { value: -other.value, ..other })
    }

    /// Where it is looked for.
    pub fn bounds(self) -> Bounds {
        let reach = REACH * self.error;
        Bounds { least: self.value - reach, greatest: self.value + reach }
    }
}

/// A signal at the first sample of a record, and its rate there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beginning {
    /// The signal.
    pub level: Reading,
    /// Its rate.
    pub rate: Reading,
}

impl Beginning {
    /// The beginning of a signal with this noise, by a parabola through its first samples, whose times are since the first sample of the
    /// record; none where they are too few.
    ///
    /// # Method
    ///
    /// Of the first nine samples outliers are left out: those ten times as far as the noise from the parabola through three of them
    /// that has the nearest sixth sample.
    ///
    /// # Source
    ///
    /// The least quantile of squares of Rousseeuw and Leroy, Robust Regression and Outlier Detection (1987).
    ///
    /// # Breaks
    ///
    /// Where more than three of the first nine samples are outliers.
    pub fn of(times: &[f64], values: &[f64], noise: f64) -> Option<Beginning> {
        let kept = without_outliers(times, values, noise);
        let times: Vec<f64> = kept.iter().map(|&i| times[i]).collect();
        let values: Vec<f64> = kept.iter().map(|&i| values[i]).collect();
        let window = first_window(values.len().max(1));
        let first = [0, 1, 2].map(|order| Some(smoothed(&times, &values, window, order).ok()?[0]));
        let [levels, rates, curvatures] = [first[0]?, first[1]?, first[2]?];
        let span = times[window.samples - 1] - times[0];
        // The parabola goes on from the first sample that is kept back to the first one, where the errors add up at most.
        let back = times[0];
        // A parabola through seven even samples has standard errors of 0.87, 4.7 over the span and 7.9 over its square there.
        let per_time = noise / span;
        let rate = Reading {
            value: rates - back * curvatures,
            error: per_time * (4.7 + 7.9 * back / span),
        };
        let level = Reading {
            value: levels - back * (rates - 0.5 * back * curvatures),
            error: noise + back * rate.error,
        };
        Some(Beginning { level, rate })
    }

    /// The difference of two.
    pub fn less(self, other: Beginning) -> Beginning {
        Beginning { level: self.level.less(other.level), rate: self.rate.less(other.rate) }
    }
}

/// The parabola through the first samples of a record of so many.
pub(super) fn first_window(count: usize) -> Window {
    let samples = 7.min((count - 1) | 1);
    Window { samples, order: 2.min(samples - 1) }
}

/// The samples of a record that are no outliers among the first.
fn without_outliers(times: &[f64], values: &[f64], noise: f64) -> Vec<usize> {
    let all = 0..values.len();
    let [first, near] = FIRST;
    if values.len() < first {
        return all.collect();
    }
    let mut best = (f64::INFINITY, vec![0.0; first]);
    for i in 0..first {
        for j in 0..i {
            for k in 0..j {
                let parabola = Parabola { times, values, through: [k, j, i] };
                let apart: Vec<f64> =
                    (0..first).map(|it| (values[it] - parabola.at(times[it])).abs()).collect();
                let mut sorted = apart.clone();
                sorted.sort_by(f64::total_cmp);
                if sorted[near - 1] < best.0 {
                    best = (sorted[near - 1], apart);
                }
            }
        }
    }
    let (size, apart) = best;
    let allowed = FAR * size.max(noise);
    all.filter(|&it| it >= first || apart[it] <= allowed).collect()
}

/// The parabola through three samples.
struct Parabola<'r> {
    times: &'r [f64],
    values: &'r [f64],
    through: [usize; 3],
}

impl Parabola<'_> {
    fn at(&self, time: f64) -> f64 {
        self.through.iter().map(|&place| self.values[place] * self.weight(place, time)).sum()
    }

    /// What the value of a sample counts at a time.
    fn weight(&self, place: usize, time: f64) -> f64 {
        let own = self.times[place];
        let others = self.through.iter().filter(|&&it| it != place);
        others.map(|&it| (time - self.times[it]) / (own - self.times[it])).product()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outliers_among_the_first_samples_do_not_move_the_beginning() {
        let times: Vec<f64> = (0..40).map(|i| 1e-3 * f64::from(i)).collect();
        let clean: Vec<f64> = times.iter().map(|t| 1e-3 + 0.3 * t - 20.0 * t * t).collect();
        for off in [vec![], vec![0], vec![3], vec![0, 1], vec![2, 5, 6], vec![0, 4, 8]] {
            let mut values = clean.clone();
            off.iter().for_each(|&i| values[i] += 5e-3 * (1.0 + i as f64));
            let found = Beginning::of(&times, &values, 1e-6).expect("long enough");
            assert!((found.rate.value - 0.3).abs() < 1e-9, "{off:?} {found:?}");
            assert!((found.level.value - 1e-3).abs() < 1e-12, "{off:?} {found:?}");
        }
    }
}
