//! The tests of the whole: closed forms, invariants, references, and the program as its users run it.

mod cli;
mod figure;
mod house;
mod paper;
mod program;
mod reference;
mod run;
mod store;
mod study;
