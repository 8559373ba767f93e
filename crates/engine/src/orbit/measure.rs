//! What a settled case is measured to be, over the cycles that are kept.

use super::all_exponents::AllExponents;
use super::aperiodic::{Aperiodic, Departure, follow_aperiodic};
use super::certificate::certify;
use super::exponent::BATCHES;
use super::matrix::{Complex, Matrix};
use super::mean_error::measured_until;
use super::measuring::{Kept, MeasureRequest, Measured};
use super::neighbourhood::{Neighbourhood, OrbitPoint};
use super::passage::{Integrator, OneByOne, PlainRequest, image};
use super::precision::{GRAZES, STANDS_STILL, same, sound};
use super::recurrence::Settled;
use super::rest::from_rest;
use super::return_map::{Cycles, append_points};
use super::settling::Foretold;
use super::{
    Case, Certificate, Exponent, Exponents, Failure, Orbit, OrbitOf, Outcome, Proof, Protocol,
    Trajectory,
};
use crate::flow::{Metric, Observer, Stroboscopic, Switched, System};
use crate::lane::Instructions;

/// What a case has been found to do.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Found<const D: usize> {
    /// Its section repeats.
    Repeats(Settled),
    /// It does not within the budget of cycles; the linearised flow has not been asked yet.
    Aperiodic,
    /// It does not, and this is what the linearised flow says of it.
    Followed(Aperiodic<D>),
    /// It is on this periodic orbit.
    Orbit(Verdict<D>),
}

/// Whether a motion leads to the orbit that it seems to tend to.
pub(super) enum Told<const D: usize> {
    /// It leads there.
    Leads(Verdict<D>),
    /// That is not proven; the orbit, if it has a neighbourhood, which does not hold the motion yet.
    Unproven(Option<(ClosedOrbit<D>, Neighbourhood<D>)>),
}

/// A periodic orbit that a motion seems to tend to.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClosedOrbit<const D: usize> {
    verdict: Verdict<D>,
    /// Its section point.
    point: [f64; D],
}

impl<const D: usize> ClosedOrbit<D> {
    /// What a motion is found to do that is on this orbit, to which its trajectory goes.
    pub(super) fn reached<S: Stroboscopic<f64, D>>(
        &self,
        trajectory: &mut Trajectory<'_, S, D>,
    ) -> Found<D> {
        trajectory.leap(self.point);
        Found::Orbit(self.verdict.clone())
    }
}

/// The motion of a case of a system.
type Moving<'a, M, const D: usize> = Trajectory<'a, <M as System<D>>::Single, D>;
/// Where and why a case of a system failed.
type Fails<M, const D: usize> = Failure<<M as System<D>>::State<f64>>;

/// What is to be measured, and what is known of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Verdict<const D: usize> {
    outcome: Outcome,
    period: u64,
    /// Cycles to measure over.
    cycles: u64,
    certificate: Certificate<[f64; D]>,
    /// The exponent; of a periodic orbit that of its multipliers, once the duration of a cycle is known.
    exponent: Exponent,
    /// Cycles over which that has been followed.
    followed: u64,
    /// The longest period that is excluded, with all shorter ones [cycles].
    excluded: f64,
    /// Size of the motion that led there, beside which what is left of it may be nothing.
    size: f64,
}

impl<const D: usize> Verdict<D> {
    /// A periodic orbit that Newton's method has closed, with its multipliers and the direction of the
    /// family that it belongs to, if it does.
    fn periodic(
        period: u64,
        (multipliers, neutral): ([Complex; D], Option<[f64; D]>),
        size: f64,
    ) -> Self {
        let proof = if neutral.is_some() { Proof::Neutral } else { Proof::Newton };
        let multipliers = multipliers.to_vec();
        Verdict {
            outcome: Outcome::Periodic,
            period,
            cycles: period,
            certificate: Certificate { proof, residual: f64::NAN, multipliers, neutral },
            exponent: Exponent { value: f64::NAN, uncertainty: 0.0 },
            followed: 0,
            excluded: (period - 1) as f64,
            size,
        }
    }

