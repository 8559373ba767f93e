//! What does not fit together between a system and its description.

use capsulemap_engine::flow::Event;

use super::Face;
use crate::description::{Description, Parameter, Parameters};

/// What does not fit together in the description of a system, or between the two, each in a sentence; nothing where all does.
pub fn faults<M: Face<D>, const D: usize>(description: &'static Description) -> Vec<String> {
    let dimension = if M::HAS_ROOM { description.section.len().min(D) } else { D };
    let faults = description.faults(dimension);
    if !faults.is_empty() {
        // What else is asked here goes by the places that these are about.
        return faults;
    }
    let (has, told) = (M::Event::ALL.len(), description.motion.events.len());
    let are_told = told > 0 || !description.motion.histories.is_empty();
    let of_events = (are_told && told != has)
        .then(|| format!("the system has {has} events, and the description names {told}"));
    let of_parameters = description.parameters().filter_map(fault_of_parameter::<M, D>);
    of_events.into_iter().chain(of_parameters).collect()
}

/// Whether the system has another name for a parameter, or another value: a list that is in another order.
fn fault_of_parameter<M: Face<D>, const D: usize>(described: Parameter) -> Option<String> {
    let mut parameters = Parameters::of(described.model());
    // Every range of allowed values has this one, and no other parameter is likely to have it.
    let value = 2.0 * parameters[described].abs() + 0.8125;
    parameters[described] = value;
    let system = M::of(&parameters, 0.0);
    let named = M::which(described);
    let symbol = described.symbol();
    if !system.has(named) {
        return Some(format!("{symbol} is {named:?} of the system, which has none of that name"));
    }
    (system.value(named) != value)
        .then(|| format!("{symbol} is {named:?} of the system, which another parameter sets"))
}
