//! The numbers that sum up a case of a model.

use std::fmt::{self, Debug, Formatter};
use std::ops::{Index, IndexMut};

use super::Description;
use crate::quantity::{Dimension, Quantity};

/// Which studies keep an output where they name none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// Each.
    Always,
    /// Those whose equations have something that is optional.
    WithParts,
    /// Those that ask for all exponents.
    WithExponents,
    /// Those that want the error of a mean.
    WithMeanError,
}

/// What a model says of an output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputDescription {
    /// The quantity that it is.
    pub quantity: Quantity,
    /// What fingerprints of studies know it by, which files keep: it stays whatever else is called anew.
    pub tag: &'static str,
    /// Whether it changes smoothly along a family of orbits with the same events, so that it has derivatives in the parameters.
    pub is_smooth: bool,
    /// Which studies keep it where they name none.
    pub kept: Kept,
}

/// A number that sums up a case of a model.
#[derive(Clone, Copy)]
pub struct Output {
    model: &'static Description,
    index: usize,
}

/// An output that a model has from another is the same.
impl PartialEq for Output {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index && self.model.shares_with(other.model)
    }
}

impl Eq for Output {}

/// As fingerprints of studies have it.
impl Debug for Output {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.model.outputs[self.index].tag)
    }
}

impl Output {
    /// The output of a model at a place among its outputs.
    pub const fn of(model: &'static Description, index: usize) -> Output {
        Output { model, index }
    }

    /// The model that has it.
    pub const fn model(self) -> &'static Description {
        self.model
    }

    /// Its place among the outputs of its model.
    pub const fn index(self) -> usize {
        self.index
    }

    /// It as a quantity.
    pub fn quantity(self) -> Quantity {
        self.model.outputs[self.index].quantity
    }

    /// Whether it changes smoothly along a family of orbits with the same events, so that it has derivatives in the parameters.
    pub fn is_smooth(self) -> bool {
        self.model.outputs[self.index].is_smooth
    }

    /// Which studies keep it where they name none.
    pub fn kept(self) -> Kept {
        self.model.outputs[self.index].kept
    }

    /// Whether not all of these keep it.
    pub fn is_optional(self) -> bool {
        self.kept() != Kept::Always
    }

    /// The name used in studies and files.
    pub fn name(self) -> &'static str {
        self.quantity().name
    }

    /// Its dimension.
    pub fn dimension(self) -> Dimension {
        self.quantity().dimension
    }

    /// What it is, in a phrase.
    pub fn meaning(self) -> &'static str {
        self.quantity().meaning
    }

    /// Its unit; "1" where it has none.
    pub fn unit(self) -> &'static str {
        self.dimension().unit()
    }
}

/// A value for every output of a model (SI).
#[derive(Clone)]
pub struct Outputs {
    model: &'static Description,
    pub(super) values: Box<[f64]>,
}

/// What is unknown in both is equal.
impl PartialEq for Outputs {
    fn eq(&self, other: &Self) -> bool {
        let mut pairs = self.values.iter().zip(&other.values);
        self.model == other.model
            && self.values.len() == other.values.len()
            && pairs.all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
    }
}

impl Debug for Outputs {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Outputs").field(&self.values).finish()
    }
}

impl Outputs {
    /// The outputs with these values, in the order of the model.
    ///
    /// # Panics
    /// Where there is not one for each.
    pub fn new(model: &'static Description, values: &[f64]) -> Outputs {
        assert!(values.len() == model.outputs.len(), "a value for each output of {}", model.name);
        Outputs { model, values: values.into() }
    }

    /// Nothing known: NaN everywhere.
    pub fn unknown(model: &'static Description) -> Outputs {
        Outputs { model, values: vec![f64::NAN; model.outputs.len()].into() }
    }

    /// The model whose outputs they are.
    pub fn model(&self) -> &'static Description {
        self.model
    }

    /// What the motion gains (SI).
    ///
    /// # Panics
    /// Where motions of the model gain nothing.
    pub fn speed(&self) -> f64 {
        self[self.model.speed()]
    }

    /// The output that is shown where no other is asked for (SI).
    pub fn main(&self) -> f64 {
        self[self.model.main_output()]
    }

    /// The same outputs with other values.
    pub fn map(&self, each: impl Fn(f64) -> f64) -> Outputs {
        Outputs { model: self.model, values: self.values.iter().copied().map(each).collect() }
    }

    /// Every output with its value.
    pub fn each(&self) -> impl Iterator<Item = (Output, f64)> + '_ {
        self.model.outputs().zip(self.values.iter().copied())
    }
}

/// Of the model's own outputs.
///
/// # Panics
/// Where the output is that of another model.
impl<O: Into<Output>> Index<O> for Outputs {
    type Output = f64;
    fn index(&self, output: O) -> &f64 {
        &self.values[place(self.model, output.into())]
    }
}

impl<O: Into<Output>> IndexMut<O> for Outputs {
    fn index_mut(&mut self, output: O) -> &mut f64 {
        &mut self.values[place(self.model, output.into())]
    }
}

/// The place of an output of a model.
fn place(model: &'static Description, output: Output) -> usize {
    assert!(output.model().shares_with(model), "{} is no output of {}", output.name(), model.name);
    output.index()
}
