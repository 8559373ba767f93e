//! Numerical continuation of periodic orbits, stable or not, in parameters, with their special points.

mod across;
mod arc;
mod arclength;
mod bialternate;
mod codim2;
mod corner;
mod curve;
mod direct;
mod doubling;
mod family;
mod follow;
mod grazing;
mod half_branch;
mod limited;
mod locus;
mod merger;
mod orbits;
mod periodic;
mod scales;
mod segment;
mod special;
mod step_control;
mod succession;
mod walk;
mod whole_step;

pub use curve::is_followed;
pub use direct::{Linearised, leads_to, linearised};
pub use family::cyclic;
pub use follow::follow;
pub use segment::{Along, ONE_VALUE, PeriodicOrbit, Segment, SegmentEnd, SpecialValue};
pub use succession::{segment, succession};

use crate::flow::{Reason, System};
use crate::orbit::OrbitOf;
use crate::orbit::matrix::Complex;

/// What to follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Request<M: System<D>, const D: usize> {
    /// The system with the parameters at which the first orbit is known.
    pub system: M,
    /// A point of the section near the first orbit.
    pub section: [f64; D],
    /// Its period [cycles].
    pub period: u64,
    /// The parameter to follow it in.
    pub along: M::Parameter,
    /// Where to stop, the lesser first.
    pub range: [f64; 2],
    /// How often to switch to the branch of twice the period where a multiplier passes -1.
    pub doublings: u32,
    /// A second parameter with its range, in which the special points are followed as curves.
    pub second: Option<(M::Parameter, [f64; 2])>,
    /// Where the curves stop in the first parameter, the lesser first; where the branch does if none is given.
    pub curve_range: Option<[f64; 2]>,
    /// Longest step, as a share of the range.
    pub longest_step: f64,
    /// Points of a branch or curve at most.
    pub most_points: usize,
    /// Relative local error of a step of the integrator.
    pub tolerance: f64,
}

/// A periodic orbit on a branch, with an `O` that was measured of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Point<O, P> {
    /// Value of the parameter that is followed.
    pub parameter: f64,
    /// The section points of one period.
    pub section: Vec<P>,
    /// Floquet multipliers of the period, the largest magnitude first.
    pub multipliers: Vec<Complex>,
    /// How far the section is from repeating, relative to the motion [-].
    pub residual: f64,
    /// What was measured over the period.
    pub measured: O,
    /// Which of the branch's sequences of events it has.
    pub sequence: usize,
}

/// A point of a branch of a system, with the orbit measured by the plain motion, if that can be followed.
pub type PointOf<M, const D: usize> = Point<Option<OrbitOf<M, D>>, [f64; D]>;
/// A branch of a system.
pub type BranchOf<M, const D: usize> = Branch<Option<OrbitOf<M, D>>, [f64; D]>;
/// What was found of a system.
pub type FoundOf<M, const D: usize> = Found<Option<OrbitOf<M, D>>, [f64; D]>;

/// What happens at a special point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpecialKind {
    /// A multiplier passes +1 and the branch turns back.
    Fold = 0,
    /// A multiplier passes -1: a branch of twice the period leaves.
    PeriodDoubling,
    /// A pair of complex multipliers passes the unit circle.
    NeimarkSacker,
    /// An extremum touches the surface of an impact, which begins or ceases there.
    Grazing,
    /// The sequence of events changes in another way.
    EventSequence,
    /// What happens could not be resolved by the shortest step: a special point may lie between the orbits on its two sides.
    Unresolved,
}

impl SpecialKind {
    /// Every kind by its name in files, in the order of declaration.
    pub const NAMES: [(&str, SpecialKind); 6] = [
        ("fold", SpecialKind::Fold),
        ("period-doubling", SpecialKind::PeriodDoubling),
        ("neimark-sacker", SpecialKind::NeimarkSacker),
        ("grazing", SpecialKind::Grazing),
        ("event-sequence", SpecialKind::EventSequence),
        ("unresolved", SpecialKind::Unresolved),
    ];
}

