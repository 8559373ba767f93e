//! The period of a motion by the recurrence of its section, with its convergence watched.

use std::collections::VecDeque;

use crate::flow::Metric;

use super::extrapolation::WINDOW;

/// A recurrence this many times closer than asked for needs no proof that it still converges.
const EXACT: f64 = 1e-2;
/// Points are kept so that a limit can be told for periods up to this.
const LONGEST_TOLD: usize = 64;
/// A longer period is nearer than a shorter one if its distance is below this share.
const DISTINCT: f64 = 0.1;
/// So many times what a quotient is compared with, it is on the same side before it is divided: far beyond rounding.
const CLEARLY: f64 = 2.0;
/// A motion below this share of the largest one seen is measured against that largest one.
const FADED: f64 = 1e-3;

/// What the section of a case has settled to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Cycles after which the section repeats to tolerance, the least such number: a period is proposed.
    pub repeats_after: usize,
    /// How closely it repeats, relative to the size of the motion [-].
    pub within: f64,
    /// Size of the motion lately, in the units of the metric.
    pub size: f64,
}

/// The last section points of a case and how well they repeat.
#[derive(Debug, Clone)]
pub struct Recurrence<const D: usize> {
    tolerance: f64,
    longest: usize,
    metric: Metric<D>,
    /// So many points are kept.
    memory: usize,
    points: VecDeque<[f64; D]>,
    /// Sizes of the last points, as many as the longest period has.
    sizes: VecDeque<f64>,
    /// For each period, how many points in a row have repeated to tolerance.
    repeats: Vec<usize>,
    largest: f64,
    /// What distances are measured against: the size of the motion lately.
    scale: f64,
    /// The number of cycles after which the last point is nearest to an earlier one, and how near.
    nearest: Option<(usize, f64)>,
}

impl<const D: usize> Recurrence<D> {
    /// Looks for periods up to `longest`, to `tolerance` relative to the size of the motion.
    pub fn new(longest: usize, tolerance: f64, metric: Metric<D>) -> Self {
        Recurrence {
            tolerance,
            longest,
            metric,
            memory: (2 * longest).max((WINDOW - 1) * longest.min(LONGEST_TOLD)) + 1,
            points: VecDeque::new(),
            sizes: VecDeque::new(),
            repeats: vec![0; longest + 1],
            largest: 0.0,
            scale: 0.0,
            nearest: None,
        }
    }

    /// The number of cycles after which the last point is nearest to an earlier one, and how near, relative
    /// to the scale; a longer time counts only if the point comes ten times nearer.
    pub fn nearest(&self) -> Option<(usize, f64)> {
        self.nearest
    }

    /// What distances are relative to.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The last `N` points that are `k` cycles apart, oldest first, if there are so many; a coordinate that repeats is told as it is
    /// nearest to that of the newest.
    pub fn last<const N: usize>(&self, k: usize) -> Option<[[f64; D]; N]> {
        let first = self.points.len().checked_sub((N - 1) * k + 1)?;
        let newest = self.points[first + (N - 1) * k];
        Some(std::array::from_fn(|i| self.metric.beside(&self.points[first + i * k], &newest)))
    }

    /// Takes the next section point; says what the motion has settled to, if it has.
    ///
    /// A recurrence after k cycles is accepted when a whole period of points has repeated to tolerance, and
    /// either the last repeat is a hundred times closer, or the remaining distance d q/(1 - q), with q
    /// the ratio of the last two distances k cycles apart, is within tolerance too.
    pub fn meet(&mut self, point: [f64; D]) -> Option<Settled> {
        self.points.push_back(point);
        if self.points.len() > self.memory {
            self.points.pop_front();
        }
        let scale = self.update_scale(&point);
        let newest = self.points.len() - 1;
        let beyond = CLEARLY * self.tolerance * scale;
        let (mut found, mut least_apart) = (None, f64::INFINITY);
        self.nearest = None;
        for k in 1..=self.longest.min(newest) {
            let difference = self.difference(newest, newest - k);
            let apart = self.metric.length(&difference);
            // Most points are neither near nor a repeat, which takes no division to see.
            if apart > CLEARLY * DISTINCT * least_apart && apart > beyond {
                self.repeats[k] = 0;
                continue;
            }
            let distance = self.metric.relative(&difference, scale);
            if self.nearest.is_none_or(|(_, nearest)| distance < DISTINCT * nearest) {
                self.nearest = Some((k, distance));
                least_apart = apart;
            }
            if distance > self.tolerance {
                self.repeats[k] = 0;
                continue;
            }
            self.repeats[k] += 1;
            if found.is_none() && self.repeats[k] >= k && self.converged(k, distance, scale) {
                found = Some(k);
            }
        }
        Some(Settled { repeats_after: found?, within: self.tolerance, size: scale })
    }

