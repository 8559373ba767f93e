//! A bifurcation and basin mapper for the vibro-impact capsule.
//!
//! The modules are floors, and each uses only those before it in this list; each opens with a sentence
//! saying what it does. A reader starts at `capsule`, which defines what is computed.

pub mod lane;
pub mod flow;
pub mod orbit;
pub mod branch;
pub mod attractor;
pub mod capsule;
pub mod study;
pub mod run;
pub mod tradeoff;
#[cfg(feature = "cli")]
pub mod store;
#[cfg(feature = "cli")]
pub mod campaign;
#[cfg(feature = "cli")]
pub mod figure;
#[cfg(feature = "cli")]
pub mod cli;
