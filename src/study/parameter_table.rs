//! What a study file says of its parameters: `[parameters]`, with what is chosen beside their values.

use super::Coordinate;
use super::document::Table;
use crate::description::{Parameter, Parameters};

/// Reads `[parameters]` of a study that varies some coordinates, and says what it takes where the table leaves it open.
pub(super) fn read_parameters(
    top: &Table<'_, '_>,
    varied: &[Coordinate],
) -> (Parameters, Vec<String>) {
    let model = top.model();
    let mut parameters = Parameters::of(model);
    let mut given = Vec::new();
    let table = top.table("parameters");
    let on_axis = |parameter: Parameter| varied.contains(&Coordinate::Parameter(parameter));
    for parameter in model.parameters() {
        let entry = table.as_ref().and_then(|table| table.entry(parameter.symbol()));
        match entry {
            Some(entry) if on_axis(parameter) => entry.fault("is given here and on an axis"),
            Some(entry) => {
                let value = entry.allowed_quantity(parameter.dimension(), parameter.allowed());
                parameters[parameter] = value.unwrap_or(parameters[parameter]);
                given.push(parameter);
            }
            None if parameter.is_asked_for() && !on_axis(parameter) => {
                let expected = format!("a value for the {} here or an axis", parameter.meaning());
                top.missing(&format!("parameters.{}", parameter.symbol()), &expected);
            }
            None => {}
        }
    }
    let Some(table) = table else { return (parameters, Vec::new()) };
    for (choice, described) in model.choices.iter().enumerate() {
        if let Some(entry) = table.entry(described.name) {
            let options = described.options.iter().enumerate();
            let options: Vec<(&str, usize)> = options.map(|(place, name)| (*name, place)).collect();
            parameters.choose(choice, entry.one_of(described.noun, &options).unwrap_or_default());
        }
    }
    table.finish();
    let is_given = |parameter: Parameter| given.contains(&parameter);
    if let Some(missing) = (model.rules.missing)(&parameters, &is_given, &on_axis) {
        top.missing(&format!("parameters.{}", missing.parameter.symbol()), &missing.why);
        return (parameters, Vec::new());
    }
    let known = |parameter: Parameter| is_given(parameter) || on_axis(parameter);
    let completed = (model.rules.complete)(&mut parameters, &known);
    (parameters, completed.map(|it| it.why).into_iter().collect())
}
