//! What is best among the cases of a study, where a gain, as speed, has its price.

mod ascent;
mod beyond;
mod front;
mod gain_and_cost;
mod goal;
mod hold;
mod lagrange_model;
mod limit;
mod operating_point;
mod optima;
mod quadratic;
mod slope;
mod stationarity;
mod surface;

pub use crate::capsule::{Sensitivity, sensitivity};
pub use ascent::{Best, best, left};
pub use front::{NOISE, front, speed_at_rest};
pub use gain_and_cost::{GainAndCost, Optimum, cost_per_gain, unit_behind};
pub use goal::Goal;
pub use hold::{Hold, Side};
pub use limit::Limit;
pub use operating_point::{Family, OperatingPoint};
pub use optima::{Candidate, Direction, Optima, hypervolume, most_first, optima};
pub use quadratic::MOST as MOST_FREE;
pub use stationarity::STATIONARY;

/// Limits of outputs that a search takes beside a budget, at most.
pub const MOST_LIMITS: usize = quadratic::LIMITS - 1;
