//! The rules a dataset keeps so that every reader of netCDF can open it, checked before writing.

use std::collections::BTreeSet;

use super::names::{CONVENTIONS, FORMAT};
use super::{Dataset, Values, Variable};

/// Every rule that `dataset` breaks, one sentence each; empty when it can be stored.
pub fn faults(dataset: &Dataset) -> Vec<String> {
    let mut found = Vec::new();
    check_names(dataset, &mut found);
    for (name, coordinate) in &dataset.coordinates {
        if coordinate.dimensions != [name.as_str()] {
            found.push(format!("coordinate {name}: its one dimension must be itself"));
        }
        check_variable(dataset, name, coordinate, &mut found);
    }
    for (name, variable) in &dataset.variables {
        check_variable(dataset, name, variable, &mut found);
    }
    for (name, words) in dataset.attributes.iter().chain(&dataset.texts) {
        check_text(name, words, &mut found);
    }
    found
}

fn check_names(dataset: &Dataset, found: &mut Vec<String>) {
    let coordinates = dataset.coordinates.iter().map(|(name, _)| name);
    let mut seen = BTreeSet::new();
    for name in coordinates.chain(dataset.variables.keys()).chain(dataset.texts.keys()) {
        if !seen.insert(name) {
            found.push(format!("{name}: the name is used twice"));
        }
    }
    for name in seen.into_iter().chain(dataset.attributes.keys()) {
        if !is_portable(name) {
            found.push(format!(
                "{name:?}: a name starts with a letter and has letters, digits, '_', '-' and '.'"
            ));
        }
    }
    for name in [CONVENTIONS, FORMAT] {
        if dataset.attributes.contains_key(name) {
            found.push(format!("attribute {name}: the file format writes this one itself"));
        }
    }
}

/// Readers differ on leading underscores, blanks and slashes, so names keep clear of them.
fn is_portable(name: &str) -> bool {
    name.starts_with(|first: char| first.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c))
}

fn check_variable(dataset: &Dataset, name: &str, variable: &Variable, found: &mut Vec<String>) {
    check_text(name, &variable.unit, found);
    check_text(name, &variable.long_name, found);
    let shape = variable.values.shape();
    if shape.len() != variable.dimensions.len() {
        let (has, named) = (shape.len(), variable.dimensions.len());
        found.push(format!("{name}: {has} dimensions in the numbers, {named} named"));
    }
    for (dimension, length) in variable.dimensions.iter().zip(shape) {
        match dataset.coordinate(dimension).map(|coordinate| coordinate.values.shape()) {
            None => found.push(format!("{name}: its dimension {dimension} has no coordinate")),
            Some(axis) if axis != [*length] => {
                found.push(format!("{name}: {length} along {dimension}, which has {axis:?}"));
            }
            Some(_) => {}
        }
    }
    check_flags(name, variable, found);
}

fn check_flags(name: &str, variable: &Variable, found: &mut Vec<String>) {
    if !variable.flags.is_empty() && matches!(variable.values, Values::Real(_)) {
        found.push(format!("{name}: flags belong to integers"));
    }
    for (value, meaning) in &variable.flags {
        check_text(name, meaning, found);
        if meaning.is_empty() || meaning.contains(char::is_whitespace) {
            found.push(format!("{name}: the meaning {meaning:?} of {value}: join words by '-'"));
        }
    }
}

fn check_text(name: &str, words: &str, found: &mut Vec<String>) {
    if words.contains('\0') {
        found.push(format!("{name}: a text with the character NUL in it"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::ArrayD;

    fn variable(dimensions: &[&str], length: usize) -> Variable {
        Variable {
            dimensions: dimensions.iter().map(|name| name.to_string()).collect(),
            unit: "1".into(),
            long_name: "a test".into(),
            values: Values::Integer(ArrayD::zeros(vec![length; dimensions.len()])),
            flags: Vec::new(),
        }
    }

    #[test]
    fn every_broken_rule_is_named_at_once() {
        let mut dataset = Dataset::default();
        dataset.coordinates.push(("omega".into(), variable(&["omega"], 3)));
        dataset.coordinates.push(("delta".into(), variable(&["omega"], 3)));
        dataset.variables.insert("omega".into(), variable(&["omega"], 3));
        dataset.variables.insert("short".into(), variable(&["omega"], 2));
        dataset.variables.insert("lost".into(), variable(&["p_d"], 2));
        dataset.variables.insert("a/b".into(), variable(&[], 0));
        let mut flagged = variable(&[], 0);
        flagged.flags.push((0, "not yet".into()));
        dataset.variables.insert("flagged".into(), flagged);
        dataset.attributes.insert("Conventions".into(), "mine".into());
        dataset.texts.insert("study".into(), "a\0b".into());
        let said = faults(&dataset).join("\n");
        for part in ["delta", "used twice", "short", "p_d", "a/b", "not yet", "Conventions", "NUL"]
        {
            assert!(said.contains(part), "{part} is missing from:\n{said}");
        }
        assert_eq!(faults(&dataset).len(), 8, "{said}");
    }
}
