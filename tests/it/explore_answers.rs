//! What the page of `capsulemap explore` is told, against what other commands and the library say of the same.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Stdio;
use std::thread;
use std::time::Duration;

use capsulemap::store::{self, Dataset};
use serde_json::Value;

use super::explorer::{Explorer, coarse_overview};
use super::program::{TWO_MOTIONS, WorkDir};

/// The file of results of a coarse map.
fn swept() -> WorkDir {
    let work = WorkDir::new();
    work.put("map.toml", coarse_overview([5, 15]));
    work.run(&["sweep", "map.toml", "--output", "map.h5", "--no-figures"]).done();
    work
}

fn results(work: &WorkDir, file: &str) -> Dataset {
    store::read(&work.path(file)).expect("results")
}

fn reals(dataset: &Dataset, name: &str) -> Vec<f64> {
    let values = dataset.variable(name).or_else(|| dataset.coordinate(name));
    values.unwrap_or_else(|| panic!("{name}")).values.to_real().into_iter().collect()
}

fn numbers(list: &Value) -> Vec<f64> {
    let number = |it: &Value| it.as_f64().unwrap_or(f64::NAN);
    list.as_array().expect("a list").iter().map(number).collect()
}

/// What `simulate --json` prints of a command that the page was given.
fn simulated(work: &WorkDir, command: &Value) -> Value {
    let command = command.as_str().expect("a command");
    let arguments = command.strip_prefix("capsulemap").expect("a command of the program");
    work.shell(&format!("\"$0\" {arguments} --json")).json()
}

#[test]
fn a_click_gives_the_numbers_of_simulate() {
    let work = swept();
    let explorer = Explorer::new(&work, &["map.h5"]);
    let file = results(&work, "map.h5");
    let (forces, speeds) = (reals(&file, "p_d"), reals(&file, "progression_speed"));
    let frequencies = reals(&file, "omega");
    let columns = frequencies.len();
    for (row, column) in [(0, 0), (2, 7), (4, 14), (3, 3)] {
        let (p_d, omega) = (forces[row], frequencies[column]);
        let told = explorer.object(&format!("/api/motion?p_d={p_d:?}&omega={omega:?}&cycles=3"));
        assert_eq!(told["simulate"], simulated(&work, &told["command"]), "{row} {column}");
        assert!(told["exact"].as_bool().expect("a truth"));
        assert_eq!(told["nearest"].as_u64(), Some((row * columns + column) as u64));
        // The motion is that of the file, whose case has settled from another start.
        let speed = told["simulate"]["orbit"]["progression_speed"].as_f64().expect("a speed");
        let kept = speeds[row * columns + column];
        let says_so = told["remarks"].to_string().contains("both are means over some cycles");
        match told["simulate"]["orbit"]["outcome"] == "periodic" {
            true => assert!((speed - kept).abs() <= 1e-9 * kept.abs().max(1e-3), "{speed} {kept}"),
            false => assert!(says_so, "{told}"),
        }
        // The last point of the history is a multiple of the drive period after the first, and advances as the speed says.
        let history = &told["history"];
        let (t, x2) = (numbers(&history["t"]), numbers(&history["signals"]["history_x2"]));
        let cycles = history["cycles"].as_f64().expect("a number");
        let length = cycles * history["period"].as_f64().expect("a period");
        assert!((t[t.len() - 1] - length).abs() < 1e-9 * length);
        if told["simulate"]["orbit"]["outcome"] == "periodic" {
            let advance = x2[x2.len() - 1] - x2[0];
            assert!((advance - speed * length).abs() < 1e-6 * advance.abs() + 1e-8, "{advance}");
            // Contacts are short, and drawn up to their peaks.
            let contact = numbers(&history["signals"]["history_contact"]);
            let drawn = contact.into_iter().fold(0.0, f64::max);
            let peak = told["simulate"]["orbit"]["peak_contact_force"].as_f64().expect("a force");
            assert!((drawn - peak).abs() <= 2e-3 * peak, "{drawn} of {peak}");
        }
        assert!(t.windows(2).all(|it| it[1] - it[0] > -1e-12 * length), "{t:?}");
    }
    let between = explorer.object("/api/motion?p_d=3.3&omega=61.7&cycles=0");
    assert!(!between["exact"].as_bool().expect("a truth"));
    assert_eq!(between["simulate"], simulated(&work, &between["command"]));
}

