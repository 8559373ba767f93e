//! Whole studies, from the first case to the last attractor: what they take beyond the lanes that move their cases, and
//! what sharing them out gains, ends included.
//!
//! `cargo bench --bench study` first computes four studies on one thread, once each: the seconds that cases and
//! attractors take, the cycles that the cases followed, and the share of the time beyond what the lanes alone need for as
//! many cycles of the same cases; and for each kernel of lanes the steps of lanes and how many of these had a motion in the
//! lane. Then 20 000 cases on one thread and on all: the median of three interleaved repetitions
//! with their spread. No file is written.

mod lanes;

use std::thread::available_parallelism;
use std::time::Instant;

use capsulemap::capsule::{CapsuleState as _, Parameters, State};
use capsulemap::lane::Instructions;
use capsulemap::orbit::{Kernel, LaneSteps};
use capsulemap::run::{Machine, attractors, final_motions, has_attractors, run, run_sample};
use capsulemap::study::Study;
use lanes::{CYCLES, integrate_from};

const REPETITIONS: usize = 3;
/// Cases of a study by which the lanes alone are measured.
const SAMPLE: usize = 1024;

const TWENTY_THOUSAND: &str = r#"
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

/// What a basin of 40 000 starts adds to the parameters of studies/hysteresis.toml.
const STARTS: &str = r#"
omega = "155 rad/s"

[[axes]]
name = "start_r"
from = "-6 mm"
to = "6 mm"
points = 200

[[axes]]
name = "start_y1"
from = "-1.5 m/s"
to = "1.5 m/s"
points = 200

[protocol]
points = 1
impact_points = 0
"#;

/// The study of four parameters, studies/million.toml, with so many points an axis.
const FOUR_PARAMETERS: usize = 13;

fn main() {
    let overview = include_str!("../studies/overview.toml").to_string();
    let four: String = include_str!("../studies/million.toml")
        .lines()
        .map(|line| match line.strip_prefix("points = ") {
            Some(points) if points != "1" => format!("points = {FOUR_PARAMETERS}\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    let hysteresis = include_str!("../studies/hysteresis.toml");
    let parameters = hysteresis.split("\n\n").find(|it| it.starts_with("[parameters]"));
    let parameters = parameters.expect("the study has parameters");
    let outputs = "outputs = [\"progression_speed\", \"work_positive\"]";
    let basin = format!("{outputs}\n\n{parameters}\n{}", STARTS.trim_start());
    println!("One thread, {}:", Instructions::widest().name());
    println!(
        "| study | cases | cycles | cases, s | attractors, s | cycles/s | lanes alone | beyond | steps a cycle | \
         events a cycle |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    let studies = [
        ("overview", &overview[..]),
        ("basin", &basin),
        ("four parameters", &four),
        ("20 000 cases", TWENTY_THOUSAND),
    ];
    let steps = studies.map(|(name, text)| (name, show(name, text)));
    println!("\nMillions of steps of lanes, and the lanes with a motion:");
    println!("| study | {} |", Kernel::ALL.map(Kernel::name).join(" | "));
    println!("|---|{}", "---:|".repeat(Kernel::ALL.len()));
    for (name, steps) in steps {
        println!("| {name} | {} |", steps.map(|it| occupancy(&it)).join(" | "));
    }
    println!();
    share_out();
}

fn parsed(text: &str) -> Study {
    Study::parse("the bench", text).expect("a study")
}

/// The steps of the lanes of a kernel, and how many had a motion.
fn occupancy(steps: &LaneSteps) -> String {
    match steps.all {
        0 => "-".to_string(),
        all => {
            let share = 100.0 * steps.with_motion as f64 / all as f64;
            format!("{:.1}, {share:.0} %", all as f64 * 1e-6)
        }
    }
}

/// Computes a study on one thread and prints what it took; the steps of the lanes of each kernel.
fn show(name: &str, text: &str) -> [LaneSteps; Kernel::ALL.len()] {
    let before = Kernel::ALL.map(Kernel::steps);
    let study = parsed(text);
    let all: Vec<usize> = (0..study.chains()).collect();
    let begun = Instant::now();
    let records = run_sample(&study, Machine::single(), &all, || ()).expect("the thread starts");
    let of_cases = begun.elapsed().as_secs_f64();
    let cycles = records.iter().map(|record| record.orbit.cycles).sum::<u64>() as f64;
    let begun = Instant::now();
    if has_attractors(&study) {
        let found = attractors(&study, &final_motions(&study, &records), Machine::single(), || ());
        found.expect("the thread starts");
    }
    let of_attractors = begun.elapsed().as_secs_f64();
    let steps = Kernel::ALL.map(|it| it.steps().since(before[it as usize]));
    let (all, alone) = (of_cases + of_attractors, LanesAlone::of(&study));
    println!(
        "| {name} | {} | {cycles} | {of_cases:.2} | {of_attractors:.2} | {:.0} | {:.0} | {:.0} % | {:.1} | {:.1} |",
        study.cases(),
        cycles / all,
        alone.speed,
        100.0 * (1.0 - cycles / alone.speed / all),
        alone.steps,
        alone.events
    );
    steps
}

/// What the lanes alone do with cases spread over a study.
struct LanesAlone {
    /// Cycles per second.
    speed: f64,
    /// Steps of a cycle.
    steps: f64,
    /// Events of a cycle.
    events: f64,
}

impl LanesAlone {
    fn of(study: &Study) -> Self {
        let every = study.cases().div_ceil(SAMPLE);
        let cases: Vec<(Parameters, State<f64>)> = (0..study.cases())
            .step_by(every)
            .map(|index| study.case(index))
            .map(|case| (case.parameters, case.start.capsule()))
            .collect();
        let begun = Instant::now();
        let ends = integrate_from(Instructions::widest(), &cases, CYCLES, study.protocol.tolerance);
        let seconds = begun.elapsed().as_secs_f64();
        let cycles = (cases.len() as u64 * CYCLES) as f64;
        let of_cycle = |count: u64| count as f64 / cycles;
        LanesAlone {
            speed: cycles / seconds,
            steps: of_cycle(ends.iter().map(|end| end.steps).sum()),
            events: of_cycle(ends.iter().map(|end| end.events).sum()),
        }
    }
}

/// Computes 20 000 cases on one thread and on all.
fn share_out() {
    let study = parsed(TWENTY_THOUSAND);
    let all = available_parallelism().map_or(1, usize::from);
    let mut seconds = [1, all].map(|threads| (threads, Vec::new()));
    for _ in 0..REPETITIONS {
        for (threads, seconds) in &mut seconds {
            let machine = Machine { threads: Some(*threads), ..Machine::default() };
            let begun = Instant::now();
            run(&study, machine, |_| ()).expect("the threads start");
            seconds.push(begun.elapsed().as_secs_f64());
        }
    }
    println!("{} cases:", study.cases());
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
