//! What a case settles to: its outcome, its period and everything measured on the attractor.

use std::ops::RangeInclusive;

use serde::Serialize;

use crate::model::{
    Capsule, EventKind, Locomotion, Parameter, Parameters, PrintedCapsule, State, Switching,
};

use super::recurrence::{RESOLUTION, Recurrence, Settled, size};
use super::{Account, Failure, History, HistorySpan, Impact, Output, Outputs, Section, Trajectory};

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
    pub fn name(self) -> &'static str {
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
    /// Longest period looked for [cycles].
    pub max_period: usize,
    /// Cycles over which an undecided case is measured.
    pub measured_cycles: u64,
    /// Section points kept at most.
    pub points: usize,
    /// Impacts kept at most.
    pub impact_points: usize,
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
            points: 64,
            impact_points: 64,
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
    match parameters.switching {
        Switching::Filippov => {
            settle_on(&Capsule::single(parameters, phase), parameters, start, protocol)
        }
        Switching::AsPrinted => {
            settle_on(&PrintedCapsule::single(parameters, phase), parameters, start, protocol)
        }
    }
}

fn settle_on<S: Locomotion>(
    system: &S,
    parameters: &Parameters,
    start: State<f64>,
    protocol: &Protocol,
) -> Orbit {
    let mut trajectory =
        Trajectory::new(system, start, parameters.drive_period(), protocol.tolerance);
    let omega = parameters[Parameter::Omega];
    let measured = find_period(&mut trajectory, omega, protocol).and_then(|settled| {
        let period = settled.map(|settled| settled.period as u64);
        let measures = measure(&mut trajectory, system, parameters, settled, protocol)?;
        let history = match protocol.history {
            None => None,
            Some(span) => {
                let settled = State { x2: 0.0, ..trajectory.state() };
                let from = if span.from_start { start } else { settled };
                Some(History::sample(system, parameters, from, span, protocol.tolerance)?)
            }
        };
        Ok((period, measures, history))
    });
    let (cycles, end) = (trajectory.cycles, trajectory.state());
    match measured {
        Ok((period, (outputs, section, impacts), history)) => Orbit {
            outcome: if period.is_some() { Outcome::Periodic } else { Outcome::Undecided },
            period: period.unwrap_or(0),
            cycles,
            outputs,
            section,
            impacts,
            history,
            end,
            failure: None,
        },
        Err(failure) => Orbit {
            outcome: Outcome::Failed,
            period: 0,
            cycles,
            outputs: Outputs::unknown(),
            section: Vec::new(),
            impacts: Vec::new(),
            history: None,
            end,
            failure: Some(failure),
        },
    }
}

/// Follows until the section repeats; none when the budget of cycles ends first.
fn find_period<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    omega: f64,
    protocol: &Protocol,
) -> Result<Option<Settled>, Failure> {
    let mut recurrence = Recurrence::new(protocol.max_period, protocol.recurrence, omega);
    recurrence.meet(trajectory.section());
    while trajectory.cycles < protocol.max_cycles {
        trajectory.cycle(|_| ())?;
        if let Some(settled) = recurrence.meet(trajectory.section()) {
            return Ok(Some(settled));
        }
    }
    Ok(None)
}

type Measures = (Outputs, Vec<Section>, Vec<Impact>);

fn measure<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    system: &S,
    parameters: &Parameters,
    settled: Option<Settled>,
    protocol: &Protocol,
) -> Result<Measures, Failure> {
    let (cycles, points) = match settled {
        Some(settled) => (settled.repeats_after as u64, settled.period.min(protocol.points)),
        None => (protocol.measured_cycles, protocol.points),
    };
    let mut account = Account::new(parameters);
    let (mut section, mut impacts) = (Vec::new(), Vec::new());
    let x2 = trajectory.state().x2;
    let mut speed: f64 = 0.0;
    for _ in 0..cycles {
        speed = speed.max(size(parameters[Parameter::Omega], &trajectory.section()));
        if section.len() < points {
            section.push(trajectory.section());
        }
        trajectory.cycle(|step| {
            account.add(system, step);
            let closes = system.event(step.event) == Some(EventKind::ContactClosed);
            if closes && impacts.len() < protocol.impact_points {
                let State { y1, y2, .. } = system.at(&step.jet, step.length);
                let phase = parameters[Parameter::Omega] * (step.start + step.length);
                impacts.push(Impact { phase, y1, y2 });
            }
        })?;
    }
    let progression = (trajectory.state().x2 - x2) / cycles as f64;
    let resolved = RESOLUTION * protocol.recurrence * speed * parameters.drive_period();
    let moves = progression.abs() > resolved;
    Ok((outputs(&account, parameters, progression, moves, cycles as f64), section, impacts))
}

/// The outputs per cycle, from the sums over `cycles` and the `progression` per cycle [m], which is
/// rounding unless the capsule `moves`.
fn outputs(
    account: &Account,
    parameters: &Parameters,
    progression: f64,
    moves: bool,
    cycles: f64,
) -> Outputs {
    let mut outputs = Outputs::unknown();
    let energies = account.energies;
    let losses = energies.friction_loss + energies.damper_loss;
    let force = parameters[Parameter::Pd] + parameters.break_away();
    let ratio = |part: f64, whole: f64| if part == 0.0 { 0.0 } else { part / whole };
    let cost_of_transport = if moves {
        energies.work_positive / cycles / (parameters.normal_load() * progression.abs())
    } else {
        f64::INFINITY
    };
    for (output, value) in [
        (Output::ProgressionSpeed, progression / parameters.drive_period()),
        (Output::ProgressionPerCycle, progression),
        (Output::WorkNet, energies.work_net / cycles),
        (Output::WorkPositive, energies.work_positive / cycles),
        (Output::WorkAbsolute, energies.work_absolute / cycles),
        (Output::WorkActuator, energies.work_actuator / cycles),
        (Output::FrictionLoss, energies.friction_loss / cycles),
        (Output::DamperLoss, energies.damper_loss / cycles),
        (Output::EnergyResidual, ratio(energies.work_net - losses, energies.work_absolute)),
        (Output::MomentumResidual, ratio(account.friction_impulse / account.time, force)),
        (Output::CostOfTransport, cost_of_transport),
        (Output::ImpactsPerCycle, account.impacts as f64 / cycles),
        (Output::ForwardSlips, account.forward_slips as f64 / cycles),
        (Output::BackwardSlips, account.backward_slips as f64 / cycles),
        (Output::Reversals, account.reversals as f64 / cycles),
        (Output::StickShare, account.stick_time / account.time),
        (Output::PeakContactForce, account.peak_contact_force),
        (Output::GrazingMargin, account.grazing_margin),
    ] {
        outputs[output] = value;
    }
    outputs
}
