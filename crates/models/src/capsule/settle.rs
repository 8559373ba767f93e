//! What a capsule settles to, with its speed, energies and counts.

use std::f64::consts::PI;

use capsulemap_engine::lane::Lane;
use capsulemap_engine::orbit::{self, Exponent, Machine, OrbitOf, Outcome, Protocol, precision};

use super::account::Account;
use super::energies::Energies;
use super::general::balance::Balance;
use super::mean_errors;
use super::output::{Output, Outputs};
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::shape::{Form, Shape};
use super::state::State;
use super::system::{AsPrinted, CapsuleSystem, Filippov, General, OverFolds, Reading};
use crate::description::{self, Parameters};
use crate::face::{self, engine_case};
use crate::motion::{Case, Orbit};

/// The mean friction force of a periodic orbit, relative to the forces that act, is rounding below this.
const BALANCED: f64 = 1e-5;
/// The same for steps of a coarse tolerance, relative to it.
const PER_STEP: f64 = 1e3;

/// Settles a case that starts on its section, at `phase` of the drive [rad], as [`settle_case`] does.
pub fn settle(
    parameters: &Parameters,
    phase: f64,
    start: impl Into<description::State>,
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
    match case.parameters.form() {
        Form::Filippov => settle_as::<Filippov>(case, protocol),
        Form::AsPrinted => settle_as::<AsPrinted>(case, protocol),
        Form::General => settle_as::<General>(case, protocol),
        Form::OverFolds => settle_of::<OverFolds, 4>(case, protocol),
    }
}

/// Follows a capsule, its friction read as `R` says, as [`settle_case`] does.
pub fn settle_as<R: Reading>(case: &Case, protocol: &Protocol) -> Orbit {
    settle_of::<R, 3>(case, protocol)
}

fn settle_of<R: Reading<D>, const D: usize>(case: &Case, protocol: &Protocol) -> Orbit {
    let orbit = orbit::settle(&engine_case::<CapsuleSystem<R>, D>(case), protocol);
    face::orbit_of::<CapsuleSystem<R>, D>(orbit, case, protocol)
}

/// What each of the cases settles to, in their order; see [`orbit::settle_all`].
///
/// # Panics
/// Where the processor does not have the instructions that `machine` asks for.
pub fn settle_all(cases: &[Case], protocol: &Protocol, machine: Machine) -> Vec<Orbit> {
    let filippov = settle_read::<Filippov, 3>(cases, Form::Filippov, protocol, machine);
    let printed = settle_read::<AsPrinted, 3>(cases, Form::AsPrinted, protocol, machine);
    let general = settle_read::<General, 3>(cases, Form::General, protocol, machine);
    let over_folds = settle_read::<OverFolds, 4>(cases, Form::OverFolds, protocol, machine);
    let mut of_forms = [filippov, printed, general, over_folds].map(Vec::into_iter);
    let orbits = cases.iter().map(|case| match case.parameters.form() {
        Form::Filippov => of_forms[0].next(),
        Form::AsPrinted => of_forms[1].next(),
        Form::General => of_forms[2].next(),
        Form::OverFolds => of_forms[3].next(),
    });
    orbits.map(|orbit| orbit.expect("every case is settled")).collect()
}

/// A case of the capsule for the engine.
pub trait CapsuleCase {
    /// It with its friction read as `R` says.
    fn read<R: Reading>(&self) -> orbit::Case<CapsuleSystem<R>, 3>;
}

impl CapsuleCase for Case {
    fn read<R: Reading>(&self) -> orbit::Case<CapsuleSystem<R>, 3> {
        engine_case(self)
    }
}

