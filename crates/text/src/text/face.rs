//! How a text's system is told by the description of its model.

use std::f64::consts::PI;

use capsulemap_engine::orbit::{Orbit, OrbitOf, Outcome};
use capsulemap_models::capsule::mean_errors::standard_error;
use capsulemap_models::description::{Description, Outputs, Parameter, Parameters, State};
use capsulemap_models::face::Face;
use capsulemap_models::motion::{Case, reduced};

use crate::text::described::{
    CYCLE_DURATION, DEFECT, EXCLUDED_PERIOD, EXPONENT, EXPONENT_ERROR, LARGEST_MULTIPLIER,
    LARGEST_PART, OF_ALL, SECTION_RESIDUAL, program_of,
};
use crate::text::sums::Sums;
use crate::text::system::TextSystem;

/// The standard error of the mean rate of what drifts: zero of a periodic orbit, else by batches of its measured cycles.
fn speed_error<S, const D: usize>(orbit: &Orbit<S, Sums<f64>, D>) -> f64 {
    if orbit.outcome == Outcome::Periodic {
        return 0.0;
    }
    let mut before = [0.0; 2];
    let rates = orbit.batches.iter().map(|sums| {
        let [time, advance] = [sums.time(), sums.advance()];
        let rate = (advance - before[1]) / (time - before[0]);
        before = [time, advance];
        rate
    });
    standard_error(&rates.collect::<Vec<_>>())
}

impl<const D: usize, const N: usize, const AUTONOMOUS: bool> Face<D>
    for TextSystem<D, N, AUTONOMOUS>
{
    const HAS_ROOM: bool = true;

    fn description(&self) -> &'static Description {
        self.program().description.get().expect("the program of a model")
    }

    fn of(parameters: &Parameters, phase: f64) -> Self {
        let turns = if AUTONOMOUS { 0.0 } else { reduced(phase) / (2.0 * PI) };
        // The phase just below a whole turn is one by rounding.
        let turns = if turns < 1.0 { turns } else { 0.0 };
        let values = parameters.each().map(|it| it.1).collect();
        TextSystem::new(program_of(parameters.model())).with_values(values).seen_at(turns)
    }

    fn which(parameter: Parameter) -> usize {
        parameter.index()
    }

    fn state(state: &State) -> [f64; N] {
        let mut places = [0.0; N];
        for (at, value) in program_of(state.model()).layout.iter().zip(state.values()) {
            places[*at] = *value;
        }
        places
    }

    fn told(&self, state: &[f64; N]) -> State {
        let values: Vec<f64> = self.program().layout.iter().map(|at| state[*at]).collect();
        State::new(self.description(), &values)
    }

    fn has_no_start(case: &Case) -> bool {
        Self::of(&case.parameters, case.section_phase)
            .is_behind(case.start_time(), Self::state(&case.start))
    }

    fn outputs(&self, orbit: &OrbitOf<Self, D>, _: f64) -> Outputs {
        let (program, exponent) = (self.program(), orbit.exponent);
        let (text, sums) = (&program.text, &orbit.observed);
        let cycles = sums.time() / orbit.duration;
        let mut outputs: Vec<f64> =
            text.drift.map(|_| sums.advance() / sums.time()).into_iter().collect();
        outputs.extend(program.outputs(self.values(), &sums.measured(program, cycles)));
        let mut values = vec![f64::NAN; OF_ALL];
        values[LARGEST_PART] = orbit.size;
        values[EXPONENT] = exponent.value;
        values[EXPONENT_ERROR] = exponent.uncertainty;
        values[EXCLUDED_PERIOD] = orbit.excluded;
        values[DEFECT] = orbit.defect;
        values[SECTION_RESIDUAL] = orbit.residual;
        values[LARGEST_MULTIPLIER] = orbit.certificate.multipliers[0].abs();
        values[CYCLE_DURATION] = orbit.duration;
        outputs.extend(values);
        outputs.extend(sums.rest(program).iter().map(|it| it / sums.time()));
        outputs.extend(sums.events(program).iter().map(|it| it / cycles));
        outputs.extend(text.drift.map(|_| speed_error(orbit)));
        outputs.resize(self.description().outputs.len(), f64::NAN);
        Outputs::new(self.description(), &outputs)
    }
}
