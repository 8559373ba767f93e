//! Known: tells attractors apart, each by its orbit.

mod identity;
mod summary;
mod table;

pub use identity::{Attractor, coincide};
pub use summary::Summary;
pub use table::{Executor, Serial, Table, attractors_of};
