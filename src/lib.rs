//! A bifurcation and basin mapper for the vibro-impact capsule.

pub mod sweep;
pub mod store;
pub mod figure;
