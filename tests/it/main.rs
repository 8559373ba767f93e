//! The one test program: a module for each floor, and one for the house itself.

mod house;
mod store;
