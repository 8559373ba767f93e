//! What a settled case is measured to be, over the cycles that are kept.

use crate::capsule::{EventKind, Locomotion, Parameter, Parameters, State};
use crate::flow::defect::{defect, greater};
use crate::lane::Dual;

use super::certificate::{certify, same};
use super::matrix::Complex;
use super::recurrence::{RESOLUTION, Settled, size};
use super::wandering::{Wandering, wander};
use super::{
    Account, Case, Certificate, Exponent, Failure, History, Impact, Orbit, Outcome, Output,
    Outputs, Proof, Protocol, Section, Trajectory,
};

/// An extremum this near to the stop, relative to the motion, is taken for one that touches it.
const GRAZES: f64 = 1e-9;

/// A defect of so many tolerances is none that the end of the series explains.
const UNSOUND: f64 = 1e4;
/// The defect of rounding alone, which no tolerance undercuts.
const ROUNDING: f64 = 1e-14;

/// What a case has been found to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Found {
    /// Its section repeats.
    Repeats(Settled),
    /// It does not within the budget of cycles; the linearised flow has not been asked yet.
    Wanders,
    /// It does not, and this is what the linearised flow says of it.
    Followed(Wandering),
}

impl From<Option<Settled>> for Found {
    fn from(settled: Option<Settled>) -> Self {
        settled.map_or(Found::Wanders, Found::Repeats)
    }
}

/// What is to be measured, and what is known of it.
struct Verdict {
    outcome: Outcome,
    period: u64,
    /// Cycles to measure over.
    cycles: u64,
    certificate: Certificate,
    exponent: Exponent,
    /// The longest period that is excluded, with all shorter ones [cycles].
    excluded: f64,
    /// Size of the motion that led there, beside which what is left of it may be nothing [m/s].
    size: f64,
}

impl Verdict {
    /// A periodic orbit that Newton's method has closed, with its multipliers and the direction of the
    /// family that it belongs to, if it does.
    fn periodic(
        period: u64,
        (multipliers, neutral): ([Complex; 3], Option<Section>),
        parameters: &Parameters,
        size: f64,
    ) -> Self {
        let time = period as f64 * parameters.drive_period();
        let value = libm::log(multipliers[0].abs()) / time;
        let proof = if neutral.is_some() { Proof::Neutral } else { Proof::Newton };
        Verdict {
            outcome: Outcome::Periodic,
            period,
            cycles: period,
            certificate: Certificate { proof, residual: f64::NAN, multipliers, neutral },
            exponent: Exponent { value, uncertainty: 0.0 },
            excluded: (period - 1) as f64,
            size,
        }
    }
}

