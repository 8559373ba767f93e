//! A case in full: where it is at every section, its events, and what is summed up and counted from its start.

use super::Failure;
use crate::description::State;

/// How much of a motion is followed and kept at most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SimulationSize {
    /// Drive cycles from the first section.
    pub cycles: u64,
    /// Events.
    pub events: usize,
}

/// A motion at the end of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Cycles since the first section.
    pub cycle: u64,
    /// Time since the start [s].
    pub time: f64,
    /// Where it is.
    pub state: State,
    /// What the model sums up, since the start (SI).
    pub sums: Vec<f64>,
    /// What the model counts, since the start.
    pub counts: Vec<u64>,
}

/// An event.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Time since the start [s].
    pub time: f64,
    /// Its number, by which the model names it.
    pub number: u8,
    /// The state before it.
    pub state: State,
}

/// A case followed from its start for a number of cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// One sample per cycle, that at the first section included, which is the start where that is on it.
    pub section: Vec<Sample>,
    /// Every event in order.
    pub events: Vec<Event>,
    /// Why it stopped early, if it did.
    pub failure: Option<Failure>,
}
