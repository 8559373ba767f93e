//! What a study file says of its parameters: `[parameters]`, with the law of resistance and the reading of the switching.

use crate::capsule;
use crate::capsule::CapsuleParameters as _;
use crate::capsule::{Resistance, Switching};
use crate::description::{Parameter, Parameters};

use super::Coordinate;
use super::document::Table;

/// Reads `[parameters]` of a study that varies some coordinates, and says what it takes where the table leaves it open.
pub(super) fn read_parameters(
    top: &Table<'_, '_>,
    varied: &[Coordinate],
) -> (Parameters, Vec<String>) {
    let mut parameters = Parameters::default();
    let mut given = Vec::new();
    let table = top.table("parameters");
    let on_axis = |parameter| varied.contains(&Coordinate::Parameter(parameter));
    for parameter in parameters.model().parameters() {
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
    if let Some(entry) = table.entry("resistance") {
        parameters.resist_by(entry.one_of("resistance", &Resistance::NAMES).unwrap_or_default());
    }
    if let Some(entry) = table.entry("friction_switching") {
        parameters.switch_by(entry.one_of("reading", &Switching::NAMES).unwrap_or_default());
    }
    table.finish();
    let follows_axis = parameters.resistance() == Resistance::Coulomb
        && ask_beside_axis(top, &on_axis, &|parameter| given.contains(&parameter));
    if follows_axis {
        return (parameters, Vec::new());
    }
    let completed = parameters
        .complete_friction(|it| given.iter().any(|given| *given == it) || on_axis(it.into()));
    let remarks = completed.map(|it| parameters.told_of_completed(it)).into_iter().collect();
    (parameters, remarks)
}

/// Asks for the one coefficient of Coulomb's law that is neither given nor on an axis, where the other is on an axis: it is one
/// number for all cases, so it cannot follow the axis. Returns whether it had to ask.
fn ask_beside_axis(
    top: &Table<'_, '_>,
    on_axis: &impl Fn(Parameter) -> bool,
    is_given: &impl Fn(Parameter) -> bool,
) -> bool {
    let [rest, slide] = [capsule::Parameter::MuS, capsule::Parameter::MuD];
    let missing = [(rest, slide), (slide, rest)].into_iter().find(|&(one, other)| {
        on_axis(other.into()) && !on_axis(one.into()) && !is_given(one.into())
    });
    let Some((one, other)) = missing else { return false };
    let hint = if one == rest { "; with 0, rest ends at mu_d N" } else { "" };
    let expected = format!(
        "a value, as {} is on an axis and Coulomb's law takes one coefficient for the other only where it is constant{hint}",
        other.symbol()
    );
    top.missing(&format!("parameters.{}", one.symbol()), &expected);
    true
}
