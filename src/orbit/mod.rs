//! Understood: says what a motion is, from its sections, its energies and what it settles to.

pub mod account;
pub mod history;
pub mod output;
pub mod recurrence;
pub mod settle;
pub mod simulate;
pub mod trajectory;

pub use account::{Account, Energies, Impact};
pub use history::{History, HistorySpan};
pub use output::{Output, Outputs};
pub use settle::{Orbit, Outcome, Protocol, settle};
pub use simulate::{Event, Sample, Simulation, simulate};
pub use trajectory::{Failure, Reason, Section, Trajectory};
