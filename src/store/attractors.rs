//! The variables that number the attractors and list their events.

use ndarray::{ArrayD, IxDyn};

use crate::run::{AttractorEvent, Attractors};
use crate::study::{Coordinate, Study};

use super::catalogue::{
    ATTRACTOR, ATTRACTOR_AXIS, EVENT, EVENT_ATTRACTOR, EVENT_KIND, EVENT_PERIOD, EVENT_UNCERTAINTY,
    Entry, Place, SECTION,
};
use super::{Dataset, Values};

/// Adds to the dataset of a study which attractor each case has ended on, and the table of events.
///
/// A column for each parameter on an axis says where the event is; that of the axis along which attractors
/// are continued was located to the uncertainty given. Without events there is no table.
pub fn add_attractors(dataset: &mut Dataset, study: &Study, attractors: &Attractors) {
    let dimensions = study.dimensions();
    let number = |of: &Option<u32>| of.map_or(-1, i64::from);
    let numbers = attractors.of_case.iter().map(number).collect();
    let array = ArrayD::from_shape_vec(IxDyn(&study.shape()), numbers).expect("one per case");
    if let Some(axis) = attractors.axis {
        let name = study.axes()[axis].coordinate.name().to_owned();
        dataset.attributes.insert(ATTRACTOR_AXIS.to_owned(), name);
    }
    dataset.put(ATTRACTOR, &dimensions, Values::Integer(array));
    if !attractors.events.is_empty() {
        add_events(dataset, study, attractors);
    }
}

fn add_events(dataset: &mut Dataset, study: &Study, attractors: &Attractors) {
    let events = &attractors.events;
    dataset.put_coordinate(EVENT, Values::count(events.len()));
    let mut whole = |entry: Entry, of: fn(&AttractorEvent) -> i64| {
        let values = Values::integers(events.iter().map(of).collect());
        dataset.put_column(entry, values);
    };
    whole(EVENT_KIND, |event| event.kind as i64);
    whole(EVENT_ATTRACTOR, |event| i64::from(event.attractor));
    whole(EVENT_PERIOD, |event| event.period as i64);
    let mut real = |entry: Entry, of: &dyn Fn(&AttractorEvent) -> f64| {
        let values = Values::reals(events.iter().map(of).collect());
        dataset.put_column(entry, values);
    };
    for (place, axis) in study.axes().iter().enumerate() {
        if let Coordinate::Parameter(parameter) = axis.coordinate {
            let at = |event: &AttractorEvent| match attractors.axis == Some(place) {
                true => event.value,
                false => study.case(event.case).parameters[parameter],
            };
            real(Place::Event.of(Entry::of_parameter(parameter)), &at);
        }
    }
    for (i, entry) in SECTION.into_iter().enumerate() {
        real(Place::Event.of(entry), &|event| event.section[i]);
    }
    let uncertainties = events.iter().map(|event| event.uncertainty).collect();
    let coordinate = attractors.axis.map(|axis| study.axes()[axis].coordinate);
    let unit = coordinate.map_or("1", |coordinate| coordinate.dimension().unit());
    dataset.put_column(EVENT_UNCERTAINTY, Values::reals(uncertainties)).unit = unit.to_owned();
}
