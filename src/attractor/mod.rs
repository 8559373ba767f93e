//! Attractors, told apart by their orbits, and how they continue along a parameter.

mod bridge;
mod final_motion;
mod identity;
mod link;
mod table;

pub use bridge::{Bridge, bridges};
pub use final_motion::FinalMotion;
pub use identity::{Attractor, coincide};
pub use link::{LinearOrbits, Links, Neighbours, Unseen, linear_orbits};
pub use table::{Executor, Serial, Table, attractors_of};
