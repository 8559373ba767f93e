//! What varies in a study without effect on its motion, under what it chooses of its model.

use super::axis::range;
use super::{Axis, Continuation, Coordinate, Study};
use crate::description::{Parameter, Parameters, Threshold};

impl Study {
    /// The axes of which several values give the same motion, each with the reason, in a sentence.
    pub fn axes_without_effect(&self) -> Vec<String> {
        self.axes().iter().filter_map(|axis| self.why_without_effect(axis)).collect()
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

    /// The branches along which orbits stay the same, at least in a part, each with the reason, in a sentence.
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
        let Coordinate::Parameter(parameter) = axis.coordinate else { return None };
        match self.reason(parameter) {
            Some(reason) if axis.values.len() > 1 => {
                let name = parameter.symbol();
                Some(format!("{name} has no effect {reason}; all its values give the same motion"))
            }
            Some(_) => None,
            None => self.idle_values(axis, parameter),
        }
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
    fn idle_values(&self, axis: &Axis, parameter: Parameter) -> Option<String> {
        let mut beside = vec![self.base.clone()];
        for other in self.axes().iter().filter(|it| it.coordinate != axis.coordinate) {
            let Coordinate::Parameter(other_parameter) = other.coordinate else { continue };
            beside = range(&other.values)
                .into_iter()
                .flat_map(|end| {
                    beside.iter().map(move |it| {
                        let mut it = it.clone();
                        it[other_parameter] = end;
                        it
                    })
                })
                .collect();
        }
        let limits = beside.iter().map(|it| self.threshold(it, parameter));
        let limits: Vec<Threshold> = limits.collect::<Option<_>>()?;
        let least = limits.into_iter().min_by(|a, b| a.value.total_cmp(&b.value))?;
        let idle = axis.values.iter().filter(|value| **value < least.value).count();
        let why = idle_below(parameter, &least, range(&axis.values)[0]).filter(|_| idle > 1)?;
        let all = axis.values.len();
        Some(format!("{why}; {idle} of its {all} values give the same motion"))
    }
}

/// That a parameter has no effect in a part of what is above `low`.
fn idle_below(parameter: Parameter, limit: &Threshold, low: f64) -> Option<String> {
    let Threshold { value, in_words, why } = limit;
    let name = parameter.symbol();
    (low < *value).then(|| format!("{name} has no effect below {in_words} = {value}, {why}"))
}
