//! `capsulemap tradeoff --refine`: motions between the cases, against brute force around them and the same search begun otherwise.

use super::program::of_the_paper;
use capsulemap::capsule::{CapsuleParameters as _, Output, Parameter, Parameters, State, settle};
use capsulemap::description::Outputs;
use capsulemap::orbit::{Outcome, Protocol};
use serde_json::Value;

use super::program::WorkDir;

/// A coarse grid over two parameters.
const STUDY: &str = "[parameters]\nc = \"0.44 N s/m\"\nmu_s = 0.437\nmu_d = 0.2185\nk2 = \"86.8 kN/m\"\n\
     delta = \"2.45 mm\"\n\
     [[axes]]\nname = \"p_d\"\nfrom = \"1 N\"\nto = \"3 N\"\npoints = 9\n\
     [[axes]]\nname = \"omega\"\nfrom = \"70 rad/s\"\nto = \"130 rad/s\"\npoints = 31\n";
/// The ranges of the free parameters.
const FREE: Free = [(Parameter::Pd, 2.0), (Parameter::Omega, 60.0)];
/// The paper's capsule, driven so that its best motions lie where their events change.
const KINKED: &str = "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\n\
     [[axes]]\nname = \"p_d\"\nfrom = \"7 N\"\nto = \"8 N\"\npoints = 6\n\
     [[axes]]\nname = \"omega\"\nfrom = \"50 rad/s\"\nto = \"65 rad/s\"\npoints = 16\n";
const FREE_OF_KINKED: Free = [(Parameter::Pd, 1.0), (Parameter::Omega, 15.0)];

/// Two free parameters with the widths of their ranges.
type Free = [(Parameter, f64); 2];

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

/// The parameters of a point, and where its motion starts.
fn motion(point: &Value) -> (Parameters, State<f64>) {
    let value = |it: &Parameter| (*it, number(&point["parameters"], it.symbol()));
    let values: Vec<(Parameter, f64)> = of_the_paper().map(value).collect();
    let start = |key: &str| number(&point["start"], key);
    let state = State::of([start("start_r"), start("start_y1"), 0.0, start("start_y2")]);
    (Parameters::with(&values), state)
}

/// The outputs at parameters moved by these shares of their ranges.
fn beside(point: &Value, free: Free, by: [f64; 2]) -> Outputs {
    let (mut parameters, start) = motion(point);
    for ((parameter, range), share) in free.into_iter().zip(by) {
        parameters[parameter] += share * range;
    }
    let orbit = settle(&parameters, 0.0, start, &Protocol::default());
    assert_eq!((orbit.outcome, Some(orbit.period)), (Outcome::Periodic, point["period"].as_u64()));
    orbit.outputs
}

fn is_interior(point: &&Value) -> bool {
    point["held_by"] == serde_json::json!(["interior"]) && point["case"].is_null()
}

#[test]
fn refined_motions_are_the_best_around_them_and_do_not_depend_on_threads_or_seed() {
    let folder = WorkDir::new();
    folder.put("study.toml", STUDY);
    folder.run(&["sweep", "study.toml"]).done();
    let asked = |more: &[&str]| {
        let first = ["tradeoff", "results/study/study.h5", "--direction", "forward", "--json"];
        folder.run(&[&first[..], more].concat())
    };
    let answer = asked(&["--refine"]).json();
    assert_eq!(answer, asked(&["--refine", "--threads", "1"]).json());
    let gain = |key: &str| number(&answer["refined"], key);
    assert!(gain("hypervolume") > gain("hypervolume_of_cases"), "{}", answer["refined"]);
    for seed in ["2", "3"] {
        let other = asked(&["--refine", "--seed", seed]).json();
        for key in ["fastest", "lowest_cost_of_transport"] {
            for (parameter, range) in FREE {
                let at = |answer: &Value| number(&answer[key]["parameters"], parameter.symbol());
                let apart = (at(&answer) - at(&other)).abs();
                assert!(apart < 1e-6 * range, "{key}: {apart} in {}", parameter.symbol());
            }
        }
    }
    let front = answer["front"].as_array().expect("a front");
    let interior: Vec<&Value> = front.iter().filter(is_interior).collect();
    assert!(interior.len() >= 3, "{} of {} are interior", interior.len(), front.len());
    for point in interior.iter().step_by(interior.len().div_ceil(6)) {
        assert!(number(point, "stationarity") <= 1e-8);
        let replay = point["replay"].as_str().expect("a command");
        let words: Vec<&str> = replay.split(' ').skip(1).chain(["--json"]).collect();
        let again = folder.run(&words).done();
        for key in ["progression_speed", "power"] {
            assert_eq!(again.printed(key), number(point, key), "{replay}");
        }
        no_better_around(point, FREE);
        derivatives_are_those_of_differences(point);
    }
}

