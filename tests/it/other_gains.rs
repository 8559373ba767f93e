//! Trade-offs of any outputs: the amplitude of an oscillator given as text against its work, and other gains of the capsule than the speed.

use std::f64::consts::PI;
use std::fs;

use capsulemap::store::{self, Dataset};
use serde_json::Value;

use super::kept_searches::{REFINE, SEARCHES, STUDY, lines, swept};
use super::program::WorkDir;

/// A linear oscillator in SI units over frequencies and amplitudes of its drive.
const LINEAR: &str = r#"title = "Amplitude and work"
outputs = ["amplitude", "work", "least"]
[[axes]]
name = "w"
values = ["0.55 rad/s", "0.7 rad/s", "0.85 rad/s", "0.95 rad/s", "1.05 rad/s", "1.3 rad/s", "1.6 rad/s"]
[[axes]]
name = "p"
values = ["0.2 N", "0.5 N", "1.1 N", "1.7 N"]
[system]
name = "linear oscillator"
states = { x = "m", v = "m/s" }
section = { every = "2*pi/w" }
[system.parameters]
m = { default = 1.0, unit = "kg" }
k = { default = 1.0, unit = "N/m" }
c = { default = 0.2, unit = "N s/m" }
p = { default = 1.0, unit = "N" }
w = { default = 1.0, unit = "rad/s" }
[system.rates]
x = "v"
v = "(p*cos(w*t) - k*x - c*v)/m"
[system.outputs]
amplitude = { value = "max(x)", unit = "m" }
least = { value = "min(x)", unit = "m" }
work = { value = "integral(c*v^2)", unit = "J" }
"#;
const FIGURES: &str = r#"[[figures]]
name = "front"
kind = "trade-off"
of = ["work", "amplitude"]
[[figures]]
name = "maps"
kind = "trade-off-maps"
of = ["work", "amplitude"]
"#;
const FILE: &str = "results/linear/linear.h5";
const HELD: [&str; 5] = ["--of", "work", "--for", "amplitude", "--json"];

/// Frequencies and amplitudes of the drive, as in the study.
const FREQUENCIES: [f64; 7] = [0.55, 0.7, 0.85, 0.95, 1.05, 1.3, 1.6];
const FORCES: [f64; 4] = [0.2, 0.5, 1.1, 1.7];

/// A folder with the study, and its results.
fn linear() -> WorkDir {
    let work = WorkDir::new();
    work.put("linear.toml", format!("{LINEAR}{FIGURES}"));
    work.run(&["sweep", "linear.toml"]).done();
    work
}

/// The amplitude and the work of a cycle of the motion at a frequency and a force: x = A cos(w t - phi), which dissipates
/// c (A w)^2 pi/w in a cycle.
fn closed_form(w: f64, p: f64) -> (f64, f64) {
    let c = 0.2;
    let amplitude = p / (1.0 - w * w).hypot(c * w);
    (amplitude, PI * c * w * amplitude * amplitude)
}

/// The front of gains and costs, case by case: the cases that no other matches in both, by rising cost.
fn by_definition(all: &[(f64, f64)]) -> Vec<usize> {
    let beaten = |at: usize| {
        let (gain, cost) = all[at];
        all.iter().any(|it| it.0 >= gain && it.1 <= cost && *it != (gain, cost))
    };
    let mut front: Vec<usize> = (0..all.len()).filter(|at| !beaten(*at)).collect();
    front.sort_by(|a, b| all[*a].1.total_cmp(&all[*b].1));
    front
}

fn column(dataset: &Dataset, name: &str) -> Vec<f64> {
    dataset.variable(name).expect("it is there").values.to_real().into_iter().collect()
}

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

fn case(point: &Value) -> usize {
    point["case"].as_u64().unwrap_or_else(|| panic!("no case: {point}")) as usize
}

