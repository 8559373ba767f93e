//! What a case settles to: its outcome, its period and everything measured on the attractor.

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::capsule::{
    Capsule, Locomotion, Parameter, Parameters, PrintedCapsule, State, Switching,
};

use super::measure::{Found, conclude};
use super::recurrence::Settled;
use super::settling::{Settling, Verdict};
use super::{
    Case, Certificate, Failure, History, HistorySpan, Impact, Outputs, Section, Trajectory,
};

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
    /// Cycles followed since the first section, measuring included.
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

/// Settles a case that starts on its section, at `phase` of the drive [rad], as [`settle_case`] does.
pub fn settle(
    parameters: &Parameters,
    phase: f64,
    start: State<f64>,
    protocol: &Protocol,
) -> Orbit {
    settle_case(&Case::at_section(parameters.clone(), start, phase), protocol)
}

/// Follows the capsule from the start of `case` to the first section, from there until it settles, and
/// measures it.
///
/// Cycles are counted from the first section: the part of a cycle before it belongs to none. The time of a
/// failure is counted from the start.
pub fn settle_case(case: &Case, protocol: &Protocol) -> Orbit {
    let Case { parameters, section_phase, .. } = case;
    match parameters.switching {
        Switching::Filippov => {
            settle_on(&Capsule::single(parameters, *section_phase), case, protocol)
        }
        Switching::AsPrinted => {
            settle_on(&PrintedCapsule::single(parameters, *section_phase), case, protocol)
        }
    }
}

/// Follows a capsule, given as its own `system`, as [`settle_case`] does.
pub fn settle_on<S: Locomotion>(system: &S, case: &Case, protocol: &Protocol) -> Orbit {
    let mut trajectory = Trajectory::of(system, case, protocol.tolerance);
    let mut settling = Settling::new(protocol, case.parameters[Parameter::Omega]);
    if trajectory.is_at_section() {
        settling.meet(trajectory.section());
    }
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
