//! Motions, periodic orbits, branches and attractors of any switched oscillator, over many cases side by side.
//!
//! The modules are floors, and each uses only those before it in this list. `capsulemap` has all of them under the same names, with a page on
//! how to write an oscillator of one's own.

pub mod lane;
pub mod flow;
pub mod orbit;
pub mod branch;
pub mod attractor;
