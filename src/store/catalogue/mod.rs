//! The one catalogue of variables: name, unit, meaning and shown form of all that a file of results can have.
//!
//! Other files refer to a variable by its constant here, by [`Entry::of_parameter`] and its like, or by a
//! [`Place`], and never spell its name.

mod branches;
mod cases;
mod entry;
mod flags;
mod lasting;
mod manifolds;
mod model;
mod places;
mod ramps;
mod tables;

pub use crate::quantity::Shown;
pub use branches::*;
pub use cases::*;
pub use entry::{Entry, Extent, Flags, Type};
pub use flags::{parameters, reasons, result, results};
pub use lasting::lasting;
pub use manifolds::*;
pub use model::{derived, edges, end, histories, impacts, neutral, section, starts};
pub use places::{Place, all, is_dimension, named, taken_twice};
pub use ramps::*;
pub use tables::*;
