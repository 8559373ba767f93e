//! What makes the capsule a model.

use capsulemap_engine::flow::{Step, System as _};
use capsulemap_engine::lane::series;
use capsulemap_engine::orbit::return_map::Cycles;
use capsulemap_engine::orbit::{OrbitOf, Outcome, Protocol};

use super::account::Account;
use super::locomotion::Locomotion as _;
use super::parameter::Parameter;
use super::parameters::CapsuleParameters as _;
use super::sensitivity::sensitivity;
use super::settle::{is_balanced, outputs, per_cycle};
use super::state::{EventKind, State};
use super::system::{CapsuleSystem, Reading};
use crate::description::{self, Description, Parameters};
use crate::face::Face;
use crate::motion::{Case, Orbit, Sensitivity};

impl<R: Reading<D>, const D: usize> Face<D> for CapsuleSystem<R> {
    fn description(&self) -> &'static Description {
        R::description()
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

    fn told(&self, state: &State<f64>) -> description::State {
        let place = state.place - state.place.floor();
        let all = [state.r, state.y1, state.x2, state.y2, place];
        let model = R::description();
        description::State::new(model, &all[..model.coordinates.len()])
    }

    fn driven(&self, single: &R::Single, step: &Step<f64, R::Single>, h: f64) -> Vec<f64> {
        let drive = single.drive(&step.jet);
        vec![drive.unit * series::value(drive.force, h)]
    }

    /// The series ends within rounding of zero, on either side: just before it rests or turns round, the capsule still slides, and
    /// friction is that of sliding.
    fn at_event(
        &self,
        single: &R::Single,
        ended: &R::Mode<f64>,
        event: EventKind,
        [before, _]: [State<f64>; 2],
    ) -> Vec<description::State> {
        let sliding = State { y2: single.direction(ended) * f64::MIN_POSITIVE, ..before };
        let states = match event {
            EventKind::Stick => vec![sliding, State { y2: 0.0, ..before }],
            EventKind::Reversal => vec![sliding],
            _ => vec![before],
        };
        states.iter().map(|it| self.told(it)).collect()
    }

    fn sums(observed: &Account<f64>) -> Vec<f64> {
        observed.energies.all().to_vec()
    }

    fn counts(observed: &Account<f64>) -> Vec<u64> {
        vec![observed.impacts as u64]
    }

    /// Nothing is behind a rigid stop.
    fn has_no_start(case: &Case) -> bool {
        let is_rigid = case.parameters.shape().is_rigid();
        is_rigid && Self::state(&case.start).r > case.parameters[Parameter::Delta]
    }

    fn judged(orbit: OrbitOf<Self, D>, case: &Case, protocol: &Protocol) -> OrbitOf<Self, D> {
        let is_balanced = is_balanced(&orbit, &case.parameters, protocol.tolerance);
        if is_balanced { orbit } else { orbit.withdrawn() }
    }

    fn impacts(observed: &Account<f64>) -> Vec<Vec<f64>> {
        let impacts = &observed.impact_points;
        vec![
            impacts.column(|it| it.phase),
            impacts.column(|it| it.y1),
            impacts.column(|it| it.y2),
            impacts.column(|it| it.y1 - it.y2),
        ]
    }

    fn remarks(parameters: &Parameters, orbit: &Orbit) -> Vec<String> {
        let rests = orbit.section.first().is_some_and(|point| point[2] == 0.0);
        let sticks = orbit.outcome == Outcome::Periodic && rests && parameters.break_away() > 0.0;
        let remark = "the capsule sticks at the section: its multiplier 0 is that of disturbances after which it sticks again";
        sticks.then(|| remark.to_owned()).into_iter().collect()
    }

    fn outputs(&self, orbit: &OrbitOf<Self, D>, recurrence: f64) -> description::Outputs {
        R::told(&outputs(orbit, &self.parameters, recurrence))
    }

    fn per_cycle(&self, observed: &Account<f64>, cycles: f64) -> description::Outputs {
        let shape = self.parameters.shape();
        R::told(&per_cycle(observed, |it| self.parameters[it], shape, cycles))
    }

    fn sensitivity(
        &self,
        section: &[f64; D],
        cycles: Cycles,
        parameter: Parameter,
    ) -> Option<Sensitivity> {
        self.has(parameter).then(|| sensitivity(self, section, cycles, parameter))?
    }
}
