//! Repeated: turns a study into cases and cases into records, in parallel, in any order.

pub mod attractor;
pub mod axis;
pub mod block;
mod branch_file;
mod bridge;
mod cell;
mod change;
pub mod continuation;
pub mod document;
pub mod drawing;
mod drawing_file;
pub mod ending;
mod family;
pub mod follow;
mod layout;
pub mod quantity;
pub mod run;
pub mod study;
mod study_file;

pub use attractor::{AttractorEvent, Attractors, attractors, has_attractors, links};
pub use axis::{Axis, Coordinate};
pub use block::run_blocks;
pub use continuation::{Continuation, FirstOrbit};
pub use document::{Fault, Faults};
pub use drawing::{Drawing, DrawingKind};
pub use ending::{Ending, endings};
pub use follow::{Followed, Unfollowed, follow};
pub use quantity::parse_quantity;
pub use run::{Machine, Record, run};
pub use study::{Direction, Follow, Study};
