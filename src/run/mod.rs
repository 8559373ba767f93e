//! Repeated: turns the cases of a study into records, in parallel, in any order.

pub mod attractor;
pub mod block;
mod bridge;
pub mod cases;
mod change;
pub mod ending;
mod family;
mod natural;
pub mod follow;
pub mod forecast;

pub use crate::orbit::Machine;
pub use attractor::{AttractorEvent, Attractors, attractors, has_attractors, links};
pub use block::run_blocks;
pub use cases::{Record, RunError, run, run_sample};
pub use ending::{Ending, ending, endings};
pub use follow::{Followed, Unfollowed, follow};
pub use forecast::{Estimate, Forecast};
