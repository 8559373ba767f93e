//! Recordings of oscillators given as text: fits find what a record was computed with, comparisons show the motion that settles.

use std::fs;

use capsulemap::description::{Parameters, State};
use capsulemap::experiment::synthesis::Noise;
use capsulemap_text::model::model;
use capsulemap_text::sampled::{Started, sampled};
use serde_json::Value;

use super::program::{FIG5, WorkDir};

/// A text of the repository.
macro_rules! system {
    ($name:literal) => {
        include_str!(concat!("../../systems/", $name))
    };
}

/// The mass at the wall as its study knows it: damping, restitution and wall are wrong.
pub const WALL: &str = "\
system = \"impact.toml\"
[parameters]
w = 1.55
[start]
start_phase = \"0.7 rad\"
";
/// The parameters that records of the wall are computed with.
const TRUTH: [(&str, f64); 4] = [("w", 1.55), ("c", 0.12), ("r", 0.75), ("wall", 0.95)];
/// The bounds that they are looked for within.
const VARY: &str = "w=1.4..1.7,c=0.02..0.4,r=0.3..0.95,wall=0.7..1.3";

/// The motion of the mass at the wall from a start, at a time since the drive had the phase of the study.
fn motion(start: [f64; 2], time: f64) -> Started {
    let wall = model(system!("impact.toml")).expect("a text without faults");
    let mut parameters = Parameters::of(wall);
    for (name, value) in TRUTH {
        parameters[wall.parameter(name).expect("a parameter")] = value;
    }
    Started { time, ..Started::new(parameters, State::new(wall, &start), 0.7) }
}

/// A record of some states of a motion, with noise of 0.003, over 30 units of time.
fn record(motion: &Started, columns: &[(usize, &str)], seed: u64) -> String {
    let times: Vec<f64> = (0..600).map(|i| 0.05 * f64::from(i)).collect();
    let places: Vec<usize> = columns.iter().map(|it| it.0).collect();
    let values = sampled(motion, &times, &places, &[], 1e-12).expect("followed").values;
    let mut noise = Noise::new(seed);
    let names: Vec<&str> = columns.iter().map(|it| it.1).collect();
    let mut text = format!("t,{}\n", names.join(","));
    for (row, time) in times.iter().enumerate() {
        text += &format!("{}", motion.time + time);
        for values in &values {
            text += &format!(",{}", values[row] + noise.normal(0.003));
        }
        text.push('\n');
    }
    text
}

/// Puts the study of the wall and a record of it into a folder.
pub fn put_wall(work: &WorkDir) {
    work.put("impact.toml", system!("impact.toml"));
    work.put("wall.toml", WALL);
    work.put("wall.csv", record(&motion([0.3, 0.1], 0.0), &[(0, "x"), (1, "v [1]")], 2));
}

fn folder() -> WorkDir {
    let work = WorkDir::new();
    put_wall(&work);
    work
}

const FIT: [&str; 6] = ["fit", "wall.csv", "--study", "wall.toml", "--vary", VARY];

/// A fitted parameter: its value and the ends of its interval.
fn fitted(told: &Value, name: &str) -> [f64; 3] {
    let all = told["fitted"].as_array().expect("parameters");
    let it = all.iter().find(|it| it["name"] == name).expect(name);
    assert_eq!(it["verdict"], "determined", "{it}");
    let number = |it: &Value| it.as_f64().expect("a number");
    [number(&it["value"]), number(&it["interval_95"][0]), number(&it["interval_95"][1])]
}

/// Checks that the interval of each parameter holds what the record was computed with, and is narrow.
fn check_truth(told: &Value) {
    for (name, truth) in TRUTH {
        let [value, least, greatest] = fitted(told, name);
        assert!((least..=greatest).contains(&truth), "{name}: {value} in {least}..{greatest}");
        assert!(greatest - least < 0.01 * truth, "{name}: {least}..{greatest}");
    }
    let misfit = told["misfit"].as_f64().expect("a number");
    assert!((0.85..1.15).contains(&misfit), "{misfit}");
}

