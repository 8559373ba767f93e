//! Experiments beside the simulation: recordings, smoothing, identification, comparison.

pub mod comparison;
pub mod course;
pub mod drive_phase;
pub mod estimate;
pub mod free_vibration;
pub mod friction;
pub mod identification;
pub mod least_squares;
pub mod line;
pub mod motion_fit;
pub mod profile;
pub mod recording;
mod recording_file;
pub mod sampled;
pub mod smoothing;
pub mod spikes;
pub mod synthesis;

pub use comparison::{Comparison, Explanation, compare, explain};
pub use course::{Recorded, Weights};
pub use drive_phase::{Harmonic, harmonic};
pub use estimate::Estimate;
pub use free_vibration::{FreeVibration, free_vibration};
pub use friction::{Coasting, CoastingTests, coasting, static_friction};
pub use identification::{Constant, Given, Identified, Test, identify};
pub use motion_fit::{Effort, Fitted, Free, MotionFit, fit_motion};
pub use profile::{Profile, Verdict};
pub use recording::{Column, Presence, Recording, RecordingFaults, Sampling};
pub use sampled::{Direction, Samples, Signal, Started, sampled};
pub use smoothing::{Unsuitable, Window, smoothed};
pub use spikes::{Spike, spikes};
pub use synthesis::{Laboratory, Sensor, SimpleTests, simple_tests};
