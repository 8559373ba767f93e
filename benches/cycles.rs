//! Forcing cycles per second on one core, by each set of instructions that the processor has, at 1e-12.
//!
//! `cargo bench --bench cycles` prints for every set of cases the steps per cycle, and for every set of
//! instructions the cycles per second (the median of five interleaved repetitions, with their spread) and
//! how many times that is the scalar form's. Compare figures of one run only: machines are shared.

mod cases;
mod lanes;

use std::hint::black_box;
use std::time::Instant;

use capsulemap::capsule::description::CAPSULE_OVER_FOLDS;
use capsulemap::capsule::{CapsuleParameters as _, DriveKind, Parameter, Parameters};
use capsulemap::lane::Instructions;
use cases::{TOLERANCE, case_sets, integrate};
use lanes::CYCLES;

const REPETITIONS: usize = 5;

fn main() {
    println!("| cases | steps/cycle | instructions | cycles/s | min .. max | times scalar |");
    println!("|---|---:|---|---:|---:|---:|");
    for (name, cases) in case_sets().into_iter().chain(member_sets()) {
        let mut speeds: Vec<(Instructions, Vec<f64>)> =
            Instructions::available().map(|it| (it, Vec::new())).collect();
        let mut steps_per_cycle = 0.0;
        for _ in 0..REPETITIONS {
            for (instructions, speeds) in &mut speeds {
                let (steps, cycles_per_second) = measure(*instructions, &cases);
                steps_per_cycle = steps;
                speeds.push(cycles_per_second);
            }
        }
        let mut scalar = f64::NAN;
        for (instructions, speeds) in &mut speeds {
            speeds.sort_by(f64::total_cmp);
            let median = speeds[REPETITIONS / 2];
            if *instructions == Instructions::Scalar {
                scalar = median;
            }
            println!(
                "| {name} | {steps_per_cycle:.1} | {} | {median:.0} | {:.0} .. {:.0} | {:.2} |",
                instructions.name(),
                speeds[0],
                speeds[REPETITIONS - 1],
                median / scalar
            );
        }
    }
}

/// Steps per cycle, and cycles per second.
fn measure(instructions: Instructions, cases: &[Parameters]) -> (f64, f64) {
    let begun = Instant::now();
    let ends = integrate(instructions, black_box(cases), CYCLES, TOLERANCE);
    let seconds = begun.elapsed().as_secs_f64();
    let cycles = (cases.len() as u64 * CYCLES) as f64;
    let steps: u64 = ends.iter().map(|end| end.steps).sum();
    (steps as f64 / cycles, cycles / seconds)
}

/// Members of the family by name, each the grid with a part more; the harmonic one has a part that changes nothing.
fn member_sets() -> Vec<(&'static str, Vec<Parameters>)> {
    let [.., (_, grid)] = case_sets();
    let with = |change: &dyn Fn(&mut Parameters)| {
        let mut cases = grid.clone();
        cases.iter_mut().for_each(change);
        cases
    };
    vec![
        ("grid, as a member", with(&|p| p[Parameter::Load] = 0.0)),
        (
            "grid, square wave",
            with(&|p| {
                p.drive_by(DriveKind::Square);
                // One that pushed alone would have a mean force that nothing holds.
                p[Parameter::PLow] = -p[Parameter::Pd];
            }),
        ),
        (
            "grid, two harmonics",
            with(&|p| {
                p.drive_by(DriveKind::TwoHarmonics);
                p[Parameter::P2] = 0.5;
            }),
        ),
        (
            "grid, rear stop and preload",
            with(&|p| {
                p[Parameter::K3] = 53_500.0;
                p[Parameter::Delta3] = 0.002;
                p[Parameter::PreloadGap] = 0.0002;
            }),
        ),
        (
            "grid, friction by direction and drag",
            with(&|p| {
                p[Parameter::MuDBackward] = 0.4;
                p[Parameter::C1] = 0.5;
            }),
        ),
        ("grid, rigid stop", with(&|p| p[Parameter::Restitution] = 0.5)),
        (
            "grid, folds",
            with(&|p| {
                *p = p.of_extension(&CAPSULE_OVER_FOLDS);
                p[Parameter::FoldFriction] = 0.3;
                p[Parameter::FoldForce] = 0.3;
            }),
        ),
        (
            "grid, prescribed motion",
            with(&|p| {
                p.drive_by(DriveKind::Prescribed);
                p[Parameter::Xi1] = 0.003;
            }),
        ),
        ("grid, cubic spring", with(&|p| p[Parameter::K1Cubic] = 1e7)),
    ]
}
