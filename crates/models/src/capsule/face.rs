//! What makes the capsule a model.

use capsulemap_engine::orbit::{OrbitOf, Outcome, Protocol};

use super::account::Account;
use super::description::CAPSULE;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::sensitivity::sensitivity;
use super::settle::{orbit_of, outputs, per_cycle};
use super::state::State;
use super::system::{CapsuleSystem, Reading};
use crate::description::{self, Description, Parameters};
use crate::face::Face;
use crate::motion::{Case, Orbit, Sensitivity};

impl<R: Reading> Face<3> for CapsuleSystem<R> {
    fn description() -> &'static Description {
        &CAPSULE
    }

    fn of(parameters: &Parameters, phase: f64) -> Self {
        CapsuleSystem::new(parameters.clone(), phase)
    }

    fn which(parameter: description::Parameter) -> Parameter {
        Parameter::which(parameter)
    }

    fn state(state: &description::State) -> State<f64> {
        state.into()
    }

    fn told(state: &State<f64>) -> description::State {
        (*state).into()
    }

    fn orbit(orbit: OrbitOf<Self, 3>, case: &Case, protocol: &Protocol) -> Orbit {
        orbit_of::<R>(orbit, case, protocol)
    }

    fn remarks(parameters: &Parameters, orbit: &Orbit) -> Vec<String> {
        let rests = orbit.section.first().is_some_and(|point| point[2] == 0.0);
        let sticks = orbit.outcome == Outcome::Periodic && rests && parameters.break_away() > 0.0;
        let remark = "the capsule sticks at the section: its multiplier 0 is that of disturbances after which it sticks again";
        sticks.then(|| remark.to_owned()).into_iter().collect()
    }

    fn outputs(&self, orbit: &OrbitOf<Self, 3>, recurrence: f64) -> description::Outputs {
        outputs(orbit, &self.parameters, recurrence).into()
    }

    fn per_cycle(&self, observed: &Account<f64>, cycles: f64) -> description::Outputs {
        per_cycle(observed, |it| self.parameters[it], cycles).into()
    }

    fn sensitivity(
        &self,
        orbit: (&[f64; 3], u64),
        tolerance: f64,
        parameter: Parameter,
    ) -> Option<Sensitivity> {
        sensitivity(self, orbit, tolerance, parameter)
    }
}
