//! Kept: keeps records and gives them back, with what made them.

pub mod dataset;
pub use dataset::{Dataset, Values, Variable};
