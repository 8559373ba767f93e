//! The capsule as a text beside the compiled one: cycles per second on one core, by turns.
//!
//! `cargo bench -p capsulemap-text --bench compiled` prints both and their ratio, for Figs 5 and 6 of the paper and a grid of 32 x 32.

use std::time::Instant;

use capsulemap_engine::orbit::{Case, Machine, returns};
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleSystem, Filippov, Parameter, Parameters, State,
};
use capsulemap_text::program::Program;
use capsulemap_text::read;
use capsulemap_text::system::Driven;

const REPETITIONS: usize = 5;
const CYCLES: usize = 200;
const TOLERANCE: f64 = 1e-12;

/// k2, omega, p_d and delta of some cases.
type Cases = Vec<[f64; 4]>;

fn sets() -> [(&'static str, Cases); 3] {
    let grid = (0..1024).map(|i| {
        let [x, y] = [i % 32, i / 32].map(|it| f64::from(it) / 31.0);
        [2420.0, 20.0 + 80.0 * x, 1.0 + 7.0 * y, 3.5e-3]
    });
    [
        ("Fig 5", vec![[2420.0, 77.91, 4.0, 3.5e-3]; 512]),
        ("Fig 6", vec![[18_960.0, 20.73, 4.0, 1.5e-3]; 512]),
        ("grid", grid.collect()),
    ]
}

fn seconds(work: impl FnOnce()) -> f64 {
    let begun = Instant::now();
    work();
    begun.elapsed().as_secs_f64()
}

fn main() {
    let text = include_str!("../../../systems/capsule.toml");
    let program = Box::leak(Box::new(Program::new(read(text).expect("no fault"), 3)));
    let base = Driven::<3, 5>::new(program);
    println!("| cases | compiled, cycles/s | text, cycles/s | times |");
    println!("|---|---:|---:|---:|");
    for (name, cases) in sets() {
        let compiled: Vec<_> = cases
            .iter()
            .map(|[k2, omega, p_d, delta]| {
                let values = [
                    (Parameter::K2, *k2),
                    (Parameter::Omega, *omega),
                    (Parameter::Pd, *p_d),
                    (Parameter::Delta, *delta),
                ];
                let system = CapsuleSystem::<Filippov>::new(Parameters::with(&values), 0.0);
                Case::new(system, State::default())
            })
            .collect();
        let texts: Vec<_> = cases
            .iter()
            .map(|values| {
                let names = ["k2", "omega", "p_d", "delta"].into_iter().zip(values);
                let system =
                    names.fold(base.clone(), |it, (name, value)| it.with_named(name, *value));
                Case::new(system, [0.0; 5])
            })
            .collect();
        let (mut ratios, mut speeds) = (Vec::new(), [0.0_f64; 2]);
        let all = (CYCLES * cases.len()) as f64;
        for _ in 0..REPETITIONS {
            let one = seconds(|| {
                returns::<_, 3>(&compiled, (CYCLES as u64, 1), TOLERANCE, Machine::single());
            });
            let other = seconds(|| {
                returns::<_, 3>(&texts, (CYCLES as u64, 1), TOLERANCE, Machine::single());
            });
            ratios.push(other / one);
            speeds = [speeds[0].max(all / one), speeds[1].max(all / other)];
        }
        ratios.sort_by(f64::total_cmp);
        let [compiled, text] = speeds;
        println!("| {name} | {compiled:.0} | {text:.0} | {:.2} |", ratios[REPETITIONS / 2]);
    }
}
