//! Oscillators beside the capsule as models: a crate of its own, so that their lanes are not compiled anew with each test.

mod impact;

pub use impact::{IMPACT, IMPACT_OSCILLATOR, Impactor, settled};
