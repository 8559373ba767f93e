//! The tests of the whole: closed forms, invariants, references, and the program as its users run it.

mod acceleration;
mod attractors;
mod belt;
mod cli;
mod closed_forms;
mod derivatives;
mod draws;
mod edges;
mod figure;
mod forms;
mod house;
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
