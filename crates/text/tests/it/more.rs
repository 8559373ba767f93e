//! The texts beside those that the form was designed with, against what is known of their oscillators.

use capsulemap_engine::attractor::attractors_of;
use capsulemap_engine::orbit::{Case, Machine, Outcome, Proof, Protocol, settle, settle_all};

use super::six::{A3, D3, characters, program};

/// The driven oscillator of a text.
fn driven(name: &str) -> D3 {
    D3::new(program(&characters(name)))
}

/// Starts along each side of the grid of the example.
const GRID: usize = 100;
/// How many of them lead to each of the five attractors, as the compiled oscillator of the engine's example `duffing` has it.
const OF_EXAMPLE: [usize; 5] = [1952, 4992, 270, 271, 2515];

#[test]
fn five_attractors_of_duffing_have_the_shares_of_the_compiled_oscillator() {
    let duffing = driven("duffing.toml");
    let starts = (0..GRID * GRID).map(|i| {
        let [x, v] = [i % GRID, i / GRID].map(|at| (at as f64 + 0.5) / GRID as f64);
        [-1.0 + 2.0 * x, -0.5 + 1.5 * v, 0.0, 0.0, 0.0]
    });
    let cases: Vec<_> = starts.map(|start| Case::new(duffing.clone(), start)).collect();
    let protocol = Protocol { exponent_cycles: 0, ..Protocol::default() };
    let orbits = settle_all(&cases, &protocol, Machine::default());
    assert!(orbits.iter().all(|it| it.outcome == Outcome::Periodic));
    assert!(orbits.iter().all(|it| it.certificate.proof == Proof::Newton));
    let table = attractors_of(&duffing, &orbits, &protocol);
    let period = |place: &usize| table.attractors[*place].points.len();
    assert_eq!(table.order.iter().map(period).collect::<Vec<_>>(), [1, 1, 2, 2, 3]);
    let mut counts = [0; 5];
    table.of_case.iter().flatten().for_each(|it| counts[*it as usize] += 1);
    let in_order: Vec<usize> = table.order.iter().map(|place| counts[*place]).collect();
    assert_eq!(in_order, OF_EXAMPLE);
}

#[test]
fn a_gear_that_is_turned_round_moves_turned_round() {
    let gear = driven("rattle.toml");
    let turned = gear.with_named("f", -0.5).with_named("b", -0.05);
    let case = |system: D3, [x, v]: [f64; 2]| Case::new(system, [x, v, 0.0, 0.0, 0.0]);
    let mut periodic = 0;
    for start in [[0.0, 0.0], [0.4, -0.3], [-0.9, 0.7]] {
        let one = settle(&case(gear.clone(), start), &Protocol::default());
        let other = settle(&case(turned.clone(), start.map(|it| -it)), &Protocol::default());
        assert_eq!((one.outcome, one.period), (other.outcome, other.period));
        for (a, b) in one.section.iter().zip(&other.section) {
            assert_eq!(*a, b.map(|it| -it));
        }
        periodic += usize::from(one.outcome == Outcome::Periodic);
    }
    assert!(periodic > 0);
}

/// Published of the block on the belt: where it turns back, and how long a cycle lasts.
#[test]
fn the_block_on_the_belt_has_the_published_cycle() {
    let block = A3::new(program(&characters("block.toml")));
    let case = Case::new(block, [1.5, 0.0, 0.0, 0.0, 0.0]);
    let orbit = settle(&case, &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert!((orbit.section[0][0] - 1.133_944_676_442).abs() < 1e-11, "{}", orbit.section[0][0]);
    assert!((orbit.duration - 12.001_031_294_834).abs() < 1e-10, "{}", orbit.duration);
}

/// Published of the drift oscillator (a = 0.3, b = 0.1, xi = 0.01, w = 0.1, gap 0.02): its motion repeats after two cycles, and the
/// multiplier of these that is not zero.
#[test]
fn the_drift_oscillator_has_the_published_multiplier() {
    let drift = driven("drift.toml");
    let orbit = settle(&Case::new(drift.clone(), [0.0; 5]), &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 2));
    assert_eq!(orbit.certificate.proof, Proof::Newton);
    let [largest, second, third] = orbit.certificate.multipliers[..] else { panic!("three") };
    assert!((largest.re + 0.60722).abs() < 5e-6 && largest.im == 0.0, "{largest:?}");
    // While the mass presses on the slider their places are one, so that two of three perturbations are forgotten.
    assert!(second.abs() < 1e-12 && third.abs() < 1e-12);
    // What a contact may press at most is a number that nothing depends on.
    let of_more = Case::new(drift.with_named("most", 1000.0), [0.0; 5]);
    let other = settle(&of_more, &Protocol::default());
    assert!((other.section[0][0] - orbit.section[0][0]).abs() < 1e-9);
}

