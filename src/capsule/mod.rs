//! The vibro-impact capsule: its parameters, forces and modes, and what its motion costs and yields.

pub mod account;
pub mod branch;
mod case;
pub mod filippov;
pub mod drag;
pub mod drive;
mod failure;
pub mod history;
mod locomotion;
pub mod output;
pub mod parameter;
pub mod parameters;
pub mod printed;
pub mod regime;
pub mod resistance;
pub mod settle;
pub mod simulate;
pub mod state;
pub mod system;

pub use account::{Account, Energies, Impact};
pub use case::Case;
pub use drive::Drive;
pub use failure::{Failure, REASONS, Section};
pub use filippov::Capsule;
pub use history::History;
pub use locomotion::{Contact, Locomotion, StickSlip};
pub use output::{Output, Outputs};
pub use parameter::{Allowed, Dimension, Parameter};
pub use parameters::{Fault, Parameters};
pub use printed::PrintedCapsule;
pub use resistance::{Resistance, Switching};
pub use settle::{Orbit, outputs, per_cycle, settle, settle_all, settle_as, settle_case};
pub use simulate::{Event, Sample, Simulation, simulate, simulate_case};
pub use state::{EventKind, Jet, State};
pub use system::{AsPrinted, CapsuleSystem, Filippov, Reading};
