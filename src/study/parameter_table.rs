//! What a study file says of its parameters: `[parameters]`, with what is chosen beside their values.

use super::Coordinate;
use super::document::Table;
use crate::description::{Parameter, Parameters};

/// What `[parameters]` of a study says.
pub(super) struct ParameterTable {
    /// The values.
    pub values: Parameters,
    /// The parameters that it gives.
    pub given: Vec<Parameter>,
    /// What is taken where it leaves something open, in sentences.
    pub remarks: Vec<String>,
}

/// Reads `[parameters]` of a study that varies some coordinates.
pub(super) fn read_parameters(top: &Table<'_, '_>, varied: &[Coordinate]) -> ParameterTable {
    let model = top.model();
    let mut values = Parameters::of(model);
    let table = top.table("parameters");
    if let Some(table) = &table {
        read_choices(table, &mut values);
    }
    let given = read_values(top, table.as_ref(), varied, &mut values);
    let mut read = ParameterTable { values, given, remarks: Vec::new() };
    let Some(table) = table else { return read };
    table.finish();
    let ParameterTable { values, given, remarks } = &mut read;
    let missing =
        (model.rules.missing)(values, &|it| given.contains(&it), &|it| varies(varied, it));
    if let Some(missing) = missing {
        top.missing(&format!("parameters.{}", missing.parameter.symbol()), &missing.why);
        return read;
    }
    let completed = (model.rules.complete)(values, &|it| given.contains(&it) || varies(varied, it));
    remarks.extend(completed.map(|it| it.why));
    read
}

/// Whether a parameter is among the coordinates that vary.
fn varies(varied: &[Coordinate], parameter: Parameter) -> bool {
    varied.contains(&Coordinate::Parameter(parameter))
}

/// Reads the values, and tells which are given.
fn read_values(
    top: &Table<'_, '_>,
    table: Option<&Table<'_, '_>>,
    varied: &[Coordinate],
    parameters: &mut Parameters,
) -> Vec<Parameter> {
    let mut given = Vec::new();
    let is_told = |it: Parameter| {
        varies(varied, it) || table.is_some_and(|table| table.entry(it.symbol()).is_some())
    };
    for parameter in top.model().parameters() {
        let on_axis = varies(varied, parameter);
        let in_its_stead = parameter.replaced_by().find(|it| is_told(*it));
        if let Some(other) = in_its_stead.filter(|_| is_told(parameter)) {
            let (symbol, other) = (parameter.symbol(), other.symbol());
            let text = format!("`{other}` stands in place of `{symbol}`: leave one of them out");
            top.conflict(&format!("parameters.{other}"), &text);
        }
        match table.and_then(|table| table.entry(parameter.symbol())) {
            Some(entry) if on_axis => entry.fault("is given here and on an axis"),
            Some(entry) => {
                let value = entry.allowed_quantity(parameter.dimension(), parameter.allowed());
                parameters[parameter] = value.unwrap_or(parameters[parameter]);
                given.push(parameter);
            }
            None if parameter.is_asked_for()
                && !on_axis
                && in_its_stead.is_none()
                && (top.model().rules.no_effect)(parameters, parameter).is_none() =>
            {
                let expected = format!("a value for the {} here or an axis", parameter.meaning());
                top.missing(&format!("parameters.{}", parameter.symbol()), &expected);
            }
            None => {}
        }
    }
    given
}

/// Reads what is chosen beside the values.
fn read_choices(table: &Table<'_, '_>, parameters: &mut Parameters) {
    for (choice, described) in table.model().choices.iter().enumerate() {
        if let Some(entry) = table.entry(described.name) {
            let options = described.options.iter().enumerate();
            let options: Vec<(&str, usize)> = options.map(|(place, name)| (*name, place)).collect();
            parameters.choose(choice, entry.one_of(described.noun, &options).unwrap_or_default());
        }
    }
}
