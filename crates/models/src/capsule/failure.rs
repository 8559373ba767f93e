//! Where and why a capsule could not be followed.

use capsulemap_engine::flow::Reason;
use capsulemap_engine::orbit;

use super::state::State;

/// Where and why a capsule failed.
pub type Failure = orbit::Failure<State<f64>>;

/// Why a capsule may fail, with its names in files; under a drive it always comes back to its section.
pub const REASONS: [(Reason, &str); 4] = {
    let [no_progress, not_finite, too_many_steps, _, out_of_steps] = Reason::NAMES;
    [no_progress, not_finite, too_many_steps, out_of_steps]
};