#[test]
fn the_front_of_any_two_outputs_is_that_of_its_definition_and_of_the_closed_form() {
    let work = linear();
    let exact: Vec<(f64, f64)> =
        FREQUENCIES.iter().flat_map(|w| FORCES.map(|p| closed_form(*w, p))).collect();
    let dataset = store::read(&work.path(FILE)).expect("a file of results");
    let [gains, costs] = ["amplitude", "work"].map(|name| column(&dataset, name));
    let found: Vec<(f64, f64)> = gains.iter().copied().zip(costs.iter().copied()).collect();
    for ((gain, cost), (amplitude, dissipated)) in found.iter().zip(&exact) {
        assert!((gain / amplitude - 1.0).abs() < 1e-7, "{gain} {amplitude}");
        assert!((cost / dissipated - 1.0).abs() < 1e-7, "{cost} {dissipated}");
    }
    let limits = ["--budget", "300 mJ", "--speed", "1.5 m", "--top", "3"];
    let answer = work.run(&[&["tradeoff", FILE][..], &HELD, &limits].concat()).json();
    let front = answer["front"].as_array().expect("a front");
    let places: Vec<usize> = front.iter().map(case).collect();
    assert_eq!(places, by_definition(&found));
    assert_eq!(places, by_definition(&exact));
    assert!(places.len() > 5, "{places:?}");
    for point in front {
        let (gain, cost) = found[case(point)];
        assert_eq!((number(point, "amplitude"), number(point, "work")), (gain, cost));
        assert_eq!(number(point, "cost_per_gain"), cost / gain);
        // What follows derivatives is not told where there are none.
        assert_eq!(point["sensitivity"], serde_json::json!({}));
    }
    let most = gains.iter().copied().fold(0.0, f64::max);
    assert_eq!(number(&answer["most_gain"], "amplitude"), most);
    assert_eq!((&answer["of"], &answer["for"]), (&"work".into(), &"amplitude".into()));
    assert_eq!(number(&answer, "gain_at_rest"), 1e-6 * most);
    let least = found.iter().map(|it| it.1 / it.0).fold(f64::INFINITY, f64::min);
    assert_eq!(number(&answer["least_cost_per_gain"], "cost_per_gain"), least);
    let within = found.iter().filter(|it| it.1 <= 0.3).map(|it| it.0).fold(0.0, f64::max);
    assert_eq!(number(&answer["most_gain_within_budget"], "amplitude"), within);
    let reaching = found.iter().filter(|it| it.0 >= 1.5).map(|it| it.1);
    let cheapest = reaching.fold(f64::INFINITY, f64::min);
    assert_eq!(number(&answer["least_cost_for_gain"], "work"), cheapest);
    assert_eq!(answer["top"].as_array().map(Vec::len), Some(3));
    for key in ["fastest", "lowest_cost_of_transport", "speed_at_rest", "least_speed"] {
        assert!(answer.get(key).is_none(), "{key} in {answer}");
    }
    // A motion is computed again by its command.
    let replay = answer["most_gain"]["replay"].as_str().expect("a command");
    let arguments = replay.strip_prefix("capsulemap").expect("a command of the program");
    let again = work.shell(&format!("\"$0\" {arguments} --json")).done();
    assert!((again.printed("amplitude") / most - 1.0).abs() < 1e-9, "{replay}");
}

#[test]
fn a_gain_may_be_negative_and_a_direction_is_its_sign() {
    let work = linear();
    let asked = |direction: &str| {
        let gain = ["tradeoff", FILE, "--of", "work", "--for", "least", "--json"];
        work.run(&[&gain[..], &["--direction", direction]].concat()).json()
    };
    assert_eq!(asked("forward")["front"], serde_json::json!([]));
    let [backward, either] = ["backward", "either"].map(asked);
    assert_eq!(backward["front"], either["front"]);
    let front = backward["front"].as_array().expect("a front");
    let dataset = store::read(&work.path(FILE)).expect("a file of results");
    let [gains, costs] = ["least", "work"].map(|name| column(&dataset, name));
    let found: Vec<(f64, f64)> = gains.iter().map(|it| -it).zip(costs).collect();
    assert_eq!(front.iter().map(case).collect::<Vec<_>>(), by_definition(&found));
    // Where a cost is below zero, none is the least per gain.
    let below = ["tradeoff", FILE, "--of", "least", "--for", "amplitude", "--json"];
    let answer = work.run(&below).json();
    assert_eq!(answer["least_cost_per_gain"], Value::Null);
    assert!(number(&answer["most_gain"], "least") < 0.0, "{answer}");
}

