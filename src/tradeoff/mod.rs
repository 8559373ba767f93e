//! What is best among the cases of a study, where speed has its price in energy.

mod front;

pub use front::{NOISE, front, speed_at_rest};
