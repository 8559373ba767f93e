//! The columns that a recording of a motion may have.

use super::recording::{Column, Presence, Recording};
use crate::capsule::sampled::Signal;
use crate::description::Description;
use crate::quantity::Dimension;

/// The columns of the recording of a motion: times, and what sensors see of a capsule, or the states of an oscillator given as text.
///
/// Times are in s, or plain numbers where all states are.
pub fn columns_of_motion(model: &'static Description) -> Vec<Column> {
    if model.equations.is_none() {
        let signals = Signal::ALL.map(|it| optional(it.name(), it.dimension()));
        let beside = [times(Dimension::Time), optional("current", Dimension::Current)];
        return beside.into_iter().chain(signals).collect();
    }
    let states = model.coordinates.iter().map(|it| optional(it.name, it.start.dimension));
    let states: Vec<Column> = states.collect();
    let are_numbers = states.iter().all(|it| it.dimension == Dimension::Number);
    let of_time = if are_numbers { Dimension::Number } else { Dimension::Time };
    [times(of_time)].into_iter().chain(states).collect()
}

/// That a recording of a capsule has columns which are no signals; nothing if it has none.
pub fn left_out(recording: &Recording) -> Option<String> {
    if recording.others.is_empty() {
        return None;
    }
    let signals = Signal::ALL.map(Signal::name).join(", ");
    Some(format!("left out: {}; the signals are {signals}, current", recording.others.join(", ")))
}

fn times(dimension: Dimension) -> Column {
    Column { presence: Presence::Required, ..optional("t", dimension) }
}

fn optional(name: &'static str, dimension: Dimension) -> Column {
    Column { name, dimension, presence: Presence::Optional }
}