#[test]
fn tables_and_reports_tell_a_gain_by_its_name_and_unit() {
    let work = linear();
    let table = work.run(&[&["tradeoff", FILE][..], &HELD[..4]].concat()).done().out;
    for part in [
        "left out without gain (no more than",
        "Pareto front of amplitude (either) and work: ",
        "amplitude [m]",
        "work [J]",
        "cost per gain",
        "most gain ",
        "least cost per gain ",
        "replay of most gain: capsulemap simulate --study ",
    ] {
        assert!(table.contains(part), "{part}: {table}");
    }
    assert!(!table.contains("mm/s") && !table.contains("J/m"), "{table}");
    let csv = work.run(&[&["tradeoff", FILE, "--csv"][..], &HELD[..4]].concat()).done().out;
    let header = csv.lines().next().expect("a header");
    assert!(header.starts_with("what,case,amplitude,work,outcome"), "{header}");
    assert!(header.contains(",cost_per_gain,standard_error_of_gain,"), "{header}");
    let draws = ["--tolerances", "c = 5 %", "--draws", "10"];
    let answer = work.run(&[&["tradeoff", FILE][..], &HELD, &draws].concat()).json();
    let most = &answer["most_gain"];
    // Damping that is larger by no more than a twentieth leaves most of the amplitude.
    let kept = number(&most["robustness"], "gain_of_least_5_percent") / number(most, "amplitude");
    assert!((0.9..=1.0).contains(&kept), "{most}");
    assert!(answer["most_gain_under_tolerances"].is_object(), "{answer}");
    work.run(&["report", FILE, "--of", "work", "--for", "amplitude"]).done();
    let page = fs::read_to_string(work.path("results/linear/linear.html")).expect("a report");
    for part in [
        "The Pareto front of amplitude (forward) and work has ",
        "amplitude [m]",
        "capsulemap report again.h5 --of work --for amplitude",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // The paper of the capsule is not that of a text.
    assert!(!page.contains("Procedia IUTAM"));
}

#[test]
fn outputs_that_are_not_named_or_misspelt_are_told_with_those_that_there_are() {
    let work = linear();
    for command in ["tradeoff", "report"] {
        work.run(&[command, FILE]).refused(&[
            "--of: missing; the model linear oscillator names no cost of its own",
            "--for: missing; the model linear oscillator names no gain of its own",
            "(allowed: amplitude, least, work",
        ]);
        work.run(&[command, FILE, "--of", "work"]).refused(&["--for: missing"]);
        work.run(&[command, FILE, "--of", "wrk", "--for", "amplitud"]).refused(&[
            "--of: unknown output \"wrk\"; did you mean \"work\"?",
            "--for: unknown output \"amplitud\"; did you mean \"amplitude\"?",
        ]);
        let twice = [command, FILE, "--of", "work", "--for", "work"];
        work.run(&twice).refused(&["--for: `work` is the output of --of, too"]);
    }
    let limits = ["--budget", "3 mm", "--speed", "3 J", "--at-rest", "1 s"];
    work.run(&[&["tradeoff", FILE][..], &HELD, &limits].concat()).refused(&[
        "--budget: \"3 mm\" is a length; expected an energy",
        "--speed: \"3 J\" is an energy; expected a length",
        "--at-rest: \"1 s\" is a time; expected a length",
    ]);
    // What is not kept in the file cannot be held against anything.
    let other = ["tradeoff", FILE, "--of", "cycle_duration", "--for", "amplitude"];
    work.run(&other).refused(&["the file has no `cycle_duration`"]);
    work.run(&[&["tradeoff", FILE, "--refine"][..], &HELD].concat()).refused(&[
        "--refine: follows derivatives of outputs in the parameters",
        "no output of the model linear oscillator has them",
    ]);
    assert!(!work.path("results/linear/linear.searches").exists());
}

#[test]
fn figures_of_a_trade_off_show_the_outputs_that_they_name() {
    let work = linear();
    for name in ["front", "maps"] {
        for extension in ["png", "svg", "pdf"] {
            let path = work.path(&format!("results/linear/{name}.{extension}"));
            assert!(fs::metadata(&path).is_ok_and(|it| it.len() > 1000), "{}", path.display());
        }
    }
    let figure = ["figure", FILE, "--kind", "trade-off", "--formats", "svg", "--data"];
    work.run(&[&figure[..], &["--of", "work,amplitude"]].concat()).done();
    let drawn = |extension: &str| {
        let path = work.path(&format!("results/linear/trade-off-work-amplitude.{extension}"));
        fs::read_to_string(path).expect("a figure")
    };
    assert!(drawn("svg").contains("are not undecided and gain more than"), "{}", drawn("svg"));
    // The front of the figure is that of the command.
    let forward = [&["tradeoff", FILE, "--direction", "forward"][..], &HELD].concat();
    let answer = work.run(&forward).json();
    let told = answer["front"].as_array().expect("a front").len();
    let data = drawn("csv");
    assert_eq!(data.lines().filter(|it| it.contains("Pareto front, forward")).count(), told);
    assert!(data.contains("most gain") && data.contains("least cost per gain"), "{data}");
    for named in [&[][..], &["--of", "work"]] {
        work.run(&[&figure[..], named].concat()).refused(&[
            "the model linear oscillator names no gain and no cost of its own",
            "`of` of a trade-off has to name both, the cost first",
        ]);
    }
    work.run(&[&figure[..], &["--of", "work,amplitud"]].concat())
        .refused(&["`amplitud` is no output of a motion"]);
    let twice = [&figure[..], &["--of", "work,work"]].concat();
    work.run(&twice).refused(&["`work` is both the gain and the cost"]);
    let drawing = "[[figures]]\nname = \"a\"\nkind = \"trade-off\"\n";
    for (of, said) in [
        ("", "names no gain and no cost of its own"),
        ("of = [\"work\"]\n", "has to name both, the cost first"),
        ("of = [\"work\", \"amplitud\"]\n", "unknown output for this kind of figure \"amplitud\""),
        ("of = [\"work\", \"amplitude\", \"least\"]\n", "expected 2 outputs"),
    ] {
        work.put("other.toml", format!("{LINEAR}{drawing}{of}"));
        work.run(&["check", "other.toml"]).refused(&["other.toml", said]);
    }
}

#[test]
fn the_capsule_with_its_speed_named_gives_the_same_bytes() {
    let folder = swept(STUDY);
    let file = "results/study/study.h5";
    for more in [
        &["--json"][..],
        &["--csv", "--budget", "300 mW"],
        &["--speed", "5 mm/s", "--of", "work_net", "--top", "3"],
    ] {
        let asked = [&["tradeoff", file][..], more].concat();
        let named = [&asked[..], &["--for", "progression_speed"]].concat();
        assert_eq!(folder.run(&asked).done().out, folder.run(&named).done().out);
    }
    let figure = ["figure", file, "--kind", "trade-off", "--formats", "svg"];
    let [short, long] = ["power", "power,progression_speed"].map(|of| {
        folder.run(&[&figure[..], &["--of", of, "--name", "a"]].concat()).done();
        fs::read(folder.path("results/study/a.svg")).expect("a figure")
    });
    assert!(short == long, "other bytes");
}

/// The searches for another gain of the capsule are kept beside those for the speed, and neither is taken for the other.
#[test]
fn searches_for_another_gain_are_kept_apart() {
    let folder = swept(STUDY);
    let of_speed = folder.run(&REFINE).done().out;
    let kept = lines(&folder);
    assert!(kept.iter().all(|line| !line.contains("\"for\":")));
    let figure = ["figure", "results/study/study.h5", "--kind", "trade-off", "--formats", "svg"];
    let drawn = || {
        folder.run(&[&figure[..], &["--of", "power", "--name", "b"]].concat()).done();
        fs::read(folder.path("results/study/b.svg")).expect("a figure")
    };
    let before = drawn();
    let other = [&REFINE[..], &["--for", "damper_loss", "--of", "power"]].concat();
    let answer = folder.run(&other).json();
    assert_eq!(answer["for"], "damper_loss");
    let all = lines(&folder);
    assert!(kept.is_subset(&all) && all.len() > kept.len(), "{} {}", kept.len(), all.len());
    let new = all.difference(&kept);
    for line in new.clone() {
        assert!(line.contains("\"for\":\"damper_loss\""), "{line}");
        // A loss per power is no output, which a search could make small.
        assert!(!line.contains("\"least\":"), "{line}");
    }
    assert!(answer["refined"]["found"].as_u64() > Some(0), "{answer}");
    // What was found is as good as the cases or better.
    let alone = ["tradeoff", "results/study/study.h5", "--json", "--for", "damper_loss"];
    let alone = folder.run(&alone).json();
    let most = |answer: &Value| number(&answer["most_gain"], "damper_loss");
    assert!(most(&answer) >= most(&alone), "{} {}", most(&answer), most(&alone));
    assert_eq!(folder.run(&REFINE).done().out, of_speed);
    assert!(lines(&folder) == all, "a search is repeated");
    assert!(drawn() == before, "the figure of the speed shows motions for another gain");
    // A report names how each was sought.
    folder.run(&["report", "results/study/study.h5"]).done();
    let page = fs::read_to_string(folder.path("results/study/study.html")).expect("a report");
    assert!(page.contains("--direction either --of power --for damper_loss --refine"), "{page}");
    assert!(page.contains("--direction either --of power --refine"), "{page}");
    assert!(folder.path(SEARCHES).exists());
    // What has no derivatives is refused as a gain, too.
    let rough = [&REFINE[..], &["--for", "impacts_per_cycle"]].concat();
    folder.run(&rough).refused(&["`impacts_per_cycle` has no derivatives in the parameters"]);
}
