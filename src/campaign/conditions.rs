//! What conditions on cases ask of the motions between them.

use serde_json::{Value, json};

use crate::capsule::{Outputs, Parameter};
use crate::store::catalogue::{OUTCOME, PERIOD};
use crate::store::{Comparison, Condition};
use crate::tradeoff::{Limit, MOST_LIMITS, SMOOTH, Side};

/// A limit is kept to this share of it.
const KEPT: f64 = 1e-8;

/// Conditions on motions between the cases.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Conditions {
    /// Limits of outputs.
    pub limits: Vec<Limit>,
    /// Bounds of parameters (SI).
    pub bounds: Vec<(Parameter, Side, f64)>,
}

impl Conditions {
    /// What conditions on cases ask of motions that lie between them: bounds of parameters and limits of outputs, which may be reached.
    /// The period and the outcome of a motion are those of the case that it is followed from.
    ///
    /// Fails with all conditions that cannot be kept between the cases.
    pub fn of(conditions: &[Condition]) -> Result<Conditions, Vec<String>> {
        let mut found = Conditions::default();
        let mut faults = Vec::new();
        for condition in conditions {
            if let Err(fault) = found.add(condition) {
                faults.push(format!("\"{}\": {fault}", condition.text));
            }
        }
        let count = found.limits.len();
        if count > MOST_LIMITS {
            faults
                .push(format!("{count} limits of outputs; `--refine` keeps {MOST_LIMITS} at most"));
        }
        if faults.is_empty() { Ok(found) } else { Err(faults) }
    }

    fn add(&mut self, condition: &Condition) -> Result<(), String> {
        let Condition { name, limit, .. } = condition;
        let sides: &[Side] = match condition.comparison {
            Comparison::Less | Comparison::AtMost => &[Side::Upper],
            Comparison::More | Comparison::AtLeast => &[Side::Lower],
            Comparison::Equal => &[Side::Lower, Side::Upper],
            Comparison::Unequal => &[],
        };
        if name == OUTCOME.name || name == PERIOD.name {
            return Ok(());
        }
        if let Some(parameter) = Parameter::named(name) {
            if sides.is_empty() {
                return Err("`--refine` cannot leave out a value of a parameter".to_owned());
            }
            self.bounds.extend(sides.iter().map(|side| (parameter, *side, *limit)));
            return Ok(());
        }
        match (SMOOTH.iter().find(|it| it.name() == name), sides) {
            (Some(output), [side]) => {
                self.limits.push(Limit { output: *output, side: *side, value: *limit });
                Ok(())
            }
            (Some(_), _) => Err("`--refine` takes only < <= > >= of an output".to_owned()),
            (None, _) => {
                let outputs: Vec<&str> = SMOOTH.iter().map(|it| it.name()).collect();
                Err(format!(
                    "`--refine` cannot keep it between the cases; it takes parameters, `{}`, `{}` and {}",
                    OUTCOME.name,
                    PERIOD.name,
                    outputs.join(", ")
                ))
            }
        }
    }

    /// The part of a range of a parameter that is allowed.
    pub fn within(&self, parameter: Parameter, [low, high]: [f64; 2]) -> [f64; 2] {
        let bounds = self.bounds.iter().filter(|(it, ..)| *it == parameter);
        bounds.fold([low, high], |[low, high], (_, side, value)| match side {
            Side::Lower => [low.max(*value), high],
            Side::Upper => [low, high.min(*value)],
        })
    }

    /// Whether outputs keep all limits.
    pub fn allow(&self, outputs: &Outputs) -> bool {
        self.limits.iter().all(|limit| {
            let value = outputs[limit.output];
            limit.excess(value) <= KEPT * limit.value.abs().max(value.abs())
        })
    }

    /// All of them in JSON; nothing of none.
    pub fn described(&self) -> Option<Value> {
        let sign = |side: Side| if side == Side::Upper { "<=" } else { ">=" };
        let bounds = self.bounds.iter().map(|it| (it.0.symbol(), it.1, it.2));
        let limits = self.limits.iter().map(|it| (it.output.name(), it.side, it.value));
        let all: Vec<Value> = bounds
            .chain(limits)
            .map(|(name, side, value)| json!([name, sign(side), value]))
            .collect();
        (!all.is_empty()).then_some(Value::Array(all))
    }
}
