//! Measures of basins on maps with known answers, and shares of draws.

use capsulemap::attractor::{Estimate, Label, entropy, shares_of_draws, uncertainty};
use capsulemap::capsule::CapsuleState as _;
use capsulemap::study::{CaseSet, Study};

use super::program::TWO_MOTIONS;

#[test]
fn shares_of_two_seeds_agree_as_their_errors_say() {
    // A start leads to the attractor of the nearest root of z^3 - 1 by Newton's method, after one step: no closed form
    // for the shares, and boundaries that are not straight.
    let label = |[x, y]: [f64; 2]| {
        let (square, cross) = (x * x - y * y, 2.0 * x * y);
        let norm = 3.0 * (square * square + cross * cross);
        let next = [2.0 * x / 3.0 + square / norm, 2.0 * y / 3.0 - cross / norm];
        let root = |k: u32| {
            let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
            (next[0] - angle.cos()).hypot(next[1] - angle.sin())
        };
        (0..3).min_by(|a, b| root(*a).total_cmp(&root(*b))).expect("three roots")
    };
    let shares = |seed: u64| {
        let text = format!(
            "{TWO_MOTIONS}omega = \"155 rad/s\"\n[draws]\ncount = 400\nseed = {seed}\n[[axes]]\nname = \"start_r\"\nfrom = \"-1 m\"\nto = \"1 m\"\n\
             [[axes]]\nname = \"start_y1\"\nfrom = \"-1 m/s\"\nto = \"1 m/s\"\n"
        );
        let study = Study::parse("draws.toml", &text).unwrap_or_else(|faults| panic!("{faults}"));
        assert!(matches!(study.case_set, CaseSet::Draws(_)));
        let label = |case: usize| {
            let start = study.case(case).start.capsule();
            Label::Attractor(label([start.r, start.y1]))
        };
        shares_of_draws(study.cases(), label, 3)
    };
    let mut agree = [0; 3];
    const REPETITIONS: u64 = 400;
    for repetition in 0..REPETITIONS {
        let [ours, theirs] = [2 * repetition, 2 * repetition + 1].map(shares);
        for (agree, (a, b)) in agree.iter_mut().zip(ours.iter().zip(&theirs)) {
            let error = a.error.hypot(b.error);
            *agree += u64::from((a.value - b.value).abs() <= 1.96 * error);
        }
    }
    for agree in agree {
        let percent = 100.0 * agree as f64 / REPETITIONS as f64;
        println!("within 1.96 standard errors: {percent:.1} of 100 repetitions");
        assert!((percent - 95.0).abs() <= 3.0, "{percent}");
    }
}

/// The labels of a map on a grid of cells over two ranges.
pub fn map_labels(
    side: usize,
    [x, y]: [[f64; 2]; 2],
    label: impl Fn([f64; 2]) -> Option<u32>,
) -> Vec<Label> {
    let at =
        |index: usize, [low, high]: [f64; 2]| low + (high - low) * index as f64 / (side - 1) as f64;
    let cells = (0..side * side).map(|cell| [at(cell / side, x), at(cell % side, y)]);
    cells.map(|point| label(point).map_or(Label::Undecided, Label::Attractor)).collect()
}

/// Newton's method for z^3 = 1: the root that it leads to.
pub fn newton([mut x, mut y]: [f64; 2]) -> Option<u32> {
    for _ in 0..200 {
        let (square, cross) = (x * x - y * y, 2.0 * x * y);
        let norm = 3.0 * (square * square + cross * cross);
        [x, y] = [2.0 * x / 3.0 + square / norm, 2.0 * y / 3.0 - cross / norm];
    }
    let from = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
        (x - angle.cos()).hypot(y - angle.sin())
    };
    (0..3).find(|k| from(*k) < 1e-6)
}

/// The map of Grebogi, Ott and Yorke (1983) with two fixed points that attract, (0, -0.3) and (pi, 0.3).
pub fn grebogi([mut theta, mut x]: [f64; 2]) -> Option<u32> {
    for _ in 0..1000 {
        let turned =
            theta + 1.32 * (2.0 * theta).sin() - 0.9 * (4.0 * theta).sin() - x * theta.sin();
        (theta, x) = (turned, -0.3 * theta.cos());
    }
    let off = [(theta / 2.0).sin().abs(), (theta / 2.0).cos().abs()];
    off.iter().position(|it| *it < 1e-6).map(|it| it as u32)
}

#[test]
fn measures_of_basins_of_maps_are_the_published_ones() {
    let shape = [300, 300];
    let newton = map_labels(300, [[-1.0, 1.0]; 2], newton);
    let found = uncertainty(&shape, |cell| newton[cell]).expect("a boundary");
    let of_newton = entropy(&shape, |cell| newton[cell], 6).expect("boxes");
    println!("Newton: {found:?} {of_newton:?}");
    assert!((0.55..0.65).contains(&found.exponent.value), "{found:?}");
    assert!(found.exponent.error < 0.05, "{found:?}");
    // Three basins meet at every point of the boundary: more than two can make.
    assert!(of_newton.boundary.value > f64::ln(2.0), "{of_newton:?}");

    let tau = std::f64::consts::TAU;
    let grebogi = map_labels(300, [[0.0, tau], [-0.5, 0.5]], grebogi);
    let found = uncertainty(&shape, |cell| grebogi[cell]).expect("a boundary");
    let of_grebogi = entropy(&shape, |cell| grebogi[cell], 6).expect("boxes");
    println!("Grebogi: {found:?} {of_grebogi:?}");
    assert!((0.2..0.3).contains(&found.exponent.value), "{found:?}");
    assert!((0.40..0.42).contains(&of_grebogi.basin.value), "{of_grebogi:?}");
    assert!((0.60..0.61).contains(&of_grebogi.boundary.value), "{of_grebogi:?}");
}

#[test]
fn a_straight_boundary_has_the_exponent_one() {
    let side = 256;
    let label = |cell: usize| {
        let (row, column) = ((cell / side) as f64, (cell % side) as f64);
        Label::Attractor(u32::from(0.7391 * row + column > 211.3))
    };
    let found = uncertainty(&[side, side], label).expect("a boundary");
    println!("straight: {found:?}");
    let Estimate { value, error } = found.exponent;
    assert!((value - 1.0).abs() < 2.0 * error && error < 0.1, "{found:?}");
    assert!((found.dimension.value + value - 2.0).abs() < 1e-12, "{found:?}");
    // Finer by two, half of the boxes are on the boundary.
    let coarse = entropy(&[side, side], label, 8).expect("boxes").basin.value;
    let fine = |cell: usize| {
        let (row, column) = (cell / (2 * side) / 2, cell % (2 * side) / 2);
        label(row * side + column)
    };
    let finer = entropy(&[2 * side, 2 * side], fine, 8).expect("boxes").basin.value;
    assert!((finer / coarse - 0.5).abs() < 0.1, "{finer} {coarse}");
}
