//! The branches that a study asks for: periodic orbits, stable or not, continued in a parameter.

use crate::description::{Parameter, Parameters, Section, State};
use crate::motion::Setting;
use crate::motion::branch::Request;

/// How the first orbit of a branch is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstOrbit {
    /// The motion settles there.
    Settle,
    /// Newton's method leads there, be it stable or not.
    Newton {
        /// Its period [cycles].
        period: u64,
    },
}

/// A periodic orbit and the parameter in which it is continued.
#[derive(Debug, Clone, PartialEq)]
pub struct Continuation {
    /// Its name.
    pub name: String,
    /// The parameter to continue it in.
    pub along: Parameter,
    /// Where to stop, the lesser first.
    pub range: [f64; 2],
    /// The parameters at which the first orbit is looked for.
    pub parameters: Parameters,
    /// Where it is looked for.
    pub start: State,
    /// Phase of the drive at the start, from where the motion settles [rad].
    pub start_phase: f64,
    /// Phase of the drive at the section [rad].
    pub section_phase: f64,
    /// How it is found.
    pub first: FirstOrbit,
    /// How often to switch to the branch of twice the period.
    pub doublings: u32,
    /// A second parameter with its range, in which the special points are continued as curves.
    pub second: Option<(Parameter, [f64; 2])>,
    /// Where the curves stop in the first parameter, the lesser first; where the branch does if none is given. No study file gives one.
    pub curve_range: Option<[f64; 2]>,
    /// Longest step, as a share of the range.
    pub longest_step: f64,
    /// Points of a branch or curve at most.
    pub most_points: usize,
}

impl Continuation {
    /// The request to continue the orbit of `period` cycles near `section`.
    pub fn request(&self, section: Section, period: u64, tolerance: f64) -> Request {
        Request {
            setting: Setting { parameters: self.parameters.clone(), phase: self.section_phase },
            section,
            period,
            along: self.along,
            range: self.range,
            doublings: self.doublings,
            second: self.second,
            curve_range: self.curve_range,
            longest_step: self.longest_step,
            most_points: self.most_points,
            tolerance,
        }
    }

    /// The parameters that vary: the one of the branch, then the second.
    pub fn varied(&self) -> impl Iterator<Item = Parameter> + '_ {
        std::iter::once(self.along).chain(self.second.map(|(parameter, _)| parameter))
    }
}
