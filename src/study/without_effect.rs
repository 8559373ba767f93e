//! What varies in a study without effect on its motion, under its law of resistance.

use crate::capsule;
use crate::capsule::CapsuleParameters as _;
use crate::capsule::Resistance;
use crate::description::Parameter;

use super::axis::range;
use super::{Axis, Continuation, Coordinate, Study};

impl Study {
    /// The axes of which several values give the same motion, each with the reason, in a sentence.
    pub fn axes_without_effect(&self) -> Vec<String> {
        self.axes().iter().filter_map(|axis| self.why_without_effect(axis)).collect()
    }

    /// That mu_s has no effect, in a sentence, where neither coefficient of friction varies and the study gives too little of it.
    pub fn idle_static_friction(&self) -> Option<String> {
        let varies = |it: &Coordinate| {
            [capsule::Parameter::MuS, capsule::Parameter::MuD]
                .map(|it| Coordinate::Parameter(it.into()))
                .contains(it)
        };
        let is_constant = !self.case_set.varied().iter().any(varies);
        self.base.idle_static_friction().filter(|_| is_constant)
    }

    /// The branches along which orbits stay the same, at least in a part, each with the reason, in a sentence.
    pub fn branches_without_effect(&self) -> Vec<String> {
        let each = |branch: &Continuation| {
            let second = branch.second.map(|(parameter, [low, _])| (parameter, low));
            let varied = [(branch.along, branch.range[0])].into_iter().chain(second);
            let why = |(parameter, low)| {
                let why = match self.reason(parameter) {
                    Some(reason) => self.unfelt(parameter, reason),
                    None if parameter == capsule::Parameter::MuS => {
                        self.idle_below(branch.parameters[capsule::Parameter::MuD], low)?
                    }
                    None => return None,
                };
                Some(format!("branch `{}`: {why}; its orbits stay the same there", branch.name))
            };
            varied.filter_map(why).collect::<Vec<String>>()
        };
        self.branches.iter().flat_map(each).collect()
    }

    fn why_without_effect(&self, axis: &Axis) -> Option<String> {
        let Coordinate::Parameter(parameter) = axis.coordinate else { return None };
        match self.reason(parameter) {
            Some(reason) if axis.values.len() > 1 => {
                let why = self.unfelt(parameter, reason);
                Some(format!("{why}; all its values give the same motion"))
            }
            None if parameter == capsule::Parameter::MuS => self.too_little_static_friction(axis),
            _ => None,
        }
    }

    /// Whether a parameter has an effect under the law of resistance.
    pub fn has_effect(&self, parameter: Parameter) -> bool {
        self.reason(parameter).is_none()
    }

    /// Why a parameter has no effect under the law of resistance, whatever its value.
    fn reason(&self, parameter: Parameter) -> Option<&'static str> {
        match (capsule::Parameter::which(parameter), self.base.resistance()) {
            (
                capsule::Parameter::MuS | capsule::Parameter::MuD | capsule::Parameter::Vs,
                Resistance::Medium,
            ) => Some("a medium has no dry friction"),
            (capsule::Parameter::Vs, Resistance::Coulomb) => {
                Some("friction under this law does not depend on speed")
            }
            (
                capsule::Parameter::C1 | capsule::Parameter::C2,
                Resistance::Coulomb | Resistance::CoulombStribeck,
            ) => Some("it belongs to the law `medium` alone"),
            _ => None,
        }
    }

    /// That a parameter has no effect for a reason.
    fn unfelt(&self, parameter: Parameter, reason: &str) -> String {
        let (name, law) = (parameter.symbol(), self.base.resistance().name());
        format!("{name} has no effect under the law `{law}`: {reason}")
    }

    /// Static friction below which it has no effect, beside so much dynamic friction: rest ends where the force exceeds
    /// the friction at the onset of sliding.
    fn least_static_friction(&self, dynamic: f64) -> f64 {
        let factor = self.base.resistance().onset_factor();
        if self.base.switching().balances_at_rest() { factor * dynamic } else { 0.0 }
    }

    /// That static friction has no effect in a part of what is above `low`.
    fn idle_below(&self, dynamic: f64, low: f64) -> Option<String> {
        let limit = self.least_static_friction(dynamic);
        let (name, onset) =
            (capsule::Parameter::MuS.symbol(), self.base.resistance().onset_in_words());
        (low < limit).then(|| {
            format!(
                "{name} has no effect below {onset} = {limit}, where rest ends with the friction at the onset \
                 of sliding"
            )
        })
    }

    fn too_little_static_friction(&self, axis: &Axis) -> Option<String> {
        let least_dynamic = match self.axes().iter().find(|it| is_dynamic(it)) {
            Some(dynamic) => range(&dynamic.values)[0],
            None => self.base[capsule::Parameter::MuD],
        };
        let limit = self.least_static_friction(least_dynamic);
        let idle = axis.values.iter().filter(|mu_s| **mu_s < limit).count();
        let why = self.idle_below(least_dynamic, range(&axis.values)[0]).filter(|_| idle > 1)?;
        let all = axis.values.len();
        Some(format!("{why}; {idle} of its {all} values give the same motion"))
    }
}

fn is_dynamic(axis: &Axis) -> bool {
    axis.coordinate == Coordinate::Parameter(capsule::Parameter::MuD.into())
}
