//! A simulated case as text: what a person wants to see first.

use std::fmt::Write as _;

use crate::description::{Description, Parameter, Parameters};
use crate::explore::{remarks, told};
use crate::motion::{Orbit, Simulation};
use crate::quantity::Dimension;

/// A coordinate of the state as the table of a motion shows it.
struct ShownCoordinate {
    head: String,
    /// What its values in SI are multiplied by.
    factor: f64,
}

impl ShownCoordinate {
    /// The one at a place among those of a model, in the unit that figures show.
    fn of(model: &'static Description, place: usize) -> ShownCoordinate {
        let name = model.coordinates[place].name;
        let quantity = model.coordinate_along(place);
        let si = (quantity.dimension.unit(), 1.0);
        let (unit, factor) = quantity.shown.map_or(si, |it| (it.unit, it.factor));
        let head = if unit.is_empty() || unit == "1" {
            name.to_owned()
        } else {
            format!("{name} [{unit}]")
        };
        ShownCoordinate { head, factor }
    }
}

/// Whether anything of a model has a unit; without, time has none either.
fn has_units(model: &'static Description) -> bool {
    let states = model.coordinates().map(|it| it.start().dimension);
    let mut all = states.chain(model.parameters().map(Parameter::dimension));
    all.any(|it| it != Dimension::Number)
}

/// What a person wants to see first.
pub fn summary(parameters: &Parameters, simulation: &Simulation, orbit: &Orbit) -> String {
    let given: Vec<String> = parameters
        .stated()
        .map(|(parameter, value)| format!("{} = {value}", parameter.symbol()))
        .collect();
    let system_of_units = if has_units(parameters.model()) { " (SI)" } else { "" };
    let mut text = format!("{}{system_of_units}\n", given.join(", "));
    if let Some(member) = (parameters.model().rules.member)(parameters) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "member of the family: {member}");
    }
    text.push('\n');
    write_section(&mut text, parameters.model(), simulation);
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{} events; --json lists them", simulation.events.len());
    if let Some(failure) = &simulation.failure {
        let _ = writeln!(text, "failed: {failure}");
    }
    let _ = writeln!(text, "\noutcome: {}, after {} cycles", verdict(orbit), orbit.cycles);
    if let Some(failure) = &orbit.failure {
        let _ = writeln!(text, "  {failure}");
        return text;
    }
    for (output, value) in told(parameters, orbit) {
        let unit = if output.unit() == "1" { "" } else { output.unit() };
        let _ = writeln!(text, "  {:<26} {:>16.9e} {unit}", output.name(), value);
    }
    for remark in remarks(parameters, orbit) {
        let _ = writeln!(text, "  {remark}");
    }
    text
}

/// The section points of a motion as a table.
fn write_section(text: &mut String, model: &'static Description, simulation: &Simulation) {
    let coordinates: Vec<ShownCoordinate> =
        (0..model.coordinates.len()).map(|place| ShownCoordinate::of(model, place)).collect();
    let time = if has_units(model) { "t [s]" } else { "t" };
    let _ = write!(text, "{:>5} {time:>12}", "cycle");
    for it in &coordinates {
        let _ = write!(text, " {:>14}", it.head);
    }
    for count in model.motion.counts {
        let _ = write!(text, " {count:>8}");
    }
    text.push('\n');
    for sample in &simulation.section {
        let _ = write!(text, "{:>5} {:>12.6}", sample.cycle, sample.time);
        for (it, value) in coordinates.iter().zip(sample.state.values()) {
            let _ = write!(text, " {:>14.9}", value * it.factor);
        }
        for count in &sample.counts {
            let _ = write!(text, " {count:>8}");
        }
        text.push('\n');
    }
}

fn verdict(orbit: &Orbit) -> String {
    match orbit.period {
        0 => orbit.outcome.name().to_owned(),
        period => format!("{} ({period})", orbit.outcome.name()),
    }
}