/// The orbits of the cases of a form, in their order.
fn settle_read<R: Reading<D>, const D: usize>(
    cases: &[Case],
    form: Form,
    protocol: &Protocol,
    machine: Machine,
) -> Vec<Orbit> {
    let chosen: Vec<&Case> = cases.iter().filter(|case| case.parameters.form() == form).collect();
    let read: Vec<_> = chosen.iter().map(|case| engine_case::<CapsuleSystem<R>, D>(case)).collect();
    let orbits = orbit::settle_all(&read, protocol, machine).into_iter().zip(chosen);
    let told = |(orbit, case)| face::orbit_of::<CapsuleSystem<R>, D>(orbit, case, protocol);
    orbits.map(told).collect()
}

/// A settled case with its outputs, and its history where the protocol asks for it.
pub fn orbit_of<R: Reading>(
    orbit: OrbitOf<CapsuleSystem<R>, 3>,
    case: &Case,
    protocol: &Protocol,
) -> Orbit {
    face::orbit_of::<CapsuleSystem<R>, 3>(orbit, case, protocol)
}

/// Whether the friction of a periodic orbit balances the mean of the other forces, as that of a motion that repeats must.
///
/// Beside a velocity that no ground would bring to rest in a lifetime, a section repeats to every digit while the
/// capsule slows down.
pub(super) fn is_balanced<const D: usize>(
    orbit: &orbit::Orbit<State<f64>, Account<f64>, D>,
    parameters: &Parameters,
    tolerance: f64,
) -> bool {
    let residual = momentum_residual(&orbit.observed, parameters);
    let rounding = BALANCED.max(PER_STEP * tolerance);
    // Without dry friction and without a drive there is no force to compare with.
    orbit.outcome != Outcome::Periodic || residual.is_infinite() || residual.abs() <= rounding
}

/// The mean friction force less the mean of the other forces along the ground, relative to the forces that act.
fn momentum_residual(account: &Account<f64>, parameters: &Parameters) -> f64 {
    let friction = account.friction_impulse / account.time;
    if !parameters.form().is_of_family() {
        return ratio(friction, parameters[Parameter::Pd] + parameters.break_away());
    }
    let Balance { mean, along, largest_drive, break_away, .. } = Balance::of(parameters);
    let others = mean + account.beside.fold_impulse / account.time;
    ratio(friction - others, largest_drive + break_away + along.abs())
}

/// The work against gravity and load, as far as the capsule has advanced [J].
fn lifting_work<L: Lane>(account: &Account<L>, of: impl Fn(Parameter) -> L, shape: Shape) -> L {
    -(Balance::new(of, shape).along * account.advance)
}

