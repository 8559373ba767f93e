//! A study of 20 000 cases on one thread and on all: what sharing it out gains, ends included.
//!
//! `cargo bench --bench study` prints the seconds from the first case to the last record, the median of three
//! interleaved repetitions with their spread, and the ratio. No file is written.

use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::available_parallelism;
use std::time::Instant;

use capsulemap::run::{Machine, run};

use capsulemap::study::Study;

const REPETITIONS: usize = 3;

const STUDY: &str = r#"
[parameters]
c = "0.9 N s/m"
mu_s = 0.3
mu_d = 0.15

[[axes]]
name = "omega"
from = "15 rad/s"
to = "140 rad/s"
points = 20

[[axes]]
name = "p_d"
from = "1 N"
to = "7 N"
points = 10

[[axes]]
name = "k2"
from = "2 kN/m"
to = "100 kN/m"
points = 10
spacing = "logarithmic"

[[axes]]
name = "delta"
from = "0 mm"
to = "4 mm"
points = 10
"#;

fn main() {
    let study = Study::parse("the bench", STUDY).expect("a study");
    let all = available_parallelism().map_or(1, usize::from);
    let mut seconds = [1, all].map(|threads| (threads, Vec::new()));
    let cycles = AtomicU64::new(0);
    for _ in 0..REPETITIONS {
        for (threads, seconds) in &mut seconds {
            let machine = Machine { threads: Some(*threads), ..Machine::default() };
            cycles.store(0, Ordering::Relaxed);
            let begun = Instant::now();
            run(&study, machine, |record| {
                cycles.fetch_add(record.orbit.cycles, Ordering::Relaxed);
            })
            .expect("the threads start");
            seconds.push(begun.elapsed().as_secs_f64());
        }
    }
    println!("{} cases, {} cycles", study.cases(), cycles.into_inner());
    println!("| threads | seconds | min .. max | times one |");
    println!("|---:|---:|---:|---:|");
    let mut one = f64::NAN;
    for (threads, seconds) in &mut seconds {
        seconds.sort_by(f64::total_cmp);
        let median = seconds[REPETITIONS / 2];
        if *threads == 1 {
            one = median;
        }
        let (least, most) = (seconds[0], seconds[REPETITIONS - 1]);
        println!("| {threads} | {median:.2} | {least:.2} .. {most:.2} | {:.2} |", one / median);
    }
}
