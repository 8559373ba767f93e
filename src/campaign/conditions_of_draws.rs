//! What conditions on cases ask of a motion under tolerances, which has parameters, outputs, a period and an outcome of its own.

use crate::capsule::{Orbit, Output, Parameter, Parameters};
use crate::store::Condition;
use crate::store::catalogue::{OUTCOME, PERIOD};

/// Conditions as far as they can be judged of a draw.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OfDraws {
    judged: Vec<(Quantity, Condition)>,
    /// Those on something else: a start, an attractor, a count of cycles, and the like.
    pub not_judged: Vec<String>,
}

/// What a condition is on.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    Parameter(Parameter),
    Output(Output),
    Period,
    Outcome,
}

impl Quantity {
    fn named(name: &str) -> Option<Quantity> {
        match name {
            _ if name == PERIOD.name => Some(Quantity::Period),
            _ if name == OUTCOME.name => Some(Quantity::Outcome),
            _ => Parameter::named(name)
                .map(Quantity::Parameter)
                .or_else(|| Output::named(name).map(Quantity::Output)),
        }
    }
}

impl OfDraws {
    /// The conditions, those that cannot be judged apart.
    pub fn of(conditions: &[Condition]) -> OfDraws {
        let mut found = OfDraws::default();
        for condition in conditions {
            match Quantity::named(&condition.name) {
                Some(quantity) => found.judged.push((quantity, condition.clone())),
                None => found.not_judged.push(condition.normal()),
            }
        }
        found
    }

    /// Whether a draw keeps those that can be judged; none where there is none.
    pub fn met(&self, parameters: &Parameters, orbit: &Orbit) -> Option<bool> {
        let holds = |(quantity, condition): &(Quantity, Condition)| {
            let value = match quantity {
                Quantity::Parameter(parameter) => parameters[*parameter],
                Quantity::Output(output) => orbit.outputs[*output],
                Quantity::Period => orbit.period as f64,
                Quantity::Outcome => code(condition, orbit.outcome.name()),
            };
            condition.comparison.holds(value, condition.limit)
        };
        (!self.judged.is_empty()).then(|| self.judged.iter().all(holds))
    }
}

/// The code of a category in the file of the condition; not a number where it has none.
fn code(condition: &Condition, name: &str) -> f64 {
    let found = condition.column.flags.iter().find(|(_, flag)| flag == name);
    found.map_or(f64::NAN, |(code, _)| *code as f64)
}
