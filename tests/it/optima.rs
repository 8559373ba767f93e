//! `capsulemap tradeoff`: the optima of a file against their definitions, and replayed.

use capsulemap::store::{self, Dataset};
use capsulemap::tradeoff::{Candidate, Direction, hypervolume, optima};
use serde_json::Value;

use super::draws::Random;
use super::program::WorkDir;

/// Cases that rest, move both ways, and in chaos, swept along one axis in both directions.
const STUDY: &str = "[parameters]\nc = \"0.44 N s/m\"\nmu_s = 0.437\nmu_d = 0.2185\nk2 = \"86.8 kN/m\"\n\
     delta = \"2.45 mm\"\n\
     [[axes]]\nname = \"p_d\"\nvalues = [\"1.5 N\", \"3 N\", \"4.5 N\"]\n\
     [[axes]]\nname = \"omega\"\nfrom = \"30 rad/s\"\nto = \"130 rad/s\"\npoints = 41\n\
     [start]\ninherit = \"omega\"\ndirections = [\"upward\", \"downward\"]\n";

fn column(dataset: &Dataset, name: &str) -> Vec<f64> {
    dataset.variable(name).expect("it is there").values.to_real().into_iter().collect()
}

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

#[test]
fn the_optima_of_a_file_are_those_of_their_definitions() {
    let folder = WorkDir::new();
    folder.put("study.toml", STUDY);
    folder.run(&["sweep", "study.toml"]).done();
    let file = "results/study/study.h5";
    let dataset = store::read(&folder.path(file)).expect("a file of results");
    let [speeds, power, work, metres, outcome, force] = [
        "progression_speed",
        "power",
        "work_positive",
        "energy_per_metre",
        "outcome",
        "peak_contact_force",
    ]
    .map(|name| column(&dataset, name));
    let omega = column_of_axis(&dataset, "omega", speeds.len());
    for case in 0..speeds.len() {
        let same = |a: f64, b: f64| a == b || (a - b).abs() < 1e-12 * b.abs();
        assert!(same(power[case], work[case] * omega[case] / std::f64::consts::TAU));
        // The speed is the advance over the same time.
        let moves = metres[case].is_finite();
        assert!(!moves || same(metres[case], power[case] / speeds[case].abs()), "{case}");
    }
    let arguments = ["tradeoff", file, "--json", "--direction", "backward"];
    let limits = ["--where", "peak_contact_force < 60 N and outcome != undecided"];
    let asked = ["--budget", "100 mW", "--speed", "5 mm/s", "--top", "4"];
    let ran = folder.run(&[&arguments[..], &limits, &asked].concat());
    let answer = ran.json();
    let takes_part = |case: &usize| outcome[*case] < 3.0 && force[*case] < 60.0;
    let moving: Vec<usize> =
        (0..speeds.len()).filter(takes_part).filter(|case| -speeds[*case] > 1e-7).collect();
    assert!(moving.len() > 10);
    let beaten = |case: &usize| {
        moving.iter().any(|other| {
            let no_worse = speeds[*other] <= speeds[*case] && power[*other] <= power[*case];
            no_worse && (speeds[*other], power[*other]) != (speeds[*case], power[*case])
        })
    };
    let by_definition = moving.iter().filter(|case| !beaten(case)).count();
    let front = answer["front"].as_array().expect("a front");
    assert!(front.len() <= by_definition && front.len() > 2);
    let case = |point: &Value| number(point, "case") as usize;
    assert!(front.iter().all(|point| !beaten(&case(point))));
    let least = |of: &dyn Fn(usize) -> f64| {
        moving.iter().map(|case| of(*case)).fold(f64::INFINITY, f64::min)
    };
    let same_speed = |key: &str, speed: f64| {
        let found = number(&answer[key], "progression_speed");
        assert!((found - speed).abs() < 1e-14, "{key}: {found} {speed}");
    };
    same_speed("fastest", least(&|case| speeds[case]));
    let within = |case: usize| if power[case] <= 0.1 { speeds[case] } else { f64::INFINITY };
    same_speed("fastest_within_budget", least(&within));
    let reaching = |case: usize| if speeds[case] <= -5e-3 { power[case] } else { f64::INFINITY };
    let price = number(&answer["least_for_speed"], "power");
    assert!((price - least(&reaching)).abs() < 1e-14);
    let cheapest = case(&answer["lowest_cost_of_transport"]);
    assert_eq!(metres[cheapest], least(&|case| metres[case]));
    assert_eq!(answer["top"].as_array().map(Vec::len), Some(4));
    // The replay is computed from the start that the case had in the sweep, and the file may stand for its study.
    let replay = answer["fastest"]["replay"].as_str().expect("a command");
    let words: Vec<&str> = replay.split(' ').skip(1).chain(["--json"]).collect();
    let again = folder.run(&words).done();
    assert_eq!(again.printed("progression_speed"), speeds[case(&answer["fastest"])]);
    // As a table and as CSV.
    let shown = folder.run(&["tradeoff", file, "--direction", "backward"]).done().out;
    assert!(shown.contains("Pareto front of progression_speed (backward) and power"), "{shown}");
    let lines = folder.run(&["tradeoff", file, "--csv", "--of", "work_positive"]).done().out;
    let header = lines.lines().next().expect("a header");
    assert!(header.starts_with("what,case,progression_speed,work_positive,outcome"), "{header}");
    assert!(lines.lines().all(|line| line.split(',').count() == header.split(',').count()));
}

