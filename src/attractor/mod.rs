//! Attractors, told apart by their orbits.

mod identity;
mod final_motion;
mod table;

pub use final_motion::FinalMotion;
pub use identity::{Attractor, coincide};
pub use table::{Executor, Serial, Table, attractors_of};
