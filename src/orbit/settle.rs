//! What a case settles to: its outcome, its period and everything measured on the attractor.

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::capsule::{
    Capsule, Locomotion, Parameter, Parameters, PrintedCapsule, State, Switching,
};

use super::measure::{Found, conclude};
use super::recurrence::Settled;
use super::settling::{Settling, Verdict};
use super::{Certificate, Failure, History, HistorySpan, Impact, Outputs, Section, Trajectory};

/// What a case turned out to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The section repeats after `period` cycles.
    Periodic = 0,
    /// Neighbouring motions part exponentially.
    Chaotic,
    /// Neither repeats nor parts.
    QuasiPeriodic,
    /// Not settled within the budget of cycles.
    Undecided,
    /// Could not be followed.
    Failed,
}

impl Outcome {
    /// Every outcome, in the order of their numbers.
    pub const ALL: [Outcome; 5] = [
        Outcome::Periodic,
        Outcome::Chaotic,
        Outcome::QuasiPeriodic,
        Outcome::Undecided,
        Outcome::Failed,
    ];

    /// Its name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Outcome::Periodic => "periodic",
            Outcome::Chaotic => "chaotic",
            Outcome::QuasiPeriodic => "quasi-periodic",
            Outcome::Undecided => "undecided",
            Outcome::Failed => "failed",
        }
    }
}

/// One case.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Its parameters.
    pub parameters: Parameters,
    /// Where it starts.
    pub start: State<f64>,
    /// Phase of the drive at the start [rad].
    pub phase: f64,
}

/// How a case is followed and judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Protocol {
    /// Relative local error of a step.
    pub tolerance: f64,
    /// How closely the section must repeat, relative to its size.
    pub recurrence: f64,
    /// Cycles after which a case that has not settled is undecided.
    pub max_cycles: u64,
    /// Longest period looked for while the motion settles [cycles]; longer ones, up to 1024, are looked for
    /// where it has not settled within the budget of cycles.
    pub max_period: usize,
    /// Cycles over which a case that does not repeat is measured.
    pub measured_cycles: u64,
    /// Cycles over which its exponent is computed at most; none is for zero.
    pub exponent_cycles: u64,
    /// Section points kept at most.
    pub points: usize,
    /// Impacts kept at most.
    pub impact_points: usize,
    /// Whether to leap to where the section tends, once it is clear, rather than wait until it is there.
    pub accelerate: bool,
    /// Time history to keep.
    pub history: Option<HistorySpan>,
}

impl Default for Protocol {
    fn default() -> Self {
        Protocol {
            tolerance: 1e-12,
            recurrence: 1e-11,
            max_cycles: 2000,
            max_period: 32,
            measured_cycles: 128,
            exponent_cycles: 2048,
            points: 64,
            impact_points: 64,
            accelerate: true,
            history: None,
        }
    }
}

impl Protocol {
    /// What a tolerance and a recurrence may be.
    pub const TOLERANCES: RangeInclusive<f64> = 1e-15..=1e-3;

    /// The usual protocol at another tolerance: the section cannot repeat more closely than the steps are.
    pub fn with_tolerance(tolerance: f64) -> Self {
        let usual = Protocol::default();
        Protocol { tolerance, recurrence: usual.recurrence.max(10.0 * tolerance), ..usual }
    }
}

/// What a case settled to.
#[derive(Debug, Clone, PartialEq)]
pub struct Orbit {
    /// What it turned out to be.
    pub outcome: Outcome,
    /// Its period [cycles]; zero unless periodic.
    pub period: u64,
    /// What is proven of its period.
    pub certificate: Certificate,
    /// Cycles followed, measuring included.
    pub cycles: u64,
    /// Per-cycle sums and the like; NaN where the case failed.
    pub outputs: Outputs,
    /// Section points of the measured cycles, up to `Protocol::points`.
    pub section: Vec<Section>,
    /// Impacts of the measured cycles, up to `Protocol::impact_points`.
    pub impacts: Vec<Impact>,
    /// Samples of the motion, where the protocol asks for them.
    pub history: Option<History>,
    /// Where it was last.
    pub end: State<f64>,
    /// Why it could not be followed, if so.
    pub failure: Option<Failure>,
}

/// Follows the capsule from `start`, the drive at `phase` [rad], until it settles, and measures it.
pub fn settle(
    parameters: &Parameters,
    phase: f64,
    start: State<f64>,
    protocol: &Protocol,
) -> Orbit {
    let case = Case { parameters: parameters.clone(), start, phase };
    match parameters.switching {
        Switching::Filippov => settle_on(&Capsule::single(parameters, phase), &case, protocol),
        Switching::AsPrinted => {
            settle_on(&PrintedCapsule::single(parameters, phase), &case, protocol)
        }
    }
}

/// Follows a capsule, given as its own `system`, as [`settle`] does.
pub fn settle_on<S: Locomotion>(system: &S, case: &Case, protocol: &Protocol) -> Orbit {
    let Case { parameters, start, .. } = case;
    let mut trajectory =
        Trajectory::new(system, *start, parameters.drive_period(), protocol.tolerance);
    let mut settling = Settling::new(protocol, parameters[Parameter::Omega]);
    settling.meet(trajectory.section());
    let settled = find_period(&mut trajectory, &mut settling, protocol);
    conclude(&mut trajectory, case, settled.map(Found::from), protocol)
}

/// Follows until the section repeats; none when the budget of cycles ends first.
pub(super) fn find_period<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    settling: &mut Settling,
    protocol: &Protocol,
) -> Result<Option<Settled>, Failure> {
    while trajectory.cycles < protocol.max_cycles {
        trajectory.cycle(|_| ())?;
        match settling.meet(trajectory.section()) {
            Verdict::Settled(settled) => return Ok(Some(settled)),
            // At the end of the budget the motion is measured where it is.
            Verdict::Leap(section) if trajectory.cycles < protocol.max_cycles => {
                trajectory.leap(section);
            }
            Verdict::Leap(_) | Verdict::Unsettled => {}
        }
    }
    Ok(None)
}
