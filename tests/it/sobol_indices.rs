//! Sobol indices: the points of the design, the estimates by closed forms and by SALib, their intervals, and the command.

use std::f64::consts::PI;

use capsulemap::campaign::{
    NoIndices, OutputSensitivity, Resampling, SobolIndices, output_sensitivity, sobol_indices,
};
use capsulemap::store::{self, Column, Design};
use capsulemap::study::{CaseSet, Coordinate, DrawKind, Draws, Range, Saltelli, Spacing, Study};
use serde_json::Value;

use super::program::{FIG5, WorkDir};

/// Points by SciPy and indices by SALib; `scripts/references/sobol.py` writes it.
fn reference() -> Value {
    serde_json::from_str(include_str!("../data/sobol.json")).expect("JSON")
}

fn numbers(of: &Value) -> Vec<f64> {
    of.as_array().expect("a list").iter().map(|it| it.as_f64().expect("a number")).collect()
}

/// So many draws of quantities from -pi to pi; which coordinates they are does not matter.
fn draws(kind: DrawKind, count: usize, quantities: usize, seed: u64) -> Draws {
    let coordinate = Coordinate::StartPhase;
    let range = Range::even(coordinate, [-PI, PI], Spacing::Linear);
    Draws { kind, count, seed, ranges: vec![range; quantities] }
}

fn ishigami(x: [f64; 3]) -> f64 {
    let [a, b, _] = x.map(libm::sin);
    a + 7.0 * b * b + 0.1 * libm::pow(x[2], 4.0) * a
}

/// The values of Ishigami's function in the cases of the design of so many rows.
fn on_design(rows: usize, seed: u64) -> Vec<f64> {
    let design = draws(DrawKind::Saltelli, 5 * rows, 3, seed);
    let point = |index| std::array::from_fn(|place| design.value(index, place));
    (0..design.count).map(|index| ishigami(point(index))).collect()
}

/// The same on rows that are independent.
fn on_independent_rows(rows: usize, seed: u64) -> Vec<f64> {
    let all = draws(DrawKind::Uniform, rows, 6, seed);
    let design = Saltelli { quantities: 3 };
    let point = |index| {
        std::array::from_fn(|place| {
            let [row, column] = design.source(index, place);
            all.value(row, column)
        })
    };
    (0..5 * rows).map(|index| ishigami(point(index))).collect()
}

/// Of Ishigami's function with a = 7 and b = 0.1: first and total order of each quantity, mean and variance, in closed form.
fn closed_form() -> ([f64; 3], [f64; 3], f64, f64) {
    let (a, b) = (7.0, 0.1);
    let alone = [0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2), a * a / 8.0, 0.0];
    let together = 8.0 * b * b * PI.powi(8) / 225.0;
    let variance = alone.iter().sum::<f64>() + together;
    let total = [alone[0] + together, alone[1], together];
    (alone.map(|it| it / variance), total.map(|it| it / variance), a / 2.0, variance)
}

/// What the command finds of an output with these values, all of which are of cases that repeat.
fn found(values: &[f64], quantities: usize) -> OutputSensitivity {
    let names = (0..quantities).map(|it| format!("x{it}")).collect();
    let design = Design { base_samples: values.len() / (quantities + 2), quantities: names };
    let flags = vec![(1, "periodic".to_owned()), (2, "chaotic".to_owned())];
    let outcomes = Column { values: vec![1.0; values.len()], unit: "1".to_owned(), flags };
    output_sensitivity(values, &outcomes, &design, Resampling::default())
}

#[test]
fn the_points_of_the_design_are_those_of_scipy_with_digits_shifted() {
    let quantities = 32;
    let whole = (1_u64 << 53) as f64;
    for seed in [0, 5] {
        let design = draws(DrawKind::Saltelli, 1, quantities, seed);
        // A and B of a row are the halves of a point; the first point of all is zero, so that it has the shift alone.
        let bits = |row: usize, column: usize| {
            let member = if column < quantities { 0 } else { quantities + 1 };
            let index = row * (quantities + 2) + member;
            (design.share(index, column % quantities) * whole) as u64
        };
        for known in reference()["points"].as_array().expect("a list") {
            let place = known["place"].as_u64().expect("a place") as usize;
            // SciPy goes in the order of Gray's code.
            let row = place ^ (place >> 1);
            for (column, expected) in numbers(&known["point"]).into_iter().enumerate() {
                let plain = bits(row, column) ^ bits(0, column);
                assert_eq!(plain as f64 / whole, expected, "{place}, {column}");
            }
        }
    }
}

