//! Asked: what to compute, from a study's file or from code, as cases by index.

pub mod axis;
pub mod block;
pub(crate) mod branch_file;
pub mod continuation;
pub mod document;
pub mod drawing;
mod drawing_file;
pub(crate) mod layout;
pub mod quantity;
mod start_file;
pub mod study;
mod study_file;

pub use axis::{Axis, Coordinate};
pub use block::spread;
pub use continuation::{Continuation, FirstOrbit};
pub use document::{Fault, Faults};
pub use drawing::{Drawing, DrawingKind};
pub use quantity::parse_quantity;
pub use study::{Direction, Follow, Study};
