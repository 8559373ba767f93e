//! Branches of periodic motions of a capsule, with their outputs.

use capsulemap_engine::branch::{self, NotFollowed};
use capsulemap_engine::orbit::Protocol;

use super::failure::Section;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::resistance::Switching;
use super::settle::outputs;
use super::system::{AsPrinted, CapsuleSystem, Filippov, Reading};
use crate::description::{self, Outputs, Parameters};

/// A periodic motion on a branch, with its outputs.
pub type Point = branch::Point<Outputs, 3>;
/// A special point of a branch.
pub type Special = branch::Special<Outputs, 3>;
/// A branch of periodic motions.
pub type Branch = branch::Branch<Outputs, 3>;
/// What was found.
pub type Found = branch::Found<Outputs, 3>;

/// What to follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The parameters at which the first orbit is known.
    pub parameters: Parameters,
    /// Phase of the drive at the section [rad].
    pub phase: f64,
    /// A point of the section near the first orbit.
    pub section: Section,
    /// Its period [cycles].
    pub period: u64,
    /// The parameter to follow it in.
    pub along: description::Parameter,
    /// Where to stop, the lesser first.
    pub range: [f64; 2],
    /// How often to switch to the branch of twice the period where a multiplier passes -1.
    pub doublings: u32,
    /// A second parameter with its range, in which the special points are followed as curves.
    pub second: Option<(description::Parameter, [f64; 2])>,
    /// Longest step, as a share of the range.
    pub longest_step: f64,
    /// Points of a branch or curve at most.
    pub most_points: usize,
    /// Relative local error of a step of the integrator.
    pub tolerance: f64,
}

/// Follows a branch of periodic orbits both ways from the one that is given, and what leaves it.
///
/// # Errors
/// Where no periodic orbit is found near the point that is given, or none that a branch goes through.
pub fn follow(request: &Request) -> Result<Found, NotFollowed> {
    match request.parameters.switching() {
        Switching::Filippov => follow_as::<Filippov>(request),
        Switching::AsPrinted => follow_as::<AsPrinted>(request),
    }
}

fn follow_as<R: Reading>(request: &Request) -> Result<Found, NotFollowed> {
    let Request { parameters, phase, along, tolerance, .. } = request;
    let found = branch::follow(&branch::Request {
        system: CapsuleSystem::<R>::new(parameters.clone(), *phase),
        section: request.section,
        period: request.period,
        along: Parameter::which(*along),
        range: request.range,
        doublings: request.doublings,
        second: request.second.map(|(second, range)| (Parameter::which(second), range)),
        longest_step: request.longest_step,
        most_points: request.most_points,
        tolerance: *tolerance,
    })?;
    let Protocol { recurrence, .. } = Protocol::with_tolerance(*tolerance);
    Ok(found.map(|value, orbit| {
        let mut parameters = parameters.clone();
        parameters[*along] = value;
        orbit.map_or_else(
            || Outputs::unknown(parameters.model()),
            |orbit| outputs(&orbit, &parameters, recurrence).into(),
        )
    }))
}
