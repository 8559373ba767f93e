//! What is best among the cases of a study, where speed has its price in energy.

mod ascent;
mod front;
mod operating_point;
mod optima;
mod quadratic;
mod sensitivity;

pub use ascent::{Best, Goal, Hold, STATIONARY, Side, best, left};
pub use front::{NOISE, front, speed_at_rest};
pub use operating_point::{Family, OperatingPoint};
pub use optima::{Candidate, Direction, Optima, hypervolume, optima};
pub use quadratic::MOST as MOST_FREE;
pub use sensitivity::{Sensitivity, sensitivity};