/// The values of an axis for each of so many cases with two directions as the last dimension.
fn column_of_axis(dataset: &Dataset, name: &str, cases: usize) -> Vec<f64> {
    let values: Vec<f64> =
        dataset.coordinate(name).expect("an axis").values.to_real().into_iter().collect();
    (0..cases).map(|case| values[case / 2 % values.len()]).collect()
}

#[test]
fn what_is_asked_wrongly_is_refused_with_all_faults() {
    let folder = WorkDir::new();
    folder.put("study.toml", "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\np_d = \"4 N\"\nomega = \"20.73 rad/s\"\n");
    folder.run(&["sweep", "study.toml"]).done();
    let file = "results/study/study.h5";
    folder.run(&["tradeoff", file, "--of", "powr", "--budget", "3 mm"]).refused(&[
        "--of: unknown output \"powr\"; did you mean \"power\"?",
        "--budget: \"3 mm\" is a length; expected a power",
    ]);
    folder
        .run(&["tradeoff", file, "--where", "speed < 3 and p_d > 3 mm and outcome = foo and p_d"])
        .refused(&[
            "unknown output or parameter of a case \"speed\"",
            "\"p_d > 3 mm\": \"3 mm\" is a length; expected a force",
            "unknown category \"foo\"",
            "\"p_d\": expected a name, one of < <= > >= = !=, and a value",
        ]);
    let shown = folder.run(&["tradeoff", file, "--direction", "forward"]).done().out;
    assert!(shown.contains("1 case"), "{shown}");
}

#[test]
fn the_knee_is_farthest_from_the_line_between_the_ends_and_the_hypervolume_an_area() {
    // A quarter of a circle: the knee is in its middle, and the area below it is known.
    let count = 20_001;
    let candidate = |case: usize| {
        let angle = std::f64::consts::FRAC_PI_2 * case as f64 / (count - 1) as f64;
        let (price, speed) = (1.0 - angle.cos(), 1e-3 + angle.sin());
        Candidate { case, gain: speed, price, per_gain: price / speed }
    };
    let mut all: Vec<Candidate> = (0..count).map(candidate).collect();
    let mut random = Random::new(7);
    all.sort_by_cached_key(|_| (1e15 * random.uniform(0.0, 1.0)) as u64);
    let best = optima(&all, Direction::Forward, None);
    assert_eq!(best.front.len(), count);
    let knee = all[best.knee.expect("a knee")];
    assert_eq!(knee.case, (count - 1) / 2);
    let points: Vec<(f64, f64)> =
        best.front.iter().map(|&at| (all[at].price, all[at].gain)).collect();
    let area = hypervolume(&points, 1.0, 1e-3);
    assert!((area - std::f64::consts::FRAC_PI_4).abs() < 1e-4, "{area}");
    assert!(best.front.is_sorted_by(|&a, &b| all[a].price < all[b].price));
    assert!(optima(&all, Direction::Backward, None).front.is_empty());
    assert_eq!(optima(&all[..0], Direction::Either, None).most_gain, None);
}
