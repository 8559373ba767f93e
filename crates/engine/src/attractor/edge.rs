//! The saddle on the boundary of two basins, from two starts that lead to different attractors.

use crate::flow::System;
use crate::orbit::Protocol;
use crate::orbit::matrix::{Complex, Matrix, eigenvalues};
use crate::orbit::newton::close;
use crate::orbit::passage::{Integrator, image};
use crate::orbit::precision::closes;
use crate::orbit::return_map::{Cycles, returned};

/// An unstable periodic orbit on the boundary of two basins, with one multiplier beyond 1 in magnitude: its stable manifold is
/// the boundary beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Saddle<P> {
    /// Its section points, from the least on as [`super::Attractor::least_point`] has it.
    pub points: Vec<P>,
    /// Its multipliers, the largest magnitude first [-].
    pub multipliers: Vec<Complex>,
    /// How far its section is from repeating after the period, relative to the motion [-].
    pub residual: f64,
}

impl<P> Saddle<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q) -> Saddle<Q> {
        let Saddle { points, multipliers, residual } = self;
        Saddle { points: points.into_iter().map(held).collect(), multipliers, residual }
    }
}

/// A saddle that a search has met, and what is on the two sides of the boundary there.
#[derive(Debug, Clone, PartialEq)]
pub struct Met<P> {
    /// The attractors to which the motions on the two sides of the boundary lead, by their numbers.
    pub sides: [u32; 2],
    /// The orbit.
    pub saddle: Saddle<P>,
}

impl<P> Met<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q) -> Met<Q> {
        Met { sides: self.sides, saddle: self.saddle.map(held) }
    }
}

/// Points at which a segment is divided at a time: they are followed side by side.
const PARTS: usize = 17;
/// The two ends of a segment are brought so close together, relative to the motion: closer, rounding would decide on which side of
/// the boundary each of them is followed.
const CLOSEST: f64 = 1e-11;
/// Two motions are followed until they are so far apart, relative to the motion.
const APART: f64 = 1e-2;
/// They are brought together again from where they were so far apart.
const NEAR: f64 = 1e-5;
/// An orbit is sought where a motion has returned so closely, relative to its size.
const RETURNS: f64 = 1e-3;
/// Cycles that two motions are followed before they are brought together again.
const CYCLES: usize = 256;
/// Times that they are brought together.
const ROUNDS: usize = 24;
/// The longest period that is sought.
const LONGEST: usize = 16;
/// How far a saddle is pushed along its unstable direction, relative to the motion: far beyond its error, and near.
const PUSH: f64 = 1e-6;
/// Times that a vector is turned to the unstable direction; another multiplier beside it may be nearly as large.
const POWERS: usize = 200;
/// To this share of the size of an orbit its points are rounded before the least is sought.
const LEAST: f64 = 1e-6;

/// What each of some section points leads to, by the number of the attractor; none where that is not known.
pub type LeadTo<'a, const D: usize> = dyn Fn(&[[f64; D]]) -> Vec<Option<u32>> + 'a;

/// What is needed to search for saddles of a system.
pub struct EdgeSearch<'a, M: System<D>, const D: usize> {
    /// The system.
    pub system: &'a M,
    /// How cases are followed.
    pub protocol: &'a Protocol,
    /// What follows orbits with derivatives.
    pub integrator: &'a dyn Integrator<M, D>,
    /// What section points lead to.
    pub leads: &'a LeadTo<'a, D>,
}

