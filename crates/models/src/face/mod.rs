//! What makes a system of the engine a model: its description, and how what the engine computes of it is told by that.

mod faults;
mod followed;
mod stretch;

use capsulemap_engine::branch::{self, NotFollowed};
use capsulemap_engine::flow::{Reason, Step, System};
use capsulemap_engine::orbit::return_map::Cycles;
use capsulemap_engine::orbit::{self, Certificate, OrbitOf, Outcome, Protocol, Spectrum};

use crate::description::{Description, Output, Outputs, Parameter, Parameters, State};
use crate::motion::branch::{Found, Request};
use crate::motion::{Case, Orbit, Sensitivity, Setting};

pub use faults::faults;
pub use followed::{AtEvent, AtSection, Followed, followed, simulate};
pub use stretch::{arc, samples};

/// A system with a face.
pub trait Face<const D: usize>: System<D> + 'static {
    /// Whether a point of the section has room for more coordinates than the description has.
    const HAS_ROOM: bool = false;

    /// What it says of itself.
    fn description(&self) -> &'static Description;

    /// The system with these parameters, whose drive is at `phase` at the section [rad].
    fn of(parameters: &Parameters, phase: f64) -> Self;

    /// The parameter that is described so; of a system by [`own_system!`](capsulemap_engine::own_system) the name of its field.
    fn which(parameter: Parameter) -> Self::Parameter;

    /// The state that is described so.
    fn state(state: &State) -> Self::State<f64>;

    /// The same, told by the description.
    fn told(&self, state: &Self::State<f64>) -> State;

    /// What depends on time alone, as the force of a drive, `h` after the beginning of a step: what is kept of a motion beside its
    /// coordinates.
    fn driven(&self, _: &Self::Single, _step: &Step<f64, Self::Single>, _h: f64) -> Vec<f64> {
        Vec::new()
    }

    /// The states to be told of at an event that ends a mode, by those before and after it; forces follow from them.
    ///
    /// Unless a model has it another way: that before it, and that after it where they differ.
    fn at_event(
        &self,
        _: &Self::Single,
        _ended: &Self::Mode<f64>,
        _event: Self::Event,
        [before, after]: [Self::State<f64>; 2],
    ) -> Vec<State> {
        let mut states = vec![self.told(&before), self.told(&after)];
        states.dedup();
        states
    }

    /// What is summed up of a motion from its start, by the model's `sums`.
    fn sums(_observed: &Self::Observer) -> Vec<f64> {
        Vec::new()
    }

    /// What is counted of a motion from its start, by the model's `counts`.
    fn counts(_observed: &Self::Observer) -> Vec<u64> {
        Vec::new()
    }

    /// Whether no motion starts as a case does, which then fails at once.
    fn has_no_start(_case: &Case) -> bool {
        false
    }

    /// What a case has settled to, withdrawn where the model can tell that it has not.
    fn judged(orbit: OrbitOf<Self, D>, _case: &Case, _protocol: &Protocol) -> OrbitOf<Self, D> {
        orbit
    }

    /// The impacts of the measured cycles: by what the model tells of an impact, then by impact.
    fn impacts(_observed: &Self::Observer) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// What is to be said of an orbit beside its numbers, in sentences.
    fn remarks(_parameters: &Parameters, _orbit: &Orbit) -> Vec<String> {
        Vec::new()
    }

    /// The outputs of an orbit that has closed; `recurrence` is how closely the section had to repeat, relative to the motion.
    fn outputs(&self, orbit: &OrbitOf<Self, D>, recurrence: f64) -> Outputs;

    /// The outputs that are sums, per cycle, of what was observed over so many cycles; NaN for others.
    ///
    /// Unless a model has it another way: none is a sum.
    fn per_cycle(&self, _observed: &Self::Observer, _cycles: f64) -> Outputs {
        Outputs::unknown(self.description())
    }

    /// The derivatives in a parameter of the periodic orbit through a section point, of so many cycles.
    ///
    /// Unless a model has it another way: no output is smooth.
    fn sensitivity(
        &self,
        _section: &[f64; D],
        _cycles: Cycles,
        _parameter: Self::Parameter,
    ) -> Option<Sensitivity> {
        None
    }
}

/// What a case has settled to, with its outputs, and its history where the protocol asks for it.
pub fn orbit_of<M: Face<D>, const D: usize>(
    orbit: OrbitOf<M, D>,
    case: &Case,
    protocol: &Protocol,
) -> Orbit {
    let system = M::of(&case.parameters, case.section_phase);
    let model = system.description();
    let told = |point: [f64; D]| model.section_point(&point);
    let orbit = M::judged(orbit, case, protocol);
    let orbit =
        OrbitOf::<M, D> { failure: orbit.failure.map(|it| explained::<M, D>(it, case)), ..orbit };
    let (orbit, history) = match history(&system, &orbit, case, protocol) {
        Ok(history) => (orbit, history),
        Err(failure) => (failed(&system, orbit, failure), Vec::new()),
    };
    let mut outputs = match orbit.failure {
        None => system.outputs(&orbit, protocol.recurrence),
        Some(_) => Outputs::unknown(model),
    };
    if let (None, Some(spectrum)) = (&orbit.failure, &orbit.spectrum) {
        add_spectrum(&mut outputs, spectrum);
    }
    let mut certificate = orbit.certificate.map(told);
    certificate.multipliers.truncate(model.section.len());
    Orbit {
        outcome: orbit.outcome,
        period: orbit.period,
        certificate,
        cycles: orbit.cycles,
        outputs,
        section: orbit.section.into_iter().map(told).collect(),
        impacts: M::impacts(&orbit.observed),
        history,
        end: system.told(&orbit.end),
        failure: orbit.failure.map(|it| it.map(|state| system.told(&state))),
    }
}

