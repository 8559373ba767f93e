//! The Pareto front against its definition, case by case.

use capsulemap::tradeoff::{front, speed_at_rest};
use proptest::prelude::*;

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
