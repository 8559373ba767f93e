//! A capsule's parameters: a value for each, the law of resistance and the reading of the switching.

use std::fmt;
use std::ops::{Index, IndexMut};

use capsulemap_engine::flow::Metric;

use super::drag::Drag;
use super::parameter::Parameter;
use super::resistance::{Resistance, Switching};
use crate::quantity::Dimension;

/// A value for every parameter (SI), the law of resistance and the reading of the switching.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameters {
    values: [f64; Parameter::ALL.len()],
    /// Law of resistance to the capsule.
    pub resistance: Resistance,
    /// Reading of the switching between stick and slip.
    pub switching: Switching,
}

impl Default for Parameters {
    fn default() -> Self {
        Parameters {
            values: std::array::from_fn(|i| Parameter::ALL[i].default_value()),
            resistance: Resistance::default(),
            switching: Switching::default(),
        }
    }
}

impl Index<Parameter> for Parameters {
    type Output = f64;
    fn index(&self, parameter: Parameter) -> &f64 {
        &self.values[parameter as usize]
    }
}

impl IndexMut<Parameter> for Parameters {
    fn index_mut(&mut self, parameter: Parameter) -> &mut f64 {
        &mut self.values[parameter as usize]
    }
}

/// A parameter whose value is not allowed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fault {
    /// Which parameter.
    pub parameter: Parameter,
    /// The value it was given.
    pub value: f64,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault { parameter, value } = self;
        let (symbol, meaning) = (parameter.symbol(), parameter.meaning());
        let unit = match parameter.dimension() {
            Dimension::Number => String::new(),
            dimension => format!(" {}", dimension.unit()),
        };
        write!(f, "{symbol} ({meaning}) = {value}{unit}: must be {}", parameter.allowed())
    }
}

impl Parameters {
    /// The defaults, with these values (SI) in place of theirs.
    pub fn with(values: &[(Parameter, f64)]) -> Self {
        let mut parameters = Parameters::default();
        for &(parameter, value) in values {
            parameters[parameter] = value;
        }
        parameters
    }

    /// Every value that is not allowed.
    pub fn faults(&self) -> Vec<Fault> {
        Parameter::ALL
            .iter()
            .map(|&parameter| Fault { parameter, value: self[parameter] })
            .filter(|fault| !fault.parameter.allowed().admits(fault.value))
            .collect()
    }

    /// Period of the drive, `2 pi / omega` [s].
    pub fn drive_period(&self) -> f64 {
        2.0 * std::f64::consts::PI / self[Parameter::Omega]
    }

    /// How far two section points are apart: a displacement r counts as the velocity omega r, so that a section where y1 passes zero
    /// has a size too.
    pub fn metric(&self) -> Metric<3> {
        Metric { scales: [self[Parameter::Omega], 1.0, 1.0] }
    }

    /// Force needed to leave rest, f_b = max(f_s, f_d(0+)); zero in a medium [N].
    pub fn break_away(&self) -> f64 {
        self.drag().break_away
    }

    /// Completes the friction where one of mu_s and mu_d is `given` and the other is not: Coulomb's law knows one coefficient, so
    /// there the other takes its value. Returns which did.
    pub fn complete_friction(&mut self, given: impl Fn(Parameter) -> bool) -> Option<Parameter> {
        let (from, to) = match (given(Parameter::MuS), given(Parameter::MuD)) {
            (true, false) => (Parameter::MuS, Parameter::MuD),
            (false, true) => (Parameter::MuD, Parameter::MuS),
            _ => return None,
        };
        if self.resistance != Resistance::Coulomb {
            return None;
        }
        self[to] = self[from];
        Some(to)
    }

    /// What [`Parameters::complete_friction`] did, in a sentence.
    pub fn told_of_completed(&self, completed: Parameter) -> String {
        let other = if completed == Parameter::MuS { Parameter::MuD } else { Parameter::MuS };
        let [completed, other] = [completed, other].map(Parameter::symbol);
        let value = self[Parameter::MuD];
        format!(
            "{completed} is not given: Coulomb's law knows one coefficient, so {completed} = {other} = {value}"
        )
    }

    /// That mu_s has no effect, in a sentence, where the friction at the onset of sliding is larger and alone decides when rest
    /// ends. In Eq. (1) as printed mu_s always has one.
    pub fn idle_static_friction(&self) -> Option<String> {
        let drag = self.drag();
        let is_idle = self.switching == Switching::Filippov && drag.static_limit < drag.at_onset;
        let onset = self.resistance.onset_in_words();
        is_idle.then(|| {
            format!(
                "mu_s below {onset} has no effect; the capsule breaks away at {onset} (m1 + m2) g = {} N",
                drag.break_away
            )
        })
    }

    /// The law of resistance with its constants.
    pub fn drag(&self) -> Drag<f64> {
        Drag::new(|parameter| self[parameter], self.resistance)
    }

    /// Normal load, `(m1 + m2) g` [N].
    pub fn normal_load(&self) -> f64 {
        (self[Parameter::M1] + self[Parameter::M2]) * self[Parameter::G]
    }
}
