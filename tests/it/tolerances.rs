//! `capsulemap tradeoff --tolerances`: against the derivatives of the motion, against brute force, and what is refused.

use super::program::of_the_paper;
use capsulemap::campaign::Tolerances;
use capsulemap::capsule::{
    CapsuleParameters as _, CapsuleState as _, Output, Parameter, Parameters, State, settle,
};
use capsulemap::orbit::{Outcome, Protocol};
use serde_json::Value;

use super::program::WorkDir;

const STUDY: &str = "[parameters]\nc = \"0.44 N s/m\"\nmu_s = 0.437\nmu_d = 0.2185\nk2 = \"86.8 kN/m\"\n\
     delta = \"2.45 mm\"\n\
     [[axes]]\nname = \"p_d\"\nfrom = \"1 N\"\nto = \"3 N\"\npoints = 5\n\
     [[axes]]\nname = \"omega\"\nfrom = \"70 rad/s\"\nto = \"130 rad/s\"\npoints = 13\n";
const FILE: &str = "results/study/study.h5";

fn swept() -> WorkDir {
    let folder = WorkDir::new();
    folder.put("study.toml", STUDY);
    folder.run(&["sweep", "study.toml"]).done();
    folder
}

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

/// Of deviations that are equally likely within t, one in twenty takes more than 0.9 t in the bad direction, and the speed falls
/// by the sensitivity times that.
#[test]
fn small_tolerances_leave_what_derivatives_foretell() {
    let folder = swept();
    let asked = ["tradeoff", FILE, "--direction", "forward", "--json", "--draws", "400"];
    let mut compared = 0;
    for symbol in ["p_d", "mu_d"] {
        let tolerances = format!("{symbol} = 0.01 %");
        let answer = folder.run(&[&asked[..], &["--tolerances", &tolerances]].concat()).json();
        for point in answer["front"].as_array().expect("a front") {
            let (speed, robustness) = (number(point, "progression_speed"), &point["robustness"]);
            let slope = point["sensitivity"][symbol].as_f64().unwrap_or(0.0).abs();
            if slope < 0.2 || number(robustness, "kept") < 1.0 {
                continue;
            }
            let lost = (speed - number(robustness, "speed_of_slowest_5_percent")) / speed;
            let foretold = 0.9 * slope * 1e-4;
            // The order statistic of 400 draws scatters by 2 % of the tolerance, and curvature adds less.
            assert!(
                (lost - foretold).abs() < 0.1 * foretold,
                "{symbol}: {lost} {foretold}: {point}"
            );
            compared += 1;
        }
    }
    assert!(compared >= 6, "{compared}");
}

#[test]
fn what_is_told_of_large_tolerances_is_that_of_the_draws_and_the_same_on_any_number_of_threads() {
    let folder = swept();
    let asked = [
        "tradeoff",
        FILE,
        "--direction",
        "forward",
        "--json",
        "--draws",
        "40",
        "--seed",
        "5",
        "--tolerances",
        "k2 = 20 %, omega=3 %",
    ];
    let told = folder.run(&asked).done();
    assert_eq!(told.out, folder.run(&[&asked[..], &["--threads", "1"]].concat()).done().out);
    let answer = told.json();
    let fastest = &answer["fastest"];
    let value = |it: &Parameter| (*it, number(&fastest["parameters"], it.symbol()));
    let parameters = Parameters::with(&of_the_paper().map(value).collect::<Vec<_>>());
    let orbit = settle(&parameters, 0.0, State::default(), &Protocol::default());
    let [r, y1, y2] = [orbit.end.capsule().r, orbit.end.capsule().y1, orbit.end.capsule().y2];
    let each = vec![(Parameter::K2.into(), 0.2), (Parameter::Omega.into(), 0.03)];
    let (mut speeds, mut kept) = (Vec::new(), 0);
    for factors in (Tolerances { each, draws: 40, seed: 5 }).factors() {
        let mut changed = parameters.clone();
        factors.into_iter().for_each(|(parameter, factor)| changed[parameter] *= factor);
        let there = settle(&changed, 0.0, State::of([r, y1, 0.0, y2]), &Protocol::default());
        speeds.push(there.outputs[Output::ProgressionSpeed]);
        kept += usize::from(there.outcome == Outcome::Periodic && there.period == orbit.period);
    }
    speeds.sort_by(f64::total_cmp);
    let robustness = &fastest["robustness"];
    assert_eq!(number(robustness, "kept"), kept as f64 / 40.0);
    let speed = number(robustness, "speed_of_slowest_5_percent");
    assert!((speed - speeds[1]).abs() < 1e-8 * speeds[1].abs(), "{speed} {speeds:?}");
    // No motion of the robust front is beaten by another in both what tolerances leave of speed and price.
    let front = answer["front"].as_array().expect("a front");
    let place = |it: &Value| front[it.as_u64().expect("a place") as usize]["robustness"].clone();
    let robust: Vec<Value> =
        answer["robust_front"].as_array().expect("places").iter().map(place).collect();
    assert!(!robust.is_empty());
    for a in &robust {
        for b in front
            .iter()
            .map(|it| &it["robustness"])
            .filter(|it| it["price_of_dearest_5_percent"].is_f64())
        {
            let [slow, fast] = [a, b]
                .map(|it| it["speed_of_slowest_5_percent"].as_f64().unwrap_or(f64::NEG_INFINITY));
            let [dear, cheap] = [a, b].map(|it| number(it, "price_of_dearest_5_percent"));
            assert!(!(fast > slow && cheap < dear), "{a} {b}");
        }
    }
}

#[test]
fn tolerances_that_make_no_sense_are_refused_all_at_once() {
    let folder = swept();
    let asked = [
        "tradeoff",
        FILE,
        "--tolerances",
        "k9 = 5 %, mu_s = 100 %, k2, p_d = 1 N, omega = 1 %, omega = 2 %",
    ];
    folder.run(&asked).refused(&[
        "k9",
        "mu_s = 100 %: is 100 %; must lie between 0 and 100 %",
        "k2: expected PARAMETER = PERCENT",
        "p_d = 1 N",
        "omega is given twice",
    ]);
}
