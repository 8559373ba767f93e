//! The scalar integrator among its peers: `scripts/peers.sh` runs it beside them on the same cases.
//!
//! `cargo bench --bench peers` follows the works of `benches/cycles.rs` for 100 drive cycles from rest
//! on one thread. With `-- --requests` it answers requests from standard input, as every contestant of
//! that script does. A request is a line "cycles tolerance seconds cases" and a line
//! "k2 omega p_d delta" for each case; the cases are followed again and again until so many seconds
//! have passed. An answer is one line of JSON: the processor's seconds and the number of passes, and
//! r, y1, x2, y2 and the number of events of each case at the end.

use std::fs;
use std::hint::black_box;
use std::io;
use std::thread;
use std::time::{Duration, Instant};

use capsulemap::flow::Step;
use capsulemap::model::{Capsule, Parameter, Parameters, State};
use capsulemap::orbit::Trajectory;
use serde_json::json;

/// Without requests, as `benches/cycles.rs`.
const CYCLES: u64 = 100;
const TOLERANCE: f64 = 1e-12;
/// So that one repetition is long beside the clock's ticks.
const SECONDS: f64 = 1.0;
/// So many copies of a figure's one case fill any number of lanes up to 64.
const COPIES: usize = 64;

/// r, y1, x2, y2 and the number of events.
type End = (f64, f64, f64, f64, u64);

struct Request {
    cycles: u64,
    tolerance: f64,
    seconds: f64,
    cases: Vec<Parameters>,
}

fn parameters(k2: f64, omega: f64, p_d: f64, delta: f64) -> Parameters {
    Parameters::with(&[
        (Parameter::K2, k2),
        (Parameter::Omega, omega),
        (Parameter::Pd, p_d),
        (Parameter::Delta, delta),
    ])
}

/// Follows every case from rest; returns where each ends.
fn follow(cases: &[Parameters], cycles: u64, tolerance: f64) -> Vec<End> {
    cases
        .iter()
        .map(|parameters| {
            let system = Capsule::single(parameters, 0.0);
            let period = parameters.drive_period();
            let mut trajectory = Trajectory::new(&system, State::default(), period, tolerance);
            let mut events = 0;
            for _ in 0..cycles {
                let count = |step: &Step<f64, _>| {
                    events += u64::from(step.event != 0.0);
                };
                trajectory.cycle(count).expect("the case can be followed");
            }
            let State { r, y1, x2, y2 } = trajectory.state();
            (r, y1, x2, y2, events)
        })
        .collect()
}

/// Processor time of this thread [s]; where the system does not tell, time on the wall.
///
/// The kernel brings its count up to date when the thread leaves the processor, hence the short sleep.
fn processor_seconds(begun: Instant) -> f64 {
    thread::sleep(Duration::from_nanos(1));
    let counted = fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds: Option<f64> =
        counted.and_then(|text| text.split_whitespace().next()?.parse().ok());
    nanoseconds.map_or_else(|| begun.elapsed().as_secs_f64(), |count| count * 1e-9)
}

/// Follows the cases until the seconds of the request have passed; returns the answer.
fn answer(request: &Request) -> serde_json::Value {
    let begun = Instant::now();
    let start = processor_seconds(begun);
    let mut passes = 0;
    loop {
        let ends = follow(black_box(&request.cases), request.cycles, request.tolerance);
        passes += 1;
        let seconds = processor_seconds(begun) - start;
        if seconds >= request.seconds {
            let cycles = (passes * request.cases.len() as u64 * request.cycles) as f64;
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
fn read(lines: &mut impl Iterator<Item = String>) -> Option<Request> {
    let numbers = |line: String| -> Vec<f64> {
        line.split_whitespace().map(|word| word.parse().expect("a number")).collect()
    };
    let head = numbers(lines.next()?);
    let cases = lines.take(head[3] as usize).map(numbers);
    let cases = cases.map(|case| parameters(case[0], case[1], case[2], case[3])).collect();
    Some(Request { cycles: head[0] as u64, tolerance: head[1], seconds: head[2], cases })
}

fn answer_requests() {
    let mut lines = io::stdin().lines().map(|line| line.expect("standard input can be read"));
    while let Some(request) = read(&mut lines) {
        println!("{}", answer(&request));
    }
}

fn main() {
    if std::env::args().any(|argument| argument == "--requests") {
        return answer_requests();
    }
    let grid: Vec<Parameters> = (0..32 * 32)
        .map(|i| {
            let along =
                |index: i32, from: f64, to: f64| from + (to - from) * f64::from(index) / 31.0;
            parameters(18_960.0, along(i % 32, 10.0, 100.0), along(i / 32, 1.0, 6.0), 0.0015)
        })
        .collect();
    let works = [
        ("Fig 5", vec![parameters(2420.0, 77.91, 4.0, 0.0035); COPIES]),
        ("Fig 6", vec![parameters(18_960.0, 20.73, 4.0, 0.0015); COPIES]),
        ("grid 32 x 32", grid),
    ];
    for (name, cases) in works {
        let request = Request { cycles: CYCLES, tolerance: TOLERANCE, seconds: SECONDS, cases };
        println!("{}", json!({ "work": name, "answer": answer(&request) }));
    }
}