/// Measures a case that was `found` to do something, going on from where its trajectory is.
pub(super) fn conclude<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    case: &Case,
    found: Result<Found, Failure>,
    protocol: &Protocol,
) -> Orbit {
    let measured = found.and_then(|found| {
        let verdict = judge(trajectory, case, found, protocol)?;
        let measures = measure(trajectory, &case.parameters, &verdict, protocol)?;
        let history = match protocol.history {
            None => None,
            Some(span) => {
                let settled = State { x2: 0.0, ..trajectory.state() };
                let on = Case::at_section(case.parameters.clone(), settled, case.section_phase);
                let from = if span.from_start { case } else { &on };
                Some(History::sample(trajectory.system(), from, span, protocol.tolerance)?)
            }
        };
        Ok((verdict, measures, history))
    });
    let (cycles, end) = (trajectory.cycles, trajectory.state());
    match measured {
        Ok((verdict, measures, history)) => Orbit {
            outcome: measures.outcome,
            period: if measures.outcome == Outcome::Periodic { verdict.period } else { 0 },
            certificate: measures.certificate,
            cycles,
            outputs: measures.outputs,
            section: measures.section,
            impacts: measures.impacts,
            history,
            end,
            failure: None,
        },
        Err(failure) => Orbit {
            outcome: Outcome::Failed,
            period: 0,
            certificate: Certificate::none(),
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

/// Says what a case is, and leads its trajectory onto the orbit where it is a periodic one.
fn judge<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    case: &Case,
    found: Found,
    protocol: &Protocol,
) -> Result<Verdict, Failure> {
    match found {
        Found::Repeats(settled) => {
            let section = trajectory.section();
            match certified(trajectory, case, (&section, settled), protocol) {
                Some(verdict) => Ok(verdict),
                None => judge(trajectory, case, Found::Wanders, protocol),
            }
        }
        Found::Followed(wandering) => {
            trajectory.cycles += wandering.cycles;
            let outcome = wandering.outcome();
            // A period too long for the recurrence of sections, or one that is approached slowly.
            let recurs = wandering.recurs.filter(|_| outcome != Outcome::Chaotic);
            let periodic = recurs.and_then(|settled| {
                certified(trajectory, case, (&wandering.last, settled), protocol)
            });
            Ok(periodic.unwrap_or_else(|| Verdict {
                outcome,
                period: 0,
                cycles: protocol.measured_cycles,
                certificate: Certificate::none(),
                exponent: wandering.exponent,
                excluded: wandering.excluded as f64,
                size: 0.0,
            }))
        }
        Found::Wanders => {
            let parameters = &case.parameters;
            let constant = |parameter: Parameter| Dual::<f64, 1>::constant(parameters[parameter]);
            let system = S::with(constant, parameters.resistance, case.section_phase);
            let followed = wander(
                &system,
                &[trajectory.section()],
                (parameters.drive_period(), parameters[Parameter::Omega]),
                protocol.exponent_cycles,
                protocol.tolerance,
            );
            match followed[0] {
                Ok(wandering) => judge(trajectory, case, Found::Followed(wandering), protocol),
                Err(reason) => Err(trajectory.failure(reason)),
            }
        }
    }
}

/// The verdict on a section that repeats: periodic if Newton's method closes the orbit, else none.
fn certified<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    case: &Case,
    (section, settled): (&Section, Settled),
    protocol: &Protocol,
) -> Option<Verdict> {
    let orbit = certify::<S>(case, section, &settled, protocol)?;
    trajectory.leap(orbit.section);
    trajectory.cycles += orbit.cycles;
    let linear = (orbit.multipliers, orbit.neutral);
    Some(Verdict::periodic(orbit.period, linear, &case.parameters, settled.size))
}

/// What is measured over the kept cycles.
struct Measures {
    /// What the case is, as far as its steps can be trusted.
    outcome: Outcome,
    outputs: Outputs,
    section: Vec<Section>,
    impacts: Vec<Impact>,
    certificate: Certificate,
}

/// The outputs of a periodic orbit with these multipliers from a point of it, and its section points.
pub fn over_cycles<S: Locomotion>(
    system: &S,
    parameters: &Parameters,
    [r, y1, y2]: Section,
    (period, multipliers): (u64, [Complex; 3]),
    tolerance: f64,
) -> Result<(Outputs, Vec<Section>), Failure> {
    let start = State { r, y1, x2: 0.0, y2 };
    let mut trajectory = Trajectory::new(system, start, parameters.drive_period(), tolerance);
    let protocol = Protocol { points: period as usize, ..Protocol::with_tolerance(tolerance) };
    let verdict = Verdict::periodic(period, (multipliers, None), parameters, 0.0);
    let measures = measure(&mut trajectory, parameters, &verdict, &protocol)?;
    Ok((measures.outputs, measures.section))
}

fn measure<S: Locomotion>(
    trajectory: &mut Trajectory<'_, S>,
    parameters: &Parameters,
    verdict: &Verdict,
    protocol: &Protocol,
) -> Result<Measures, Failure> {
    let system = trajectory.system();
    let cycles = verdict.cycles;
    let begins = trajectory.section();
    let mut account = Account::new(parameters);
    let (mut section, mut impacts) = (Vec::new(), Vec::new());
    let x2 = trajectory.state().x2;
    // The largest velocity at the section, and at any step.
    let (mut speed, mut swing): (f64, f64) = (0.0, 0.0);
    let mut largest_defect = 0.0;
    let omega = parameters[Parameter::Omega];
    for _ in 0..cycles {
        speed = speed.max(size(omega, &trajectory.section()));
        if section.len() < protocol.points {
            section.push(trajectory.section());
        }
        trajectory.cycle(|step| {
            account.add(system, step);
            largest_defect = greater(largest_defect, defect(system, step));
            let [r, y1, _, y2] = system.coordinates(&step.jet).map(|series| series[0]);
            swing = swing.max(size(omega, &[r, y1, y2]));
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
    let mut outputs = outputs(&account, parameters, progression, moves, cycles as f64);
    let motion = swing.max(verdict.size);
    let relative_defect = if largest_defect == 0.0 { 0.0 } else { largest_defect / motion };
    let sealed = seal(verdict, &begins, &trajectory.section(), speed, &account, parameters);
    // An orbit that Newton's method has closed with derivatives closes without them, too.
    let closes = sealed.proof == Proof::None || sealed.residual <= same(protocol.tolerance);
    let is_sound = relative_defect <= UNSOUND * protocol.tolerance.max(ROUNDING) && closes;
    let (outcome, certificate) = if is_sound {
        (verdict.outcome, sealed)
    } else {
        (Outcome::Undecided, Certificate::none())
    };
    // The exponent of an orbit is that of its multipliers, and goes with its certificate.
    let withdrawn = !is_sound && verdict.outcome == Outcome::Periodic;
    let Exponent { value, uncertainty } = verdict.exponent;
    let known = |number: f64| if withdrawn { f64::NAN } else { number };
    outputs[Output::LyapunovExponent] = known(value);
    outputs[Output::LyapunovUncertainty] = known(uncertainty);
    outputs[Output::LargestMultiplier] = certificate.multipliers[0].abs();
    outputs[Output::IntegrationDefect] = relative_defect;
    outputs[Output::ExcludedPeriod] = if is_sound { verdict.excluded } else { f64::NAN };
    outputs[Output::SectionResidual] = sealed.residual;
    Ok(Measures { outcome, outputs, section, impacts, certificate })
}

/// The certificate with what the measured cycles say of it: how well they close, and whether the mass just
/// touches the stop.
fn seal(
    verdict: &Verdict,
    begins: &Section,
    ends: &Section,
    speed: f64,
    account: &Account,
    parameters: &Parameters,
) -> Certificate {
    let Certificate { proof, multipliers, neutral, .. } = verdict.certificate;
    if proof == Proof::None {
        return verdict.certificate;
    }
    let omega = parameters[Parameter::Omega];
    let gap = std::array::from_fn(|i| ends[i] - begins[i]);
    let gap = size(omega, &gap);
    let residual = if gap == 0.0 { 0.0 } else { gap / speed.max(verdict.size) };
    let touches = omega * account.touching_margin <= GRAZES * speed;
    let proof = if touches { Proof::Grazing } else { proof };
    Certificate { proof, residual, multipliers, neutral }
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
    // Without a drive only losses are left to measure against.
    let exchanged = energies.work_absolute.max(losses);
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
        (Output::EnergyResidual, ratio(energies.work_net - losses, exchanged)),
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
