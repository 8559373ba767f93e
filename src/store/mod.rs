//! Kept: keeps records and gives them back, with what made them.

mod attractors;
mod branch_columns;
pub mod branches;
pub mod dataset;
mod decode;
mod difference;
mod encode;
mod error;
mod faults;
mod file;
mod flat;
mod names;
pub mod provenance;
mod scale;
pub mod schema;
mod seal;
pub mod shard;
mod whole;

pub use attractors::add_attractors;
pub use branches::{add_branches, drop_branches, has_branches, has_cases, keep_branches};
pub use dataset::{Dataset, Values, Variable};
pub use difference::difference;
pub use error::StoreError;
pub use file::{read, write};
pub use schema::{dataset, frame};