/// Csernak's family: at half the natural frequency, with friction f, a motion that begins at rest at x = f + 4/3 + a turns back where a
/// period of free vibration has passed, at f - 4/3 + a, and is where it began after a period of the drive, for every a for which it
/// does not stick: |a| and |a + 2 f| below 1/3, as its velocity is -(2/3) sin(t/2) - a sin t, then with a + 2 f.
#[test]
fn every_motion_of_the_neutral_family_with_dry_friction_repeats() {
    let f = 0.05;
    let of_half = driven("friction.toml").with_named("w", 0.5).with_named("f", f);
    let of_half = of_half.with_named("s", f);
    let protocol = Protocol::default();
    let begun = |a: f64| {
        settle(&Case::new(of_half.clone(), [f + 4.0 / 3.0 + a, 0.0, 0.0, 0.0, 0.0]), &protocol)
    };
    for a in [-0.33, -0.2, -0.05, 0.1, 0.22] {
        let orbit = begun(a);
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1), "{a}");
        assert_eq!(orbit.certificate.proof, Proof::Neutral, "{a}");
        let [x, v, _] = orbit.certificate.neutral.expect("a direction");
        assert!((x.abs() - 1.0).abs() < 1e-6 && v.abs() < 1e-6, "{a}: {x} {v}");
        let [x, v, _] = orbit.section[0];
        assert!((x - (f + 4.0 / 3.0 + a)).abs() < 1e-9 && v.abs() < 1e-9, "{a}: {x} {v}");
    }
    // Beside the family a motion sticks, and nears the end of the family by less and less.
    let orbit = begun(-0.5);
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    assert!((orbit.section[0][0] - (f + 1.0)).abs() < 1e-4, "{}", orbit.section[0][0]);
}

/// One step of the classical Runge-Kutta method of the valve in flight, with its flow `q`.
fn valve_step([y1, y2, y3]: [f64; 3], h: f64, q: f64) -> [f64; 3] {
    let rate = |[y1, y2, y3]: [f64; 3]| {
        [y2, -1.25 * y2 - (y1 + 10.0) + y3, 20.0 * (q - y1 * libm::sqrt(y3))]
    };
    let from = [y1, y2, y3];
    let ahead = |by: f64, along: [f64; 3]| [0, 1, 2].map(|i| from[i] + by * along[i]);
    let a = rate(from);
    let b = rate(ahead(0.5 * h, a));
    let c = rate(ahead(0.5 * h, b));
    let d = rate(ahead(h, c));
    [0, 1, 2].map(|i| from[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
}

/// The last part of a step after which a coordinate of the valve is zero, by Newton's method.
fn valve_reaches(from: [f64; 3], coordinate: usize, q: f64) -> (f64, [f64; 3]) {
    let mut h = 0.0;
    for _ in 0..30 {
        let here = valve_step(from, h, q);
        let slope = (valve_step(from, h + 1e-7, q)[coordinate] - here[coordinate]) / 1e-7;
        h -= here[coordinate] / slope;
    }
    (h, valve_step(from, h, q))
}

/// A valve that does not bounce stays on its seat until the vessel has filled, at a constant rate, to the preload of the spring; from
/// there its flight is followed by another method.
#[test]
fn a_valve_stays_closed_until_the_vessel_has_filled() {
    let q = 1.0;
    let valve = A3::new(program(&characters("seat.toml"))).with_named("r", 0.0);
    let (step, mut state, mut flown, mut lift) = (1e-4, [0.0, 0.0, 10.0], 0.0, None);
    let lands = loop {
        let next = valve_step(state, step, q);
        if state[1] > 0.0 && next[1] <= 0.0 {
            lift = Some(valve_reaches(state, 1, q).1);
        }
        if flown > 0.5 && next[0] < 0.0 {
            let (rest, lands) = valve_reaches(state, 0, q);
            flown += rest;
            break lands;
        }
        (state, flown) = (next, flown + step);
    };
    let cycle = flown + (10.0 - lands[2]) / (20.0 * q);
    for start in [[0.0, 0.0, 5.0], [0.0, 0.0, 10.0], [0.5, 0.0, 12.0]] {
        // On the section y2 is zero; it is told behind the others.
        let [y1, y2, y3] = start;
        let case = Case::new(valve.clone(), [y1, y3, 0.0, y2, 0.0]);
        let orbit = settle(&case, &Protocol::default());
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1), "{start:?}");
        assert!((orbit.duration - cycle).abs() < 1e-9, "{} {cycle}", orbit.duration);
        let lift = lift.expect("a largest lift");
        let [y1, y3, _] = orbit.section[0];
        assert!((y1 - lift[0]).abs() < 1e-9 && (y3 - lift[2]).abs() < 1e-9, "{y1} {y3} {lift:?}");
    }
}