/// What happens at a point of codimension 2, where a curve in two parameters meets another or changes what it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Codim2Kind {
    /// Two folds meet on a curve of folds, and both vanish.
    Cusp = 0,
    /// One multiplier is +1 and one is -1.
    FoldFlip,
    /// One multiplier is +1 and a complex pair lies on the unit circle.
    FoldNeimarkSacker,
    /// One multiplier is -1 and a complex pair lies on the unit circle.
    FlipNeimarkSacker,
    /// Two multipliers are +1: strong resonance 1:1.
    Resonance1,
    /// Two multipliers are -1: strong resonance 1:2.
    Resonance2,
    /// A pair of multipliers are third roots of one: strong resonance 1:3.
    Resonance3,
    /// A pair of multipliers are fourth roots of one: strong resonance 1:4.
    Resonance4,
    /// An extremum touches its surface on an orbit with the multiplier +1.
    FoldGrazing,
    /// An extremum touches its surface on an orbit with the multiplier -1.
    DoublingGrazing,
    /// An extremum touches its surface on an orbit with a complex pair of multipliers on the unit circle.
    NeimarkSackerGrazing,
    /// Two extrema touch their surfaces.
    DoubleGrazing,
    /// A test function of the curve changes its sign, and where it does could not be located.
    Unresolved,
}

impl Codim2Kind {
    /// Every kind by its name in files, in the order of declaration.
    pub const NAMES: [(&str, Codim2Kind); 13] = [
        ("cusp", Codim2Kind::Cusp),
        ("fold-flip", Codim2Kind::FoldFlip),
        ("fold-neimark-sacker", Codim2Kind::FoldNeimarkSacker),
        ("flip-neimark-sacker", Codim2Kind::FlipNeimarkSacker),
        ("resonance-1-1", Codim2Kind::Resonance1),
        ("resonance-1-2", Codim2Kind::Resonance2),
        ("resonance-1-3", Codim2Kind::Resonance3),
        ("resonance-1-4", Codim2Kind::Resonance4),
        ("fold-grazing", Codim2Kind::FoldGrazing),
        ("doubling-grazing", Codim2Kind::DoublingGrazing),
        ("neimark-sacker-grazing", Codim2Kind::NeimarkSackerGrazing),
        ("double-grazing", Codim2Kind::DoubleGrazing),
        ("unresolved", Codim2Kind::Unresolved),
    ];
}

/// A point of codimension 2 on a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Codim2 {
    /// What happens there.
    pub kind: Codim2Kind,
    /// It lies between this point of the curve and the next; of an unresolved one, what is told is of one of the two.
    pub after: usize,
    /// Values of the followed and of the second parameter.
    pub parameters: [f64; 2],
    /// A section point of the orbit.
    pub section: Vec<f64>,
    /// Floquet multipliers of the period, the largest magnitude first; at a grazing those on the side from which it is followed.
    pub multipliers: Vec<Complex>,
}

/// A special point of a branch.
#[derive(Debug, Clone, PartialEq)]
pub struct Special<O, P> {
    /// What happens there.
    pub kind: SpecialKind,
    /// It lies between this point of the branch and the next.
    pub after: usize,
    /// The orbit there.
    pub point: Point<O, P>,
    /// The curve in two parameters that goes through it.
    pub curve: Option<usize>,
}

/// Why a branch or a curve ends where it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// A parameter is at an end of its range.
    Bound = 0,
    /// It has come back to where it began, and has no ends.
    Closed,
    /// It runs into an orbit of half its period.
    Merged,
    /// It has as many points as it may have.
    MostPoints,
    /// The return map has a kink or a jump there, and no step leads on: where impacts accumulate, or at a grazing
    /// beyond which no orbit was found.
    Corner,
    /// The extremum that touches its surface meets another there, and both vanish.
    Vanishes,
    /// It could not be followed further.
    Stopped,
    /// Orbits of an autonomous system shrink onto an equilibrium there: a Hopf bifurcation.
    Equilibrium,
    /// Orbits of an autonomous system take as long there as a return is waited for.
    LongestWait,
    /// The complex pair of a curve of Neimark-Sacker points becomes real there: a strong resonance 1:1 or 1:2.
    StrongResonance,
}

