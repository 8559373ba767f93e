//! An orbit that is told before it is reached is the one to which integration alone leads.

use capsulemap_engine::lane::Instructions;
use capsulemap_engine::orbit::{Machine, Outcome, Protocol};
use capsulemap_models::capsule::{
    CapsuleParameters as _, Case, Orbit, Output, Parameter, Parameters, Resistance, State,
    settle_all,
};

use super::draws::{self, Random};

/// A count that the environment may set.
fn count(name: &str, usual: usize) -> usize {
    std::env::var(name).map_or(usual, |text| text.parse().expect("a number"))
}

/// Whether two motions are on one orbit, by period, speed and work.
fn are_one(a: &Orbit, b: &Orbit) -> bool {
    let near = |output: Output| {
        let (a, b) = (a.outputs[output], b.outputs[output]);
        (a - b).abs() <= 1e-8 + 1e-6 * b.abs()
    };
    a.period == b.period && near(Output::ProgressionSpeed) && near(Output::WorkPositive)
}

/// Compares what cases settle to with what they settle to by integration alone: how many are periodic both times, and the
/// cycles followed.
fn compared(cases: &[Case], protocol: &Protocol, name: &str) -> (usize, [u64; 2]) {
    let plain = Protocol { accelerate: false, ..*protocol };
    let [fast, slow] = [protocol, &plain].map(|it| settle_all(cases, it, Machine::default()));
    let (mut both, mut cycles) = (0, [0, 0]);
    for (i, (fast, slow)) in fast.iter().zip(&slow).enumerate() {
        match [fast, slow].map(|it| it.outcome == Outcome::Periodic) {
            [true, true] => {
                assert!(are_one(fast, slow), "{name}, case {i}: {:?}", cases[i]);
                both += 1;
                cycles = [cycles[0] + fast.cycles, cycles[1] + slow.cycles];
            }
            // Whoever waits may run out of cycles first, and has them when they are allowed.
            [true, false] => {
                let patient = Protocol { max_cycles: 20 * plain.max_cycles, ..plain };
                let waited = &settle_all(&cases[i..=i], &patient, Machine::single())[0];
                assert!(are_one(fast, waited), "{name}, case {i}: {:?}", cases[i]);
            }
            [false, true] => {
                panic!("{name}, case {i} settles by integration alone: {:?}", cases[i])
            }
            [false, false] => assert_eq!(fast.outcome, slow.outcome, "{name}, case {i}"),
        }
    }
    (both, cycles)
}

/// `CASES=200000 cargo test --release --test it -- acceleration --nocapture` for long.
#[test]
fn random_cases_settle_where_integration_leads() {
    let cases = draws::cases(count("CASES", 500), 3);
    let (both, cycles) = compared(&cases, &Protocol::default(), "a draw");
    println!("{both} periodic both times, in {cycles:?} cycles");
    assert!(both > cases.len() * 8 / 10 && cycles[0] < cycles[1]);
}

/// A weakly damped capsule whose basins have a fractal boundary.
fn fractal() -> Parameters {
    Parameters::with(&[
        (Parameter::K2, 60e3),
        (Parameter::Delta, 2e-3),
        (Parameter::Omega, 37.5),
        (Parameter::Pd, 2.75),
        (Parameter::C, 0.05),
        (Parameter::MuS, 0.3),
        (Parameter::MuD, 0.25),
    ])
}

/// A start in the plane in which basins are narrow.
fn start(parameters: &Parameters, random: &mut Random) -> Case {
    let (r, y1) = (random.uniform(-1.2e-2, 5e-3), random.uniform(-0.8, 0.8));
    let y2 = if random.uniform(0.0, 1.0) < 0.5 { 0.0 } else { random.uniform(-0.3, 0.3) };
    Case::at_section(parameters.clone(), State::of([r, y1, 0.0, y2]), 0.0)
}