    /// The exponent, for cycles of this duration [s].
    fn exponent(&self, duration: f64) -> Exponent {
        if self.outcome != Outcome::Periodic {
            return self.exponent;
        }
        let time = self.period as f64 * duration;
        let value = libm::log(self.certificate.multipliers[0].abs()) / time;
        Exponent { value, uncertainty: 0.0 }
    }
}

/// Measures a case that was `found` to do something, going on from where its trajectory is.
pub(super) fn conclude<M: System<D>, const D: usize>(
    trajectory: &mut Moving<'_, M, D>,
    case: &Case<M, D>,
    found: Result<Found<D>, Fails<M, D>>,
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> OrbitOf<M, D> {
    let measured = found.and_then(|found| {
        let verdict = judge(trajectory, case, found, protocol, integrator)?;
        measure(trajectory, &case.system, &verdict, protocol, integrator)
    });
    measured.unwrap_or_else(|failure| {
        let state = trajectory.state();
        let observed = case.system.observer(0);
        Orbit { cycles: trajectory.progress.cycles, ..Orbit::failed(failure, state, observed) }
    })
}

/// Says what a case is, and leads its trajectory onto the orbit where it is a periodic one.
fn judge<M: System<D>, const D: usize>(
    trajectory: &mut Moving<'_, M, D>,
    case: &Case<M, D>,
    found: Found<D>,
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> Result<Verdict<D>, Fails<M, D>> {
    match found {
        Found::Repeats(settled) => {
            let section = trajectory.section();
            match certified(trajectory, case, (&section, settled), protocol, integrator) {
                Some((verdict, _)) => Ok(verdict),
                None => judge(trajectory, case, Found::Aperiodic, protocol, integrator),
            }
        }
        Found::Followed(aperiodic) => {
            trajectory.progress.cycles += aperiodic.cycles;
            trajectory.progress.steps_before += aperiodic.steps;
            let outcome = aperiodic.outcome();
            // A period too long for the recurrence of sections, or one that is approached slowly.
            let recurs = aperiodic.recurs.filter(|_| outcome != Outcome::Chaotic);
            let periodic = recurs.and_then(|settled| {
                certified(trajectory, case, (&aperiodic.last, settled), protocol, integrator)
            });
            let periodic = periodic.map(|(verdict, _)| verdict);
            Ok(periodic.unwrap_or_else(|| Verdict {
                outcome,
                period: 0,
                cycles: protocol.measured_cycles,
                certificate: Certificate::none(),
                exponent: aperiodic.exponent,
                followed: aperiodic.cycles,
                excluded: aperiodic.excluded as f64,
                size: 0.0,
            }))
        }
        Found::Orbit(verdict) => Ok(verdict),
        Found::Aperiodic => {
            let start = Departure {
                system: &case.system,
                point: trajectory.section(),
                max_steps: trajectory.progress.steps_left(protocol.max_steps),
            };
            match follow_aperiodic(Instructions::Scalar, &[start], protocol)[0] {
                Ok(aperiodic) => {
                    judge(trajectory, case, Found::Followed(aperiodic), protocol, integrator)
                }
                Err(reason) => Err(trajectory.failure(reason)),
            }
        }
    }
}

/// Whether a motion leads to the orbit that it seems to tend to; its trajectory is then led onto it.
///
/// Method: Newton's closes the orbit from the limit of the section points, and a neighbourhood that the return map leads
/// into itself holds the section point where the motion is.
pub(super) fn told<M: System<D>, const D: usize>(
    trajectory: &mut Moving<'_, M, D>,
    case: &Case<M, D>,
    foretold: &Foretold<D>,
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> Told<D> {
    let here = trajectory.section();
    let limit = (&foretold.limit, foretold.nearly);
    let orbit = certified(trajectory, case, limit, protocol, integrator);
    let isolated = orbit.filter(|(it, _)| it.certificate.neutral.is_none());
    let Some((orbit, jacobian)) = isolated else { return Told::Unproven(None) };
    match home(trajectory, case, (&orbit, &jacobian, &here), protocol, integrator) {
        Some(home) if home.contains(&here) => Told::Leads(orbit),
        home => {
            let orbit = ClosedOrbit { verdict: orbit, point: trajectory.section() };
            Told::Unproven(home.map(|home| (orbit, home)))
        }
    }
}

/// A neighbourhood of the orbit on which the trajectory is, around its section point that is nearest to another, which it
/// holds if it can.
fn home<M: System<D>, const D: usize>(
    trajectory: &Moving<'_, M, D>,
    case: &Case<M, D>,
    (orbit, jacobian, held): (&Verdict<D>, &Matrix<D>, &[f64; D]),
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> Option<Neighbourhood<D>> {
    let (system, metric) = (&case.system, case.system.metric());
    let cycles = Cycles { count: orbit.period, tolerance: protocol.tolerance };
    let mut points = vec![trajectory.section()];
    append_points(system, &mut points, orbit.period as usize, protocol.tolerance)?;
    let away = |point: &[f64; D]| metric.distance(point, held);
    let place = (0..points.len()).min_by(|&a, &b| away(&points[a]).total_cmp(&away(&points[b])))?;
    let point = points[place];
    let jacobian = match place {
        0 => *jacobian,
        _ => image(integrator, system, &point, &cycles).ok()?.jacobian,
    };
    Neighbourhood::holding(&OrbitPoint { point, jacobian }, &metric, held, |points| {
        integrator.plain_returns(PlainRequest { system: system.clone(), points, cycles })
    })
}

/// The verdict on a section that repeats, with the derivative of the return map over the period: periodic if Newton's
/// method closes the orbit within the steps left, else none.
fn certified<M: System<D>, const D: usize>(
    trajectory: &mut Moving<'_, M, D>,
    case: &Case<M, D>,
    (section, settled): (&[f64; D], Settled),
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> Option<(Verdict<D>, Matrix<D>)> {
    let progress = &mut trajectory.progress;
    let steps = |cycles: u64| progress.mean_steps().saturating_mul(cycles);
    let steps_left = progress.steps_left(protocol.max_steps);
    if steps(settled.repeats_after as u64) > steps_left {
        return None;
    }
    let orbit = certify(&case.system, section, &settled, protocol, integrator)?;
    let cycles = protocol.max_cycles.min(steps_left / progress.mean_steps().max(1));
    let rest = from_rest(&case.system, (&orbit, &settled), cycles, protocol, integrator);
    let (orbit, settled) = rest.unwrap_or((orbit, settled));
    if steps(orbit.cycles) > steps_left {
        return None;
    }
    progress.steps_before = progress.steps_before.saturating_add(steps(orbit.cycles));
    progress.cycles += orbit.cycles;
    trajectory.leap(orbit.section);
    let multipliers = (orbit.multipliers, orbit.neutral);
    Some((Verdict::periodic(orbit.period, multipliers, settled.size), orbit.jacobian))
}

/// The periodic orbit with these multipliers from a point of it, measured over its period.
pub fn measured<M: System<D>, const D: usize>(
    system: &M,
    section: [f64; D],
    (period, multipliers): (u64, [Complex; D]),
    tolerance: f64,
) -> Result<OrbitOf<M, D>, Fails<M, D>> {
    let moving = system.single();
    let start = <M::Single as Stroboscopic<f64, D>>::state(section);
    let mut trajectory = Trajectory::new(&moving, start, tolerance);
    let (points, max_steps) = (period as usize, u64::MAX);
    let protocol = Protocol { points, max_steps, ..Protocol::with_tolerance(tolerance) };
    let verdict = Verdict::periodic(period, (multipliers, None), 0.0);
    measure(&mut trajectory, system, &verdict, &protocol, &OneByOne)
}

fn measure<M: System<D>, const D: usize>(
    trajectory: &mut Moving<'_, M, D>,
    system: &M,
    verdict: &Verdict<D>,
    protocol: &Protocol,
    integrator: &dyn Integrator<M, D>,
) -> Result<OrbitOf<M, D>, Fails<M, D>> {
    let metric = system.metric();
    let (begins, elapsed) = (trajectory.state(), trajectory.elapsed());
    let first = trajectory.section();
    // The sums of a periodic orbit are the same in all of its periods.
    let repeats = verdict.outcome == Outcome::Periodic;
    let request = MeasureRequest {
        system: system.clone(),
        motion: trajectory.motion(),
        progress: trajectory.progress,
        cycles: verdict.cycles,
        batches: if repeats { 0 } else { BATCHES as u64 },
        max_steps: protocol.max_steps,
        tolerance: protocol.tolerance,
        points: protocol.points,
        observed_points: protocol.impact_points,
    };
    let wanted = protocol.mean_error.filter(|_| !repeats);
    let (cycles, measured) = measured_until(integrator, request, wanted);
    let Measured { motion, progress, observed, batches, kept, failure } = measured;
    trajectory.go_on(motion, progress);
    if let Some(failure) = failure {
        return Err(failure);
    }
    let Kept { section, size, swing, excursion, defect, .. } = kept;
    let duration = if M::Single::AUTONOMOUS {
        (trajectory.elapsed() - elapsed) / cycles as f64
    } else {
        trajectory.system().period()
    };
    let motion = swing.max(verdict.size);
    let defect = if defect == 0.0 { 0.0 } else { defect / motion };
    let ends = [first, trajectory.section()];
    let certificate = completed(verdict, &metric, ends, (size, observed.touching_margin()));
    // An orbit that Newton's method has closed with derivatives closes without them, too.
    let closes =
        certificate.proof == Proof::None || certificate.residual <= same(protocol.tolerance);
    // An equilibrium of an autonomous system has no section: its derivatives there would be rounding.
    let moves = !M::Single::AUTONOMOUS || excursion > STANDS_STILL * motion;
    let is_sound = defect <= sound(protocol.tolerance) && closes && moves;
    let orbit = Orbit {
        outcome: verdict.outcome,
        period: verdict.period,
        residual: certificate.residual,
        certificate,
        exponent: verdict.exponent(duration),
        spectrum: None,
        excluded: verdict.excluded,
        defect,
        size,
        cycles: trajectory.progress.cycles,
        measured_cycles: cycles,
        duration,
        section,
        begins,
        end: trajectory.state(),
        observed,
        batches,
        failure: None,
    };
    let is_wanted = is_sound && protocol.exponents == Exponents::All;
    let asked = is_wanted.then(|| AllExponents {
        system,
        point: first,
        followed: verdict.followed,
        affordable: trajectory.progress.affordable_cycles(protocol.max_steps),
        tolerance: protocol.tolerance,
        integrator,
    });
    let orbit = Orbit { spectrum: asked.and_then(|it| it.of(&orbit)), ..orbit };
    Ok(if is_sound { orbit } else { orbit.withdrawn() })
}

/// The certificate with what the measured cycles say of it: how well they close, and whether an extremum just
/// touches a surface.
fn completed<const D: usize>(
    verdict: &Verdict<D>,
    metric: &Metric<D>,
    [begins, ends]: [[f64; D]; 2],
    (size, touching_margin): (f64, f64),
) -> Certificate<[f64; D]> {
    let certificate = verdict.certificate.clone();
    if certificate.proof == Proof::None {
        return certificate;
    }
    let gap = metric.distance(&ends, &begins);
    let residual = if gap == 0.0 { 0.0 } else { gap / size.max(verdict.size) };
    let touches = metric.scales[0] * touching_margin <= GRAZES * size;
    let proof = if touches { Proof::Grazing } else { certificate.proof };
    Certificate { proof, residual, ..certificate }
}
