//! Where and why a capsule could not be followed.

use capsulemap_engine::orbit;

use super::state::State;

/// Where and why a capsule failed.
pub type Failure = orbit::Failure<State<f64>>;
