//! What is best among the cases of a study, where speed has its price in energy.

mod front;

pub use front::{front, speed_at_rest};
