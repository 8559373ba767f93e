//! What a study gives or varies without effect on its motion, under what it chooses of its model.

use super::axis::range;
use super::{Axis, Continuation, Coordinate, Study, Varying};
use crate::description::{Parameter, Parameters, Threshold};

impl Study {
    /// The axes and draws of which several values give the same motion, each with the reason, in a sentence.
    pub fn varied_without_effect(&self) -> Vec<String> {
        let of_axes = self.axes().iter().filter_map(|axis| self.why_without_effect(axis));
        let drawn = match self.axes() {
            [] => self.case_set.varied(),
            _ => Vec::new(),
        };
        let of_draws = drawn.into_iter().filter_map(|it| self.why_idle(it));
        of_axes.chain(of_draws).collect()
    }

    /// What has no effect at the values of the study, in sentences, as far as it varies none of the parameters that are concerned.
    pub fn remarks_on_values(&self) -> Vec<String> {
        let varied = self.case_set.varied();
        let mut remarks = (self.base.model().rules.remarks)(&self.with_parts());
        remarks.retain(|remark| {
            remark.about.iter().all(|it| !varied.contains(&Coordinate::Parameter(*it)))
        });
        remarks.into_iter().map(|it| it.text).collect()
    }

    /// The branches and ramps along which orbits stay the same, at least in a part, each with the reason, in a sentence.
    pub fn branches_without_effect(&self) -> Vec<String> {
        let mut all = Vec::new();
        for branch in &self.branches {
            let second = branch.second.map(|(parameter, [low, _])| (parameter, low));
            let varied = [(branch.along, branch.range[0])].into_iter().chain(second);
            let reasons = varied.filter_map(|(it, low)| self.why_idle_along(branch, it, low));
            all.extend(reasons.map(|why| {
                format!("branch `{}`: {why}; its orbits stay the same there", branch.name)
            }));
        }
        for ramp in &self.ramps {
            let (name, along) = (&ramp.name, ramp.along.symbol());
            let reason = self.reason(ramp.along);
            all.extend(reason.map(|why| format!("ramp `{name}`: {along} has no effect {why}")));
        }
        all
    }

    /// That a parameter which a branch varies from `low` on has no effect, at least in a part of the branch.
    fn why_idle_along(
        &self,
        branch: &Continuation,
        parameter: Parameter,
        low: f64,
    ) -> Option<String> {
        match self.reason(parameter) {
            Some(reason) => Some(format!("{} has no effect {reason}", parameter.symbol())),
            None => idle_below(parameter, &self.threshold(&branch.parameters, parameter)?, low),
        }
    }

    fn why_without_effect(&self, axis: &Axis) -> Option<String> {
        let Some(Varying { coordinate, values }) = axis.single() else {
            return self.why_idle_along_path(axis);
        };
        let Coordinate::Parameter(parameter) = *coordinate else { return None };
        self.why_idle(*coordinate).or_else(|| self.idle_values(axis, parameter, values))
    }

    /// That what varies along a path has no effect, in a part or all of it.
    fn why_idle_along_path(&self, axis: &Axis) -> Option<String> {
        let parameters = axis.coordinates().filter_map(|it| match it {
            Coordinate::Parameter(parameter) => Some((parameter, self.reason(parameter)?)),
            _ => None,
        });
        let idle: Vec<(Parameter, String)> = parameters.collect();
        let told = idle.iter().map(|(it, why)| format!("{} has no effect {why}", it.symbol()));
        let told: Vec<String> = told.collect();
        let all = match idle.len() == axis.varying.len() {
            true => format!("; all places of {} give the same motion", axis.name()),
            false => String::new(),
        };
        (!told.is_empty()).then(|| format!("{}{all}", told.join("; ")))
    }

    /// That all values of a coordinate give the same motion.
    fn why_idle(&self, coordinate: Coordinate) -> Option<String> {
        let Coordinate::Parameter(parameter) = coordinate else { return None };
        let (name, reason) = (parameter.symbol(), self.reason(parameter)?);
        Some(format!("{name} has no effect {reason}; all its values give the same motion"))
    }

    /// Whether a parameter has an effect by what the study chooses.
    pub fn has_effect(&self, parameter: Parameter) -> bool {
        self.reason(parameter).is_none()
    }

    /// Why a parameter has no effect by what the study chooses, whatever its value, as what follows "has no effect".
    fn reason(&self, parameter: Parameter) -> Option<String> {
        (self.base.model().rules.no_effect)(&self.with_parts(), parameter)
    }

    /// The value below which a parameter has no effect beside others.
    fn threshold(&self, beside: &Parameters, parameter: Parameter) -> Option<Threshold> {
        (self.base.model().rules.no_effect_below)(beside, parameter)
    }

    /// That several values of an axis have no effect, beside all values of the other axes.
    fn idle_values(&self, axis: &Axis, parameter: Parameter, values: &[f64]) -> Option<String> {
        let mut beside = vec![self.base.clone()];
        for other in self.axes().iter().filter(|it| it.name() != axis.name()) {
            let at_ends = other.extremes().into_iter().map(|place| parameters_at(other, place));
            beside = at_ends
                .flat_map(|of_end| {
                    beside.iter().map(move |it| {
                        let mut it = it.clone();
                        of_end.iter().for_each(|(parameter, value)| it[*parameter] = *value);
                        it
                    })
                })
                .collect();
        }
        let limits = beside.iter().map(|it| self.threshold(it, parameter));
        let limits: Vec<Threshold> = limits.collect::<Option<_>>()?;
        let least = limits.into_iter().min_by(|a, b| a.value.total_cmp(&b.value))?;
        let idle = values.iter().filter(|value| **value < least.value).count();
        let why = idle_below(parameter, &least, range(values)[0]).filter(|_| idle > 1)?;
        let all = values.len();
        Some(format!("{why}; {idle} of its {all} values give the same motion"))
    }
}

/// The parameters that vary along an axis with their values at a place.
fn parameters_at(axis: &Axis, place: usize) -> Vec<(Parameter, f64)> {
    let varying = axis.varying.iter().filter_map(|it| match it.coordinate {
        Coordinate::Parameter(parameter) => Some((parameter, it.values[place])),
        _ => None,
    });
    varying.collect()
}

/// Those of some parameters that have no effect by what is chosen and given, in sentences, one for each reason.
pub fn given_without_effect(parameters: &Parameters, given: &[Parameter]) -> Vec<String> {
    let mut reasons: Vec<(String, Vec<&str>)> = Vec::new();
    for parameter in given {
        let reason = (parameters.model().rules.no_effect)(parameters, *parameter);
        let Some(reason) = reason else { continue };
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, names)) => names.push(parameter.symbol()),
            None => reasons.push((reason, vec![parameter.symbol()])),
        }
    }
    let told = |(reason, names): (String, Vec<&str>)| match &names[..] {
        [one] => format!("{one} has no effect {reason}"),
        all => format!("{} have no effect {reason}", all.join(", ")),
    };
    reasons.into_iter().map(told).collect()
}

/// That a parameter has no effect in a part of what is above `low`.
fn idle_below(parameter: Parameter, limit: &Threshold, low: f64) -> Option<String> {
    let Threshold { value, in_words, why } = limit;
    let name = parameter.symbol();
    (low < *value).then(|| format!("{name} has no effect below {in_words} = {value}, {why}"))
}