impl<M: System<D>, const D: usize> EdgeSearch<'_, M, D> {
    /// The saddle to which the motions tend that begin on a boundary between two section points; none where these do not lead
    /// to two known attractors, where no orbit of a period of up to 16 cycles is met, as the motion on the boundary does not
    /// repeat or is longer, or where pushes of it do not lead to two known attractors.
    ///
    /// The boundary is the first on the way from the first point. Where a third basin lies between the two, it is that of
    /// the third: what the saddle parts is told by motions that begin beside it, to either side along its unstable direction.
    ///
    /// Method: two points on the two sides of the boundary are brought together by division of the segment between them, and
    /// followed until they part; from where they were still close they are brought together anew (Skufca, Yorke and Eckhardt
    /// 2006). Where both come back to where they were, Newton's method on the return map closes the orbit. Guarantees: it
    /// closes to rounding and has exactly one multiplier beyond 1 in magnitude. Breaks: where the boundary is fractal the
    /// saddle depends on the starts, and is one of many.
    pub fn saddle(&self, points: [[f64; D]; 2]) -> Option<Met<[f64; D]>> {
        let leads = (self.leads)(&points);
        let first = leads[0]?;
        if leads[1].is_none_or(|second| second == first) {
            return None;
        }
        let mut ends = points;
        for _ in 0..ROUNDS {
            ends = self.together(ends, first);
            let trail = self.trail(ends)?;
            if let Some(closed) = self.closed(&trail) {
                return self.met(closed);
            }
            let metric = self.system.metric();
            let near = trail.iter().take_while(|pair| {
                metric.distance(&pair[0], &pair[1]) <= NEAR * metric.largest(&pair[..])
            });
            let near = near.count();
            if near < 2 {
                return None;
            }
            ends = trail[near - 1];
        }
        None
    }

    /// A saddle with what small pushes along its unstable direction lead to, which are two attractors where it lies on their boundary.
    fn met(&self, closed: Saddled<D>) -> Option<Met<[f64; D]>> {
        let Saddled { saddle, pushes } = closed;
        let leads = (self.leads)(&pushes);
        let sides = [leads[0]?, leads[1]?];
        (sides[0] != sides[1]).then_some(Met { sides, saddle })
    }

    /// Two points on the two sides of the boundary, close together.
    fn together(&self, mut ends: [[f64; D]; 2], first: u32) -> [[f64; D]; 2] {
        let metric = self.system.metric();
        ends[1] = metric.beside(&ends[1], &ends[0]);
        while metric.distance(&ends[0], &ends[1]) > CLOSEST * metric.largest(&ends) {
            let shares = (1..PARTS).map(|number| number as f64 / PARTS as f64);
            let inner = shares.map(|share| -> [f64; D] {
                std::array::from_fn(|i| ends[0][i] + share * (ends[1][i] - ends[0][i]))
            });
            let inner: Vec<[f64; D]> = inner.collect();
            let leads = (self.leads)(&inner);
            let other = leads.iter().position(|it| *it != Some(first)).unwrap_or(inner.len());
            let before = if other > 0 { inner[other - 1] } else { ends[0] };
            let narrower = [before, inner.get(other).copied().unwrap_or(ends[1])];
            if narrower == ends {
                break;
            }
            ends = narrower;
        }
        ends
    }

    /// Both motions from cycle to cycle until they part; none if they cannot be followed.
    fn trail(&self, ends: [[f64; D]; 2]) -> Option<Vec<[[f64; D]; 2]>> {
        let (system, metric) = (self.system.single(), self.system.metric());
        let cycles = Cycles { count: 1, tolerance: self.protocol.tolerance };
        let mut trail = vec![ends];
        while trail.len() < CYCLES {
            let [a, b] = trail[trail.len() - 1];
            let next = [
                returned(&system, a, &cycles, |_| ()).ok()?,
                returned(&system, b, &cycles, |_| ()).ok()?,
            ];
            if metric.distance(&next[0], &next[1]) > APART * metric.largest(&next) {
                break;
            }
            trail.push(next);
        }
        Some(trail)
    }

    /// The saddle near which a trail returns, the closest return first.
    fn closed(&self, trail: &[[[f64; D]; 2]]) -> Option<Saddled<D>> {
        let metric = self.system.metric();
        let size = trail.iter().map(|[point, _]| metric.size(point)).fold(0.0, f64::max);
        for period in 1..=LONGEST.min(trail.len().saturating_sub(1)) {
            let pairs = (period..trail.len()).map(|at| (at, trail[at][0], trail[at - period][0]));
            let apart = pairs.map(|(at, a, b)| (at, metric.distance(&a, &b)));
            let Some((at, gap)) = apart.min_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
            if gap > RETURNS * size {
                continue;
            }
            if let Some(saddle) = self.close(trail[at][0], period, size) {
                return Some(saddle);
            }
        }
        None
    }

    /// The saddle of this period near a section point.
    fn close(&self, point: [f64; D], period: usize, size: f64) -> Option<Saddled<D>> {
        let metric = self.system.metric();
        let cycles = Cycles { count: period as u64, tolerance: self.protocol.tolerance };
        let closed = close(
            |at| image(self.integrator, self.system, at, &cycles),
            period as u64,
            &metric,
            &point,
            size,
        );
        let closed = closed.ok()??;
        let multipliers = eigenvalues(&closed.jacobian);
        let beyond = multipliers.iter().filter(|it| it.abs() > 1.0).count();
        if closed.residual > closes(self.protocol.recurrence) || beyond != 1 {
            return None;
        }
        let once = Cycles { count: 1, ..cycles };
        let mut points = vec![closed.point];
        for _ in 1..period {
            let last = points[points.len() - 1];
            points.push(returned(&self.system.single(), last, &once, |_| ()).ok()?);
        }
        let unit = LEAST * metric.largest(&points);
        let least = (0..period).min_by_key(|place| metric.rounded(&points[*place], unit));
        points.rotate_left(least.unwrap_or(0));
        let along = self.unstable(&closed.jacobian).map(|it| it * PUSH * size);
        let pushes =
            [1.0, -1.0].map(|side| std::array::from_fn(|i| closed.point[i] + side * along[i]));
        let saddle =
            Saddle { points, multipliers: multipliers.to_vec(), residual: closed.residual };
        Some(Saddled { saddle, pushes })
    }

    /// The direction of the one multiplier beyond 1, of size one in the units of the metric: what a matrix turns any vector to.
    fn unstable(&self, jacobian: &Matrix<D>) -> [f64; D] {
        let metric = self.system.metric();
        let mut vector: [f64; D] = std::array::from_fn(|i| 1.0 / metric.scales[i]);
        for _ in 0..POWERS {
            let image: [f64; D] =
                std::array::from_fn(|i| (0..D).map(|j| jacobian[i][j] * vector[j]).sum());
            let size = metric.length(&image);
            vector = image.map(|it| it / size);
        }
        vector
    }
}

/// A saddle, and two points beside it, to either side along its unstable direction.
struct Saddled<const D: usize> {
    saddle: Saddle<[f64; D]>,
    pushes: [[f64; D]; 2],
}
