//! When two motions are on one attractor.

use super::final_motion::FinalMotion;
use crate::flow::{Metric, System};
use crate::orbit::precision::OBLIQUE;
use crate::orbit::return_map::append_points;
use crate::orbit::{Outcome, Protocol};

/// How many points of two motions that do not repeat are compared, one pair of numbers after the other, and the share of
/// nearest neighbours in the same sample up to which they are one attractor.
///
/// Two samples of one motion have half of all nearest neighbours in the same sample once they have mixed, those of two
/// attractors all. Intermittent motions and those that wander slowly between bands need many points to mix; at the last
/// comparison two samples are those of one attractor where any notable part has mixed.
const COMPARED: [(usize, f64); 3] = [(64, 0.75), (512, 0.75), (4096, 0.95)];

/// To this share of the size of an orbit its points are rounded before they are compared.
const LEAST: f64 = 1e-6;

/// An attractor as the cases with the same parameters show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Attractor<P> {
    /// The first of its cases.
    pub case: usize,
    /// Periodic, chaotic or quasi-periodic.
    pub outcome: Outcome,
    /// Section points of a period, or a sample, which is held only until the cases are sorted.
    pub points: Vec<P>,
    /// How far each point may be from the true orbit, in the units of the metric.
    pub bound: f64,
    /// Size of the motion, in the units of the metric.
    pub size: f64,
}

impl<P> Attractor<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q) -> Attractor<Q> {
        let Attractor { case, outcome, points, bound, size } = self;
        Attractor { case, outcome, points: points.into_iter().map(held).collect(), bound, size }
    }
}

impl<const D: usize> Attractor<[f64; D]> {
    /// What a case has ended on; none where that repels or is not known.
    pub fn of<M: System<D>>(
        index: usize,
        system: &M,
        motion: &FinalMotion<[f64; D]>,
        protocol: &Protocol,
    ) -> Option<Self> {
        let wanted = match motion.outcome {
            Outcome::Periodic if motion.is_stable => motion.period as usize,
            Outcome::Chaotic | Outcome::QuasiPeriodic => COMPARED[0].0,
            Outcome::Periodic | Outcome::Undecided | Outcome::Failed => return None,
        };
        let mut points = vec![motion.section];
        append_points(system, &mut points, wanted, protocol.tolerance)?;
        let metric = system.metric();
        let size = metric.largest(&points);
        let bound = relative_bound(motion.residual, motion.from_one, protocol) * size;
        Some(Attractor { case: index, outcome: motion.outcome, points, bound, size })
    }

    /// What tells it from others of its kind and period: of a periodic orbit its [`Attractor::least_point`], of another
    /// motion the mean of its sample.
    pub(super) fn mark(&self, metric: &Metric<D>) -> [f64; D] {
        if self.outcome == Outcome::Periodic {
            return self.points[self.least_point(metric)];
        }
        let count = self.points.len() as f64;
        std::array::from_fn(|i| self.points.iter().map(|point| point[i]).sum::<f64>() / count)
    }

    /// The place of the section point of a periodic orbit whose first coordinate is least, by the second and third where
    /// points agree to a millionth of the size.
    pub fn least_point(&self, metric: &Metric<D>) -> usize {
        let places = 0..self.points.len();
        let least =
            places.min_by_key(|place| metric.rounded(&self.points[*place], LEAST * self.size));
        least.unwrap_or(0)
    }

    /// How often it is compared with another, each time by more points; once where it repeats.
    pub(super) fn comparisons(&self) -> usize {
        if self.outcome == Outcome::Periodic { 1 } else { COMPARED.len() }
    }

    /// Whether it has the points of this comparison.
    pub(super) fn has_points_for(&self, comparison: usize) -> bool {
        self.outcome == Outcome::Periodic || self.points.len() >= COMPARED[comparison].0
    }

    /// Follows it until it has the points of this comparison, or those that can be computed.
    pub(super) fn follow_for<M: System<D>>(
        &mut self,
        comparison: usize,
        system: &M,
        protocol: &Protocol,
    ) {
        if !self.has_points_for(comparison) {
            let _ =
                append_points(system, &mut self.points, COMPARED[comparison].0, protocol.tolerance);
        }
    }

    /// Forgets the points of all comparisons but the first.
    pub(super) fn shorten(&mut self) {
        if self.outcome != Outcome::Periodic {
            self.points.truncate(COMPARED[0].0);
            self.points.shrink_to_fit();
        }
    }

    /// Whether this is the same attractor as another at the same parameters.
    ///
    /// Periodic orbits: the periods are equal, and the points up to a cyclic shift, within the two bounds.
    /// Others: by the nearest neighbours of the two samples (Schilling 1986), of as many points as both have. It breaks
    /// where two attractors interleave more closely than their samples lie, and where a motion drifts so slowly that
    /// its two samples do not meet.
    pub fn is(&self, other: &Self, metric: &Metric<D>) -> bool {
        if self.outcome != other.outcome {
            return false;
        }
        if self.outcome == Outcome::Periodic {
            return coincide(&self.points, &other.points, self.bound + other.bound, metric);
        }
        let count = self.points.len().min(other.points.len());
        let own = own_neighbours(&self.points[..count], &other.points[..count], metric);
        let at = COMPARED.iter().rposition(|(points, _)| *points <= count).unwrap_or(0);
        own <= COMPARED[at].1
    }
}

