//! A parameter of a model, with what the model says of it.

use std::fmt::{self, Debug, Formatter};

use super::Description;
use crate::quantity::{Allowed, Dimension, Quantity};

/// What a model says of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParameterDescription {
    /// The quantity that it is.
    pub quantity: Quantity,
    /// What fingerprints of studies know it by, which files keep: it stays whatever else is called anew.
    pub tag: &'static str,
    /// What values it may take.
    pub allowed: Allowed,
    /// Its value where none is given (SI).
    pub default: f64,
    /// Whether a study has to say what it is.
    pub is_asked_for: bool,
    /// Where the equations have it, and where it is told of.
    pub presence: Presence,
    /// The place of the parameter in whose stead it is given, if there is one.
    pub replaces: Option<usize>,
}

/// Where the equations of a model have a parameter, and where it is told of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// They always have it.
    Always,
    /// They have it where it is given; it is always told of.
    Told,
    /// They have it where it is given, and only there it is told of.
    Optional,
}

/// A parameter of a model.
#[derive(Clone, Copy)]
pub struct Parameter {
    model: &'static Description,
    index: usize,
}

/// A parameter that a model has from another is the same.
impl PartialEq for Parameter {
    fn eq(&self, other: &Self) -> bool {
        self.index == other.index && self.model.shares_with(other.model)
    }
}

impl Eq for Parameter {}

/// As fingerprints of studies have it.
impl Debug for Parameter {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.described().tag)
    }
}

impl Parameter {
    /// The parameter of a model at a place among its parameters.
    pub const fn of(model: &'static Description, index: usize) -> Parameter {
        Parameter { model, index }
    }

    /// The model that has it.
    pub const fn model(self) -> &'static Description {
        self.model
    }

    /// Its place among the parameters of its model.
    pub const fn index(self) -> usize {
        self.index
    }

    fn described(self) -> &'static ParameterDescription {
        &self.model.parameters[self.index]
    }

    /// It as a quantity.
    pub fn quantity(self) -> Quantity {
        self.described().quantity
    }

    /// The symbol used in studies, on the command line and in files.
    pub fn symbol(self) -> &'static str {
        self.described().quantity.name
    }

    /// Its dimension.
    pub fn dimension(self) -> Dimension {
        self.described().quantity.dimension
    }

    /// What it is, in a phrase.
    pub fn meaning(self) -> &'static str {
        self.described().quantity.meaning
    }

    /// What values it may take.
    pub fn allowed(self) -> Allowed {
        self.described().allowed
    }

    /// Whether a study has to say what it is.
    pub fn is_asked_for(self) -> bool {
        self.described().is_asked_for
    }

    /// The parameter in whose stead it is given, if there is one.
    pub fn replaces(self) -> Option<Parameter> {
        self.described().replaces.map(|index| Parameter::of(self.model, index))
    }

    /// Those that may be given in its stead.
    pub fn replaced_by(self) -> impl Iterator<Item = Parameter> {
        self.model.parameters().filter(move |it| it.replaces() == Some(self))
    }

    /// Where the equations have it, and where it is told of.
    pub fn presence(self) -> Presence {
        self.described().presence
    }

    /// Its value where none is given (SI).
    pub fn default_value(self) -> f64 {
        self.described().default
    }
}
