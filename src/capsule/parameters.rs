//! A capsule's parameters: a value for each, the law of resistance and the reading of the switching.

use std::fmt;
use std::ops::{Index, IndexMut};

use super::drag::Drag;
use super::parameter::{Dimension, Parameter};
use super::resistance::{Resistance, Switching};

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

    /// Force needed to leave rest, f_b = max(f_s, f_d(0+)); zero in a medium [N].
    pub fn break_away(&self) -> f64 {
        self.drag().break_away
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
