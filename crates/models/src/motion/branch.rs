//! Branches of periodic motions, with their outputs.

use capsulemap_engine::branch;

use super::Setting;
use crate::description::{Outputs, Parameter, Section};

/// A periodic motion on a branch, with its outputs.
pub type Point = branch::Point<Outputs, Section>;
/// A special point of a branch.
pub type Special = branch::Special<Outputs, Section>;
/// A branch of periodic motions.
pub type Branch = branch::Branch<Outputs, Section>;
/// What was found.
pub type Found = branch::Found<Outputs, Section>;

/// What to follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The parameters at which the first orbit is known, and the phase at the section.
    pub setting: Setting,
    /// A point of the section near the first orbit.
    pub section: Section,
    /// Its period [cycles].
    pub period: u64,
    /// The parameter to follow it in.
    pub along: Parameter,
    /// Where to stop, the lesser first.
    pub range: [f64; 2],
    /// How often to switch to the branch of twice the period where a multiplier passes -1.
    pub doublings: u32,
    /// A second parameter with its range, in which the special points are followed as curves.
    pub second: Option<(Parameter, [f64; 2])>,
    /// Where the curves stop in the first parameter, the lesser first; where the branch does if none is given.
    pub curve_range: Option<[f64; 2]>,
    /// Longest step, as a share of the range.
    pub longest_step: f64,
    /// Points of a branch or curve at most.
    pub most_points: usize,
    /// Relative local error of a step of the integrator.
    pub tolerance: f64,
}
