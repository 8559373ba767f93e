//! The stable manifolds that make up the boundary of basins in a plane of starts, one curve after the other.

use std::cell::Cell;

use super::boundary_cover::{BoundaryCover, Pair};
use super::crossing::Crossing;
use super::edge::{Met, Saddle};
use super::manifold::{Coverage, CurveEnd, Manifolds, Plane, SectionMap, StableCurve};
use super::saddle_frame::SaddleFrame;
use super::stable_curve::{Follower, OpenEnd};
use super::start_plane::StartPlane;
use super::unstable_branch::UnstableSearch;

/// Curves at most, and points of all of them together.
const MOST_CURVES: usize = 300;
const MOST_POINTS: usize = 40_000;
/// Cycles that are followed for each pair of neighbouring starts that lead to two attractors, on the average, and for all: a boundary
/// takes a few hundred for each by derivatives, and some ten thousand by division.
const PER_CROSSING: u64 = 20_000;
const LEAST_CYCLES: u64 = 1_500_000;
const MOST_CYCLES: u64 = 12_000_000;
/// The search stops after so many pairs of starts from which no curve is found.
const MOST_FAILED: usize = 48;
/// Two starts on the two sides are brought this close together before derivatives are tried, and then closer, the distance of the
/// starts of the grid being one.
const CLOSE: [f64; 3] = [0.1, 1e-3, 1e-6];
/// Saddles whose points are this near to each other are one, relative to the motion.
const SAME: f64 = 1e-7;
/// The unstable manifolds are sought of so many saddles at most.
const MOST_SADDLES: usize = 16;

/// The saddle to which motions tend that begin on the boundary between two section points.
pub type SaddleBetween<'a, const D: usize> = dyn Fn([[f64; D]; 2]) -> Option<Met<[f64; D]>> + 'a;

/// What is needed to find the manifolds of saddles.
pub struct ManifoldSearch<'a, const D: usize> {
    /// The return map.
    pub map: SectionMap<'a, D>,
    /// Finds saddles that are not known, see [`EdgeSearch::saddle`](super::EdgeSearch::saddle).
    pub saddle: &'a SaddleBetween<'a, D>,
    /// The plane of the starts.
    pub plane: &'a Plane<[f64; D]>,
    /// The attractor that each start of the grid leads to, the first side of the plane the slower.
    pub attractors: &'a [Option<u32>],
    /// The section points of the attractors by their numbers.
    pub points: &'a [Vec<[f64; D]>],
}

/// What has been found so far.
struct Search<'a, const D: usize> {
    search: &'a ManifoldSearch<'a, D>,
    plane: StartPlane<'a, D>,
    saddles: Vec<Met<[f64; D]>>,
    frames: Vec<SaddleFrame<D>>,
    curves: Vec<StableCurve>,
    open: Vec<OpenEnd>,
    points: usize,
}

impl<const D: usize> ManifoldSearch<'_, D> {
    /// The curves of the boundary in the plane, and the unstable manifolds of the saddles on it, of which some are `known`.
    ///
    /// Method: of each pair of neighbouring starts that lead to two attractors and that no curve passes yet, two starts are brought
    /// together on the boundary. From there the zero of g(x) = w (P^n(x) - s) is followed, P the return map, s the section point of
    /// the saddle to which the motion comes near, w the left eigenvector of its multiplier beyond 1, and n the number of cycles for
    /// which the error of second order is least. The saddle is one that is known, or is sought there.
    /// Source: the level set of the unstable coordinate under a power of the map is the definition of the stable manifold; step
    /// control by turn and chord, and images of a fundamental segment for the unstable one, after D. Hobson, J. Comput. Phys. 104,
    /// 1993. A survey of other methods: B. Krauskopf et al., Int. J. Bifurcation Chaos 15, 2005.
    /// Assumes: one multiplier beyond 1 in magnitude, which is positive.
    /// Guarantees: points by derivatives have g = 0 to rounding; points by division lie between starts that lead to the two
    /// attractors.
    /// Breaks: where the boundary is fractal there is no end of curves, and the search stops; where the map is torn, the boundary is
    /// no manifold of a saddle and is followed by division alone.
    pub fn manifolds(&self, known: &[Saddle<[f64; D]>]) -> Manifolds<[f64; D]> {
        let cover = BoundaryCover::of(self.plane, self.attractors);
        let most = (PER_CROSSING * cover.pairs.len() as u64).clamp(LEAST_CYCLES, MOST_CYCLES);
        let cycles = Cell::new(0);
        let plane = StartPlane { map: &self.map, plane: self.plane, cycles, most };
        let mut search = Search {
            search: self,
            plane,
            saddles: Vec::new(),
            frames: Vec::new(),
            curves: Vec::new(),
            open: Vec::new(),
            points: 0,
        };
        for saddle in known {
            search.learn(saddle);
        }
        let coverage = search.cover(cover);
        let Search { saddles, frames, curves, .. } = search;
        let mut unstable = Vec::new();
        for (place, frame) in frames.iter().take(MOST_SADDLES).enumerate() {
            let search = UnstableSearch { map: &self.map, frame, attractors: self.points };
            unstable.extend(search.branches(place));
        }
        let stable = curves.into_iter().map(|curve| told(curve, self.plane)).collect();
        Manifolds { saddles, stable, unstable, coverage }
    }
}

