//! The tests of what models describe, and of the capsule beside the engine; what the engine owes it is in `crates/engine/tests`.

mod arcs;
mod described;
mod faults;
mod forces;
mod printable;
mod sampled;
mod units;