#[test]
fn a_fit_finds_the_parameters_of_a_record_with_impacts() {
    let work = folder();
    // The whole record: seven cycles and a half.
    let told = work.run(&[&FIT[..], &["--json", "--cycles", "8"]].concat()).json();
    check_truth(&told);
    assert_eq!((&told["samples"], &told["warnings"]), (&1200.into(), &Value::Array(Vec::new())));
    let told = work.run(&[&FIT[..], &["--output", "fitted.toml"]].concat()).done().out;
    for part in ["c     0.1", "standard error", "misfit ", "starts led here", "fitted.toml"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    // The file is one that a study includes.
    let included = WALL.replace("[parameters]\nw = 1.55\n", "include = \"fitted.toml\"\n");
    work.put("again.toml", included);
    let told = work.run(&["simulate", "--study", "again.toml", "--case", "0", "--json"]).json();
    let found = told["parameters"]["c"].as_f64().expect("a number");
    assert!((found - 0.12).abs() < 1e-3, "{found}");
}

#[test]
fn one_state_is_enough_and_the_first_sample_may_be_later() {
    let work = folder();
    for (columns, time) in [([(0, "x")], 0.0), ([(1, "v")], 0.0), ([(0, "x")], 3.3)] {
        work.put("wall.csv", record(&motion([0.3, 0.1], time), &columns, 3));
        check_truth(&work.run(&[&FIT[..], &["--json", "--cycles", "8"]].concat()).json());
    }
}

#[test]
fn recordings_of_one_oscillator_are_fitted_together() {
    let work = folder();
    let other = motion([-0.4, 0.6], 0.0);
    work.put("other.csv", record(&other, &[(0, "x")], 3));
    let arguments = ["fit", "wall.csv", "other.csv", "--study", "wall.toml", "--vary", VARY];
    let told = work.run(&[&arguments[..], &["--json", "--cycles", "8"]].concat()).json();
    check_truth(&told);
    assert_eq!(told["samples"], 1800);
    work.put("belt.toml", system!("belt.toml"));
    work.put("stick.toml", "system = \"belt.toml\"\n");
    let mixed = ["fit", "wall.csv", "other.csv", "--study", "wall.toml", "--study", "stick.toml"];
    let refused = work.run(&[&mixed[..], &["--vary", "c=0.1..0.2"]].concat());
    refused.refused(&["stick.toml", "mass on a belt", "impact oscillator"]);
}

#[test]
fn wrong_columns_and_parameters_are_named_with_what_is_allowed() {
    let work = folder();
    let good = fs::read_to_string(work.path("wall.csv")).expect("a record");
    let with_header = |header: &str| good.replacen("t,x,v [1]", header, 1);
    work.put("wall.csv", with_header("t,position,speed"));
    let parts = ["no column of a state of impact oscillator", "one of x, v", "position, speed"];
    work.run(&FIT).refused(&parts);
    work.run(&["compare", "wall.csv", "wall.toml"]).refused(&parts);
    work.put("wall.csv", with_header("t,x [mm],v"));
    work.run(&FIT).refused(&["x [mm]", "expected a plain number"]);
    work.put("wall.csv", with_header("t,x,speed"));
    let told = work.run(&[&FIT[..], &["--json"]].concat()).json();
    let warning = told["warnings"][0].as_str().expect("a warning");
    assert!(warning.contains("left out: speed; the states are x, v"), "{warning}");
    let vary = |what| work.run(&["fit", "wall.csv", "--study", "wall.toml", "--vary", what]);
    vary("k2=1..2").refused(&["unknown parameter \"k2\"", "c, f, w, r, wall"]);
    vary("w=-1..2").refused(&["--vary w", "-1 must be"]);
    let explain = ["compare", "wall.csv", "wall.toml", "--explain", "c=0.05..0.2"];
    work.run(&explain).refused(&["--explain", "capsulemap fit"]);
}

#[test]
fn the_capsule_as_a_text_is_fitted_as_the_capsule() {
    let work = WorkDir::new();
    work.put("fig5.toml", FIG5);
    work.put("capsule.toml", system!("capsule.toml"));
    work.put("text.toml", "system = \"capsule.toml\"\n");
    work.run(&["synthesize", "fig5.toml", "--output", "rig", "--cycles", "6"]).done();
    let fit = |study: &str, vary: &str| {
        let arguments = ["fit", "rig/motion.csv", "--study", study, "--vary", vary];
        work.run(&[&arguments[..], &["--starts", "1", "--json"]].concat()).json()
    };
    let own = fit("fig5.toml", "k2=2 kN/m..3 kN/m,mu_d=0.2..0.5");
    let text = fit("text.toml", "k2=2000..3000,mu_d=0.2..0.5");
    for name in ["k2", "mu_d"] {
        let ([a, from, to], [b, least, greatest]) = (fitted(&own, name), fitted(&text, name));
        let allowed = 0.5 * (to - from).hypot(greatest - least);
        assert!((a - b).abs() < allowed, "{name}: {a} in {from}..{to}, {b} in {least}..{greatest}");
    }
    let warning = text["warnings"][0].as_str().expect("a warning");
    assert!(warning.contains("left out: a1, drive"), "{warning}");
    let told = work.run(&["compare", "rig/motion.csv", "text.toml", "--json"]).json();
    assert_eq!((&told["outcome"], &told["period"]), (&"periodic".into(), &1.into()));
    for it in told["errors"].as_array().expect("states") {
        assert!(it["error"].as_f64().is_some_and(|it| it < 0.05), "{it}");
    }
}

#[test]
fn a_comparison_shows_the_motion_that_settles() {
    let work = folder();
    let set = "c = 0.12\nr = 0.75\nwall = 0.95\n";
    work.put("wall.toml", WALL.replace("w = 1.55\n", &format!("w = 1.55\n{set}")));
    let compare = ["compare", "wall.csv", "wall.toml"];
    let transient = work.run(&[&compare[..], &["--json"]].concat()).json();
    let errors = |told: &Value| -> Vec<f64> {
        let all = told["errors"].as_array().expect("states").iter();
        all.map(|it| it["error"].as_f64().expect("a number")).collect()
    };
    // The record begins far from the motion that settles.
    assert!(errors(&transient).iter().all(|it| *it > 0.3), "{transient}");
    let start = ["x", "v"].map(|it| transient["start"][it].as_f64().expect("a number"));
    work.put("wall.csv", record(&motion(start, 0.0), &[(0, "x"), (1, "v")], 1));
    let settled = work.run(&[&compare[..], &["--json", "--output", "overlay"]].concat()).json();
    assert!(errors(&settled).iter().all(|it| *it < 0.02), "{settled}");
    assert_eq!(settled["outcome"], "periodic");
    assert_eq!(settled["period"], settled["period_recorded"]);
    for file in ["overlay.png", "overlay.pdf", "overlay.csv"] {
        assert!(work.path(file).exists(), "{file}");
    }
    let told = work.run(&compare).done().out;
    for part in ["600 samples", "periodic, period", "error of x:", "error of v:"] {
        assert!(told.contains(part), "{part}: {told}");
    }
}

#[test]
fn without_a_drive_the_moment_of_the_record_is_found() {
    let work = WorkDir::new();
    work.put("belt.toml", system!("belt.toml"));
    work.put("stick.toml", "system = \"belt.toml\"\n[start]\nv = 1.5\n");
    let belt = model(system!("belt.toml")).expect("a text without faults");
    let start = State::new(belt, &[0.0, 1.5]);
    let cycle = Started::new(Parameters::of(belt), start, 0.0);
    // Long after the start, at a moment that no section has.
    let later = sampled(&cycle, &[203.7], &[0, 1], &[], 1e-12).expect("followed").values;
    let start = State::new(belt, &[later[0][0], later[1][0]]);
    let seen = Started { start, ..cycle };
    work.put("belt.csv", record(&seen, &[(0, "x"), (1, "v")], 4));
    let told = work.run(&["compare", "belt.csv", "stick.toml", "--json"]).json();
    for it in told["errors"].as_array().expect("states") {
        assert!(it["error"].as_f64().is_some_and(|it| it < 0.02), "{it}");
    }
    let fit = ["fit", "belt.csv", "--study", "stick.toml", "--vary", "belt=1.3..1.7,a=0.3..0.8"];
    let told = work.run(&[&fit[..], &["--json"]].concat()).json();
    for (name, truth) in [("belt", 1.5), ("a", 0.5)] {
        let [value, least, greatest] = fitted(&told, name);
        // Three times the reach of the interval: chance, and not a wrong model.
        let reach = 1.5 * (greatest - least);
        assert!((value - truth).abs() < reach, "{name}: {value} in {least}..{greatest}");
    }
    work.run(&[&fit[..], &["--cycles", "3"]].concat()).refused(&["--cycles", "no drive"]);
}
