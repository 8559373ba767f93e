//! The vibro-impact capsule: its parameters, forces and modes, and what its motion costs and yields.

pub mod account;
pub mod branch;
pub mod description;
pub mod filippov;
pub mod drag;
pub mod drive;
mod face;
mod failure;
mod forces;
mod friction_rules;
mod locomotion;
pub mod mean_errors;
pub mod output;
pub mod parameter;
pub mod parameters;
pub mod printed;
mod quantities;
pub mod regime;
pub mod resistance;
pub mod sampled;
mod sensitivity;
mod signals;
pub mod settle;
pub mod simulate;
pub mod state;
pub mod system;

pub use crate::description::{Fault, Parameters};
pub use crate::motion::{Case, Orbit, Sensitivity};
pub use account::{Account, Energies, Impact};
pub use drive::Drive;
pub use failure::Failure;
pub use filippov::Capsule;
pub use forces::Forces;
pub use locomotion::{Contact, Locomotion, StickSlip};
pub use output::{Output, Outputs};
pub use parameter::Parameter;
pub use parameters::CapsuleParameters;
pub use printed::PrintedCapsule;
pub use resistance::{Resistance, Switching};
pub use sensitivity::sensitivity;
pub use settle::{
    CapsuleCase, orbit_of, outputs, per_cycle, settle, settle_all, settle_as, settle_case,
};
pub use simulate::{Event, Sample, Simulation, simulate, simulate_case};
pub use state::{CapsuleState, EventKind, Jet, State};
pub use system::{AsPrinted, CapsuleSystem, Filippov, Reading};