/// A part of a whole; zero where there is none.
fn ratio(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// The outputs of what a capsule has settled to; NaN where it failed.
///
/// `recurrence` is how closely the section had to repeat, relative to the motion: a progression within a
/// hundred times that is rounding.
pub fn outputs<const D: usize>(
    orbit: &orbit::Orbit<State<f64>, Account<f64>, D>,
    parameters: &Parameters,
    recurrence: f64,
) -> Outputs {
    if orbit.failure.is_some() {
        return Outputs::unknown();
    }
    let cycles = orbit.measured_cycles as f64;
    let progression = orbit.observed.advance / cycles;
    let resolved = precision::resolution(recurrence) * orbit.size * parameters.drive_period();
    let moves = progression.abs() > resolved;
    let mut outputs = summed(&orbit.observed, parameters, moves, cycles);
    let Exponent { value, uncertainty } = orbit.exponent;
    outputs[Output::LyapunovExponent] = value;
    outputs[Output::LyapunovUncertainty] = uncertainty;
    outputs[Output::LargestMultiplier] = orbit.certificate.multipliers[0].abs();
    outputs[Output::IntegrationDefect] = orbit.defect;
    outputs[Output::ExcludedPeriod] = orbit.excluded;
    outputs[Output::SectionResidual] = orbit.residual;
    mean_errors::add(&mut outputs, orbit, parameters);
    if parameters.shape().over_folds && orbit.outcome == Outcome::Periodic {
        let advance = orbit.observed.advance / cycles * orbit.period as f64;
        let folds = (advance / parameters[Parameter::FoldSpacing]).round();
        // Of what is held no fold is passed, in no direction.
        outputs[Output::FoldsPerPeriod] = if folds == 0.0 { 0.0 } else { folds };
    }
    outputs
}

/// The outputs per cycle, from the sums over `cycles`; costs of progression are infinite unless the capsule `moves` by more
/// than rounding.
fn summed(account: &Account<f64>, parameters: &Parameters, moves: bool, cycles: f64) -> Outputs {
    let mut outputs = per_cycle(account, |it| parameters[it], parameters.shape(), cycles);
    let Energies { work_net, work_absolute, friction_loss, damper_loss, .. } = account.energies;
    let mut losses = friction_loss + damper_loss;
    // Without a drive only losses are left to measure against.
    let mut exchanged = work_absolute.max(losses);
    if parameters.form().is_of_family() {
        let lifting = lifting_work(account, |it| parameters[it], parameters.shape());
        losses += account.beside.contact_loss + lifting;
        exchanged = work_absolute.max(losses).max(lifting.abs());
    }
    for (output, value) in [
        (Output::EnergyResidual, ratio(work_net - losses, exchanged)),
        (Output::MomentumResidual, momentum_residual(account, parameters)),
        (Output::ImpactsPerCycle, account.impacts / cycles),
        (Output::RearImpactsPerCycle, account.beside.rear_impacts / cycles),
        (Output::ForwardSlips, account.forward_slips / cycles),
        (Output::BackwardSlips, account.backward_slips / cycles),
        (Output::Reversals, account.reversals / cycles),
    ] {
        outputs[output] = value;
    }
    if !moves {
        outputs[Output::CostOfTransport] = f64::INFINITY;
        outputs[Output::EnergyPerMetre] = f64::INFINITY;
    }
    outputs
}

/// The outputs that change with the parameters, from the sums over `cycles`, in numbers of any kind; NaN for others. Costs of
/// no progression are infinite, of rounding they are what they are.
pub fn per_cycle<L: Lane>(
    account: &Account<L>,
    of: impl Fn(Parameter) -> L,
    shape: Shape,
    cycles: f64,
) -> Outputs<L> {
    let mut outputs = Outputs::unknown();
    let (energies, beside, cycles) = (&account.energies, &account.beside, L::splat(cycles));
    let drive_period = L::splat(2.0 * PI) / shape.frequency(&of);
    let normal_load = (of(Parameter::M1) + of(Parameter::M2)) * of(Parameter::G);
    let progression = account.advance / cycles;
    let distance = progression.abs();
    let work_positive = energies.work_positive / cycles;
    for (output, value) in [
        (Output::ProgressionSpeed, progression / drive_period),
        (Output::ProgressionPerCycle, progression),
        (Output::WorkNet, energies.work_net / cycles),
        (Output::WorkPositive, work_positive),
        (Output::WorkAbsolute, energies.work_absolute / cycles),
        (Output::WorkActuator, energies.work_actuator / cycles),
        (Output::FrictionLoss, energies.friction_loss / cycles),
        (Output::DamperLoss, energies.damper_loss / cycles),
        (Output::CostOfTransport, work_positive / (normal_load * distance)),
        (Output::Power, work_positive / drive_period),
        (Output::EnergyPerMetre, work_positive / distance),
        (Output::StickShare, account.stick_time / account.time),
        (Output::PeakContactForce, account.peak_contact_force),
        (Output::GrazingMargin, account.grazing_margin),
        (Output::ContactLoss, beside.contact_loss / cycles),
        (Output::DragLoss, beside.drag_loss / cycles),
        (Output::LiftingWork, lifting_work(account, &of, shape) / cycles),
        (Output::RearPeakContactForce, beside.rear_peak_force),
        (Output::RearGrazingMargin, beside.rear_margin),
    ] {
        outputs[output] = value;
    }
    outputs
}
