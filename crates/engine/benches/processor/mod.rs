//! Processor time of benches whose work has threads of its own.

use std::fs;
use std::time::Instant;

/// Processor time of all threads of this program [s], to a hundredth; where the system does not report it, the time since `begun`.
pub fn seconds_of_all_threads(begun: Instant) -> f64 {
    ticks().map_or_else(|| begun.elapsed().as_secs_f64(), |ticks| 0.01 * ticks)
}

/// The same in the unit of the system [1/100 s], if it reports it.
fn ticks() -> Option<f64> {
    // After the name in parentheses come the state, ten numbers, and the user's and the system's time.
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    let (_, fields) = text.rsplit_once(')')?;
    let times = fields.split_whitespace().skip(11).take(2);
    times.map(|time| time.parse::<f64>().ok()).sum()
}
