//! What is known of the curves in which basins meet: stable manifolds of saddles in a plane of starts, and their unstable manifolds.

use super::edge::{LeadTo, Met};
use crate::flow::Metric;
use crate::orbit::return_map::Image;

/// The return map of a system over one cycle, and where its motions lead.
pub struct SectionMap<'a, const D: usize> {
    /// How far section points are apart.
    pub metric: Metric<D>,
    /// Where a section point returns to, with derivatives; none where the motion cannot be followed.
    pub image: &'a dyn Fn(&[f64; D]) -> Option<Image<D>>,
    /// The same without derivatives.
    pub next: &'a dyn Fn(&[f64; D]) -> Option<[f64; D]>,
    /// What section points lead to.
    pub leads: &'a LeadTo<'a, D>,
}

/// Two coordinates of a section point that vary, the others held.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane<P> {
    /// A section point in it.
    pub origin: P,
    /// Which coordinates vary.
    pub places: [usize; 2],
    /// The values of each at the starts of a grid, two or more, all rising or all falling.
    pub values: [Vec<f64>; 2],
}

/// Why a curve ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum CurveEnd {
    /// It leaves the plane.
    Border,
    /// It comes back to where it began.
    Closed,
    /// It meets the end of another.
    Meets,
    /// It has as many points as one may have, or all have as many as they may have together.
    Length,
    /// Motions from there do not come near the saddle within the cycles that are followed.
    Far,
    /// No next point is found, not by derivatives and not by the attractors of starts around: other basins are near.
    Lost,
}

impl CurveEnd {
    /// All of them.
    pub const ALL: [CurveEnd; 6] = [
        CurveEnd::Border,
        CurveEnd::Closed,
        CurveEnd::Meets,
        CurveEnd::Length,
        CurveEnd::Far,
        CurveEnd::Lost,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            CurveEnd::Border => "border",
            CurveEnd::Closed => "closed",
            CurveEnd::Meets => "other_curve",
            CurveEnd::Length => "length",
            CurveEnd::Far => "far",
            CurveEnd::Lost => "lost",
        }
    }
}

/// A curve in the plane on which two basins meet.
#[derive(Debug, Clone, PartialEq)]
pub struct StableCurve {
    /// The saddle whose stable manifold it is, by its place; none where it was followed by where starts lead alone.
    pub saddle: Option<usize>,
    /// The attractors on its left and on its right.
    pub sides: [u32; 2],
    /// Its points, by the values of the two coordinates.
    pub points: Vec<[f64; 2]>,
    /// Whether each point was found by division between starts that lead to the two attractors, not by derivatives.
    pub divided: Vec<bool>,
    /// Why it ends at its first point and at its last.
    pub ends: [CurveEnd; 2],
    /// Its length, the sides of the plane being one.
    pub length: f64,
    /// The largest estimate of how far a point found by derivatives is from the manifold, the sides of the plane being one.
    pub error: f64,
}

/// Why a half of an unstable manifold ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum BranchEnd {
    /// It comes to an attractor.
    Attractor,
    /// It is as long as one may be.
    Length,
    /// It has as many points, or was followed for as many cycles, as are allowed.
    Points,
    /// A motion cannot be followed.
    Lost,
}

impl BranchEnd {
    /// All of them.
    pub const ALL: [BranchEnd; 4] =
        [BranchEnd::Attractor, BranchEnd::Length, BranchEnd::Points, BranchEnd::Lost];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            BranchEnd::Attractor => "attractor",
            BranchEnd::Length => "length",
            BranchEnd::Points => "points",
            BranchEnd::Lost => "lost",
        }
    }
}

/// One half of the unstable manifold of a section point of a saddle.
#[derive(Debug, Clone, PartialEq)]
pub struct UnstableBranch<P> {
    /// The saddle, by its place.
    pub saddle: usize,
    /// From which of its section points it goes.
    pub cycle: usize,
    /// The attractor to which motions lead that begin on it.
    pub side: u32,
    /// Its points, from the saddle on.
    pub points: Vec<P>,
    /// Why it ends.
    pub end: BranchEnd,
    /// Places where the map tears it apart, so that two points that follow each other are not near.
    pub tears: usize,
    /// Its length [units of the metric].
    pub length: f64,
}

impl<P> UnstableBranch<P> {
    /// The same with section points held in another way.
    pub fn map<Q>(self, held: impl Fn(P) -> Q) -> UnstableBranch<Q> {
        let UnstableBranch { saddle, cycle, side, points, end, tears, length } = self;
        let points = points.into_iter().map(held).collect();
        UnstableBranch { saddle, cycle, side, points, end, tears, length }
    }
}

/// How much of the boundary that the grid shows lies beside a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Coverage {
    /// Pairs of neighbouring starts that lead to two attractors.
    pub crossings: usize,
    /// Those of them that no curve passes within the distance of two neighbouring starts.
    pub uncovered: usize,
    /// Those of them from which a curve was sought.
    pub seeds: usize,
    /// Those of these that gave none.
    pub failed: usize,
    /// Whether the search stopped because there are as many curves, points or failures as are allowed.
    pub stopped: bool,
}

/// The manifolds of the saddles on the boundaries of the basins in a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Manifolds<P> {
    /// The saddles: those that were known, and those that were met beside.
    pub saddles: Vec<Met<P>>,
    /// Stable manifolds in the plane.
    pub stable: Vec<StableCurve>,
    /// Unstable manifolds.
    pub unstable: Vec<UnstableBranch<P>>,
    /// How much of the boundary the stable ones make up.
    pub coverage: Coverage,
}
