//! One case in full: every section point, every event, and the sums since the start.

use serde::Serialize;

use crate::flow::{Event as _, Observer, Stroboscopic};
use crate::orbit::Trajectory;

use super::Failure;
use super::account::{Account, Energies};
use super::capsule::Capsule;
use super::locomotion::Locomotion;
use super::parameters::Parameters;
use super::printed::PrintedCapsule;
use super::resistance::Switching;
use super::state::{EventKind, State};

/// State and sums at the end of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sample {
    /// Cycles since the start.
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
    pub energies: Energies,
    /// Impacts since the start.
    pub impacts: u64,
}

/// An event with its time since the start [s].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Event {
    /// When [s].
    pub t: f64,
    /// What.
    pub kind: EventKind,
}

/// A case followed from its start for a number of cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// One sample per cycle, that at the start included.
    pub section: Vec<Sample>,
    /// Every event in order.
    pub events: Vec<Event>,
    /// Why it stopped early, if it did.
    pub failure: Option<Failure>,
}

/// Follows the capsule from `start`, the drive at `phase` [rad], for `cycles` drive cycles.
pub fn simulate(
    parameters: &Parameters,
    phase: f64,
    start: State<f64>,
    cycles: u64,
    tolerance: f64,
) -> Simulation {
    match parameters.switching {
        Switching::Filippov => {
            let system = Capsule::single(parameters, phase);
            simulate_on(&system, parameters, start, cycles, tolerance)
        }
        Switching::AsPrinted => {
            let system = PrintedCapsule::single(parameters, phase);
            simulate_on(&system, parameters, start, cycles, tolerance)
        }
    }
}

fn simulate_on<S: Locomotion + Stroboscopic<f64, 3>>(
    system: &S,
    parameters: &Parameters,
    start: State<f64>,
    cycles: u64,
    tolerance: f64,
) -> Simulation {
    let drive_period = parameters.drive_period();
    let mut account = Account::new(parameters, 0);
    let mut trajectory = Trajectory::new(system, start, tolerance);
    let mut events = Vec::new();
    let mut section = vec![sample(&trajectory, &account, drive_period)];
    let mut failure = None;
    for n in 0..cycles {
        let begun = n as f64 * drive_period;
        let followed = trajectory.cycle(|step| {
            account.see(system, step);
            if let Some(kind) = EventKind::from_code(step.event) {
                events.push(Event { t: begun + (step.start + step.length), kind });
            }
        });
        if let Err(why) = followed {
            failure = Some(why);
            break;
        }
        section.push(sample(&trajectory, &account, drive_period));
    }
    Simulation { section, events, failure }
}

fn sample<S: Locomotion + Stroboscopic<f64, 3>>(
    trajectory: &Trajectory<'_, S, 3>,
    account: &Account,
    drive_period: f64,
) -> Sample {
    let State { r, y1, x2, y2 } = trajectory.state();
    let n = trajectory.cycles;
    Sample {
        n,
        t: n as f64 * drive_period,
        r,
        y1,
        x2,
        y2,
        energies: account.energies,
        impacts: account.impacts,
    }
}