/// On small circles no motion is faster for no more power.
fn no_better_around(point: &Value, free: Free) {
    let here = beside(point, free, [0.0; 2]);
    let (speed, power) = (here[Output::ProgressionSpeed], here[Output::Power]);
    for radius in [1e-3, 1e-4] {
        for turn in 0..24 {
            let angle = f64::from(turn) * std::f64::consts::TAU / 24.0;
            let there = beside(point, free, [radius * angle.cos(), radius * angle.sin()]);
            let is_better = there[Output::Power] <= power
                && there[Output::ProgressionSpeed].abs() > speed.abs() * (1.0 + 1e-9);
            assert!(!is_better, "{radius} {turn}: {there:?} {point}");
        }
    }
}

/// The sensitivities, percent per percent, are those of central differences.
fn derivatives_are_those_of_differences(point: &Value) {
    let (parameters, _) = motion(point);
    for (place, (parameter, range)) in FREE.into_iter().enumerate() {
        let moved = |share: f64| {
            let mut by = [0.0; 2];
            by[place] = share;
            beside(point, FREE, by)
        };
        let pairs = [1e-7, 5e-8].map(|h| (h, moved(h), moved(-h)));
        let each =
            [(Output::ProgressionSpeed, "sensitivity"), (Output::Power, "sensitivity_of_power")];
        for (output, key) in each {
            let [coarse, fine] = pairs
                .clone()
                .map(|(h, ahead, behind)| (ahead[output] - behind[output]) / (2.0 * h * range));
            let slope = (4.0 * fine - coarse) / 3.0;
            let relative = slope * parameters[parameter] / number(point, output.name());
            let told = number(&point[key], parameter.symbol());
            assert!(
                (relative - told).abs() < 1e-5 * (1.0 + told.abs()),
                "{key}: {relative} {told}"
            );
        }
    }
}

#[test]
fn a_motion_held_by_a_change_of_events_is_where_continuation_finds_that() {
    let folder = WorkDir::new();
    folder.put("study.toml", KINKED);
    folder.run(&["sweep", "study.toml"]).done();
    let refine = ["tradeoff", "results/study/study.h5", "--refine", "--json"];
    let answer = folder.run(&refine).json();
    let front = answer["front"].as_array().expect("a front");
    let is_held = |point: &&Value| point["held_by"] == serde_json::json!(["event sequence"]);
    let held: Vec<&Value> = front.iter().filter(is_held).collect();
    assert!(!held.is_empty(), "{}", answer["front"]);
    for point in held {
        assert!(number(point, "stationarity") <= 1e-8);
        no_better_around(point, FREE_OF_KINKED);
        let [p_d, omega] = FREE_OF_KINKED.map(|(it, _)| number(&point["parameters"], it.symbol()));
        let start = ["start_r", "start_y1", "start_y2"].map(|key| number(&point["start"], key));
        let branches = format!(
            "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\np_d = \"{p_d:?} N\"\n\
             [[axes]]\nname = \"omega\"\nfrom = \"{:?} rad/s\"\nto = \"{:?} rad/s\"\npoints = 3\n\
             [[branches]]\nname = \"along omega\"\nalong = \"omega\"\nat = {{ omega = \"{omega:?} rad/s\" }}\n\
             orbit = \"newton\"\nperiod = {}\n\
             start = {{ r = \"{:?} m\", y1 = \"{:?} m/s\", y2 = \"{:?} m/s\" }}\n",
            omega - 0.01,
            omega + 0.01,
            point["period"],
            start[0],
            start[1],
            start[2]
        );
        folder.put("branches.toml", &branches);
        folder.run(&["continue", "branches.toml", "--overwrite"]).done();
        let file = hdf5::File::open(folder.path("results/branches/branches.h5")).expect("a file");
        let of_special = |name: &str| {
            file.dataset(name).and_then(|it| it.read_raw::<f64>()).expect("special points")
        };
        let apart = of_special("special_omega").into_iter().map(|it| (it - omega).abs());
        let apart = apart.fold(f64::INFINITY, f64::min);
        assert!(apart <= 1e-9 * 15.0, "{apart} rad/s from {omega}");
    }
}

#[test]
fn a_search_is_refused_where_nothing_varies_or_conditions_could_not_be_kept() {
    let folder = WorkDir::new();
    let starts = "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"1 mm\"\np_d = \"2 N\"\nomega = \"40 rad/s\"\n\
         [[axes]]\nname = \"start_r\"\nfrom = \"-1 mm\"\nto = \"1 mm\"\npoints = 3\n";
    folder.put("study.toml", starts);
    folder.run(&["sweep", "study.toml"]).done();
    let file = "results/study/study.h5";
    folder.run(&["tradeoff", file, "--refine"]).refused(&["0 parameters vary", "1 to 6"]);
    let both = ["tradeoff", file, "--refine", "--where", "start_r > 0 mm"];
    folder.run(&both).refused(&["start_r > 0 mm", "`--refine` cannot keep it between the cases"]);
}
