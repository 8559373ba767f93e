//! One case in full: every section point, every event, and the sums since the start.

use serde::Serialize;

use super::Failure;
use super::energies::Energies;
use super::parameters::CapsuleParameters as _;
use super::shape::Form;
use super::state::{EventKind, State};
use super::system::{AsPrinted, CapsuleSystem, Filippov, General, OverFolds, Reading};
use crate::description::{self, Parameters};
use crate::face::{Followed, followed};
use crate::motion::{Case, SimulationSize};

/// State and sums at the end of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sample {
    /// Cycles since the first section.
    pub n: u64,
    /// Time since the start [s].
    pub t: f64,
    /// Relative displacement [m].
    pub r: f64,
    /// Velocity of the mass [m/s].
    pub y1: f64,
    /// Displacement of the capsule [m].
    pub x2: f64,
    /// Velocity of the capsule [m/s].
    pub y2: f64,
    /// Work of the drive and losses since the start.
    #[serde(flatten)]
    pub energies: Energies<f64>,
    /// Impacts since the start.
    pub impacts: u64,
}

/// An event with its time since the start [s] and the state there, before a jump of the velocities.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Event {
    /// When [s].
    pub t: f64,
    /// What.
    pub kind: EventKind,
    /// Where.
    #[serde(flatten)]
    pub state: State<f64>,
}

/// A case followed from its start for a number of cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// One sample per cycle, that at the first section included, which is the start where that is on it.
    pub section: Vec<Sample>,
    /// Every event in order.
    pub events: Vec<Event>,
    /// Why it stopped early, if it did.
    pub failure: Option<Failure>,
}

/// Follows a case that starts on its section, at `phase` of the drive [rad], as [`simulate_case`] does.
pub fn simulate(
    parameters: &Parameters,
    phase: f64,
    start: impl Into<description::State>,
    cycles: u64,
    tolerance: f64,
) -> Simulation {
    simulate_case(&Case::at_section(parameters.clone(), start, phase), cycles, tolerance)
}

/// Follows the capsule from the start of `case` to the first section, and for `cycles` drive cycles from
/// there. Times and sums are counted from the start.
pub fn simulate_case(case: &Case, cycles: u64, tolerance: f64) -> Simulation {
    match case.parameters.form() {
        Form::Filippov => simulate_as::<Filippov, 3>(case, cycles, tolerance),
        Form::AsPrinted => simulate_as::<AsPrinted, 3>(case, cycles, tolerance),
        Form::General => simulate_as::<General, 3>(case, cycles, tolerance),
        Form::OverFolds => simulate_as::<OverFolds, 4>(case, cycles, tolerance),
    }
}

fn simulate_as<R: Reading<D>, const D: usize>(
    case: &Case,
    cycles: u64,
    tolerance: f64,
) -> Simulation {
    let most = SimulationSize { cycles, events: usize::MAX };
    let Followed { section, events, failure } =
        followed::<CapsuleSystem<R>, D>(case, most, tolerance);
    let section = section.into_iter().map(|it| {
        let State { r, y1, x2, y2, .. } = it.state;
        let (energies, impacts) = (it.observed.energies, it.observed.impacts as u64);
        Sample { n: it.cycle, t: it.time, r, y1, x2, y2, energies, impacts }
    });
    let events = events.into_iter().map(|it| Event { t: it.time, kind: it.event, state: it.state });
    Simulation { section: section.collect(), events: events.collect(), failure }
}
