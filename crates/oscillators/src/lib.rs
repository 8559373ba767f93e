//! Oscillators beside the capsule as models: a crate of its own, so that their lanes are not compiled anew with each test.

mod belt;
mod impact;
mod words;

pub use belt::{BELT, Belt, MASS_ON_BELT};
pub use impact::{IMPACT, IMPACT_OSCILLATOR, Impactor, settled};
