//! The tests of the whole: closed forms, invariants, references, and the program as its users run it.

mod belt;
mod closed_forms;
mod figure;
mod house;
mod paper;
mod reference;
mod store;
