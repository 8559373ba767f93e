//! Where a capsule could not be followed, in words.

use std::fmt;

use crate::flow::{Breakdown, Reason, STEPS_PER_CYCLE};
use crate::orbit;

use super::state::State;

/// A point of the stroboscopic section: r [m], y1 [m/s], y2 [m/s].
pub type Section = [f64; 3];

/// Where and why a capsule failed.
pub type Failure = orbit::Failure<State<f64>>;

/// Why a capsule may fail, with its names in files; under a drive it always comes back to its section.
pub const REASONS: [(Reason, &str); 4] = {
    let [no_progress, not_finite, too_many_steps, _, out_of_steps] = Reason::NAMES;
    [no_progress, not_finite, too_many_steps, out_of_steps]
};

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let State { r, y1, x2, y2 } = self.state;
        let reason = match self.reason {
            Reason::NoProgress => Breakdown::NoProgress.to_string(),
            Reason::NotFinite => Breakdown::NotFinite.to_string(),
            Reason::NoReturn => Breakdown::NoReturn.to_string(),
            Reason::TooManySteps => format!("a drive cycle takes over {STEPS_PER_CYCLE} steps"),
            Reason::OutOfSteps => "the case takes more steps than max_steps allows".to_owned(),
        };
        write!(
            f,
            "{reason}, at t = {} s, r = {r} m, y1 = {y1} m/s, x2 = {x2} m, y2 = {y2} m/s",
            self.time
        )
    }
}
