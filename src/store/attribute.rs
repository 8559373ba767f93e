//! The attributes of variables and of a whole dataset, the same for every form in which it is handed out.

use super::catalogue::{
    CERTIFICATE, CYCLES, FAILURE_REASON, FAILURE_TIME, OUTCOME, PERIOD, neutral,
};
use super::element::Element;
use super::names::{
    CONVENTIONS, CONVENTIONS_FOLLOWED, COORDINATES, FLAG_MEANINGS, FLAG_VALUES, FORMAT,
    FORMAT_WRITTEN, LONG_NAME, OF_PROTOCOL, UNITS,
};
use super::{Dataset, Variable};

/// What a text kept beside the numbers has as its long name.
pub const TEXT_MEANING: &str = "text kept beside the numbers";

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    /// Words.
    Words(String),
    /// A whole number.
    Whole(i64),
    /// A real number.
    Real(f64),
    /// The integers that a category takes, in the type of the category.
    Flags(Vec<i64>),
}

/// The unit, the meaning and the flags of a variable, by the names of the attributes.
pub fn attributes_of(variable: &Variable) -> Vec<(&'static str, Attribute)> {
    let mut attributes = vec![
        (UNITS, Attribute::Words(variable.unit.clone())),
        (LONG_NAME, Attribute::Words(variable.long_name.clone())),
    ];
    if !variable.flags.is_empty() {
        let values = variable.flags.iter().map(|(value, _)| *value).collect();
        let meanings: Vec<&str> = variable.flags.iter().map(|(_, text)| text.as_str()).collect();
        attributes.push((FLAG_VALUES, Attribute::Flags(values)));
        attributes.push((FLAG_MEANINGS, Attribute::Words(meanings.join(" "))));
    }
    attributes
}

/// The attributes of a dataset, those first that every file has.
pub fn attributes_of_set(dataset: &Dataset) -> Vec<(&str, Attribute)> {
    let always = [(CONVENTIONS, CONVENTIONS_FOLLOWED), (FORMAT, FORMAT_WRITTEN)];
    let always = always.map(|(name, words)| (name, Attribute::Words(words.to_owned())));
    let own = dataset.attributes.iter().map(|(name, words)| (name.as_str(), number(name, words)));
    always.into_iter().chain(own).collect()
}

/// Whether an attribute is one that every file has of its format, and none of the dataset in it.
pub fn is_of_format(name: &str) -> bool {
    [CONVENTIONS, FORMAT, COORDINATES].contains(&name)
}

/// An attribute of the protocol as a number where it is one, any other as it is.
pub(super) fn number(name: &str, words: &str) -> Attribute {
    let of_protocol = name.starts_with(OF_PROTOCOL);
    if let (true, Ok(whole)) = (of_protocol, words.parse()) {
        return Attribute::Whole(whole);
    }
    if let (true, Ok(real)) = (of_protocol, words.parse()) {
        return Attribute::Real(real);
    }
    Attribute::Words(words.to_owned())
}

/// Whether a number of a variable of this name and type stands for a missing one: NaN of reals, and 0 of the period, which no
/// motion has.
pub fn has_missing(name: &str, element: Element) -> bool {
    element == Element::Real || name == PERIOD.name
}

/// What is the same for all cases, variables and texts: readers keep it as coordinates.
pub fn constants(dataset: &Dataset) -> Vec<&str> {
    let constants = dataset.variables.iter().filter(|(_, it)| it.dimensions.is_empty());
    constants.map(|(name, _)| name).chain(dataset.texts.keys()).map(String::as_str).collect()
}

/// The same of a dataset that has its cases, too: where nothing varies, what is told of the one case is no constant.
pub fn constants_beside_cases(dataset: &Dataset) -> Vec<&str> {
    let model = dataset.model();
    let mut of_case = vec![OUTCOME, PERIOD, CYCLES, FAILURE_REASON, FAILURE_TIME, CERTIFICATE];
    of_case.extend(neutral(model));
    let is_of_case =
        |name: &str| of_case.iter().any(|it| it.name == name) || model.output(name).is_some();
    constants(dataset).into_iter().filter(|name| !is_of_case(name)).collect()
}
