//! Tests of oscillators given as text.

mod compiled;
mod contract;
#[path = "../../../engine/tests/it/differences.rs"]
#[allow(dead_code)]
mod differences;
#[path = "../../../engine/tests/it/draws.rs"]
#[allow(dead_code)]
mod draws;
mod events;
mod faults;
mod lasting;
mod more;
mod outputs;
mod own;
mod random_texts;
mod sampled;
mod six;
mod spectra;
mod units;
#[path = "../../../engine/tests/it/volumes.rs"]
mod volumes;
