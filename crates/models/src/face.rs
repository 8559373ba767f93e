//! What makes a system of the engine a model: its description, and how what the engine computes of it is told by that.

use capsulemap_engine::branch::{self, NotFollowed};
use capsulemap_engine::flow::System;
use capsulemap_engine::orbit::{self, OrbitOf, Protocol};

use crate::description::{Description, Outputs, Parameter, Parameters, Section, State};
use crate::motion::branch::{Found, Request};
use crate::motion::{Case, Orbit, Sensitivity, Setting};

/// A system with a face.
pub trait Face<const D: usize>: System<D> + 'static {
    /// What it says of itself.
    fn description() -> &'static Description;

    /// The system with these parameters, whose drive is at `phase` at the section [rad].
    fn of(parameters: &Parameters, phase: f64) -> Self;

    /// The parameter that is described so.
    fn which(parameter: Parameter) -> Self::Parameter;

    /// The state that is described so.
    fn state(state: &State) -> Self::State<f64>;

    /// The same, told by the description.
    fn told(state: &Self::State<f64>) -> State;

    /// What a case has settled to, with its outputs, and its history where the protocol asks for it.
    ///
    /// Unless a model has it another way: without impacts and histories.
    fn orbit(orbit: OrbitOf<Self, D>, case: &Case, protocol: &Protocol) -> Orbit {
        let system = Self::of(&case.parameters, case.section_phase);
        let outputs = match orbit.failure {
            None => system.outputs(&orbit, protocol.recurrence),
            Some(_) => Outputs::unknown(Self::description()),
        };
        Orbit {
            outcome: orbit.outcome,
            period: orbit.period,
            certificate: orbit.certificate.map(Section::from),
            cycles: orbit.cycles,
            outputs,
            section: orbit.section.into_iter().map(Section::from).collect(),
            impacts: Vec::new(),
            history: Vec::new(),
            end: Self::told(&orbit.end),
            failure: orbit.failure.map(|it| it.map(|state| Self::told(&state))),
        }
    }

    /// What is to be said of an orbit beside its numbers, in sentences.
    fn remarks(_parameters: &Parameters, _orbit: &Orbit) -> Vec<String> {
        Vec::new()
    }

    /// The outputs of an orbit that has closed; `recurrence` is how closely the section had to repeat, relative to the motion.
    fn outputs(&self, orbit: &OrbitOf<Self, D>, recurrence: f64) -> Outputs;

    /// The outputs that are sums, per cycle, of what was observed over so many cycles; NaN for others.
    fn per_cycle(&self, observed: &Self::Observer, cycles: f64) -> Outputs;

    /// The derivatives in a parameter of the periodic orbit through a section point, of this period [cycles].
    fn sensitivity(
        &self,
        orbit: (&[f64; D], u64),
        tolerance: f64,
        parameter: Self::Parameter,
    ) -> Option<Sensitivity>;
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
        longest_step: request.longest_step,
        most_points: request.most_points,
        tolerance: *tolerance,
    })?;
    let Protocol { recurrence, .. } = Protocol::with_tolerance(*tolerance);
    let measured = |value: f64, orbit: Option<OrbitOf<M, D>>| match orbit {
        Some(orbit) => system.with(M::which(*along), value).outputs(&orbit, recurrence),
        None => Outputs::unknown(M::description()),
    };
    Ok(found.map(measured, Into::into))
}