#[test]
fn a_map_has_the_numbers_of_the_file() {
    let work = swept();
    let explorer = Explorer::new(&work, &["map.h5"]);
    let file = results(&work, "map.h5");
    let speeds = reals(&file, "progression_speed");
    let (rows, columns) = (5, 15);
    for (x, y) in [("omega", "p_d"), ("p_d", "omega")] {
        let map = explorer.packed(&format!("/api/map?of=progression_speed&x={x}&y={y}"));
        assert_eq!(map.head["told"], "Progression speed (mm/s)");
        let shown = map.numbers(4 * rows * columns, rows * columns);
        for (case, speed) in speeds.iter().enumerate() {
            let (row, column) = (case / columns, case % columns);
            let cell = if x == "omega" { case } else { column * rows + row };
            assert_eq!(shown[cell], (speed * 1e3) as f32, "{x} over {y}: case {case}");
        }
    }
    // The cells have the values of the file in the trade-off, too; its fronts are those of the definition.
    let cells = explorer.packed("/api/trade-off?of=power&x=omega&y=p_d");
    let (prices, speeds) = (cells.numbers(0, 75), cells.numbers(300, 75));
    let powers = reals(&file, "power");
    let taking_part = prices.iter().filter(|it| it.is_finite()).count();
    let left_out: u64 = cells.head["left_out"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|it| it[1].as_u64().expect("a count"))
        .sum();
    assert_eq!(taking_part as u64 + left_out, 75);
    for case in (0..75).filter(|case| prices[*case].is_finite()) {
        assert_eq!(prices[case], (powers[case] * 1e3) as f32);
    }
    for (direction, sign) in [("forward", 1.0), ("backward", -1.0)] {
        let front: BTreeSet<usize> =
            numbers(&cells.head["fronts"][direction]).iter().map(|it| *it as usize).collect();
        assert!(front.len() > 2, "{direction}");
        let beats = |a: usize, b: usize| {
            let [fast, faster] = [sign * speeds[b], sign * speeds[a]];
            faster >= fast && prices[a] <= prices[b] && (faster > fast || prices[a] < prices[b])
        };
        for case in (0..75).filter(|it| sign * speeds[*it] > 1e-3) {
            let is_beaten = (0..75).any(|other| beats(other, case));
            assert_eq!(front.contains(&case), !is_beaten, "{direction}: case {case}");
        }
    }
}

#[test]
fn a_line_is_that_of_its_study() {
    let work = swept();
    let explorer = Explorer::new(&work, &["map.h5"]);
    for start in ["inherit", "afresh"] {
        let lines =
            explorer.lines(&format!("/api/line?p_d=3&omega=45&to_omega=70&count=12&start={start}"));
        let name = format!("line-{start}");
        work.put(&format!("{name}.toml"), lines[0]["study"].as_str().expect("a study"));
        let file = format!("{name}.h5");
        let study = format!("{name}.toml");
        work.run(&["sweep", &study, "--output", &file, "--no-figures"]).done();
        let kept = results(&work, &file);
        let speeds: Vec<f64> = lines[1..]
            .iter()
            .map(|it| it["progression_speed"].as_f64().expect("a speed"))
            .collect();
        assert_eq!(speeds, reals(&kept, "progression_speed"), "{start}");
    }
    // From where a value settled the motion goes on as it did there, and repeats itself.
    let lines = explorer.lines("/api/line?p_d=3&omega=45&to_omega=55&count=6");
    for point in lines[1..].iter().filter(|it| it["outcome"] == "periodic") {
        let [r, y1, y2] = [0, 1, 2].map(|i| point["end"][i].as_f64().expect("a state"));
        let omega = 45.0 + 10.0 * point["share"].as_f64().expect("a share");
        let start = format!("start_r={r:?}&start_y1={y1:?}&start_y2={y2:?}&start_phase=0");
        let told = explorer.object(&format!("/api/motion?p_d=3&omega={omega:?}&{start}"));
        let speed = |it: &Value| it["progression_speed"].as_f64().expect("a speed");
        let [there, here] = [speed(point), speed(&told["simulate"]["orbit"])];
        assert!((there - here).abs() <= 1e-9 * there.abs().max(1e-3), "{omega}: {there} {here}");
    }
    // A line across the map is a study of a path.
    let across =
        explorer.lines("/api/line?p_d=3&to_p_d=4&omega=45&to_omega=70&count=4&start=afresh");
    assert_eq!(across.len(), 5);
    work.put("across.toml", across[0]["study"].as_str().expect("a study"));
    work.run(&["sweep", "across.toml", "--output", "across.h5", "--no-figures"]).done();
    let speeds: Vec<f64> =
        across[1..].iter().map(|it| it["progression_speed"].as_f64().expect("a speed")).collect();
    assert_eq!(speeds, reals(&results(&work, "across.h5"), "progression_speed"));
}

