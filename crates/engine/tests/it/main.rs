//! The tests of the engine, with the capsule among its systems: closed forms, invariants, references, and one contract for all.

// The examples name the engine by the library that shows it.
extern crate capsulemap_engine as capsulemap;

mod acceleration;
mod belt;
mod branch;
mod branch_curves;
mod branch_ends;
mod certificates;
mod closed_forms;
mod contract;
mod den_hartog;
mod derivatives;
mod differences;
mod direct_links;
mod directions;
mod divergence;
mod draws;
mod dual_lanes;
mod edges;
mod eigenvalues;
mod elementary;
mod exponents;
mod far_starts;
mod forms;
mod impact_orbits;
mod invariants;
mod lanes;
mod library_faults;
mod neighbourhoods;
mod neutral;
mod observers;
mod oscillators;
mod paper;
mod passages;
mod reference;
mod rigid_branches;
mod rigid_curves;
mod second_method;
mod sensitivities;
mod series_terms;
mod stribeck_scan;
mod successions;
mod unbounded;
mod whole_branches;
mod wide_box;
