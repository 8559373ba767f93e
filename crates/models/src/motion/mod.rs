//! A case of a model: where it starts, what it settles to, and what a branch through it is.

pub mod branch;
mod case;
mod orbit;
mod setting;
mod simulation;
mod stretch;

pub use case::{Case, reduced};
pub use orbit::{Failure, Orbit, reasons};
pub use setting::{Sensitivity, Setting};
pub use simulation::{Event, Sample, Simulation, SimulationSize};
pub use stretch::Stretch;