/// A capsule with two motions at 155 rad/s.
pub(super) const TWO: &str = "[[axes]]\nname = \"omega\"\nvalues = [\"155 rad/s\", \"156 rad/s\"]\n\
     [[axes]]\nname = \"p_d\"\nvalues = [\"2.79 N\", \"2.8 N\"]\n[start]\ninherit = \"omega\"\n";

#[test]
fn a_basin_is_that_of_its_study_and_each_start_leads_where_it_says() {
    let work = WorkDir::new();
    work.put("two.toml", TWO_MOTIONS.replace("p_d = \"2.79 N\"\n", "") + TWO);
    work.run(&["sweep", "two.toml", "--output", "two.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["two.h5"]);
    let passes = explorer.lines("/api/basin?p_d=2.79&omega=155");
    work.put("basin.toml", passes[0]["study"].as_str().expect("a study"));
    work.run(&["sweep", "basin.toml", "--output", "basin.h5", "--no-figures"]).done();
    let kept = reals(&results(&work, "basin.h5"), "attractor");
    let side = passes[0]["side"].as_u64().expect("a number") as usize;
    let shown: Vec<&Value> = passes.iter().filter(|it| it.get("labels").is_some()).collect();
    assert_eq!(shown.len(), 5);
    for pass in shown {
        let step = pass["step"].as_u64().expect("a number") as usize;
        let labels = numbers(&pass["labels"]);
        let coarse = (side - 1) / step + 1;
        assert_eq!(labels.len(), coarse * coarse);
        // Attractors are numbered in the order in which they appear, which a coarse grid sees in another.
        let mut pairs = BTreeMap::new();
        for (place, label) in labels.iter().enumerate() {
            let case = place / coarse * step * side + place % coarse * step;
            let same = pairs.entry(*label as i64).or_insert(kept[case]);
            assert_eq!(*same, kept[case], "step {step}, start {case}");
        }
        if step == 1 {
            assert_eq!(labels, kept);
        }
    }
    // A click on a start shows the motion that it leads to, not that of the nearest case.
    let last = passes.last().expect("a pass");
    let attractors = last["attractors"].as_array().expect("a list");
    assert_eq!(attractors.len(), 2, "{last}");
    let study = results(&work, "basin.h5");
    let (r, y1) = (reals(&study, "start_r"), reals(&study, "start_y1"));
    for (label, attractor) in attractors.iter().enumerate() {
        let start = kept.iter().position(|it| *it == label as f64).expect("a start");
        let (r, y1) = (r[start % side], y1[start / side]);
        let asked = format!("/api/motion?p_d=2.79&omega=155&start_r={r:?}&start_y1={y1:?}");
        let told = explorer.object(&asked);
        let speed = |it: &Value| it.as_f64().expect("a speed");
        let shown = speed(&told["simulate"]["orbit"]["progression_speed"]);
        assert!((shown - speed(&attractor["progression_speed"])).abs() < 1e-9, "{asked}: {shown}");
    }
}

#[test]
fn figures_are_those_of_the_command_line() {
    let work = swept();
    let explorer = Explorer::new(&work, &["map.h5"]);
    let asked = explorer.get("/api/figure?kind=map&of=period&x=omega&y=p_d&format=svg");
    assert_eq!((asked.status, asked.header("content-type")), (200, Some("image/svg+xml")));
    let drawn =
        ["figure", "map.h5", "--kind", "map", "--of", "period", "--x", "omega", "--y", "p_d"];
    work.run(&[&drawn[..], &["--formats", "svg"]].concat()).done();
    let files = work.files();
    let svg = files.iter().find(|it| it.ends_with(".svg")).expect("a figure");
    let drawn = fs::read_to_string(work.path(svg)).expect("a figure");
    assert!(asked.text() == drawn, "{svg} differs");
    for kind in [
        "trade-off&of=power&x=omega&y=p_d",
        "history&p_d=3&omega=60",
        "phase-portrait&p_d=3&omega=60",
        "bifurcation&p_d=3&omega=45&to_omega=50&count=6",
        // An oblique line is a path.
        "bifurcation&p_d=3&to_p_d=4&omega=45&to_omega=50&count=6",
    ] {
        let asked = explorer.get(&format!("/api/figure?format=pdf&kind={kind}"));
        assert_eq!(asked.status, 200, "{kind}: {}", asked.text());
        assert!(asked.body.starts_with(b"%PDF"), "{kind}");
    }
}

#[test]
fn curves_and_branches_lie_over_a_map_where_they_were_found() {
    let work = WorkDir::new();
    work.put("regions.toml", REGIONS);
    work.run(&["sweep", "regions.toml", "--output", "r.h5", "--no-figures"]).done();
    work.run(&["continue", "regions.toml", "--output", "r.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["r.h5"]);
    let over = explorer.object("/api/curves?x=omega&y=p_d");
    let file = results(&work, "r.h5");
    let lines = over["lines"].as_array().expect("a list");
    let (curves, branches): (Vec<_>, Vec<_>) = lines.iter().partition(|it| !it["colour"].is_null());
    assert!(!curves.is_empty() && !branches.is_empty(), "{over}");
    let of = |all: &[&Value], axis: usize| -> Vec<f64> {
        let points = all.iter().flat_map(|it| it["points"].as_array().expect("points"));
        points.map(|it| it[axis].as_f64().expect("a number")).collect()
    };
    let sorted = |mut all: Vec<f64>| {
        all.sort_by(f64::total_cmp);
        all
    };
    for (axis, name) in [(0, "omega"), (1, "p_d")] {
        let kept = reals(&file, &format!("curve_{name}"));
        assert_eq!(sorted(of(&curves, axis)), sorted(kept), "{name}");
    }
    assert_eq!(sorted(of(&branches, 0)), sorted(reals(&file, "branch_omega")));
    // What a branch does not vary has one value.
    assert!(of(&branches, 1).iter().all(|it| *it == 2.79));
    let specials = over["points"].as_array().expect("a list");
    let [of_branches, of_curves] =
        ["special_omega", "codim2_omega"].map(|it| reals(&file, it).len());
    assert_eq!(specials.len(), of_branches + of_curves);
}

/// The capsule of `studies/regions.toml` over a coarse grid, with the curve of one of its folds.
const REGIONS: &str = r#"
[parameters]
m2 = "0.2 kg"
c = "1.77 N s/m"
mu_s = 0.33
mu_d = 0.165
k2 = "65.518 kN/m"
delta = "4.33 mm"
[[axes]]
name = "p_d"
from = "2.7 N"
to = "2.9 N"
points = 3
[[axes]]
name = "omega"
from = "115 rad/s"
to = "135 rad/s"
points = 5
[[branches]]
name = "b"
along = "omega"
at = { omega = "120 rad/s", p_d = "2.79 N" }
start = { y1 = "0.3 m/s" }
from = "115 rad/s"
to = "135 rad/s"
second = { name = "p_d", from = "2.7 N", to = "2.9 N" }
"#;

#[test]
fn an_unfinished_run_is_shown_and_grows() {
    let work = WorkDir::new();
    // Some thousand cases in blocks of 512, of which one task computes a half.
    let many = coarse_overview([40, 60]);
    work.put("many.toml", many.replace("inherit = \"omega\"", "r = \"0 mm\""));
    work.run(&["explore", "many.toml", "--no-browser"])
        .refused(&["nothing is computed yet", "capsulemap sweep many.toml"]);
    work.run(&["sweep", "many.toml", "--task", "1/2", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["many.toml"]);
    let before = explorer.object("/api/progress");
    let done = before["done"].as_u64().expect("a count");
    assert!(done > 0 && done < 2400 && before["cases"] == 2400, "{before}");
    let known = |explorer: &Explorer| {
        let map = explorer.packed("/api/map?of=progression_speed&x=omega&y=p_d");
        map.numbers(4 * 2400, 2400).iter().filter(|it| it.is_finite()).count() as u64
    };
    assert!(known(&explorer) <= done && known(&explorer) > done / 2);
    let mut sweep = work.command(&["sweep", "many.toml", "--no-figures"]);
    let mut sweep = sweep.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("starts");
    assert!(sweep.wait().expect("ends").success());
    let is_whole = || explorer.object("/api/progress").is_null();
    for _ in 0..100 {
        if is_whole() {
            break;
        }
        thread::sleep(Duration::from_millis(200));
    }
    assert!(is_whole(), "the whole is not shown");
    assert!(explorer.object("/api/file")["running"].is_null());
    assert!(known(&explorer) > 2300);
}

#[test]
fn wrong_inputs_are_named() {
    let work = swept();
    work.run(&["explore", "none.h5"]).refused(&["none.h5"]);
    work.put("other.toml", coarse_overview([2, 3]));
    let other = work.run(&["explore", "other.toml", "--output", "map.h5"]);
    other.refused(&["map.h5", "name another --output"]);
    assert!(!other.err.contains("--overwrite"), "{}", other.err);
    work.run(&["explore", "map.h5", "--output", "x.h5"])
        .refused(&["--output", "goes with a study"]);
    let explorer = Explorer::new(&work, &["map.h5"]);
    let port = explorer.port.to_string();
    work.run(&["explore", "map.h5", "--no-browser", "--port", &port])
        .refused(&[&format!("--port {port}"), "cannot be listened on"]);
    for (address, part) in [
        ("/api/motion?omega=-1&p_d=3", "omega"),
        ("/api/motion?omega=fast", "omega: a finite number is expected"),
        ("/api/motion?omega=60&omega=70", "omega is given twice"),
        ("/api/motion?speed=3", "is not known"),
        ("/api/motion?omega=60&cycles=1e9", "cycles: a whole number from 0 to 400"),
        ("/api/motion?omega=60&sweep=sideways", "sweep"),
        ("/api/line?omega=60&to_omega=60&p_d=3", "two ends that differ"),
        ("/api/line?omega=60&to_k2=60", "k2: a line needs both of its ends"),
        ("/api/line?omega=60&to_omega=70&count=1000000", "count: a whole number from 2 to 2000"),
        ("/api/line?omega=60&to_omega=-70", "omega"),
        ("/api/basin?omega=60&p_d=3&start_r_from=1&start_r_to=0", "start_r_from must be less"),
        ("/api/map?of=nothing&x=omega&y=p_d", "nothing"),
        ("/api/map?of=progression_speed&x=omega&y=omega", "omega"),
        ("/api/map?of=progression_speed&x=omega&y=p_d&k2=86801", "k2: is no axis"),
        ("/api/figure?kind=map&of=period&format=exe", "format: pdf, svg or png"),
        ("/api/figure?kind=house&format=pdf", "kind: map"),
    ] {
        let refused = explorer.get(address);
        assert_eq!(refused.status, 400, "{address}: {}", refused.text());
        assert!(refused.text().contains(part), "{address}: {}", refused.text());
    }
}
