//! Says where two datasets differ: the proof, after writing, that a file holds what it should.

use std::collections::BTreeMap;

use super::{Dataset, Values, Variable};

/// The first difference between two datasets, in a phrase; `None` if they are the same to the bit.
///
/// A missing value (NaN) equals itself here, which `==` denies.
pub fn difference(left: &Dataset, right: &Dataset) -> Option<String> {
    let [names, others] = [left, right].map(coordinate_names);
    if names != others {
        return Some(format!("coordinates {names:?} and {others:?}"));
    }
    let coordinates = left.coordinates.iter().zip(&right.coordinates);
    coordinates
        .filter_map(|((name, a), (_, b))| variable_difference(name, a, b))
        .next()
        .or_else(|| variables_difference(&left.variables, &right.variables))
        .or_else(|| text_difference("attribute", &left.attributes, &right.attributes))
        .or_else(|| text_difference("text", &left.texts, &right.texts))
}

fn coordinate_names(dataset: &Dataset) -> Vec<&str> {
    dataset.coordinates.iter().map(|(name, _)| name.as_str()).collect()
}

fn variables_difference(
    left: &BTreeMap<String, Variable>,
    right: &BTreeMap<String, Variable>,
) -> Option<String> {
    if !left.keys().eq(right.keys()) {
        return Some(format!("variables {:?} and {:?}", left.keys(), right.keys()));
    }
    left.iter().find_map(|(name, a)| variable_difference(name, a, &right[name]))
}

fn text_difference(
    kind: &str,
    left: &BTreeMap<String, String>,
    right: &BTreeMap<String, String>,
) -> Option<String> {
    if !left.keys().eq(right.keys()) {
        return Some(format!("{kind}s {:?} and {:?}", left.keys(), right.keys()));
    }
    left.iter()
        .find(|(name, words)| right[*name] != **words)
        .map(|(name, _)| format!("{kind} {name}"))
}

fn variable_difference(name: &str, a: &Variable, b: &Variable) -> Option<String> {
    let what = if a.dimensions != b.dimensions || a.values.shape() != b.values.shape() {
        "the dimensions"
    } else if a.unit != b.unit || a.long_name != b.long_name || a.flags != b.flags {
        "the unit, long name or flags"
    } else if !same_values(&a.values, &b.values) {
        "the values"
    } else {
        return None;
    };
    Some(format!("{what} of {name}"))
}

fn same_values(a: &Values, b: &Values) -> bool {
    match (a, b) {
        (Values::Real(a), Values::Real(b)) => {
            a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits())
        }
        (Values::Integer(a), Values::Integer(b)) => a == b,
        _ => false,
    }
}
