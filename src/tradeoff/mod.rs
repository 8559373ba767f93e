//! What is best among the cases of a study, where speed has its price in energy.

mod front;
mod optima;

pub use front::{NOISE, front, speed_at_rest};
pub use optima::{Candidate, Direction, Optima, hypervolume, optima};
