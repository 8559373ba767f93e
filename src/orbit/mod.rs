//! Understood: says what a motion is, from its sections, its energies and what it settles to.

pub mod account;
pub mod cycle;
pub mod history;
pub mod output;
pub mod recurrence;
pub mod settle;
pub mod simulate;

pub use account::{Account, Impact};
pub use cycle::{Failure, Reason, Section, Trajectory};
pub use history::{History, HistorySpan};
pub use output::{Output, Outputs};
pub use settle::{Orbit, Outcome, Protocol, settle};
pub use simulate::{Event, Sample, Simulation, simulate};
