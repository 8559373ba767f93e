//! One case in full as JSON, and what its numbers do not say by themselves.

use serde_json::{Map, Value, json};

use crate::description::{Description, Kept, Output, Parameters, State};
use crate::motion::{Event, Orbit, Sample, Simulation};
use crate::of::{default_model, model_of};
use crate::orbit::{Certificate, Outcome, Proof};
use crate::store::catalogue::{CERTIFICATE, CYCLES, OUTCOME, PERIOD};

/// The case as one object: its model, unless that is the usual one, its parameters, the section and the events from its start, and
/// the orbit that it settles to, in SI.
pub fn case_json(parameters: &Parameters, simulation: &Simulation, orbit: &Orbit) -> Value {
    let model = parameters.model();
    let section = simulation.section.iter().map(|it| sample_json(model, it));
    let events = simulation.events.iter().map(|it| event_json(model, it));
    let mut object = json!({
        "parameters": parameters_json(parameters),
        "section": section.collect::<Vec<_>>(),
        "events": events.collect::<Vec<_>>(),
        "failure": failure_json(simulation),
        "orbit": orbit_json(parameters, orbit),
    });
    if model.without_own() != default_model() {
        object["model"] = json!(model.name);
    }
    object
}

fn parameters_json(parameters: &Parameters) -> Value {
    let mut object = Map::new();
    for (parameter, value) in parameters.stated() {
        object.insert(parameter.symbol().to_owned(), json!(value));
    }
    for (name, option) in parameters.choices() {
        object.insert(name.to_owned(), json!(option));
    }
    Value::Object(object)
}

/// A motion at a section: its cycle and time, where it is, and what the model sums up and counts from the start.
fn sample_json(model: &Description, sample: &Sample) -> Value {
    let mut object = Map::new();
    object.insert("n".to_owned(), json!(sample.cycle));
    object.insert("t".to_owned(), json!(sample.time));
    put_state(&mut object, &sample.state);
    let sums = model.motion.sums.iter().zip(sample.sums.iter().map(|sum| json!(sum)));
    let counts = model.motion.counts.iter().zip(sample.counts.iter().map(|count| json!(count)));
    object.extend(sums.chain(counts).map(|(name, value)| ((*name).to_owned(), value)));
    Value::Object(object)
}

fn event_json(model: &Description, event: &Event) -> Value {
    let mut object = Map::new();
    object.insert("t".to_owned(), json!(event.time));
    object.insert("kind".to_owned(), json!(model.event(event.number)));
    put_state(&mut object, &event.state);
    Value::Object(object)
}

fn put_state(object: &mut Map<String, Value>, state: &State) {
    object.extend(state.each().map(|(it, value)| (it.name().to_owned(), json!(value))));
}

fn failure_json(simulation: &Simulation) -> Value {
    simulation.failure.as_ref().map_or(Value::Null, |failure| json!(failure.to_string()))
}

fn orbit_json(parameters: &Parameters, orbit: &Orbit) -> Value {
    let mut object = Map::new();
    object.insert(OUTCOME.name.to_owned(), json!(orbit.outcome));
    object.insert(PERIOD.name.to_owned(), json!(orbit.period));
    object.insert(CYCLES.name.to_owned(), json!(orbit.cycles));
    for (output, value) in told(parameters, orbit) {
        object.insert(output.name().to_owned(), json!(value));
    }
    let Certificate { proof, multipliers, neutral, .. } = &orbit.certificate;
    object.insert(CERTIFICATE.name.to_owned(), json!(Proof::NAMES[*proof as usize].0));
    let parts: Vec<[f64; 2]> = multipliers.iter().map(|it| [it.re, it.im]).collect();
    object.insert("multipliers".to_owned(), json!(parts));
    object.insert("neutral_direction".to_owned(), json!(neutral));
    let failure = orbit.failure.as_ref().map(|failure| failure.to_string());
    object.insert("failure".to_owned(), json!(failure));
    Value::Object(object)
}

/// The outputs that there is something to tell of.
pub fn told(parameters: &Parameters, orbit: &Orbit) -> impl Iterator<Item = (Output, f64)> + use<> {
    let has_parts = parameters.have_optional_parts();
    let all: Vec<(Output, f64)> = orbit.outputs.each().collect();
    all.into_iter().filter(move |(it, value)| match it.kept() {
        Kept::Always => true,
        Kept::WithParts => has_parts,
        Kept::WithExponents | Kept::WithMeanError => !value.is_nan(),
    })
}

/// What the numbers of an orbit do not say by themselves.
pub fn remarks(parameters: &Parameters, orbit: &Orbit) -> Vec<String> {
    let mut remarks = Vec::from_iter(neutral_remark(orbit));
    remarks.extend(model_of(parameters).remarks(parameters, orbit));
    remarks.extend(outcome_remark(parameters, orbit));
    remarks
}

/// That a periodic orbit is one of a family of them, and along what.
fn neutral_remark(orbit: &Orbit) -> Option<String> {
    let direction = orbit.certificate.neutral?;
    let parts = direction.iter().map(|x| ((x * 1e4).round() / 1e4 + 0.0).to_string());
    let parts = parts.collect::<Vec<_>>().join(", ");
    let model = orbit.outputs.model();
    let names = model.compared_as.join(", ");
    let moves = model.rest_share().is_some_and(|share| orbit.outputs[share] < 1.0);
    let speed = if moves { ", and with it the speed" } else { "" };
    Some(format!(
        "neutral: as far as rounding tells (a multiplier within 1e-7 of one) this is one of a family of \
         periodic orbits along ({names}) = ({parts}); the start decides which{speed}"
    ))
}

/// What an outcome rests on, or what it would take to decide.
fn outcome_remark(parameters: &Parameters, orbit: &Orbit) -> Option<String> {
    let model = parameters.model();
    let [exponent, uncertainty, excluded, defect] =
        [model.exponent(), model.exponent_error(), model.excluded_period(), model.defect()]
            .map(|output| orbit.outputs[output]);
    match orbit.outcome {
        Outcome::QuasiPeriodic => {
            Some(format!("no period up to {excluded} cycles, as far as the section shows"))
        }
        Outcome::Undecided if excluded.is_nan() => {
            let residual = orbit.outputs[model.section_residual()];
            Some(format!(
                "undecided: what was found is not certified; its largest defect is {defect:.1e} (allowed: \
                 10 000 tolerances), and integrated without derivatives it closes to {residual:.1e} (allowed: \
                 100 000 tolerances)"
            ))
        }
        Outcome::Undecided if exponent.is_finite() && exponent + 5.0 * uncertainty < 0.0 => {
            let enough = parameters.period_of_drive().map_or(String::new(), |period| {
                let cycles = 25.0 / (-exponent * period);
                format!("; at that rate some {cycles:.0} cycles would do (--max-cycles), and more if it slows down")
            });
            let time = -1.0 / exponent;
            Some(format!(
                "undecided: the motion approaches an orbit too slowly for the cycles given, by e in {time:.3} s{enough}"
            ))
        }
        Outcome::Undecided => Some(
            "undecided: too few cycles to tell whether neighbouring motions separate (--max-cycles)"
                .to_owned(),
        ),
        Outcome::Periodic | Outcome::Chaotic | Outcome::Failed => None,
    }
}
