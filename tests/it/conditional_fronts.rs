//! Motions that are sought under conditions make fronts of their own, and draws under tolerances are counted against these.

use std::fs;

use super::program::of_the_paper;
use capsulemap::campaign::Tolerances;
use capsulemap::capsule::{CapsuleParameters as _, Output, Parameter, Parameters, State, settle};
use capsulemap::orbit::Protocol;
use serde_json::Value;

use super::program::WorkDir;

const STUDY: &str = "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\n\
     [[axes]]\nname = \"p_d\"\nfrom = \"7 N\"\nto = \"8 N\"\npoints = 4\n\
     [[axes]]\nname = \"omega\"\nfrom = \"50 rad/s\"\nto = \"60 rad/s\"\npoints = 5\n";
const FILE: &str = "results/study/study.h5";

fn swept() -> WorkDir {
    let folder = WorkDir::new();
    folder.put("study.toml", STUDY);
    folder.run(&["sweep", "study.toml", "--no-figures"]).done();
    folder
}

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

/// The speeds of a front in the data behind the figure, by what it is called there, in their order.
fn recorded(data: &str, name: &str) -> Vec<f64> {
    let lines = data.lines().filter(|line| line.contains(name));
    let numbers =
        |line: &str| -> Option<f64> { line.rsplit(',').find_map(|cell| cell.trim().parse().ok()) };
    lines.filter_map(numbers).collect()
}

/// The front without conditions is that of the cases, which `tradeoff` without `--refine` tells, and is not touched by what is found
/// under conditions; the front under conditions is that of `tradeoff --where --refine`.
#[test]
fn figure_and_report_keep_fronts_under_different_conditions_apart() {
    let folder = swept();
    let condition = "p_d < 7.4 N and outcome = periodic";
    let whole = ["tradeoff", FILE, "--direction", "backward", "--json"];
    let alone = folder.run(&whole).json();
    let under = [&whole[..], &["--where", condition, "--refine", "--budget", "1 W"]].concat();
    let under = folder.run(&under).json();
    assert_eq!(under["where"], serde_json::json!(["outcome = periodic", "p_d < 7.4 N"]));
    assert_eq!(number(&under, "budget"), 1.0);
    let figure = ["figure", FILE, "--kind", "trade-off", "--of", "power", "--formats", "svg"];
    folder.run(&[&figure[..], &["--data"]].concat()).done();
    let data = folder.path("results/study/trade-off-power.csv");
    let data = fs::read_to_string(data).expect("the data behind the figure");
    let count = |answer: &Value| answer["front"].as_array().expect("a front").len();
    let said = "Pareto front, backward, where outcome = periodic and p_d < 7.4 N";
    assert_eq!(recorded(&data, said).len(), count(&under), "{data}");
    let both = recorded(&data, "Pareto front, backward").len();
    assert_eq!(both, count(&under) + count(&alone), "{data}");
    let svg =
        fs::read_to_string(folder.path("results/study/trade-off-power.svg")).expect("a figure");
    assert!(svg.contains(" 0 periodic motions between the cases; "), "{svg}");
    assert!(svg.contains("found by local search"));
    folder.run(&["report", FILE]).done();
    let page = fs::read_to_string(folder.path("results/study/study.html")).expect("a report");
    let front = |condition: &str, count: usize| {
        format!(
            "The Pareto front of progression speed (backward) and power{condition} has {count} motions"
        )
    };
    assert!(page.contains(&front("", count(&alone))));
    let condition = " where outcome = periodic and p_d &lt; 7.4 N";
    assert!(page.contains(&front(condition, count(&under))));
    assert!(page.contains("each search is local, and a better motion may lie elsewhere"));
    // Forward nothing was sought under conditions.
    assert!(!page.contains("Moving forward, where"));
}

/// The counts are those of the same draws, each settled by the library and held against condition and budget here.
#[test]
fn draws_are_counted_that_keep_conditions_and_budget() {
    let folder = swept();
    let tolerances = "k2 = 20 %, omega = 4 %";
    let asked = ["tradeoff", FILE, "--direction", "backward", "--tolerances", tolerances];
    let limits =
        ["--where", "omega < 56 rad/s and energy_per_metre < 40 J/m", "--budget", "600 mW"];
    let more = ["--draws", "40", "--seed", "5"];
    let all = [&asked[..], &limits, &more].concat();
    let answer = folder.run(&[&all[..], &["--json"]].concat()).json();
    let told = &answer["tolerances"];
    assert_eq!(
        (&told["each_is"], &told["distribution"]),
        (&"half width".into(), &"uniform".into())
    );
    let each = vec![(Parameter::K2.into(), 0.2), (Parameter::Omega.into(), 0.04)];
    let factors = (Tolerances { each, draws: 40, seed: 5 }).factors();
    let mut has_both = [false; 2];
    for point in answer["front"].as_array().expect("a front") {
        let value = |it: &Parameter| (*it, number(&point["parameters"], it.symbol()));
        let values: Vec<(Parameter, f64)> = of_the_paper().map(value).collect();
        let parameters = Parameters::with(&values);
        let rest = State::of([0.0, 0.0, 0.0, 0.0]);
        let begun = settle(&parameters, 0.0, rest, &Protocol::default()).end;
        let mut counts = [0_u64; 3];
        for factors in &factors {
            let mut changed = parameters.clone();
            factors.iter().for_each(|(parameter, factor)| changed[*parameter] *= factor);
            let start = begun.clone().without_drift();
            let outputs = settle(&changed, 0.0, start, &Protocol::default()).outputs;
            let keeps = changed[Parameter::Omega] < 56.0 && outputs[Output::EnergyPerMetre] < 40.0;
            let is_within = outputs[Output::Power] <= 0.6;
            let each = [keeps, is_within, keeps && is_within];
            counts.iter_mut().zip(each).for_each(|(count, does)| *count += u64::from(does));
        }
        let robustness = &point["robustness"];
        let keys = ["meet_conditions", "within_budget", "meet_conditions_within_budget"];
        let found = keys.map(|key| robustness[key].as_u64().expect(key));
        assert_eq!(found, counts, "{point}");
        has_both[0] |= (1..40).contains(&counts[0]);
        has_both[1] |= (1..40).contains(&counts[1]);
    }
    // Neither all nor none of the draws do, or the counts would say little.
    assert_eq!(has_both, [true; 2], "{}", answer["front"]);
    let text = folder.run(&all).done().out;
    assert!(
        text.contains("k2 \u{b1} 20 %, omega \u{b1} 4 %, half widths of even distributions"),
        "{text}"
    );
    assert!(
        text.contains("of 40 draws keep the conditions") && text.contains("keep to the budget")
    );
}
