//! What a settled case is measured to be, over the cycles that are kept.

use crate::model::{EventKind, Locomotion, Parameter, Parameters, State};

use super::recurrence::{RESOLUTION, Settled, size};
use super::{
    Account, Failure, History, Impact, Orbit, Outcome, Output, Outputs, Protocol, Section,
    Trajectory,
};

/// Measures what a case that began at `start` has `settled` to (none: nothing within its budget), going on
/// from where its trajectory is.
pub(super) fn conclude<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    parameters: &Parameters,
    start: State<f64>,
    settled: Result<Option<Settled>, Failure>,
    protocol: &Protocol,
) -> Orbit {
    let measured = settled.and_then(|settled| {
        let period = settled.map(|settled| settled.period as u64);
        let measures = measure(trajectory, parameters, settled, protocol)?;
        let history = match protocol.history {
            None => None,
            Some(span) => {
                let settled = State { x2: 0.0, ..trajectory.state() };
                let from = if span.from_start { start } else { settled };
                let system = trajectory.system();
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

/// The outputs per cycle of `period` cycles from a point of the section, those cycles' section points and
/// the point after them.
pub fn over_cycles<S: Locomotion>(
    system: &S,
    parameters: &Parameters,
    [r, y1, y2]: Section,
    period: u64,
    tolerance: f64,
) -> Result<(Outputs, Vec<Section>, Section), Failure> {
    let start = State { r, y1, x2: 0.0, y2 };
    let mut trajectory = Trajectory::new(system, start, parameters.drive_period(), tolerance);
    let points = period as usize;
    let protocol = Protocol { points, ..Protocol::with_tolerance(tolerance) };
    let settled = Settled { period: points, repeats_after: points };
    let (outputs, section, _) = measure(&mut trajectory, parameters, Some(settled), &protocol)?;
    Ok((outputs, section, trajectory.section()))
}

type Measures = (Outputs, Vec<Section>, Vec<Impact>);

fn measure<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    parameters: &Parameters,
    settled: Option<Settled>,
    protocol: &Protocol,
) -> Result<Measures, Failure> {
    let system = trajectory.system();
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
