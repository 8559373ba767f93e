//! The tests of the program, one module per floor.

mod figure;
