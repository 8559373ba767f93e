//! Attractors, told apart by their orbits, and how they continue along a parameter.

mod basin;
mod boundary_cover;
mod bridge;
mod crossing;
mod distance;
mod edge;
mod final_motion;
mod identity;
mod integrity;
mod link;
mod manifold;
mod saddle_frame;
mod share;
mod shock;
mod stable_curve;
mod stable_curves;
mod start_plane;
mod table;
mod uncertainty;
mod unstable_branch;
mod wada;

pub use basin::{Entropy, Estimate, entropy};
pub use bridge::{Bridge, bridges};
pub use edge::{EdgeSearch, LeadTo, Met, Saddle};
pub use final_motion::FinalMotion;
pub use identity::{Attractor, coincide};
pub use integrity::{Integrity, integrity};
pub use link::{LinearOrbits, Links, Neighbours, linear_orbits};
pub use manifold::{
    BranchEnd, Coverage, CurveEnd, Manifolds, Plane, SectionMap, StableCurve, UnstableBranch,
};
pub use share::{Label, Share, shares_of_draws, shares_of_grid, weighted_shares_of_grid};
pub use shock::{Shock, minimal_critical_shock};
pub use stable_curves::{ManifoldSearch, SaddleBetween};
pub use table::{Executor, Serial, Table, attractors_of};
pub use uncertainty::{BoxSize, LocalSlope, Uncertainty, uncertainty};
pub use wada::{BoundaryPair, Wada, WadaScale, wada};
