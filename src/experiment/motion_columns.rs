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

/// What must be known of how a recording of a capsule was read, and that it has columns which are no signals.
pub fn left_out(recording: &Recording) -> Vec<String> {
    let mut told = recording.notes.clone();
    if !recording.others.is_empty() {
        let (others, signals) = (recording.others.join(", "), Signal::ALL.map(Signal::name));
        told.push(format!("left out: {others}; the signals are {}, current", signals.join(", ")));
    }
    told
}

fn times(dimension: Dimension) -> Column {
    Column { presence: Presence::Required, ..optional("t", dimension) }
}

fn optional(name: &'static str, dimension: Dimension) -> Column {
    Column { name, dimension, presence: Presence::Optional }
}
