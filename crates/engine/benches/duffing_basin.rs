//! A basin of attraction as a whole job: `scripts/peers.sh --jobs` compares it with that of another program.
//!
//! `cargo bench -p capsulemap-engine --bench duffing_basin -- 100 1e-8` settles 100 x 100 starts of Duffing's oscillator, those of the
//! example of that name, at this tolerance on one thread, and prints one line of JSON: the processor's seconds, and the attractor that
//! each start leads to, -1 where that is not decided.

// Of the example only its system is used here, not its program.
#[path = "../examples/duffing.rs"]
#[allow(dead_code)]
mod duffing;
mod processor;

use std::time::Instant;

use capsulemap_engine::attractor::attractors_of;
use capsulemap_engine::orbit::{Case, Machine, Protocol, settle_all};
use duffing::Duffing;
use processor::seconds_of_all_threads;

fn main() {
    let numbers: Vec<f64> = std::env::args().filter_map(|text| text.parse().ok()).collect();
    let [side, tolerance] = numbers[..] else {
        panic!("duffing_basin is asked for by the starts along a side and a tolerance");
    };
    let duffing = Duffing { c: 0.08, p: 0.2 };
    let along = |at: usize, from: f64, to: f64| from + (to - from) * (at as f64 + 0.5) / side;
    let side_count = side as usize;
    let starts = (0..side_count * side_count).map(|number| {
        let (column, row) = (number % side_count, number / side_count);
        [along(column, -1.0, 1.0), along(row, -0.5, 1.0)]
    });
    let cases: Vec<_> = starts.map(|start| Case::new(duffing, start)).collect();
    let protocol = Protocol::with_tolerance(tolerance);
    let begun = Instant::now();
    let before = seconds_of_all_threads(begun);
    let orbits = settle_all(&cases, &protocol, Machine::single());
    let table = attractors_of(&duffing, &orbits, &protocol);
    let seconds = seconds_of_all_threads(begun) - before;
    let labels = table.of_case.iter().map(|place| place.map_or(-1, |it| it as i64));
    println!("{{\"seconds\": {seconds}, \"labels\": {:?}}}", labels.collect::<Vec<_>>());
}