/// A curve with its points by the values of the coordinates.
fn told<P>(curve: StableCurve, plane: &Plane<P>) -> StableCurve {
    let points = curve.points.iter().map(|at| plane.told(at)).collect();
    StableCurve { points, ..curve }
}

impl<const D: usize> Search<'_, D> {
    /// Takes a saddle among those that are known; its place, or none where it does not part two basins.
    fn learn(&mut self, saddle: &Saddle<[f64; D]>) -> Option<usize> {
        let map = &self.search.map;
        let same = self.frames.iter().position(|it| it.is(map, saddle, SAME));
        if same.is_some() {
            return same;
        }
        let frame = SaddleFrame::of(map, saddle, self.plane.size())?;
        self.saddles.push(Met { sides: frame.sides, saddle: saddle.clone() });
        self.frames.push(frame);
        Some(self.frames.len() - 1)
    }

    /// Follows curves until each pair of neighbouring starts that lead to two attractors has one beside it.
    fn cover(&mut self, mut cover: BoundaryCover<'_, [f64; D]>) -> Coverage {
        let mut coverage = Coverage { crossings: cover.pairs.len(), ..Coverage::default() };
        for number in 0..cover.pairs.len() {
            let pair = cover.pairs[number];
            if pair.is_covered {
                continue;
            }
            let is_full = self.curves.len() >= MOST_CURVES || self.points >= MOST_POINTS;
            if is_full || coverage.failed >= MOST_FAILED || self.plane.is_spent() {
                coverage.stopped = true;
                break;
            }
            coverage.seeds += 1;
            match self.curve(&pair) {
                Some(curve) => {
                    cover.cover(&curve.points);
                    self.keep(curve);
                }
                None => coverage.failed += 1,
            }
        }
        coverage.uncovered = cover.uncovered();
        coverage
    }

    /// Takes a curve among those that are found.
    fn keep(&mut self, curve: StableCurve) {
        let points = &curve.points;
        let last = points.len() - 1;
        let ends = [[points[0], points[1]], [points[last], points[last - 1]]];
        for (end, [at, before]) in curve.ends.into_iter().zip(ends) {
            if matches!(end, CurveEnd::Far | CurveEnd::Lost | CurveEnd::Length) {
                let length = libm::hypot(at[0] - before[0], at[1] - before[1]);
                let outward = [0, 1].map(|side| (at[side] - before[side]) / length);
                self.open.push(OpenEnd { at, outward });
            }
        }
        self.points += points.len();
        self.curves.push(curve);
    }

    /// The curve that passes between two neighbouring starts.
    fn curve(&mut self, pair: &Pair) -> Option<StableCurve> {
        let plane = self.search.plane;
        let starts = pair.starts.map(|places| [0, 1].map(|side| plane.share(side, places[side])));
        let mut crossing = Crossing { starts, attractors: pair.attractors };
        let distance = crossing.width();
        for close in CLOSE {
            crossing = crossing.closer(&self.plane, close * distance)?;
            for saddle in 0..self.frames.len() {
                if let Some(curve) = self.followed(&crossing, Some(saddle)) {
                    return Some(curve);
                }
            }
        }
        let points = crossing.starts.map(|at| self.plane.point(&at));
        let met = (self.search.saddle)(points);
        let saddle = met.and_then(|met| self.learn(&met.saddle));
        let by_saddle = saddle.and_then(|saddle| self.followed(&crossing, Some(saddle)));
        by_saddle.or_else(|| self.followed(&crossing, None))
    }

    /// The curve through a crossing, by a saddle or without one.
    fn followed(&self, crossing: &Crossing, saddle: Option<usize>) -> Option<StableCurve> {
        let saddle = saddle.map(|place| (place, &self.frames[place]));
        let [left, right] = crossing.attractors;
        if let Some((_, frame)) = saddle
            && frame.sides != [left, right]
            && frame.sides != [right, left]
        {
            return None;
        }
        let follower = Follower {
            plane: &self.plane,
            saddle,
            sides: crossing.attractors,
            open: &self.open,
            most: MOST_POINTS - self.points,
        };
        let crossing = match saddle {
            Some(_) => *crossing,
            None => crossing
                .closer(&self.plane, 0.0)
                .filter(|it| it.attractors == crossing.attractors)?,
        };
        follower.curve(&crossing)
    }
}
