//! The unstable manifold of a saddle, by the images of a segment along its unstable direction.

use super::manifold::{BranchEnd, SectionMap, UnstableBranch};
use super::saddle_frame::SaddleFrame;

/// How far from the saddle a segment begins, relative to the motion: its images are as near to the manifold as the square of it.
const BEGINS: f64 = 1e-6;
/// Two points that follow each other are so far apart at most, relative to the motion.
const APART: f64 = 0.02;
/// The curve turns by so much between three points at most [rad].
const TURN: f64 = 0.2;
/// Points that are nearer to each other may turn by more, relative to the motion.
const NEAR: f64 = 1e-3;
/// Points that are nearer to the last are left out, relative to the motion.
const KEPT: f64 = 3e-4;
/// The first step along the segment, whose images are one period of the saddle apart; and the longest and the shortest.
const FIRST: f64 = 0.1;
const LONGEST: f64 = 0.25;
const SHORTEST: f64 = 1e-9;
/// A branch has come to an attractor where it has been so near to its points for a whole period, relative to the motion.
const REACHES: f64 = 1e-3;
/// The length of a branch at most, relative to the motion, and its points.
const MOST_LENGTH: f64 = 30.0;
const MOST_POINTS: usize = 4000;
/// Images of the segment at most.
const MOST_IMAGES: f64 = 300.0;

/// What is needed to follow the unstable manifold of a saddle.
pub(super) struct UnstableSearch<'a, const D: usize> {
    /// The return map.
    pub map: &'a SectionMap<'a, D>,
    /// The saddle.
    pub frame: &'a SaddleFrame<D>,
    /// The section points of the attractors by their numbers.
    pub attractors: &'a [Vec<[f64; D]>],
}

impl<const D: usize> UnstableSearch<'_, D> {
    /// Both halves from each section point of the saddle, which is at a place among all.
    pub fn branches(&self, saddle: usize) -> Vec<UnstableBranch<[f64; D]>> {
        let mut branches = Vec::new();
        for cycle in 0..self.frame.points.len() {
            for (side, sign) in self.frame.sides.into_iter().zip([1.0, -1.0]) {
                let half = Half { search: self, cycle, side, sign };
                branches.push(half.branch(saddle));
            }
        }
        branches
    }
}

/// One half of the manifold of one section point.
struct Half<'a, const D: usize> {
    search: &'a UnstableSearch<'a, D>,
    cycle: usize,
    side: u32,
    sign: f64,
}

impl<const D: usize> Half<'_, D> {
    /// The half, from the saddle on.
    ///
    /// Method: at the parameter n + t, t from 0 to 1, it has the n-th image of the point that is m^t times as far along the unstable
    /// direction as where the segment begins, m the multiplier: the images of the segment follow each other without a gap. The
    /// parameter advances by steps that are repeated with half their length where points are too far apart or turn too much.
    fn branch(&self, saddle: usize) -> UnstableBranch<[f64; D]> {
        let Half { search, cycle, side, .. } = self;
        let (map, size) = (search.map, search.frame.size);
        let mut points = vec![search.frame.points[*cycle].point];
        let (mut length, mut tears, mut step) = (0.0, 0, FIRST);
        // The parameter, and that from which on all points are beside the attractor.
        let (mut at, mut beside) = (0.0, None);
        let mut end = BranchEnd::Points;
        while points.len() < MOST_POINTS && at < MOST_IMAGES {
            let Some(point) = self.point(at + step) else {
                end = BranchEnd::Lost;
                break;
            };
            let last = &points[points.len() - 1];
            let apart = map.metric.distance(&point, last) / size;
            let turn = match points.len() {
                1 => 0.0,
                count => self.turn(&points[count - 2], last, &point),
            };
            let is_near = apart <= APART && (turn <= TURN || apart <= NEAR);
            if !is_near && step > SHORTEST {
                step = (0.5 * step).max(SHORTEST);
                continue;
            }
            at += step;
            step = (1.6 * step).min(LONGEST);
            beside = beside.or(Some(at)).filter(|_| self.is_beside_attractor(&point));
            let has_come = beside.is_some_and(|since| at - since >= 1.0);
            if apart < KEPT && !has_come {
                continue;
            }
            tears += usize::from(apart > APART);
            length += map.metric.distance(&point, last);
            points.push(point);
            if has_come {
                end = BranchEnd::Attractor;
                break;
            }
            if length > MOST_LENGTH * size {
                end = BranchEnd::Length;
                break;
            }
        }
        UnstableBranch { saddle, cycle: *cycle, side: *side, points, end, tears, length }
    }

    /// The point at a parameter; none where the motion cannot be followed.
    fn point(&self, at: f64) -> Option<[f64; D]> {
        let SaddleFrame { points, multiplier, size, .. } = self.search.frame;
        let images = at.floor();
        let away = BEGINS * size * libm::pow(*multiplier, at - images);
        let mut point = points[self.cycle].moved(self.sign * away);
        for _ in 0..images as usize * points.len() {
            point = (self.search.map.next)(&point)?;
        }
        Some(point)
    }

    /// The angle between the ways from a point to the next and from there to the one after, in the units of the metric.
    fn turn(&self, a: &[f64; D], b: &[f64; D], c: &[f64; D]) -> f64 {
        let metric = &self.search.map.metric;
        let [first, second] =
            [[b, a], [c, b]].map(|[to, from]| metric.scaled(&metric.difference(to, from)));
        let product = |x: &[f64; D], y: &[f64; D]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let lengths = (product(&first, &first) * product(&second, &second)).sqrt();
        if lengths == 0.0 {
            0.0
        } else {
            libm::acos((product(&first, &second) / lengths).clamp(-1.0, 1.0))
        }
    }

    /// Whether a point is beside one of the attractor's.
    fn is_beside_attractor(&self, point: &[f64; D]) -> bool {
        let metric = &self.search.map.metric;
        let within = REACHES * self.search.frame.size;
        let of_attractor = self.search.attractors.get(self.side as usize);
        of_attractor.is_some_and(|all| all.iter().any(|it| metric.distance(it, point) <= within))
    }
}
