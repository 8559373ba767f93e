//! What varies in a study without effect on its motion, under its law of resistance.

use crate::capsule::{Parameter, Resistance, Switching};

use super::axis::range;
use super::{Axis, Coordinate, Study};

impl Study {
    /// The axes of which several values give the same motion, each with the reason, in a sentence.
    pub fn without_effect(&self) -> Vec<String> {
        self.axes().iter().filter_map(|axis| self.why_without_effect(axis)).collect()
    }

    fn why_without_effect(&self, axis: &Axis) -> Option<String> {
        let Coordinate::Parameter(parameter) = axis.coordinate else { return None };
        let (name, law) = (parameter.symbol(), self.base.resistance);
        let reason = match (parameter, law) {
            (Parameter::MuS | Parameter::MuD | Parameter::Vs, Resistance::Medium) => {
                "a medium has no dry friction"
            }
            (Parameter::Vs, Resistance::Coulomb) => {
                "friction under this law does not depend on speed"
            }
            (Parameter::C1 | Parameter::C2, Resistance::Coulomb | Resistance::CoulombStribeck) => {
                "it belongs to the law `medium` alone"
            }
            (Parameter::MuS, _) if self.base.switching == Switching::Filippov => {
                return self.too_little_static_friction(axis);
            }
            _ => return None,
        };
        (axis.values.len() > 1).then(|| {
            let law = law.name();
            format!("{name} has no effect under the law `{law}`: {reason}; all its values give the same motion")
        })
    }

    /// Rest ends where the force exceeds the friction at the onset of sliding, if static friction is less than that.
    fn too_little_static_friction(&self, axis: &Axis) -> Option<String> {
        let least_dynamic = match self.axes().iter().find(|it| is_dynamic(it)) {
            Some(dynamic) => range(&dynamic.values)[0],
            None => self.base[Parameter::MuD],
        };
        let stribeck = self.base.resistance == Resistance::CoulombStribeck;
        let (times, factor) = if stribeck { ("2 ", 2.0) } else { ("", 1.0) };
        let idle = axis.values.iter().filter(|mu_s| **mu_s < factor * least_dynamic).count();
        (idle > 1).then(|| {
            let all = axis.values.len();
            let [limit, slides] = [Parameter::MuS, Parameter::MuD].map(Parameter::symbol);
            format!(
                "{limit} has no effect below {times}{slides} = {}, where rest ends with the friction at the onset of \
                 sliding; {idle} of its {all} values give the same motion",
                factor * least_dynamic
            )
        })
    }
}

fn is_dynamic(axis: &Axis) -> bool {
    axis.coordinate == Coordinate::Parameter(Parameter::MuD)
}
