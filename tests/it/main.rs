//! The tests of the whole: closed forms, invariants, references, and the program as its users run it.

mod acceleration;
mod belt;
mod cli;
mod closed_forms;
mod den_hartog;
mod derivatives;
mod differences;
mod directions;
mod divergence;
mod draws;
mod dual_lanes;
mod edges;
mod figure;
mod forms;
mod house;
mod impact_orbits;
mod invariants;
mod lanes;
mod oscillators;
mod paper;
mod program;
mod readme;
mod reference;
mod run;
mod store;
mod study;
