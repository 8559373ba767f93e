//! A bifurcation and basin mapper for the vibro-impact capsule.
//!
//! The modules are floors, and each uses only those before it in this list; each opens with a sentence
//! saying what it does. A reader starts at `capsule`, which defines what is computed.

pub mod lane;
pub mod capsule;
pub mod flow;
pub mod orbit;
pub mod branch;
pub mod study;
pub mod run;
pub mod tradeoff;
pub mod store;
pub mod figure;
pub mod cli;
