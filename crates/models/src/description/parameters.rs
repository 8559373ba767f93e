//! A value for every parameter of a model, and what is chosen beside them.

use std::f64::consts::PI;
use std::fmt::{self, Debug, Formatter};
use std::ops::{Index, IndexMut};

use super::{Description, Parameter};
use crate::quantity::Dimension;

/// A value for every parameter of a model (SI), and what is chosen beside them.
#[derive(Clone, PartialEq)]
pub struct Parameters {
    model: &'static Description,
    values: Vec<f64>,
    chosen: Vec<usize>,
}

/// As fingerprints of studies have it.
impl Debug for Parameters {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut text = f.debug_struct("Parameters");
        text.field("values", &self.values);
        for (choice, option) in self.model.choices.iter().zip(&self.chosen) {
            text.field(choice.tag, &format_args!("{}", choice.option_tags[*option]));
        }
        text.finish()
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
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
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
    /// The defaults of a model.
    pub fn of(model: &'static Description) -> Parameters {
        let values = model.parameters.iter().map(|it| it.default).collect();
        Parameters { model, values, chosen: vec![0; model.choices.len()] }
    }

    /// The model whose parameters they are.
    pub fn model(&self) -> &'static Description {
        self.model
    }

    /// Every parameter with its value (SI).
    pub fn each(&self) -> impl Iterator<Item = (Parameter, f64)> + '_ {
        self.model.parameters().zip(self.values.iter().copied())
    }

    /// The period of the drive [s]; none of a model without one.
    pub fn period_of_drive(&self) -> Option<f64> {
        Some(2.0 * PI / self[self.model.drive_frequency()?])
    }

    /// Every value that is not allowed.
    pub fn faults(&self) -> Vec<Fault> {
        let faults = self.each().map(|(parameter, value)| Fault { parameter, value });
        faults.filter(|it| !it.parameter.allowed().admits(it.value)).collect()
    }

    /// What is chosen at a place among the choices of the model, as the place among its options.
    pub fn chosen(&self, choice: usize) -> usize {
        self.chosen[choice]
    }

    /// Chooses the option at a place for the choice at another.
    pub fn choose(&mut self, choice: usize, option: usize) {
        self.chosen[choice] = option;
    }

    /// Each choice of the model by its name, with the name of what is chosen.
    pub fn choices(&self) -> impl Iterator<Item = (&'static str, &'static str)> + '_ {
        let both = self.model.choices.iter().zip(&self.chosen);
        both.map(|(choice, option)| (choice.name, choice.options[*option]))
    }
}

/// Of the model's own parameters.
///
/// # Panics
/// Where the parameter is that of another model.
impl<P: Into<Parameter>> Index<P> for Parameters {
    type Output = f64;
    fn index(&self, parameter: P) -> &f64 {
        &self.values[place(self.model, parameter.into())]
    }
}

impl<P: Into<Parameter>> IndexMut<P> for Parameters {
    fn index_mut(&mut self, parameter: P) -> &mut f64 {
        &mut self.values[place(self.model, parameter.into())]
    }
}

/// The place of a parameter of a model.
fn place(model: &'static Description, parameter: Parameter) -> usize {
    assert!(parameter.model() == model, "{} is no parameter of {}", parameter.symbol(), model.name);
    parameter.index()
}
