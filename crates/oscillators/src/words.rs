//! Descriptions of what has no unit.

use capsulemap_models::description::{
    Description, Kept, Output, OutputDescription, Outputs, ParameterDescription, Presence,
};
use capsulemap_models::quantity::{Allowed, Dimension, Quantity};

/// A quantity without a unit.
pub const fn number(name: &'static str, meaning: &'static str) -> Quantity {
    Quantity { name, dimension: Dimension::Number, meaning, shown: None }
}

/// A parameter without a unit.
pub const fn parameter(
    (name, tag): (&'static str, &'static str),
    meaning: &'static str,
    (allowed, default): (Allowed, f64),
) -> ParameterDescription {
    ParameterDescription {
        quantity: number(name, meaning),
        tag,
        allowed,
        default,
        is_asked_for: false,
        presence: Presence::Always,
        replaces: None,
    }
}

/// An output without a unit.
pub const fn output(
    (name, tag): (&'static str, &'static str),
    meaning: &'static str,
) -> OutputDescription {
    OutputDescription { quantity: number(name, meaning), tag, is_smooth: false, kept: Kept::Always }
}

/// The outputs of a model with these values, in the order of its description.
pub fn outputs_of(model: &'static Description, values: &[f64]) -> Outputs {
    let mut outputs = Outputs::unknown(model);
    for (index, value) in values.iter().enumerate() {
        outputs[Output::of(model, index)] = *value;
    }
    outputs
}
