//! The Pareto front against its definition, case by case.

use std::io::Write;
use std::process::{Command, Stdio};

use capsulemap::tradeoff::{Candidate, Direction, front, hypervolume, optima, speed_at_rest};
use proptest::prelude::*;

use super::draws::Random;
use super::store::say;

/// Whether the case `a` is at least as good as `b` in both numbers.
fn matches(a: (f64, f64), b: (f64, f64)) -> bool {
    a.0 <= b.0 && a.1 >= b.1
}

/// The front by comparing every case with every other: energies and speeds, by rising energy.
fn by_definition(cases: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let beaten =
        |case: &(f64, f64)| cases.iter().any(|other| other != case && matches(*other, *case));
    let mut best: Vec<(f64, f64)> = cases.iter().copied().filter(|case| !beaten(case)).collect();
    best.sort_by(|a, b| a.partial_cmp(b).expect("finite numbers"));
    best.dedup();
    best
}

/// The front as places, as energies and speeds.
fn found(cases: &[(f64, f64)]) -> (Vec<usize>, Vec<(f64, f64)>) {
    let (energies, speeds): (Vec<f64>, Vec<f64>) = cases.iter().copied().unzip();
    let places = front(&energies, &speeds);
    let on_front = places.iter().map(|&place| cases[place]).collect();
    (places, on_front)
}

proptest! {
    // Few different numbers, so that many agree; with and without cases that move forward.
    #[test]
    fn the_front_is_what_no_case_beats(
        cases in prop::collection::vec((-3..6_i32, -5..5_i32), 0..30),
        offset in -6..2_i32,
    ) {
        let cases: Vec<(f64, f64)> = cases
            .into_iter()
            .map(|(energy, speed)| (f64::from(energy) / 3.0, f64::from(speed + offset) / 7.0))
            .collect();
        let (places, on_front) = found(&cases);
        prop_assert_eq!(&on_front, &by_definition(&cases));
        prop_assert_eq!(on_front.is_empty(), cases.is_empty());
        prop_assert!(on_front.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1));
        for place in places {
            let first = cases.iter().position(|case| *case == cases[place]);
            prop_assert_eq!(first, Some(place));
        }
    }
}

#[test]
fn rounding_is_no_speed() {
    // A front among motions of 1e-17 m/s would be one of rounding.
    assert_eq!(speed_at_rest([1e-17, -3e-17]), 1e-10);
    assert_eq!(speed_at_rest([2e-3, -5e-2, 0.0]), 5e-8);
    assert_eq!(speed_at_rest([]), 1e-10);
}

#[test]
#[should_panic(expected = "each case has an energy and a speed")]
fn an_energy_without_a_speed_is_refused() {
    front(&[1.0], &[]);
}

/// The problems ZDT1 to ZDT3 (Zitzler, Deb, Thiele 2000) on a grid of three variables, in any order and some points twice:
/// prices f1 and speeds 2 - f2.
fn zdt(number: u32) -> Vec<(f64, f64)> {
    let mut cases = Vec::new();
    for (x1, x2, x3) in (0..=200).flat_map(|a| (0..121).map(move |b| (a, b / 11, b % 11))) {
        let f1 = f64::from(x1) / 200.0;
        let g = 1.0 + 9.0 * f64::from(x2 + x3) / 20.0;
        cases.push((f1, 2.0 - g * shape(number, f1, g)));
    }
    let twice: Vec<(f64, f64)> = cases.iter().step_by(7).copied().collect();
    cases.extend(twice);
    let mut random = Random::new(u64::from(number));
    cases.sort_by_cached_key(|_| (1e15 * random.uniform(0.0, 1.0)) as u64);
    cases
}

fn shape(number: u32, f1: f64, g: f64) -> f64 {
    let ratio = f1 / g;
    match number {
        1 => 1.0 - ratio.sqrt(),
        2 => 1.0 - ratio * ratio,
        _ => 1.0 - ratio.sqrt() - ratio * (10.0 * std::f64::consts::PI * f1).sin(),
    }
}

#[test]
fn the_fronts_of_zdt1_to_zdt3_are_the_known_ones() {
    // Where the front of ZDT3 lies in f1.
    let parts = [
        [0.0, 0.0830015349],
        [0.1822287280, 0.2577623634],
        [0.4093136748, 0.4538821041],
        [0.6183967944, 0.6525117038],
        [0.8233317983, 0.8518328654],
    ];
    for number in [1, 2, 3] {
        let (_, on_front) = found(&zdt(number));
        let is_known = |f1: f64| number < 3 || parts.iter().any(|[a, b]| (*a..=*b).contains(&f1));
        let grid = (0..=200).map(|x1| f64::from(x1) / 200.0).filter(|f1| is_known(*f1));
        let known: Vec<(f64, f64)> = grid.map(|f1| (f1, 2.0 - shape(number, f1, 1.0))).collect();
        if number < 3 {
            assert_eq!(on_front, known, "ZDT{number}");
        } else {
            // Between two points of the grid the ends of a part are not met: a point may be left where the next part begins.
            let missed = known.iter().filter(|point| !on_front.contains(point)).count();
            let more = on_front.iter().filter(|point| !known.contains(point)).count();
            assert!(missed <= 5 && more <= 5 && on_front.len() > 40, "{missed} {more}");
        }
    }
}

#[test]
fn motions_without_numbers_and_equal_ones_are_no_trouble() {
    let one =
        |case: usize, gain: f64, price: f64| Candidate { case, gain, price, per_gain: f64::NAN };
    let all = [
        one(0, f64::NAN, 1.0),
        one(1, 2.0, f64::NAN),
        one(2, 3.0, f64::INFINITY),
        one(3, -1.0, 2.0),
        one(4, -1.0, 2.0),
        one(5, 0.5, 1.0),
    ];
    let best = optima(&all, Direction::Either, None);
    assert_eq!((best.front, best.most_gain), (vec![5, 3], Some(3)));
    assert_eq!((best.knee, best.least_per_gain), (None, None));
}

/// The hypervolume that moocore, a public implementation, finds; none where it is not installed.
fn by_moocore(front: &[(f64, f64)], dearest: f64, slowest: f64) -> Option<f64> {
    let python = std::env::var("CAPSULEMAP_PYTHON").unwrap_or_else(|_| "python3".into());
    let script = format!(
        "import sys, numpy, moocore\n\
         points = numpy.array([float(x) for x in sys.stdin.read().split()]).reshape(-1, 2)\n\
         print(repr(float(moocore.hypervolume(points, ref=[{dearest:?}, {:?}]))))",
        -slowest
    );
    let mut child = Command::new(python)
        .args(["-c", &script])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let text: String =
        front.iter().map(|(price, speed)| format!("{price:?} {:?}\n", -speed)).collect();
    // Where the package is missing Python ends before it reads.
    let _ = child.stdin.take()?.write_all(text.as_bytes());
    let done = child.wait_with_output().ok()?;
    String::from_utf8_lossy(&done.stdout).trim().parse().ok()
}

#[test]
fn the_hypervolume_is_that_of_a_public_implementation() {
    for number in [1, 2, 3] {
        let (_, on_front) = found(&zdt(number));
        for (dearest, slowest) in [(1.1, -0.5), (0.7, 0.9), (2.0, -3.0)] {
            let own = hypervolume(&on_front, dearest, slowest);
            let Some(other) = by_moocore(&on_front, dearest, slowest) else {
                say("SKIPPED: Python cannot import moocore");
                return;
            };
            assert!((own - other).abs() <= 1e-12 * other, "ZDT{number}: {own} {other}");
        }
    }
}
