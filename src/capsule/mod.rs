//! Defined: the vibro-impact capsule, its parameters, forces, modes and what ends each of them.

pub mod capsule;
pub mod drive;
pub mod parameter;
pub mod printed;
pub mod regime;
pub mod resistance;
pub mod state;
pub mod switched;

pub use capsule::Capsule;
pub use drive::Drive;
pub use parameter::{Allowed, Dimension, Fault, Parameter, Parameters};
pub use printed::PrintedCapsule;
pub use resistance::{Resistance, Switching};
pub use state::{Contact, EventKind, Jet, State, StickSlip};
pub use switched::{Field, Locomotion, Stroboscopic, Switched, Zeros};
