//! The integrator among its peers: `scripts/peers.sh` runs it beside them on the same cases.
//!
//! `cargo bench --bench peers` integrates the cases of `benches/cycles.rs` over 100 drive cycles from rest on
//! one thread, by the widest instructions that the processor has or, with `-- --scalar`, one by one. With
//! `-- --requests` it answers requests from standard input, as every contestant of that script does. A
//! request is a line "cycles tolerance seconds cases" and a line "k2 omega p_d delta" for each case; the
//! cases are integrated repeatedly until so many seconds have passed. An answer is one line of JSON: the
//! processor's seconds and the number of passes, and r, y1, x2, y2 and the number of events of each case at
//! the end.

mod cases;
mod lanes;

use std::fs;
use std::hint::black_box;
use std::io;
use std::thread;
use std::time::{Duration, Instant};

use capsulemap::capsule::Parameters;
use capsulemap::lane::Instructions;
use cases::{TOLERANCE, case_sets, integrate, parameters};
use lanes::{CYCLES, End};
use serde_json::json;

/// So that one repetition is long beside the clock's ticks.
const SECONDS: f64 = 1.0;

struct Request {
    instructions: Instructions,
    cycles: u64,
    tolerance: f64,
    seconds: f64,
    cases: Vec<Parameters>,
}

/// Processor time of this thread [s]; where the system does not report it, elapsed time.
///
/// The kernel brings its count up to date when the thread leaves the processor, hence the short sleep.
fn processor_seconds(begun: Instant) -> f64 {
    thread::sleep(Duration::from_nanos(1));
    let counted = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds: Option<f64> =
        counted.and_then(|text| text.split_whitespace().next()?.parse().ok());
    nanoseconds.map_or_else(|| begun.elapsed().as_secs_f64(), |count| count * 1e-9)
}

/// Integrates the cases until the seconds of the request have passed; returns the answer.
fn answer(request: &Request) -> serde_json::Value {
    let begun = Instant::now();
    let start = processor_seconds(begun);
    let mut passes = 0;
    loop {
        let cases = black_box(&request.cases);
        let ends = integrate(request.instructions, cases, request.cycles, request.tolerance);
        passes += 1;
        let seconds = processor_seconds(begun) - start;
        if seconds >= request.seconds {
            let cycles = (passes * request.cases.len() as u64 * request.cycles) as f64;
            let ends: Vec<_> = ends
                .iter()
                .map(|End { state: s, events, .. }| (s.r, s.y1, s.x2, s.y2, events))
                .collect();
            return json!({
                "seconds": seconds,
                "passes": passes,
                "cycles_per_second": cycles / seconds,
                "ends": ends,
            });
        }
    }
}

/// The next request, if there is one.
fn read(instructions: Instructions, lines: &mut impl Iterator<Item = String>) -> Option<Request> {
    let numbers = |line: String| -> Vec<f64> {
        line.split_whitespace().map(|number| number.parse().expect("a number")).collect()
    };
    let head = numbers(lines.next()?);
    let cases = lines.take(head[3] as usize).map(numbers);
    let cases = cases.map(|case| parameters(case[0], case[1], case[2], case[3])).collect();
    let (cycles, tolerance, seconds) = (head[0] as u64, head[1], head[2]);
    Some(Request { instructions, cycles, tolerance, seconds, cases })
}

fn answer_requests(instructions: Instructions) {
    let mut lines = io::stdin().lines().map(|line| line.expect("standard input can be read"));
    while let Some(request) = read(instructions, &mut lines) {
        println!("{}", answer(&request));
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let scalar = arguments.iter().any(|argument| argument == "--scalar");
    let instructions = if scalar { Instructions::Scalar } else { Instructions::widest() };
    if arguments.iter().any(|argument| argument == "--requests") {
        return answer_requests(instructions);
    }
    for (name, cases) in case_sets() {
        let (cycles, tolerance, seconds) = (CYCLES, TOLERANCE, SECONDS);
        let request = Request { instructions, cycles, tolerance, seconds, cases };
        println!("{}", json!({ "cases": name, "answer": answer(&request) }));
    }
}
