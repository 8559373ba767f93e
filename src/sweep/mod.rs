//! Repeated: turns a study into cases and cases into records.

pub mod drawing;
pub use drawing::{Drawing, DrawingKind};