#[test]
fn a_row_of_the_design_differs_in_one_quantity_from_case_to_case() {
    let quantities = 4;
    let design = draws(DrawKind::Saltelli, 6 * 64, quantities, 3);
    let point = |index: usize| -> Vec<f64> {
        (0..quantities).map(|place| design.value(index, place)).collect()
    };
    for row in 0..64 {
        let [a, b] = [point(6 * row), point(6 * row + 5)];
        assert!(a.iter().zip(&b).all(|(a, b)| a != b));
        for place in 0..quantities {
            let mut mixed = a.clone();
            mixed[place] = b[place];
            assert_eq!(point(6 * row + 1 + place), mixed);
        }
    }
    // Another seed has other draws.
    assert!((0..64).all(|row| draws(DrawKind::Saltelli, 1, 4, 4).value(row, 0) != point(row)[0]));
}

#[test]
fn estimates_are_those_of_salib() {
    for known in reference()["indices"].as_array().expect("a list") {
        let quantities = known["quantities"].as_u64().expect("a count") as usize;
        let confidence = known["confidence"].as_f64().expect("a share");
        let resampling = Resampling { resamples: 4000, confidence, seed: 1 };
        let values = numbers(&known["values"]);
        let found = sobol_indices(&values, Saltelli { quantities }, resampling).expect("indices");
        for (own, name) in [(&found.first, "S1"), (&found.total, "ST")] {
            let conf = numbers(&known[format!("{name}_conf")]);
            for (own, (value, conf)) in own.iter().zip(numbers(&known[name]).iter().zip(&conf)) {
                assert!((own.value - value).abs() < 1e-12, "{name}: {} {value}", own.value);
                // Both come from random resamples, of which 4000 tell a standard deviation to about 1.1 %.
                let ratio = own.half_width / conf;
                assert!((ratio - 1.0).abs() < 0.06, "{name}: {} {conf}", own.half_width);
            }
        }
    }
}

#[test]
fn ishigami_on_the_design_has_its_closed_form_within_the_intervals() {
    let (first, total, mean, variance) = closed_form();
    for (rows, bound) in [(512, 0.05), (4096, 2e-3)] {
        let indices = found(&on_design(rows, 0), 3).indices.expect("indices");
        for (own, exact) in [(&indices.first, first), (&indices.total, total)] {
            for (own, exact) in own.iter().zip(exact) {
                let off = (own.value - exact).abs();
                assert!(off < own.half_width && off < bound, "{rows}: {own:?} {exact}");
                assert!(own.half_width < 3.0 / (rows as f64).sqrt(), "{rows}: {own:?}");
            }
        }
        for (own, exact) in [(indices.first_sum, first), (indices.total_sum, total)] {
            assert!((own.value - exact.iter().sum::<f64>()).abs() < own.half_width, "{own:?}");
        }
        let off = [indices.mean / mean - 1.0, indices.variance / variance - 1.0];
        assert!(off.iter().all(|it| it.abs() < bound), "{rows}: {off:?}");
    }
}

#[test]
fn intervals_hold_the_closed_form_as_often_as_they_say() {
    let (first, total, ..) = closed_form();
    let resampling = Resampling { resamples: 200, ..Resampling::default() };
    let seeds = 200;
    let held = |values: &dyn Fn(u64) -> Vec<f64>| {
        let mut held = [0; 6];
        for seed in 0..seeds {
            let found: SobolIndices =
                sobol_indices(&values(seed), Saltelli { quantities: 3 }, resampling).expect("some");
            let own = found.first.iter().chain(&found.total);
            for (count, (own, exact)) in held.iter_mut().zip(own.zip(first.iter().chain(&total))) {
                *count += usize::from((own.value - exact).abs() <= own.half_width);
            }
        }
        held.map(|count| f64::from(count as u32) / seeds as f64)
    };
    let independent = held(&|seed| on_independent_rows(512, seed));
    assert!(independent.iter().all(|share| (0.9..=0.99).contains(share)), "{independent:?}");
    // The rows of the design are more even, which intervals do not know.
    let even = held(&|seed| on_design(512, seed));
    assert!(even.iter().all(|share| *share >= 0.93), "{even:?}");
}

