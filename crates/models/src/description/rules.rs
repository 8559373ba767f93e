//! What a model says of values beside each other: which have no effect, and what is taken for those that are not given.

use super::{Parameter, Parameters};

/// A value below which a parameter has no effect, beside the other parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Threshold {
    /// The value (SI).
    pub value: f64,
    /// What it is, in the symbols of the model.
    pub in_words: String,
    /// Why, as what follows a comma.
    pub why: &'static str,
}

/// A parameter that is not given, and what is said of it.
#[derive(Debug, Clone, PartialEq)]
pub struct NotGiven {
    /// The parameter.
    pub parameter: Parameter,
    /// What is taken for it, or why it has to be given, in a sentence.
    pub why: String,
}

/// What is said of the values of some parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Remark {
    /// The parameters.
    pub about: Vec<Parameter>,
    /// What is said, in a sentence.
    pub text: String,
}

/// Whether a parameter is given, or is on an axis.
pub type Which<'a> = &'a dyn Fn(Parameter) -> bool;

/// What a model says of values beside each other.
#[derive(Debug, Clone, Copy)]
pub struct Rules {
    /// Why a parameter has no effect by what is chosen, whatever its value, as what follows "has no effect".
    pub no_effect: fn(&Parameters, Parameter) -> Option<String>,
    /// The value below which a parameter has no effect beside the others; none where it always has one.
    pub no_effect_below: fn(&Parameters, Parameter) -> Option<Threshold>,
    /// What has no effect at these values, and what else is to be said of them.
    pub remarks: fn(&Parameters) -> Vec<Remark>,
    /// What cannot be computed at these values, with the drive at a phase at the section [rad].
    pub conflicts: fn(&Parameters, f64) -> Vec<Remark>,
    /// Which member of its family the model is by what is chosen and given, in words; none where it is the usual one.
    pub member: fn(&Parameters) -> Option<String>,
    /// A parameter that has to be given, as another, which is on an axis, cannot stand for it; `given` and `on_axis` tell which are.
    pub missing: fn(&Parameters, Which<'_>, Which<'_>) -> Option<NotGiven>,
    /// Takes a value for a parameter that is not given from another that is; says which, if it did.
    pub complete: fn(&mut Parameters, Which<'_>) -> Option<NotGiven>,
}

impl Rules {
    /// Of a model whose parameters all have an effect, whatever the others are, and stand for no other.
    pub const NONE: Rules = Rules {
        no_effect: |_, _| None,
        no_effect_below: |_, _| None,
        remarks: |_| Vec::new(),
        conflicts: |_, _| Vec::new(),
        member: |_| None,
        missing: |_, _, _| None,
        complete: |_, _| None,
    };
}
