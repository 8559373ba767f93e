//! Tests of what is said of recordings that a model does not describe or that leave a constant open.

use super::*;
use crate::experiment::friction::coast_down;
use crate::experiment::synthesis::Noise;

const GIVEN: Given = Given { m1: 0.11, m2: 0.53, g: 9.81 };

/// What a recording of rows of two numbers gives.
fn told(test: Test, rows: &[[f64; 2]]) -> Result<Vec<Identified>, String> {
    let columns = test.columns();
    let header: Vec<String> =
        columns.iter().map(|it| format!("{} [{}]", it.name, it.dimension.unit())).collect();
    let mut text = header.join(",") + "\n";
    for row in rows {
        let cells: Vec<String> = row[..columns.len()].iter().map(f64::to_string).collect();
        text += &(cells.join(",") + "\n");
    }
    let recording = Recording::read("test.csv", &text, &columns, 2).expect("readable");
    identify(test, &recording, &GIVEN).map(|(all, _)| all)
}

fn notes(all: &[Identified]) -> String {
    all.iter().flat_map(|it| it.notes.clone()).collect::<Vec<_>>().join("\n")
}

/// Coasting tests of a law of friction over the whole coast-down, with one per cent of noise.
fn coasting_of(distance: impl Fn(f64) -> f64, speeds: &[f64]) -> Vec<[f64; 2]> {
    let mut noise = Noise::new(4);
    speeds.iter().map(|&v| [v, distance(v) * (1.0 + noise.normal(0.01))]).collect()
}

/// The distance from a speed at which friction has this coefficient all the time.
fn slid(v: f64, mu: f64) -> f64 {
    v * v / (2.0 * mu * 9.81)
}

#[test]
fn of_two_modes_of_friction_neither_is_a_value() {
    let slow: Vec<f64> = (0..8).map(|i| 0.02 + 0.03 * f64::from(i) / 7.0).collect();
    let wide = [0.05, 0.1, 0.2, 0.4, 0.8, 1.2];
    for (rows, limits) in [
        (
            coasting_of(|v| coast_down(v, 0.33, 0.3, 9.81).0, &slow),
            ["v_s may be 0.00", " m/s or 0."],
        ),
        (coasting_of(|v| slid(v, 0.33), &wide), ["v_s may be below 0.0", " or above "]),
    ] {
        let all = told(Test::Coasting, &rows).expect("told");
        for it in &all {
            assert_eq!(it.verdict, Verdict::Several, "{it:?}");
            assert!(it.estimate.standard_error.is_infinite(), "{it:?}");
        }
        assert!(all[0].estimate.holds(0.33), "{all:?}");
        assert!(all[0].estimate.interval[1] > 1.8 * all[0].estimate.interval[0], "{all:?}");
        let text = notes(&all);
        assert!(text.contains("mu_d may be 0.") && text.contains(" or 0."), "{text}");
        assert!(text.contains(limits[0]) && text.contains(limits[1]), "{text}");
        // Studies take the default of what is not determined.
        let file = parameter_file(&all, &[]);
        for (symbol, default) in
            [(Parameter::MuD.symbol(), "0.33"), (Parameter::Vs.symbol(), "0.3 m/s")]
        {
            assert!(!file.contains(&format!("\n{symbol} = ")), "{file}");
            let comment = format!("a study takes the default, {default}, unless it sets {symbol}");
            assert!(file.contains(&comment), "{file}");
        }
        assert!(!file.contains("standard_error") && !file.contains("inf"), "{file}");
        assert!(!file.contains("\nvalue ="), "{file}");
    }
}

#[test]
fn friction_that_the_law_cannot_describe_is_told() {
    let wide = [0.05, 0.1, 0.2, 0.4, 0.8, 1.2];
    let rising = coasting_of(|v| slid(v, 0.3 + 0.2 * v), &wide);
    let text = notes(&told(Test::Coasting, &rising).expect("told"));
    assert!(text.contains("friction rises with speed"), "{text}");
    // Friction that falls to a fifth, more than by the factor two of the law.
    let all: Vec<f64> = (0..14).map(|i| 0.05 * f64::from(i + 1)).collect();
    let steep = coasting_of(|v| slid(v, 0.15 + 0.7 * (-v / 0.15).exp()), &all);
    let text = notes(&told(Test::Coasting, &steep).expect("told"));
    assert!(text.contains("does not describe"), "{text}");
    // Distances that were read in millimetres as metres.
    let short = coasting_of(|v| 1e-3 * slid(v, 0.33), &wide);
    let text = notes(&told(Test::Coasting, &short).expect("told"));
    assert!(text.contains("is above 10: are the units"), "{text}");
    let long = coasting_of(|v| 1e3 * slid(v, 0.33), &wide);
    let text = notes(&told(Test::Coasting, &long).expect("told"));
    assert!(text.contains("is below 0.001: are the units"), "{text}");
}

