//! Experiments beside the simulation: recordings, smoothing, identification, comparison.

pub mod least_squares;
pub mod recording;
pub mod smoothing;

pub use recording::{Column, Presence, Recording, RecordingFaults, Sampling};
pub use smoothing::{Unsuitable, Window, smoothed};