#[test]
fn rows_without_all_values_are_left_out_and_counted() {
    let rows = 64;
    let mut values = on_design(rows, 2);
    let whole = found(&values, 3);
    assert_eq!((whole.rows, whole.rows_left_out, whole.aperiodic), (rows, 0, 0));
    // Without the last two rows, the same as a design that never had them.
    let fewer = found(&values[..5 * (rows - 2)], 3).indices.expect("indices");
    values[5 * (rows - 2) + 3] = f64::INFINITY;
    values[5 * (rows - 1)] = f64::NAN;
    values[5 * (rows - 1) + 4] = f64::NAN;
    let some = found(&values, 3);
    assert_eq!((some.rows, some.rows_left_out), (rows - 2, 2));
    assert_eq!(
        some.left_out.iter().collect::<Vec<_>>(),
        [(&"without a finite value".to_owned(), &3)]
    );
    assert_eq!(some.indices.expect("indices"), fewer);
}

#[test]
fn outputs_that_do_not_vary_have_no_indices() {
    for values in
        [vec![0.0; 40], vec![3.7; 40], (0..40).map(|i| 1.0 + 1e-15 * f64::from(i % 3)).collect()]
    {
        assert_eq!(found(&values, 3).indices, Err(NoIndices::Constant));
    }
    assert_eq!(found(&on_design(1, 0), 3).indices, Err(NoIndices::TooFewRows));
    assert_eq!(found(&[f64::NAN; 40], 3).indices, Err(NoIndices::TooFewRows));
    // Small differences of large values are no rounding.
    let values: Vec<f64> = on_design(64, 0).iter().map(|it| 1e6 + 1e-3 * it).collect();
    let [shifted, own] = [values, on_design(64, 0)].map(|it| found(&it, 3).indices.expect("some"));
    for (a, b) in shifted.first.iter().chain(&shifted.total).zip(own.first.iter().chain(&own.total))
    {
        assert!((a.value - b.value).abs() < 1e-6, "{a:?} {b:?}");
    }
}

/// Draws about Fig 5, with a figure of their indices.
pub const ABOUT_FIG5: &str = r#"outputs = ["progression_speed", "power", "reversals_per_cycle"]
[draws]
kind = "saltelli"
base_samples = 64
[[axes]]
name = "omega"
from = "70 rad/s"
to = "86 rad/s"
[[axes]]
name = "p_d"
from = "3.5 N"
to = "4.5 N"
[[axes]]
name = "k2"
from = "1 kN/m"
to = "6 kN/m"
spacing = "logarithmic"
[[axes]]
name = "delta"
from = "2.5 mm"
to = "4.5 mm"
[[figures]]
name = "indices"
kind = "sensitivity"
of = ["progression_speed", "power"]
data = true
svg_text = true
"#;

#[test]
fn a_study_of_the_capsule_has_indices_and_a_figure() {
    let dir = WorkDir::new();
    dir.put("draws.toml", ABOUT_FIG5);
    dir.run(&["sweep", "draws.toml", "--formats", "svg"]).done();
    let file = "results/draws/draws.h5";
    let dataset = store::read(&dir.path(file)).expect("results");
    assert_eq!(&*dataset.attributes["draws_base_samples"], "64");
    assert_eq!(&*dataset.attributes["draws_quantities"], "omega, p_d, k2, delta");
    dir.run(&["verify", file, "--cases", "5"]).done();

    let told = dir.run(&["sensitivity", file, "--json"]).json();
    assert_eq!((told["base_samples"].as_u64(), told["cases"].as_u64()), (Some(64), Some(384)));
    for name in ["progression_speed", "power"] {
        let told = &told["outputs"][name];
        let number = |key: &str| told[key].as_f64().expect(key);
        assert_eq!((told["base_samples"].as_u64(), &told["no_indices"]), (Some(64), &Value::Null));
        assert!(number("ST_sum") + number("ST_sum_conf") >= 1.0, "{told}");
        assert!(number("S1_sum") - number("S1_sum_conf") <= 1.0, "{told}");
        // What the command finds is what the library finds of the values in the file.
        let values: Vec<f64> = dataset.variables[name].values.to_real().into_iter().collect();
        let own = found(&values, 4).indices.expect("indices");
        assert_eq!((number("mean"), number("variance")), (own.mean, own.variance));
        for (place, quantity) in ["omega", "p_d", "k2", "delta"].into_iter().enumerate() {
            let told = &told["quantities"][quantity];
            assert_eq!(told["S1"].as_f64(), Some(own.first[place].value));
            assert_eq!(told["ST_conf"].as_f64(), Some(own.total[place].half_width));
        }
    }
    // The amplitude and the frequency make the power; the gap and the stiffness of the stop hardly matter.
    let of_power = |name: &str| told["outputs"]["power"]["quantities"][name]["ST"].as_f64();
    assert!(of_power("p_d") > of_power("delta") && of_power("omega") > of_power("k2"), "{told}");

    let table = dir.run(&["sensitivity", file, "--of", "power"]).done().out;
    assert!(table.contains("64 base samples of 4 quantities, 384 cases"), "{table}");
    let csv = dir.run(&["sensitivity", file, "--csv"]).done().out;
    assert!(csv.lines().count() == 13 && csv.starts_with("output,unit,quantity,S1,"), "{csv}");
    let twice = dir.run(&["sensitivity", file, "--csv", "--threads", "1"]).done().out;
    assert_eq!(csv, twice);
    let other = dir.run(&["sensitivity", file, "--csv", "--seed", "2"]).done().out;
    assert_ne!(csv, other);

    let data = std::fs::read_to_string(dir.path("results/draws/indices.csv")).expect("data");
    let first = told["outputs"]["progression_speed"]["quantities"]["omega"]["S1"].as_f64();
    let row = data.lines().find(|it| it.starts_with("1,\"S1 of omega")).expect("a row");
    assert!(row.contains(&first.expect("an index").to_string()), "{row} {first:?}");
    assert_eq!(data.lines().filter(|it| it.starts_with(['1', '2'])).count(), 16);
    let svg = std::fs::read_to_string(dir.path("results/draws/indices.svg")).expect("a figure");
    let words: String = svg.split('<').filter_map(|it| it.split_once('>')).map(|it| it.1).collect();
    assert!(words.contains("Sobol index") && words.contains("95 % intervals"), "{words}");
}