/// How far the true orbit may be from one that repeats to this residual, relative to its size.
///
/// The residual, or the error of the integrator if that is larger, over the least distance of a multiplier from
/// one, is how far the true orbit is along the slowest direction.
pub fn relative_bound(residual: f64, from_one: f64, protocol: &Protocol) -> f64 {
    OBLIQUE * residual.max(protocol.tolerance) / from_one
}

/// Whether two orbits are one up to where they begin.
pub fn coincide<const D: usize>(
    a: &[[f64; D]],
    b: &[[f64; D]],
    bound: f64,
    metric: &Metric<D>,
) -> bool {
    let k = a.len();
    k == b.len()
        && (0..k).any(|shift| (0..k).all(|i| metric.distance(&a[i], &b[(i + shift) % k]) <= bound))
}

/// The share of points, of both samples, whose nearest neighbour is of their own sample.
///
/// The points are sorted by their first coordinate, and neighbours are looked for from each on to both sides until that
/// coordinate alone is farther away than the nearest one.
fn own_neighbours<const D: usize>(a: &[[f64; D]], b: &[[f64; D]], metric: &Metric<D>) -> f64 {
    let mut sorted: Vec<(bool, &[f64; D])> =
        a.iter().map(|it| (true, it)).chain(b.iter().map(|it| (false, it))).collect();
    sorted.sort_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]));
    let own = (0..sorted.len()).filter(|&place| {
        let mut nearest =
            Nearest { of: sorted[place], metric, distance: f64::INFINITY, is_own: false };
        sorted[place + 1..].iter().all(|other| nearest.meet(*other));
        sorted[..place].iter().rev().all(|other| nearest.meet(*other));
        nearest.is_own
    });
    own.count() as f64 / sorted.len() as f64
}

/// A point with the sample that it is of.
type Sampled<'a, const D: usize> = (bool, &'a [f64; D]);

/// The nearest neighbour of a point among those that it has met.
struct Nearest<'a, const D: usize> {
    of: Sampled<'a, D>,
    metric: &'a Metric<D>,
    distance: f64,
    /// Whether it is of the same sample; of two as near it is the one of the other sample.
    is_own: bool,
}

impl<'a, const D: usize> Nearest<'a, D> {
    /// Meets another point; whether one that has its first coordinate may be nearer.
    fn meet(&mut self, other: Sampled<'a, D>) -> bool {
        let ((own, point), (sample, other)) = (self.of, other);
        let distance = self.metric.distance(point, other);
        if distance < self.distance || (distance == self.distance && sample != own) {
            (self.distance, self.is_own) = (distance, sample == own);
        }
        self.metric.scales[0] * (point[0] - other[0]).abs() <= self.distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share by comparing each point with all others.
    fn by_all_pairs(a: &[[f64; 2]], b: &[[f64; 2]], metric: &Metric<2>) -> f64 {
        let nearest = |point: &[f64; 2], among: &[[f64; 2]], but: usize| {
            let others = among.iter().enumerate().filter(|(place, _)| *place != but);
            others.map(|(_, it)| metric.distance(point, it)).fold(f64::INFINITY, f64::min)
        };
        let own = |own: &[[f64; 2]], other: &[[f64; 2]]| {
            let places = 0..own.len();
            let is_own =
                |i: &usize| nearest(&own[*i], own, *i) < nearest(&own[*i], other, usize::MAX);
            places.filter(is_own).count()
        };
        (own(a, b) + own(b, a)) as f64 / (a.len() + b.len()) as f64
    }

    /// Points of the Hénon map.
    fn henon(start: [f64; 2], count: usize) -> Vec<[f64; 2]> {
        let next = |[x, y]: &[f64; 2]| Some([1.0 - 1.4 * x * x + y, 0.3 * x]);
        std::iter::successors(Some(start), next).skip(100).take(count).collect()
    }

    #[test]
    fn neighbours_are_found_as_among_all_pairs() {
        let metric = Metric::new([20.0, 0.5]);
        let a = henon([0.1, 0.1], 300);
        for b in [henon([0.3, -0.1], 300), henon([0.3, -0.1], 150), a.clone()] {
            let shifted: Vec<[f64; 2]> = b.iter().map(|[x, y]| [x + 0.003, *y]).collect();
            for b in [b, shifted] {
                assert_eq!(own_neighbours(&a, &b, &metric), by_all_pairs(&a, &b, &metric));
            }
        }
        let apart: Vec<[f64; 2]> = a.iter().map(|[x, y]| [x + 5.0, *y]).collect();
        assert_eq!(own_neighbours(&a, &apart, &metric), 1.0);
        let mixed = own_neighbours(&a, &henon([0.3, -0.1], 300), &metric);
        assert!((mixed - 0.5).abs() < 0.1, "{mixed}");
    }
}