#[test]
fn loading_and_unloading_and_outliers_are_told() {
    let mut noise = Noise::new(8);
    let loads: Vec<f64> = (0..16).map(|i| 0.5 * f64::from(i)).collect();
    let both: Vec<f64> = loads.iter().chain(loads.iter().rev()).copied().collect();
    let [plain, hysteretic] = [0.0, 1e-4].map(|apart| {
        let rows = both.iter().enumerate().map(|(i, load)| {
            let unloading = if i >= loads.len() { apart } else { 0.0 };
            [*load, load / 2420.0 + unloading + noise.normal(1e-5)]
        });
        rows.collect::<Vec<_>>()
    });
    let text = notes(&told(Test::StaticForce, &plain).expect("told"));
    assert_eq!(text, "");
    let text = notes(&told(Test::StaticForce, &hysteretic).expect("told"));
    assert!(text.contains(" mm larger while the load falls than while it rises"), "{text}");
    let mut outlying = plain.clone();
    outlying[6][1] += 2e-4;
    let text = notes(&told(Test::StaticForce, &outlying).expect("told"));
    assert!(text.starts_with("row 7 of the numbers lies"), "{text}");
    assert_eq!(text.lines().count(), 1, "{text}");
}

/// The numbers from 0 to 7, each with a function of it.
fn eight_rows(of: fn(f64) -> f64) -> Vec<[f64; 2]> {
    (0..8).map(f64::from).map(|it| [it, of(it)]).collect()
}

#[test]
fn recordings_without_scatter_are_told_and_do_not_panic() {
    for force in [2.0, 0.1, 0.0] {
        let rows: Vec<[f64; 2]> = (0..8).map(|i| [f64::from(i), force]).collect();
        let why = told(Test::Motor, &rows).expect_err("no constant");
        assert!(why.contains("all forces are equal"), "{why}");
    }
    let exact = told(Test::Motor, &eight_rows(|it| 5.0 * it)).expect("told");
    assert_eq!(exact[0].estimate.value, 5.0);
    assert_eq!(notes(&exact), "");
    let reversed = notes(&told(Test::Motor, &eight_rows(|it| -5.0 * it)).expect("told"));
    assert!(reversed.contains("opposite to the current"), "{reversed}");
    let exact = told(Test::StaticForce, &eight_rows(|it| it / 2420.0)).expect("told");
    assert_eq!(notes(&exact), "");
    let loads = (0..16).map(f64::from);
    let rounded = loads.map(|it| [it, (1e9 * it / 2420.0 + (7.0 * it).sin() * 0.1).round() / 1e9]);
    let rounded: Vec<[f64; 2]> = rounded.collect();
    assert_eq!(notes(&told(Test::StaticForce, &rounded).expect("told")), "");
    let pulls = told(Test::Pull, &[[0.42, 0.0]; 5]).expect("told");
    let text = notes(&pulls);
    assert!(text.contains("half a step bounds the error"), "{text}");
    // Masses read in grams as kilograms.
    let text = notes(&told(Test::Pull, &[[420.0, 0.0], [430.0, 0.0]]).expect("told"));
    assert!(text.contains("mu_s = 664 is above 10"), "{text}");
    let why = told(Test::Pull, &[[0.4, 0.0], [-0.4, 0.0]]).expect_err("no pull");
    assert_eq!(why, "row 2 of the numbers: pulled masses must be above zero");
}

#[test]
fn two_methods_of_an_exact_decay_agree() {
    let laboratory = crate::experiment::synthesis::Laboratory {
        r_noise: 0.0,
        ..crate::experiment::synthesis::Laboratory::default()
    };
    let truth = crate::capsule::Parameters::default();
    let tests = crate::experiment::synthesis::simple_tests(&truth, &laboratory, 1);
    let [times, r] = tests.free_vibration;
    let rows: Vec<[f64; 2]> = times.into_iter().zip(r).map(|(t, r)| [t, r]).collect();
    let all = told(Test::FreeVibration, &rows).expect("told");
    assert_eq!(notes(&all), "");
    for it in all {
        let apart = it.other.and_then(|it| it.disagreement).expect("two methods");
        assert!(apart.abs() < 3.0, "{apart}");
    }
}

#[test]
fn what_has_no_default_must_be_set_by_the_study() {
    let rows = eight_rows(|it| it / 2420.0 + 1e-6 * (7.0 * it).sin());
    let mut all = told(Test::StaticForce, &rows).expect("told");
    assert!(parameter_file(&all, &[]).contains("\nk2 = \"24"));
    all[0].verdict = Verdict::LimitedBelow;
    let file = parameter_file(&all, &[]);
    let comment =
        "# k2 has no value here: one-sided: the data set a lower limit only; a study must set k2\n";
    assert!(file.contains(comment) && !file.contains("\nk2 ="), "{file}");
}
