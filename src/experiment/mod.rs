//! Experiments beside the simulation: recordings, smoothing, identification, comparison.

pub mod estimate;
pub mod free_vibration;
pub mod friction;
pub mod least_squares;
pub mod line;
pub mod profile;
pub mod recording;
pub mod sampled;
pub mod smoothing;

pub use estimate::Estimate;
pub use free_vibration::{FreeVibration, free_vibration};
pub use friction::{Coasting, CoastingTests, coasting, static_friction};
pub use profile::{Profile, Verdict};
pub use recording::{Column, Presence, Recording, RecordingFaults, Sampling};
pub use sampled::{Direction, Samples, Signal, Started, sampled};
pub use smoothing::{Unsuitable, Window, smoothed};