    fn converged(&self, k: usize, now: f64, scale: f64) -> bool {
        let newest = self.points.len() - 1;
        if now <= EXACT * self.tolerance {
            return true;
        }
        if newest < 2 * k {
            return false;
        }
        let difference = self.difference(newest - k, newest - 2 * k);
        let ratio = now / self.metric.relative(&difference, scale);
        ratio < 1.0 && now * ratio / (1.0 - ratio) <= self.tolerance
    }

    fn update_scale(&mut self, point: &[f64; D]) -> f64 {
        let size = self.metric.size(point);
        self.largest = self.largest.max(size);
        self.sizes.push_back(size);
        if self.sizes.len() > self.longest {
            self.sizes.pop_front();
        }
        self.scale = self.sizes.iter().copied().fold(FADED * self.largest, f64::max);
        self.scale
    }

    /// The difference of two section points, by their places.
    #[inline]
    fn difference(&self, a: usize, b: usize) -> [f64; D] {
        self.metric.difference(&self.points[a], &self.points[b])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn period_of(point: impl Fn(usize) -> f64, cycles: usize) -> Option<usize> {
        let mut recurrence = Recurrence::new(16, 1e-11, Metric::new([1.0; 3]));
        (0..cycles)
            .find_map(|n| recurrence.meet([point(n), 1.0, 0.0]))
            .map(|found| found.repeats_after)
    }

    #[test]
    fn finds_the_smallest_period() {
        for k in 1..=16 {
            assert_eq!(period_of(|n| (n % k) as f64, 100), Some(k));
        }
        assert_eq!(period_of(|n| (n % 17) as f64, 100), None);
    }

    #[test]
    fn slow_convergence_is_not_yet_a_period() {
        // Each step is below the tolerance, yet the limit is a hundred tolerances away.
        let creeping = |n: usize| 1.0 + 1e-9 * libm::pow(0.995, n as f64);
        assert_eq!(period_of(creeping, 50), None);
        assert_eq!(period_of(creeping, 2000), Some(1));
    }

    #[test]
    fn a_small_period_two_is_not_a_period_one() {
        assert_eq!(period_of(|n| 1.0 + 1e-8 * (n % 2) as f64, 100), Some(2));
        assert_eq!(period_of(|n| 1.0 + 1e-10 * (n % 2) as f64, 100), Some(2));
        assert_eq!(period_of(|n| 1.0 + 1e-14 * (n % 2) as f64, 100), Some(1));
    }

    /// By the definition, with a quotient for each point.
    fn nearest_of(points: &[[f64; 3]], metric: &Metric<3>, scale: f64) -> Option<(usize, f64)> {
        let (last, before) = points.split_last()?;
        let mut nearest = None;
        for (k, point) in (1..=16).zip(before.iter().rev()) {
            let apart = metric.relative(&std::array::from_fn(|i| last[i] - point[i]), scale);
            if nearest.is_none_or(|(_, nearest)| apart < DISTINCT * nearest) {
                nearest = Some((k, apart));
            }
        }
        nearest
    }

    #[test]
    fn the_nearest_point_is_that_of_all_quotients() {
        let metric = Metric::new([3.0, 1.0, 1e-3]);
        // Chaos, windows of periods 3 and 5 and the way into them, and rest.
        for rate in [3.99, 3.83, 3.7389, 3.5, 0.0] {
            let mut recurrence = Recurrence::new(16, 1e-11, metric);
            let (mut points, mut x) = (Vec::new(), 0.3);
            for _ in 0..300 {
                x *= rate * (1.0 - x);
                points.push([x, x * x, 1.0 - x]);
                recurrence.meet([x, x * x, 1.0 - x]);
                let scale = recurrence.scale();
                let recent = points.iter().rev().take(16).map(|point| metric.size(point));
                let all = metric.largest(&points);
                assert_eq!(scale, recent.fold(FADED * all, f64::max));
                assert_eq!(recurrence.nearest(), nearest_of(&points, &metric, scale));
            }
        }
    }
}