#[test]
fn what_has_no_indices_is_refused_with_the_reason() {
    let dir = WorkDir::new();
    dir.put("draws.toml", ABOUT_FIG5.replace("base_samples = 64", "base_samples = 2"));
    dir.run(&["sweep", "draws.toml", "--no-figures"]).done();
    let file = "results/draws/draws.h5";
    let said =
        ["--of: period is a category", "unknown output \"pwer\"; did you mean \"power\"?", "twice"];
    dir.run(&["sensitivity", file, "--of", "period,pwer,power,power"]).refused(&said);
    dir.run(&["sensitivity", file, "--of", "work_net"])
        .refused(&["the file has no work_net (it has: "]);
    dir.run(&["sensitivity", file, "--confidence", "1"]).refused(&["must lie between 0 and 1"]);
    dir.put("case.toml", FIG5);
    dir.run(&["sweep", "case.toml"]).done();
    let file = "results/case/case.h5";
    dir.run(&["sensitivity", file])
        .refused(&["case.h5: its cases are no design", "kind = \"saltelli\""]);
    let figure = ["figure", file, "--kind", "sensitivity"];
    dir.run(&figure).refused(&["its cases are no design"]);
}

#[test]
fn faults_of_a_design_are_told_with_what_is_allowed() {
    let faults = |from: &str, to: &str| {
        let text = ABOUT_FIG5.replace(from, to);
        assert_ne!(text, ABOUT_FIG5);
        Study::parse("study.toml", &text).expect_err(&text).to_string()
    };
    for (from, to, said) in [
        (
            "base_samples = 64",
            "base_samples = 100",
            "100 is no power of two, with which Sobol' points are even; the next are 64 and 128",
        ),
        (
            "base_samples = 64",
            "count = 64",
            "draws.count: does not go with `kind = \"saltelli\"`; give `base_samples`, each of which makes 6 cases here",
        ),
        (
            "base_samples = 64",
            "seed = 1",
            "draws.base_samples: missing; expected the number of base samples, a power of two",
        ),
        ("base_samples = 64", "base_samples = 1", "expected a whole number, 2 to 1666666, found 1"),
        (
            "kind = \"saltelli\"\nbase_samples = 64",
            "count = 64",
            "figures[1].kind: a figure of the kind sensitivity needs `[draws]` with `kind = \"saltelli\"`",
        ),
        (
            "kind = \"saltelli\"",
            "count = 9",
            "draws.base_samples: goes with `kind = \"saltelli\"` alone",
        ),
    ] {
        let told = faults(from, to);
        assert!(told.contains(said), "{told}\n{said}");
    }
    let study = Study::parse("study.toml", ABOUT_FIG5).expect("a study");
    let CaseSet::Draws(draws) = &study.case_set else { panic!("draws") };
    assert_eq!((draws.count, study.cases(), study.shape()), (384, 384, vec![384]));
    assert_eq!(
        Study::parse("again.toml", &study.to_toml()).expect("a study").case_set,
        study.case_set
    );
}
