//! A bifurcation and basin mapper for the vibro-impact capsule.

pub mod figure;
pub mod store;
pub mod sweep;
