//! Kept: keeps records and gives them back, with what made them.

mod attractors;
pub mod dataset;
mod decode;
mod difference;
mod encode;
mod error;
mod faults;
mod file;
mod names;
pub mod provenance;
mod scale;
pub mod schema;
mod seal;

pub use attractors::add_attractors;
pub use dataset::{Dataset, Values, Variable};
pub use difference::difference;
pub use error::StoreError;
pub use file::{read, write};
pub use schema::dataset;
