//! The family of capsules in general: driven by any of the drives, between two stops, on any ground.

pub mod balance;
mod drive;
mod edges;
mod equations;
mod field;
mod folds;
mod ground;
mod over_folds;
mod prescribed;
mod guards;
mod rigid;
mod springs;
mod state;
mod switch;

pub use drive::PiecewiseDrive;
pub use edges::edge_at;
pub use equations::GeneralCapsule;
pub use folds::Folds;
pub use ground::Ground;
pub use springs::{Springs, Touched};
pub use state::{GeneralJet, GeneralMode};
