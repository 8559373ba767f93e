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
