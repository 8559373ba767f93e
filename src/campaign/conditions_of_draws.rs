//! What conditions on cases ask of a motion under tolerances, which has parameters, outputs, a period and an outcome of its own.

use crate::description::{Description, Output, Parameter, Parameters};
use crate::motion::Orbit;
use crate::store::catalogue::{OUTCOME, PERIOD};
use crate::store::{Comparison, Condition};

/// Conditions as far as they can be judged of a draw.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OfDraws {
    judged: Vec<(Quantity, Condition)>,
    /// Those on something else: a start, an attractor, a count of cycles, and the like.
    pub not_judged: Vec<String>,
}

/// A limit is kept to this share of it.
const KEPT: f64 = 1e-8;

/// What a condition is on.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    Parameter(Parameter),
    Output(Output),
    Period,
    Outcome,
}

impl Quantity {
    fn named(name: &str, model: &'static Description) -> Option<Quantity> {
        match name {
            _ if name == PERIOD.name => Some(Quantity::Period),
            _ if name == OUTCOME.name => Some(Quantity::Outcome),
            _ => model
                .parameter(name)
                .map(Quantity::Parameter)
                .or_else(|| model.output(name).map(Quantity::Output)),
        }
    }

    /// Its value in a draw; of an outcome the code that the condition has for it.
    fn value(self, parameters: &Parameters, orbit: &Orbit, condition: &Condition) -> f64 {
        match self {
            Quantity::Parameter(parameter) => parameters[parameter],
            Quantity::Output(output) => orbit.outputs[output],
            Quantity::Period => orbit.period as f64,
            Quantity::Outcome => condition.code(orbit.outcome.name()),
        }
    }
}

impl OfDraws {
    /// The conditions, those that cannot be judged apart.
    pub fn of(conditions: &[Condition], model: &'static Description) -> OfDraws {
        let mut found = OfDraws::default();
        for condition in conditions {
            match Quantity::named(&condition.name, model) {
                Some(quantity) => found.judged.push((quantity, condition.clone())),
                None => found.not_judged.push(condition.normal()),
            }
        }
        found
    }

    /// Whether a draw keeps those that can be judged; none where there is none. Limits may be reached, as by motions between the cases,
    /// which lie on them.
    pub fn met(&self, parameters: &Parameters, orbit: &Orbit) -> Option<bool> {
        let mut each = self.judged.iter();
        (!self.judged.is_empty()).then(|| {
            each.all(|(quantity, condition)| {
                keeps(condition, quantity.value(parameters, orbit, condition))
            })
        })
    }
}

/// Whether a number keeps a condition, or reaches its limit but for rounding.
fn keeps(condition: &Condition, value: f64) -> bool {
    let Condition { comparison, limit, .. } = condition;
    let is_reached = (value - limit).abs() <= KEPT * limit.abs().max(value.abs());
    comparison.holds(value, *limit) || (*comparison != Comparison::Unequal && is_reached)
}