/// Adds all exponents and the dimension, where the model tells them.
fn add_spectrum<const D: usize>(outputs: &mut Outputs, spectrum: &Spectrum<D>) {
    let model = outputs.model();
    let Some(roles) = model.roles.spectrum else { return };
    let places = roles.exponents.iter().chain([&roles.dimension]);
    let of_section = &spectrum.exponents[..roles.exponents.len()];
    for (places, found) in places.zip(of_section.iter().chain([&spectrum.dimension])) {
        for (place, value) in places.iter().zip([found.value, found.uncertainty]) {
            outputs[Output::of(model, *place)] = value;
        }
    }
}

/// Why a case has failed, where its start tells that.
fn explained<M: Face<D>, const D: usize>(
    failure: orbit::Failure<M::State<f64>>,
    case: &Case,
) -> orbit::Failure<M::State<f64>> {
    match failure.reason {
        Reason::NotFinite if M::has_no_start(case) => {
            orbit::Failure { reason: Reason::NoStart, time: 0.0, state: M::state(&case.start) }
        }
        _ => failure,
    }
}

/// The history of a motion where the protocol asks for it: from the start of its case, or from where it has settled, with what
/// drifts at zero.
fn history<M: Face<D>, const D: usize>(
    system: &M,
    orbit: &OrbitOf<M, D>,
    case: &Case,
    protocol: &Protocol,
) -> Result<Vec<Vec<f64>>, orbit::Failure<M::State<f64>>> {
    let is_kept = orbit.failure.is_none() && system.description().keeps_histories();
    let Some(span) = protocol.history.filter(|_| is_kept) else {
        return Ok(Vec::new());
    };
    let settled = system.told(&orbit.end).without_drift();
    let on = Case::at_section(case.parameters.clone(), settled, case.section_phase);
    let from = if span.from_start { case } else { &on };
    Ok(samples::<M, D>(from, span, protocol.tolerance)?.histories)
}

/// An orbit whose history cannot be followed.
fn failed<M: Face<D>, const D: usize>(
    system: &M,
    orbit: OrbitOf<M, D>,
    failure: orbit::Failure<M::State<f64>>,
) -> OrbitOf<M, D> {
    OrbitOf::<M, D> {
        outcome: Outcome::Failed,
        period: 0,
        certificate: Certificate::none(),
        section: Vec::new(),
        failure: Some(failure),
        observed: system.observer(0),
        batches: Vec::new(),
        ..orbit
    }
}

/// The system of a setting.
pub fn system<M: Face<D>, const D: usize>(setting: &Setting) -> M {
    M::of(&setting.parameters, setting.phase)
}

/// A case for the engine.
pub fn engine_case<M: Face<D>, const D: usize>(case: &Case) -> orbit::Case<M, D> {
    let system = M::of(&case.parameters, case.section_phase);
    orbit::Case { system, start: M::state(&case.start), begins: case.start_time() }
}

/// Follows a branch of periodic orbits both ways from the one that is given, and what leaves it.
///
/// # Errors
/// Where no periodic orbit is found near the point that is given, or none that a branch goes through.
pub fn follow<M: Face<D>, const D: usize>(request: &Request) -> Result<Found, NotFollowed> {
    let Request { setting, along, tolerance, .. } = request;
    let system = system::<M, D>(setting);
    let found = branch::follow(&branch::Request {
        system: system.clone(),
        section: request.section.array(),
        period: request.period,
        along: M::which(*along),
        range: request.range,
        doublings: request.doublings,
        second: request.second.map(|(second, range)| (M::which(second), range)),
        curve_range: request.curve_range,
        longest_step: request.longest_step,
        most_points: request.most_points,
        tolerance: *tolerance,
    })?;
    let Protocol { recurrence, .. } = Protocol::with_tolerance(*tolerance);
    let model = system.description();
    let mut found = found.map(
        |value, orbit: Option<OrbitOf<M, D>>| match orbit {
            Some(orbit) => system.with(M::which(*along), value).outputs(&orbit, recurrence),
            None => Outputs::unknown(model),
        },
        |point| model.section_point(&point),
    );
    for point in found.branches.iter_mut().flat_map(|it| &mut it.points) {
        point.multipliers.truncate(model.section.len());
    }
    Ok(found)
}
