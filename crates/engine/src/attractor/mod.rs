//! Attractors, told apart by their orbits, and how they continue along a parameter.

mod basin;
mod bridge;
mod distance;
mod edge;
mod final_motion;
mod identity;
mod integrity;
mod link;
mod share;
mod shock;
mod table;
mod uncertainty;
mod wada;

pub use basin::{Entropy, Estimate, entropy};
pub use bridge::{Bridge, bridges};
pub use edge::{EdgeSearch, LeadTo, Met, Saddle};
pub use final_motion::FinalMotion;
pub use identity::{Attractor, coincide};
pub use integrity::{Integrity, integrity};
pub use link::{LinearOrbits, Links, Neighbours, linear_orbits};
pub use share::{Label, Share, shares_of_draws, shares_of_grid, weighted_shares_of_grid};
pub use shock::{Shock, minimal_critical_shock};
pub use table::{Executor, Serial, Table, attractors_of};
pub use uncertainty::{BoxSize, LocalSlope, Uncertainty, uncertainty};
pub use wada::{BoundaryPair, Wada, WadaScale, wada};
