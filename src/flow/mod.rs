//! Moved: advances any switched system by Taylor steps and locates every event on the way.

pub mod defect;
pub mod guard;
pub mod motion;
mod pace;

pub use motion::{Breakdown, Motion, Step};
