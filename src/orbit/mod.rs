//! Understood: says what a motion is, from its sections, its energies and what it settles to.

pub mod account;
pub mod case;
pub mod certificate;
pub mod exponent;
mod extrapolation;
pub mod history;
pub mod matrix;
mod measure;
pub mod neutral;
pub mod newton;
pub mod output;
pub mod recurrence;
pub mod return_map;
pub mod settle;
mod settling;
pub mod side_by_side;
pub mod simulate;
pub mod trajectory;
pub mod wandering;

pub use account::{Account, Energies, Impact};
pub use case::Case;
pub use certificate::{Certificate, Proof};
pub use exponent::Exponent;
pub use history::{History, HistorySpan};
pub use measure::over_cycles;
pub use output::{Output, Outputs};
pub use settle::{Orbit, Outcome, Protocol, settle, settle_case, settle_on};
pub use side_by_side::{Queue, Underway, settle_side_by_side};
pub use simulate::{Event, Sample, Simulation, simulate, simulate_case};
pub use trajectory::{Failure, Reason, Section, Trajectory};
