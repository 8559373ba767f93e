//! The variables that tell attractors apart and list their events.

use ndarray::{ArrayD, IxDyn};

use crate::branch::SpecialKind;
use crate::run::{AttractorEvent, Attractors};
use crate::study::{Coordinate, Study};

use super::{Dataset, Values, Variable};

/// The dimension of the table of events.
const EVENT: &str = "event";

/// Adds to the dataset of a study which attractor each case has ended on, and the table of events.
///
/// A column `event_NAME` for each parameter on an axis says where the event is; that of the axis along which
/// attractors are followed was bisected to `event_uncertainty`. Without events there is no table.
pub fn add_attractors(dataset: &mut Dataset, study: &Study, attractors: &Attractors) {
    let dimensions = study.dimensions().into_iter().map(str::to_owned).collect();
    let number = |of: &Option<u32>| of.map_or(-1, i64::from);
    let numbers = attractors.of_case.iter().map(number).collect();
    let array = ArrayD::from_shape_vec(IxDyn(&study.shape()), numbers).expect("one per case");
    if let Some(axis) = attractors.axis {
        let name = study.axes()[axis].coordinate.name().to_owned();
        dataset.attributes.insert("attractor_axis".to_owned(), name);
    }
    let meaning = "attractor of the case, numbered along the axis of parameters, -1 for none";
    dataset.variables.insert(
        "attractor".to_owned(),
        Variable { dimensions, ..column("1", meaning, Values::Integer(array)) },
    );
    if !attractors.events.is_empty() {
        add_events(dataset, study, attractors);
    }
}

fn add_events(dataset: &mut Dataset, study: &Study, attractors: &Attractors) {
    let events = &attractors.events;
    let place = integers((0..events.len() as i64).collect());
    dataset.coordinates.push((EVENT.to_owned(), column("1", "event of an attractor", place)));
    let mut add = |name: &str, variable: Variable| {
        dataset.variables.insert(format!("event_{name}"), variable);
    };
    let codes = integers(events.iter().map(|event| event.kind as i64).collect());
    let flags = SpecialKind::NAMES.map(|(name, kind)| (kind as i64, name.to_owned())).to_vec();
    add("kind", Variable { flags, ..column("1", "what happens to the attractor", codes) });
    let numbers = integers(events.iter().map(|event| i64::from(event.attractor)).collect());
    add("attractor", column("1", "attractor of the event", numbers));
    let periods = integers(events.iter().map(|event| event.period as i64).collect());
    add("period", column("1", "period of the orbit that changes, in drive cycles", periods));
    for (place, axis) in study.axes().iter().enumerate() {
        if let Coordinate::Parameter(parameter) = axis.coordinate {
            let at = |event: &AttractorEvent| match attractors.axis == Some(place) {
                true => event.value,
                false => study.case(event.case).parameters[parameter],
            };
            let unit = parameter.dimension().unit();
            let values = reals(events.iter().map(at).collect());
            add(parameter.symbol(), column(unit, parameter.meaning(), values));
        }
    }
    let followed = attractors.axis.map(|axis| study.axes()[axis].coordinate);
    let unit = followed.map_or("1", |coordinate| coordinate.dimension().unit());
    let uncertainties = reals(events.iter().map(|event| event.uncertainty).collect());
    let meaning = "half width of the bracket that bisection has left";
    add("uncertainty", column(unit, meaning, uncertainties));
    let sections = [("section_r", "m"), ("section_y1", "m/s"), ("section_y2", "m/s")];
    for (i, (name, unit)) in sections.into_iter().enumerate() {
        let values = reals(events.iter().map(|event| event.section[i]).collect());
        add(name, column(unit, "section point of the orbit at the event", values));
    }
}

fn column(unit: &str, long_name: &str, values: Values) -> Variable {
    Variable {
        dimensions: vec![EVENT.to_owned()],
        unit: unit.to_owned(),
        long_name: long_name.to_owned(),
        values,
        flags: Vec::new(),
    }
}

fn reals(values: Vec<f64>) -> Values {
    Values::Real(ArrayD::from_shape_vec(IxDyn(&[values.len()]), values).expect("a column"))
}

fn integers(values: Vec<i64>) -> Values {
    Values::Integer(ArrayD::from_shape_vec(IxDyn(&[values.len()]), values).expect("a column"))
}
