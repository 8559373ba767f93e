//! One case in full: every section point, every event, and the sums since the start.

use serde::Serialize;

use capsulemap_engine::flow::{Event as _, Observer, Stroboscopic};
use capsulemap_engine::orbit::Trajectory;

use super::Failure;
use super::account::{Account, Energies};
use super::filippov::Capsule;
use super::locomotion::Locomotion;
use super::parameters::CapsuleParameters as _;
use super::printed::PrintedCapsule;
use super::resistance::Switching;
use super::state::{EventKind, State};
use crate::description::{self, Parameters};
use crate::motion::Case;

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

/// An event with its time since the start [s] and the state there, which it does not change.
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

/// How much of a motion is followed and kept at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SimulationSize {
    /// Drive cycles from the first section.
    pub cycles: u64,
    /// Events.
    pub events: usize,
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
    simulate_case_within(case, SimulationSize { cycles, events: usize::MAX }, tolerance)
}

/// The same, and no further than to the last section before which it has no more events than `most` says.
pub fn simulate_case_within(case: &Case, most: SimulationSize, tolerance: f64) -> Simulation {
    let Case { parameters, section_phase, .. } = case;
    match parameters.switching() {
        Switching::Filippov => {
            simulate_on(&Capsule::single(parameters, *section_phase), case, most, tolerance)
        }
        Switching::AsPrinted => {
            simulate_on(&PrintedCapsule::single(parameters, *section_phase), case, most, tolerance)
        }
    }
}

fn simulate_on<S: Locomotion<f64> + Stroboscopic<f64, 3>>(
    system: &S,
    case: &Case,
    most: SimulationSize,
    tolerance: f64,
) -> Simulation {
    let mut account = Account::single(&case.parameters, 0);
    let mut trajectory = trajectory(case, system, tolerance);
    let (mut section, mut events) = (Vec::new(), Vec::new());
    let mut failure = None;
    loop {
        if trajectory.is_at_section() {
            section.push(sample(&trajectory, &account));
        }
        if section.len() as u64 > most.cycles {
            break;
        }
        let before = events.len();
        let begun = trajectory.cycle_began();
        let followed = trajectory.cycle(|step| {
            account.see(system, step);
            if let Some(kind) = EventKind::from_code(step.event) {
                let state = system.jet(&step.jet).state(step.length);
                events.push(Event { t: begun + (step.start + step.length), kind, state });
            }
        });
        if let Err(why) = followed {
            failure = Some(why);
            break;
        }
        if events.len() > most.events {
            events.truncate(before);
            break;
        }
    }
    Simulation { section, events, failure }
}

/// The way of a case from its start, as `system` moves.
pub(super) fn trajectory<'a, S>(case: &Case, system: &'a S, tolerance: f64) -> Trajectory<'a, S, 3>
where
    S: Stroboscopic<f64, 3, State = State<f64>>,
{
    Trajectory::begun(system, State::from(&case.start), case.start_time(), tolerance)
}

fn sample<S: Locomotion<f64> + Stroboscopic<f64, 3>>(
    trajectory: &Trajectory<'_, S, 3>,
    account: &Account<f64>,
) -> Sample {
    let State { r, y1, x2, y2 } = trajectory.state();
    Sample {
        n: trajectory.progress.cycles,
        t: trajectory.cycle_began(),
        r,
        y1,
        x2,
        y2,
        energies: account.energies,
        impacts: account.impacts as u64,
    }
}
