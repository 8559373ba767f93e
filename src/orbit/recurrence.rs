//! The period of a motion by the recurrence of its section, with its convergence watched.

use std::collections::VecDeque;

use super::Section;

/// A recurrence this many times closer than asked for needs no proof that it still converges.
const EXACT: f64 = 1e-2;
/// A section below this share of the largest one seen is measured against that largest one.
const FADED: f64 = 1e-3;

/// The last section points of a case and how well they repeat.
#[derive(Debug, Clone)]
pub struct Recurrence {
    tolerance: f64,
    longest: usize,
    points: VecDeque<Section>,
    /// For each period, how many points in a row have repeated.
    repeats: Vec<usize>,
    largest: [f64; 2],
}

impl Recurrence {
    /// Looks for periods up to `longest`, to `tolerance` relative to the size of the section.
    pub fn new(longest: usize, tolerance: f64) -> Self {
        Recurrence {
            tolerance,
            longest,
            points: VecDeque::with_capacity(2 * longest + 1),
            repeats: vec![0; longest + 1],
            largest: [0.0; 2],
        }
    }

    /// Takes the next section point; returns the smallest period that the motion has settled to.
    ///
    /// The period k is accepted when a whole period of points has repeated to tolerance, and either the
    /// last repeat is a hundred times closer, or the remaining distance d q/(1 - q), with q the ratio of
    /// the last two distances k cycles apart, is within tolerance too. Smaller periods are tried
    /// first, so the divisors of k are excluded.
    pub fn meet(&mut self, point: Section) -> Option<usize> {
        self.points.push_back(point);
        if self.points.len() > 2 * self.longest + 1 {
            self.points.pop_front();
        }
        let scale = self.scale(&point);
        let newest = self.points.len() - 1;
        let mut settled = None;
        for k in 1..=self.longest.min(newest) {
            let distance = distance(&point, &self.points[newest - k], scale);
            if distance > self.tolerance {
                self.repeats[k] = 0;
                continue;
            }
            self.repeats[k] += 1;
            if settled.is_none() && self.repeats[k] >= k && self.converged(k, distance, scale) {
                settled = Some(k);
            }
        }
        settled
    }

    fn converged(&self, k: usize, now: f64, scale: [f64; 2]) -> bool {
        let newest = self.points.len() - 1;
        if now <= EXACT * self.tolerance {
            return true;
        }
        if newest < 2 * k {
            return false;
        }
        let before = distance(&self.points[newest - k], &self.points[newest - 2 * k], scale);
        let ratio = now / before;
        ratio < 1.0 && now * ratio / (1.0 - ratio) <= self.tolerance
    }

    /// Sizes of the displacement [m] and of the velocities [m/s] that distances are measured against.
    fn scale(&mut self, point: &Section) -> [f64; 2] {
        let size = |[r, y1, y2]: &Section| [r.abs(), y1.abs().max(y2.abs())];
        let larger = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        self.largest = larger(self.largest, size(point));
        let recent = self.points.iter().rev().take(self.longest).map(size);
        recent.fold(self.largest.map(|a| FADED * a), larger)
    }
}

/// Largest difference of two section points relative to their sizes [-].
fn distance(a: &Section, b: &Section, scale: [f64; 2]) -> f64 {
    let relative = |i: usize, size: f64| {
        let difference = (a[i] - b[i]).abs();
        if difference == 0.0 { 0.0 } else { difference / size }
    };
    relative(0, scale[0]).max(relative(1, scale[1])).max(relative(2, scale[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn period_of(point: impl Fn(usize) -> f64, cycles: usize) -> Option<usize> {
        let mut recurrence = Recurrence::new(16, 1e-11);
        (0..cycles).find_map(|n| recurrence.meet([point(n), 1.0, 0.0]))
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
        assert_eq!(period_of(|n| 1.0 + 1e-9 * (n % 2) as f64, 100), Some(2));
    }
}
