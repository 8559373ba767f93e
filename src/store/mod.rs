//! Kept: keeps records and gives them back, with what made them.

pub mod dataset;
pub mod provenance;
pub mod schema;

pub use dataset::{Dataset, Values, Variable};
pub use schema::dataset;