/// Draws a capsule of the box of weak and usual damping.
fn capsule(random: &mut Random) -> Parameters {
    let seed = random.uniform(0.0, 1e9) as u64;
    let mut parameters =
        draws::wide(1, seed, Resistance::CoulombStribeck).swap_remove(0).parameters;
    parameters[Parameter::Omega] = random.uniform(10.0, 200.0);
    parameters[Parameter::C] = random.logarithmic(0.05, 2.0);
    parameters[Parameter::Pd] = random.uniform(0.5, 8.0);
    parameters[Parameter::Delta] = random.uniform(0.0, 5e-3);
    parameters
}

/// Whether starts of a capsule lead to two periodic motions or more, and few to others, which take long to follow.
fn has_several(parameters: &Parameters, random: &mut Random, protocol: &Protocol) -> bool {
    let cases: Vec<Case> = (0..32).map(|_| start(parameters, random)).collect();
    let plain = Protocol { accelerate: false, ..*protocol };
    let orbits = settle_all(&cases, &plain, Machine::default());
    let mut periodic = orbits.iter().filter(|it| it.outcome == Outcome::Periodic);
    let Some(first) = periodic.next() else { return false };
    let (mut several, mut all) = (false, 1);
    for orbit in periodic {
        several |= !are_one(orbit, first);
        all += 1;
    }
    several && all * 10 >= 9 * cases.len()
}

/// `CAPSULES=41 STARTS=5000 cargo test --release --test it -- acceleration --nocapture` for long.
#[test]
fn starts_of_several_attractors_settle_where_integration_leads() {
    let protocol =
        Protocol { points: 1, impact_points: 0, exponent_cycles: 256, ..Protocol::default() };
    let (wanted, starts) = (count("CAPSULES", 4), count("STARTS", 250));
    let mut random = Random::new(7);
    let mut capsules = vec![fractal()];
    while capsules.len() < wanted {
        let drawn = capsule(&mut random);
        if has_several(&drawn, &mut random, &protocol) {
            capsules.push(drawn);
        }
    }
    let (mut both, mut cycles) = (0, [0, 0]);
    for (number, parameters) in capsules.iter().enumerate() {
        let cases: Vec<Case> = (0..starts).map(|_| start(parameters, &mut random)).collect();
        let of_capsule = compared(&cases, &protocol, &format!("capsule {number}"));
        both += of_capsule.0;
        cycles = [cycles[0] + of_capsule.1[0], cycles[1] + of_capsule.1[1]];
    }
    println!(
        "{} capsules: {both} starts periodic both times, in {cycles:?} cycles",
        capsules.len()
    );
    assert!(both * 10 > wanted * starts * 8);
}

/// A leap to the limit of the section points once led this start to a motion of period 3 with 4.59582 mJ; integrators at
/// 1e-12 and 1e-14 that share no code with the series lead it to period 1 with 4.5951 mJ.
#[test]
fn a_start_between_narrow_basins_settles_where_it_leads() {
    let start = State::of([-10.481e-3, 0.516456, 0.0, 0.0]);
    let case = Case::at_section(fractal(), start, 0.0);
    let orbit = &settle_all(&[case], &Protocol::default(), Machine::single())[0];
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert!((orbit.outputs[Output::WorkPositive] - 4.5951e-3).abs() < 1e-7);
}

#[test]
fn whoever_asks_for_period_one_alone_is_told_as_soon() {
    let cases = draws::cases(100, 4);
    let cycles = |protocol: &Protocol| -> u64 {
        let orbits = draws::settled(&cases, protocol, Instructions::widest());
        // Longer periods are found only after the budget of cycles, with and without acceleration.
        let periodic = orbits.iter().filter(|orbit| orbit.period == 1);
        periodic.map(|orbit| orbit.cycles).sum()
    };
    let told = Protocol { max_period: 1, ..Protocol::default() };
    let waiting = Protocol { accelerate: false, ..told };
    assert!(cycles(&told) < cycles(&waiting));
}
