//! The integrator among its peers: `scripts/peers.sh` runs it beside them on the same cases.
//!
//! `cargo bench --bench peers` integrates the cases of `benches/cycles.rs` over 100 drive cycles from rest on
//! one thread, by the widest instructions that the processor has or, with `-- --scalar`, one by one. With
//! `-- --requests` it answers requests from standard input, as every contestant of that script does. A
//! request is a line "cycles tolerance seconds cases" and a line "k2 omega p_d delta" for each case; the
//! cases are integrated repeatedly until so many seconds have passed. An answer is one line of JSON: the
//! processor's seconds and the number of passes, and r, y1, x2, y2 and the number of events of each case at
//! the end. With `--settle` the cases are settled instead, within so many cycles and with less damping than Table 1's, and told are the
//! period, zero where none was found, and the average progression speed [m/s].

mod cases;
mod lanes;
#[path = "../crates/engine/benches/processor/mod.rs"]
mod processor;

use std::fs;
use std::hint::black_box;
use std::io;
use std::thread;
use std::time::{Duration, Instant};

use capsulemap::capsule::{Case, Orbit, Output, Parameter, Parameters, State, settle_all};
use capsulemap::lane::Instructions;
use capsulemap::orbit::{Machine, Protocol};
use cases::{TOLERANCE, case_sets, integrate, parameters};
use lanes::{CYCLES, End};
use processor::seconds_of_all_threads;
use serde_json::json;

/// So that one repetition is long beside the clock's ticks.
const SECONDS: f64 = 1.0;
/// Damping of the cases that are settled [N s/m]: with that of Table 1 few periods are longer than one.
const MAP_DAMPING: f64 = 0.9;

struct Request {
    instructions: Instructions,
    /// Whether the cases are settled rather than integrated over the cycles.
    settle: bool,
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

/// The state and the number of events of each case at the end.
fn ends(request: &Request) -> Vec<serde_json::Value> {
    let Request { instructions, cycles, tolerance, cases, .. } = request;
    let ends = integrate(*instructions, black_box(cases), *cycles, *tolerance);
    let told = |End { state: s, events, .. }: &End| json!([s.r, s.y1, s.x2, s.y2, events]);
    ends.iter().map(told).collect()
}

/// The period and the speed of what each case settles to.
fn orbits(request: &Request) -> Vec<serde_json::Value> {
    let Request { instructions, cycles, tolerance, cases, .. } = request;
    let from_rest = |it: &Parameters| {
        let mut parameters = it.clone();
        parameters[Parameter::C] = MAP_DAMPING;
        Case::at_section(parameters, State::default(), 0.0)
    };
    let cases: Vec<Case> = black_box(cases).iter().map(from_rest).collect();
    let protocol = Protocol::with_tolerance(*tolerance);
    let protocol = Protocol { max_cycles: *cycles, exponent_cycles: 0, ..protocol };
    let machine = Machine { threads: Some(1), instructions: Some(*instructions) };
    let told = |it: &Orbit| json!([it.period, it.outputs[Output::ProgressionSpeed]]);
    settle_all(&cases, &protocol, machine).iter().map(told).collect()
}

/// Computes the cases until the seconds of the request have passed; returns the answer.
fn answer(request: &Request) -> serde_json::Value {
    let begun = Instant::now();
    // Cases settle on a thread of their own.
    let now = if request.settle { seconds_of_all_threads } else { processor_seconds };
    let start = now(begun);
    let mut passes = 0;
    loop {
        let ends = if request.settle { orbits(request) } else { ends(request) };
        passes += 1;
        let seconds = now(begun) - start;
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
fn read(
    instructions: Instructions,
    settle: bool,
    lines: &mut impl Iterator<Item = String>,
) -> Option<Request> {
    let numbers = |line: String| -> Vec<f64> {
        line.split_whitespace().map(|number| number.parse().expect("a number")).collect()
    };
    let head = numbers(lines.next()?);
    let cases = lines.take(head[3] as usize).map(numbers);
    let cases = cases.map(|case| parameters(case[0], case[1], case[2], case[3])).collect();
    let (cycles, tolerance, seconds) = (head[0] as u64, head[1], head[2]);
    Some(Request { instructions, settle, cycles, tolerance, seconds, cases })
}

fn answer_requests(instructions: Instructions, settle: bool) {
    let mut lines = io::stdin().lines().map(|line| line.expect("standard input can be read"));
    while let Some(request) = read(instructions, settle, &mut lines) {
        println!("{}", answer(&request));
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let is_given = |option: &str| arguments.iter().any(|argument| argument == option);
    let (scalar, settle) = (is_given("--scalar"), is_given("--settle"));
    let instructions = if scalar { Instructions::Scalar } else { Instructions::widest() };
    if is_given("--requests") {
        return answer_requests(instructions, settle);
    }
    for (name, cases) in case_sets() {
        let (cycles, tolerance, seconds) = (CYCLES, TOLERANCE, SECONDS);
        let request = Request { instructions, settle, cycles, tolerance, seconds, cases };
        println!("{}", json!({ "cases": name, "answer": answer(&request) }));
    }
}
