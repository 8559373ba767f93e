//! When two motions are on one attractor.

use crate::flow::{Metric, System};
use crate::orbit::precision::OBLIQUE;
use crate::orbit::return_map::{Cycles, returned};
use crate::orbit::{Outcome, Protocol};

use super::final_motion::FinalMotion;

/// Points by which two motions that do not repeat are compared.
const SAMPLE: usize = 64;
/// Two samples of one motion have half of all nearest neighbours in the same sample, those of two motions
/// all: in the middle between the two they are told apart.
const MIXED: f64 = 0.75;

/// To this share of the size of an orbit its points are rounded before they are compared.
const LEAST: f64 = 1e-6;

/// An attractor as the cases with the same parameters show it.
#[derive(Debug, Clone, PartialEq)]
pub struct Attractor<const D: usize> {
    /// The first of its cases.
    pub case: usize,
    /// Periodic, chaotic or quasi-periodic.
    pub outcome: Outcome,
    /// Section points of a period, or a sample, which is held only until the cases are sorted.
    pub points: Vec<[f64; D]>,
    /// How far each point may be from the true orbit, in the units of the metric.
    pub bound: f64,
    /// Size of the motion, in the units of the metric.
    pub size: f64,
}

impl<const D: usize> Attractor<D> {
    /// What a case has ended on; none where that repels or is not known.
    ///
    pub fn of<M: System<D>>(
        index: usize,
        system: &M,
        motion: &FinalMotion<D>,
        protocol: &Protocol,
    ) -> Option<Self> {
        let wanted = match motion.outcome {
            Outcome::Periodic if motion.is_stable => motion.period as usize,
            Outcome::Chaotic | Outcome::QuasiPeriodic => SAMPLE,
            Outcome::Periodic | Outcome::Undecided | Outcome::Failed => return None,
        };
        let points = section_points(system, motion.section, wanted, protocol)?;
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
        let key = |place: &usize| metric.rounded(&self.points[*place], LEAST * self.size);
        (0..self.points.len()).min_by_key(key).unwrap_or(0)
    }

    /// Whether this is the same attractor as another at the same parameters.
    ///
    /// Periodic orbits: the periods are equal, and the points up to a cyclic shift, within the two bounds.
    /// Others: by the nearest neighbours of the two samples (Schilling 1986). It breaks where two
    /// attractors interleave more closely than their samples lie, and where a motion drifts so slowly that
    /// its two samples do not meet.
    pub fn is(&self, other: &Self, metric: &Metric<D>) -> bool {
        if self.outcome != other.outcome {
            return false;
        }
        match self.outcome {
            Outcome::Periodic => {
                coincide(&self.points, &other.points, self.bound + other.bound, metric)
            }
            _ => same_neighbours(&self.points, &other.points, metric) <= MIXED,
        }
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
    let near = |shift: usize, i: usize| metric.distance(&a[i], &b[(i + shift) % k]) <= bound;
    k == b.len() && (0..k).any(|shift| (0..k).all(|i| near(shift, i)))
}

/// The share of points, of both samples, whose nearest neighbour is of their own sample.
fn same_neighbours<const D: usize>(a: &[[f64; D]], b: &[[f64; D]], metric: &Metric<D>) -> f64 {
    let nearest = |i: usize, own: &[[f64; D]], point: &[f64; D]| {
        let others = own.iter().enumerate().filter(|(j, _)| *j != i);
        others.map(|(_, other)| metric.distance(point, other)).fold(f64::INFINITY, f64::min)
    };
    let own = |own: &[[f64; D]], other: &[[f64; D]]| {
        let is_own = |(i, point): &(usize, &[f64; D])| {
            nearest(*i, own, point) < nearest(usize::MAX, other, point)
        };
        own.iter().enumerate().filter(is_own).count()
    };
    (own(a, b) + own(b, a)) as f64 / (a.len() + b.len()) as f64
}

/// So many section points of the motion from one of them on.
fn section_points<M: System<D>, const D: usize>(
    system: &M,
    from: [f64; D],
    wanted: usize,
    protocol: &Protocol,
) -> Option<Vec<[f64; D]>> {
    let system = system.single();
    let cycles = Cycles { count: 1, tolerance: protocol.tolerance };
    let mut points = Vec::with_capacity(wanted);
    points.push(from);
    while points.len() < wanted {
        points.push(returned(&system, points[points.len() - 1], &cycles, |_| ()).ok()?);
    }
    Some(points)
}
