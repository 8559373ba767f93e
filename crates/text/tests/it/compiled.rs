//! The capsule as a text against the compiled one, over the whole box.

use capsulemap_engine::flow::System as _;
use capsulemap_engine::orbit::{self};
use capsulemap_engine::orbit::{Machine, Outcome, Protocol, Trajectory, settle_all};
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, Output, Parameter, Resistance, State,
    settle_case,
};
use capsulemap_models::model::SimulationSize;
use capsulemap_models::of::model_of;
use rayon::prelude::*;

use super::draws;
use super::six::{D3, characters, program};

/// Cases that are drawn; the long form takes 10 000 (CASES=10000).
fn count() -> usize {
    std::env::var("CASES").map_or(150, |it| it.parse().expect("CASES is a number"))
}

/// The parameters of the text, each with that of the capsule.
const NAMES: [(&str, Parameter); 12] = [
    ("m1", Parameter::M1),
    ("m2", Parameter::M2),
    ("k1", Parameter::K1),
    ("c", Parameter::C),
    ("v_s", Parameter::Vs),
    ("mu_s", Parameter::MuS),
    ("mu_d", Parameter::MuD),
    ("g", Parameter::G),
    ("omega", Parameter::Omega),
    ("p_d", Parameter::Pd),
    ("k2", Parameter::K2),
    ("delta", Parameter::Delta),
];

/// The same case of the text.
fn as_text(base: &D3, case: &Case) -> orbit::Case<D3, 3> {
    let named = |system: D3, (name, parameter): &(&str, Parameter)| {
        system.with_named(name, case.parameters[*parameter])
    };
    let turns = case.section_phase.rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
    let system = NAMES.iter().fold(base.clone(), named).seen_at(turns);
    let State { r, y1, x2, y2, .. } = case.start.capsule();
    orbit::Case { begins: case.start_time(), ..orbit::Case::new(system, [r, y1, y2, 0.0, x2]) }
}

#[test]
fn the_first_cycles_are_those_of_the_compiled_capsule() {
    let base = D3::new(program(&characters("capsule.toml")));
    let (mut worst, mut sensitive, mut followed) = (0.0_f64, 0, 0);
    for case in draws::wide(count(), 43, Resistance::CoulombStribeck) {
        let size = SimulationSize { cycles: 5, events: 10_000 };
        let sections = |case: &Case| {
            let motion = model_of(&case.parameters).simulate(case, size, 1e-14);
            let states = motion.section.iter().map(|it| it.state.capsule().coordinates());
            states.collect::<Vec<_>>()
        };
        let known = sections(&case);
        let size = known.iter().flatten().map(|it| it.abs()).fold(1e-3, f64::max);
        // A motion that forgets its start so slowly, or not at all, that rounding shows, is no measure of a method.
        let State { r, .. } = case.start.capsule();
        let push = State {
            r: r + 1e-11 * size / case.parameters[Parameter::Omega],
            ..case.start.capsule()
        };
        let near = sections(&Case { start: push.into(), ..case.clone() });
        let gap = |a: &[f64; 4], b: &[f64; 4]| {
            (0..4).map(|i| (a[i] - b[i]).abs() / size).fold(0.0, f64::max)
        };
        if known.iter().zip(&near).map(|(a, b)| gap(a, b)).fold(0.0, f64::max) > 1e-10 {
            sensitive += 1;
            continue;
        }
        let text = as_text(&base, &case);
        let single = text.system.single();
        let mut trajectory = Trajectory::<_, 3>::begun(&single, text.start, text.begins, 1e-14);
        let mut sections = known.iter();
        if trajectory.is_at_section() {
            sections.next();
        }
        for (cycle, known) in sections.enumerate() {
            let arrives = trajectory.cycle(|_| ());
            assert!(arrives.is_ok(), "{cycle}: {case:?}");
            let [r, y1, y2, _, x2] = trajectory.state();
            let gap = gap(known, &[r, y1, x2, y2]);
            assert!(
                gap < 1e-9,
                "{gap:e} after {cycle} cycles, {known:?} {:?}: {case:?}",
                [r, y1, x2, y2]
            );
            worst = worst.max(gap);
        }
        followed += 1;
    }
    println!("{followed} capsules within {worst:e}, {sensitive} are sensitive");
    assert!(followed > sensitive, "{followed} {sensitive}");
}

/// Where several attractors are near, or one is neutral, the last digit decides where a long transient ends: few differ so.
#[test]
fn what_it_settles_to_is_what_the_compiled_capsule_settles_to() {
    let base = D3::new(program(&characters("capsule.toml")));
    let drawn = draws::wide(count(), 41, Resistance::CoulombStribeck);
    let protocol = Protocol { exponent_cycles: 0, ..Protocol::default() };
    let cases: Vec<_> = drawn.iter().map(|case| as_text(&base, case)).collect();
    let texts = settle_all(&cases, &protocol, Machine::default());
    let compiled: Vec<_> = drawn.par_iter().map(|it| settle_case(it, &protocol)).collect();
    let (mut same, mut other) = (0, Vec::new());
    for ((case, text), capsule) in drawn.iter().zip(&texts).zip(&compiled) {
        let cycles = text.measured_cycles as f64;
        let speed = (text.end[4] - text.begins[4]) / (cycles * case.parameters.drive_period());
        let known = capsule.outputs[Output::ProgressionSpeed];
        let is_alike = (text.outcome, text.period) == (capsule.outcome, capsule.period);
        if is_alike && (text.outcome != Outcome::Periodic || (speed - known).abs() < 1e-9) {
            same += 1;
        } else {
            let (outcome, known_outcome) = (text.outcome, capsule.outcome);
            let (period, known_period) = (text.period, capsule.period);
            other.push(format!(
                "{outcome:?} {period} {speed:e}, compiled {known_outcome:?} {known_period} {known:e}: \
                 defect {:e}, {:?}",
                text.defect, case.parameters
            ));
        }
    }
    println!("{same} of {} are the same", drawn.len());
    other.iter().take(12).for_each(|it| println!("    {it}"));
    assert!(20 * other.len() <= drawn.len(), "{}", other.len());
}
