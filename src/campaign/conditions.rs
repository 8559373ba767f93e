//! What conditions on cases ask of the motions between them.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use crate::description::{Description, Output, Outputs, Parameter, Parameters};
use crate::orbit::Outcome;
use crate::store::catalogue::{OUTCOME, PERIOD};
use crate::store::{Comparison, Condition};
use crate::study::{Axis, Study};
use crate::tradeoff::{Limit, MOST_LIMITS, Side};

/// A limit is kept to this share of it.
const KEPT: f64 = 1e-8;

/// Why no motions are sought between cases that lie along a path, where each parameter would be moved by itself.
pub fn along_path(study: &Study) -> Option<String> {
    let path = study.axes().iter().find(|axis| axis.path.is_some()).map(Axis::name)?;
    Some(format!(
        "`--refine` moves each parameter by itself, and these cases lie along the path `{path}`: leave it out"
    ))
}

/// Conditions on motions between the cases.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Conditions {
    /// All conditions in the form of [`Condition::normal`], each once, in their order.
    pub normal: Vec<String>,
    /// Limits of outputs.
    pub limits: Vec<Limit>,
    /// What the period may be, each with its limit [cycles].
    pub periods: Vec<(Comparison, f64)>,
    /// Whether motions may not be periodic, so that none can be sought.
    pub excludes_periodic: bool,
    /// Bounds of parameters (SI).
    pub bounds: Vec<(Parameter, Side, f64)>,
}

impl Conditions {
    /// What conditions on cases ask of motions that lie between them: bounds of parameters and limits of outputs, which may be reached.
    /// The period and the outcome of a motion are those of the case that it is followed from.
    ///
    /// Fails with all conditions that cannot be kept between the cases.
    pub fn of(
        conditions: &[Condition],
        model: &'static Description,
    ) -> Result<Conditions, Vec<String>> {
        let mut found = Conditions { normal: normal(conditions), ..Conditions::default() };
        let mut faults = Vec::new();
        for condition in conditions {
            if let Err(fault) = found.add(condition, model) {
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

    fn add(&mut self, condition: &Condition, model: &'static Description) -> Result<(), String> {
        let Condition { name, limit, .. } = condition;
        let sides: &[Side] = match condition.comparison {
            Comparison::Less | Comparison::AtMost => &[Side::Upper],
            Comparison::More | Comparison::AtLeast => &[Side::Lower],
            Comparison::Equal => &[Side::Lower, Side::Upper],
            Comparison::Unequal => &[],
        };
        if name == PERIOD.name {
            self.periods.push((condition.comparison, *limit));
            return Ok(());
        }
        if name == OUTCOME.name {
            let code = condition.code(Outcome::Periodic.name());
            self.excludes_periodic |= !condition.comparison.holds(code, *limit);
            return Ok(());
        }
        if let Some(parameter) = model.parameter(name) {
            if sides.is_empty() {
                return Err("`--refine` cannot leave out a value of a parameter".to_owned());
            }
            self.bounds.extend(sides.iter().map(|side| (parameter, *side, *limit)));
            return Ok(());
        }
        self.limits.push(limit_of_output(condition, sides, model)?);
        Ok(())
    }

    /// The part of a range of a parameter that is allowed.
    pub fn within(&self, parameter: Parameter, [low, high]: [f64; 2]) -> [f64; 2] {
        let bounds = self.bounds.iter().filter(|(it, ..)| *it == parameter);
        bounds.fold([low, high], |[low, high], (_, side, value)| match side {
            Side::Lower => [low.max(*value), high],
            Side::Upper => [low, high.min(*value)],
        })
    }

    /// Whether a search may begin with a motion that has these parameters and this period: limits of outputs, to which a search comes back,
    /// may be exceeded.
    pub fn may_begin(&self, parameters: &Parameters, period: u64) -> bool {
        let mut bounds = self.bounds.iter();
        let mut periods = self.periods.iter();
        !self.excludes_periodic
            && bounds.all(|(parameter, side, value)| match side {
                Side::Lower => parameters[*parameter] >= *value,
                Side::Upper => parameters[*parameter] <= *value,
            })
            && periods.all(|(comparison, limit)| comparison.holds(period as f64, *limit))
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
        (!self.normal.is_empty()).then(|| json!(self.normal))
    }
}

/// The limit of an output on these sides; fails with what can be kept where that is none.
fn limit_of_output(
    condition: &Condition,
    sides: &[Side],
    model: &'static Description,
) -> Result<Limit, String> {
    let smooth: Vec<Output> = model.outputs().filter(|it| it.is_smooth()).collect();
    match (smooth.iter().find(|it| it.name() == condition.name), sides) {
        (Some(&output), &[side]) => Ok(Limit { output, side, value: condition.limit }),
        (Some(_), _) => Err("`--refine` takes only < <= > >= of an output".to_owned()),
        (None, _) => {
            let outputs: Vec<&str> = smooth.iter().map(|it| it.name()).collect();
            Err(format!(
                "`--refine` cannot keep it between the cases; it takes parameters, `{}`, `{}` and {}",
                OUTCOME.name,
                PERIOD.name,
                outputs.join(", ")
            ))
        }
    }
}

/// Conditions in the form of [`Condition::normal`], each once, in their order: those who ask for the same have the same.
pub(super) fn normal(conditions: &[Condition]) -> Vec<String> {
    let found: BTreeSet<String> = conditions.iter().map(Condition::normal).collect();
    found.into_iter().collect()
}
