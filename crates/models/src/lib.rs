//! The models: each a system with a face, compiled once for every kind of lane, behind one door without type parameters.
//!
//! The modules are floors, and each uses only those before it in this list; they stand on `capsulemap-engine`.

pub mod quantity;
pub mod description;
pub mod motion;
pub mod samples;
pub mod face;
pub mod capsule;
pub mod model;
pub mod of;