impl End {
    /// Every reason by its name in files, in the order of declaration.
    pub const NAMES: [(&str, End); 10] = [
        ("edge-of-range", End::Bound),
        ("closed", End::Closed),
        ("half-period", End::Merged),
        ("most-points", End::MostPoints),
        ("corner", End::Corner),
        ("touch-vanishes", End::Vanishes),
        ("stopped", End::Stopped),
        ("equilibrium", End::Equilibrium),
        ("longest-wait", End::LongestWait),
        ("strong-resonance", End::StrongResonance),
    ];
}

/// A branch of periodic orbits, from one end to the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch<O, P> {
    /// Period of its orbits [cycles].
    pub period: u64,
    /// The branch that it left at a period doubling, and which of its special points that was.
    pub parent: Option<(usize, usize)>,
    /// Its orbits in order. Where a rigid impact passes the instant of the section, the section point jumps.
    pub points: Vec<Point<O, P>>,
    /// Its special points in order.
    pub special: Vec<Special<O, P>>,
    /// Why it ends at its first orbit and at its last.
    pub ends: [End; 2],
}

/// A curve of special points in two parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What happens on it.
    pub kind: SpecialKind,
    /// The branch and the special point that it was followed from.
    pub through: (usize, usize),
    /// Period of the orbits on it [cycles].
    pub period: u64,
    /// Values of the followed and of the second parameter, in order.
    pub points: Vec<[f64; 2]>,
    /// Its points of codimension 2, in order.
    pub codim2: Vec<Codim2>,
    /// Why it ends at its first point and at its last.
    pub ends: [End; 2],
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found<O, P> {
    /// The branch through the first orbit, then those that doubling leads to.
    pub branches: Vec<Branch<O, P>>,
    /// Curves in two parameters, where a second was asked for.
    pub curves: Vec<Curve>,
    /// Period doublings off which no orbit of twice the period was found, though it was asked for: the branch, and which of
    /// its special points.
    pub not_left: Vec<(usize, usize)>,
}

/// Why nothing could be followed.
#[derive(Debug, Clone, PartialEq)]
pub enum NotFollowed {
    /// No periodic orbit was found near the point that was given.
    NoOrbit,
    /// The range does not hold the parameter's value at the first orbit, or is empty.
    OutOfRange,
    /// The motion could not be followed there.
    Failed(Reason),
    /// A multiplier of the orbit cannot be told from one: it belongs to a family of orbits at one value of the
    /// parameter, along which a branch in the parameter has no direction of its own, or lies in a fold.
    Neutral,
    /// The system has no parameter of the name that was given, to be followed in or as the second.
    NoParameter,
}

impl<O, P> Point<O, P> {
    fn map<N, Q>(self, measured: &impl Fn(f64, O) -> N, held: &impl Fn(P) -> Q) -> Point<N, Q> {
        Point {
            measured: measured(self.parameter, self.measured),
            parameter: self.parameter,
            section: self.section.into_iter().map(held).collect(),
            multipliers: self.multipliers,
            residual: self.residual,
            sequence: self.sequence,
        }
    }
}

impl<O, P> Special<O, P> {
    fn map<N, Q>(self, measured: &impl Fn(f64, O) -> N, held: &impl Fn(P) -> Q) -> Special<N, Q> {
        let Special { kind, after, point, curve } = self;
        Special { kind, after, point: point.map(measured, held), curve }
    }
}

impl<O, P> Branch<O, P> {
    fn map<N, Q>(self, measured: &impl Fn(f64, O) -> N, held: &impl Fn(P) -> Q) -> Branch<N, Q> {
        Branch {
            period: self.period,
            parent: self.parent,
            points: self.points.into_iter().map(|it| it.map(measured, held)).collect(),
            special: self.special.into_iter().map(|it| it.map(measured, held)).collect(),
            ends: self.ends,
        }
    }
}

impl<O, P> Found<O, P> {
    /// The same with something else that is `measured` of each orbit, and section points `held` in another way.
    pub fn map<N, Q>(self, measured: impl Fn(f64, O) -> N, held: impl Fn(P) -> Q) -> Found<N, Q> {
        let branches = self.branches.into_iter().map(|it| it.map(&measured, &held)).collect();
        Found { branches, curves: self.curves, not_left: self.not_left }
    }
}
