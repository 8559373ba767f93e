//! What a motion is, from its sections and from what it settles to.

mod case;
pub mod certificate;
mod batch;
pub mod exponent;
pub mod extrema;
mod extrapolation;
mod francis;
mod machine;
pub mod matrix;
mod measure;
pub mod neutral;
pub mod newton;
pub mod passage;
pub mod precision;
mod protocol;
pub mod recurrence;
pub mod return_map;
mod returns;
pub mod settle;
mod settle_all;
mod settling;
pub mod side_by_side;
pub mod trajectory;
pub mod aperiodic;

pub use batch::Batch;
pub use case::{Case, Orbit, OrbitOf};
pub use certificate::{Certificate, Proof};
pub use exponent::Exponent;
pub use machine::Machine;
pub use measure::measured;
pub use protocol::{HistorySpan, Outcome, Protocol};
pub use returns::{Returns, returns};
pub use settle::settle;
pub use settle_all::settle_all;
pub use side_by_side::{Queue, Underway, settle_side_by_side};
pub use trajectory::{Failure, Trajectory};
