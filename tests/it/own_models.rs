//! The program with models that it does not have: an oscillator at a wall and a mass on a belt, registered in `examples/own_models.rs`, are
//! simulated, swept, continued, drawn and explored by the same commands as the capsule.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fs;

use serde_json::Value;

use super::explorer::Explorer;
use super::program::WorkDir;

/// A folder to run the program with these models in.
fn work() -> WorkDir {
    let tests = std::env::current_exe().expect("the path of this program");
    let built = tests.ancestors().nth(2).expect("the folder of what is built");
    let program = built.join("examples").join("own_models");
    assert!(program.exists(), "cargo build --release --example own_models");
    WorkDir::of(program)
}

/// The mass at the wall, which it meets at the first value and not at the second.
const TWO_WALLS: &str = r#"model = "impact-oscillator"
[parameters]
f = "1"
w = "1.5"
[start]
x = "-0.79"
v = "0.14"
[[axes]]
name = "wall"
values = ["0.5", "1.2"]
[history]
cycles = 3
samples_per_cycle = 200
[protocol]
points = 4
"#;

/// Walls and frequencies.
const PLANE: &str = r#"model = "impact-oscillator"
[[axes]]
name = "wall"
from = "0.4"
to = "1.4"
points = 6
[[axes]]
name = "w"
from = "1.3"
to = "1.7"
points = 5
"#;

/// Starts of the mass on the belt, and the cycle in which it sticks and slips, followed in the velocity of the belt.
const BELT: &str = r#"model = "belt"
[[axes]]
name = "start_x"
from = "-2"
to = "2"
points = 24
[[axes]]
name = "start_u"
from = "0"
to = "2"
points = 24
[protocol]
points = 4
[[branches]]
name = "of the cycle"
along = "v"
from = "1"
to = "2.5"
start = { x = "2" }
"#;

/// Velocities of the belt and Stribeck velocities.
const BELTS: &str = r#"model = "belt"
[start]
x = "2"
[[axes]]
name = "v"
from = "1"
to = "1.6"
points = 4
[[axes]]
name = "s"
values = ["0.5", "0.6"]
"#;

/// Where the mass is at the phase `phase` if it never meets the wall, how fast, and the force.
fn without_wall(c: f64, f: f64, w: f64, phase: f64) -> [f64; 3] {
    let size = (1.0 - w * w).powi(2) + (c * w).powi(2);
    let (cos, sin) = (phase.cos(), phase.sin());
    let [a, b] = [f * (1.0 - w * w) / size, f * c * w / size];
    [a * cos + b * sin, w * (b * cos - a * sin), f * cos]
}

/// The numbers of each series of each panel in the data of a figure.
fn series(csv: &str) -> BTreeMap<String, Vec<[f64; 2]>> {
    let mut found = BTreeMap::<String, Vec<[f64; 2]>>::new();
    for line in csv.lines().filter(|it| it.starts_with(|first: char| first.is_ascii_digit())) {
        // The name of a series of lines has a comma of its own.
        let fields: Vec<&str> = line.rsplit(',').collect();
        let point = [2, 1].map(|at| fields[at].parse().expect("a number"));
        let [.., name, _] = &fields[..] else { panic!("{line}") };
        found.entry(name.trim_matches('"').to_owned()).or_default().push(point);
    }
    found
}

/// The data of the figure of a kind of the file `a.h5` with these options.
fn data(work: &WorkDir, kind: &str, options: &[&str]) -> BTreeMap<String, Vec<[f64; 2]>> {
    let figure = ["figure", "a.h5", "--kind", kind, "--data", "--formats", "svg"];
    work.run(&[&figure[..], options].concat()).done();
    let files = work.files();
    let csv = files.iter().find(|it| it.contains(kind) && it.ends_with(".csv")).expect("data");
    series(&fs::read_to_string(work.path(csv)).expect("a file"))
}

fn numbers(list: &Value) -> Vec<f64> {
    let number = |it: &Value| it.as_f64().unwrap_or(f64::NAN);
    list.as_array().expect("a list").iter().map(number).collect()
}

#[test]
fn one_case_is_simulated_with_its_events() {
    let work = work();
    let model = ["simulate", "--model", "belt"];
    let told = work.run(&[&model[..], &["--start", "x=2", "--cycles", "4", "--json"]].concat());
    let told = told.json();
    assert_eq!(
        (&told["orbit"]["outcome"], &told["orbit"]["period"]),
        (&"periodic".into(), &1.into())
    );
    assert_eq!(told["model"], "belt");
    let events = told["events"].as_array().expect("events");
    let number = |event: &Value, key: &str| event[key].as_f64().expect(key);
    let mut rests = 0;
    for pair in events.windows(2).filter(|it| it[0]["kind"] == "stick") {
        let [stick, slip] = [&pair[0], &pair[1]];
        assert_eq!(slip["kind"], "slip");
        // It goes with the belt, until the spring and the damper pull as strongly as friction can: x + c v = 2 a.
        let moved = number(slip, "x") - number(stick, "x");
        let time = number(slip, "t") - number(stick, "t");
        assert!((moved - 1.5 * time).abs() < 1e-9, "{moved} {time}");
        assert!((number(slip, "x") - (1.0 - 0.1 * 1.5)).abs() < 1e-9);
        assert!((number(stick, "u") - 1.5).abs() < 1e-9 && number(slip, "u") == 1.5);
        rests += 1;
    }
    assert!(rests >= 3, "{told}");
    let printed = work.run(&[&model[..], &["--cycles", "1"]].concat()).done().out;
    assert!(printed.contains("duration") && !printed.contains("impacts"), "{printed}");
    let refused = [&model[..], &["--set", "k2=1", "--start", "r=1", "--phase", "90 deg"]].concat();
    work.run(&refused).refused(&[
        "--set: unknown parameter \"k2\"",
        "--start: unknown coordinate \"r\"",
        "--phase: the model belt has no drive",
    ]);
    let unknown = work.run(&["simulate", "--model", "belts"]);
    unknown.refused(&["--model: unknown model \"belts\"", "did you mean \"belt\"?"]);
    work.run(&["simulate", "--model", "belt", "--omega", "3 rad/s"]).refused(&["--omega"]);
}

#[test]
fn histories_portraits_sections_and_spectra_are_those_of_its_motion() {
    let work = work();
    work.put("a.toml", TWO_WALLS);
    work.run(&["sweep", "a.toml", "--output", "a.h5", "--no-figures"]).done();
    let (c, f, w) = (0.1, 1.0, 1.5);
    // Without an impact the histories are those of the closed form.
    let free = ["--at", "wall=1.2", "--of", "history_x,history_v,history_force,history_spring"];
    let drawn = data(&work, "history", &free);
    assert!(drawn["history_x"].len() > 600);
    for (at, [time, x]) in drawn["history_x"].iter().enumerate() {
        let exact = without_wall(c, f, w, w * time);
        let found = ["history_x", "history_v", "history_force"].map(|name| drawn[name][at][1]);
        let apart = found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{time}: {found:?} {exact:?}");
        assert_eq!(drawn["history_spring"][at][1], -x);
    }
    // With impacts it never passes the wall, and is thrown back there.
    let drawn = data(&work, "phase-portrait", &["--at", "wall=0.5"]);
    let motion = &drawn["motion"];
    let reached = motion.iter().map(|it| it[0]).fold(f64::NEG_INFINITY, f64::max);
    assert!((reached - 0.5).abs() < 1e-9, "{reached}");
    let thrown =
        motion.windows(2).filter(|it| it[0][1] > 0.1 && it[1][1] < 0.0 && it[0][0] > 0.499);
    let mut impacts = 0;
    for pair in thrown {
        assert!((pair[1][1] + 0.7 * pair[0][1]).abs() < 1e-9, "{pair:?}");
        impacts += 1;
    }
    assert!(impacts >= 1, "{motion:?}");
    assert_eq!(drawn["stroboscopic"].len(), 1);
    // A sinusoid has one line, at the frequency of the force.
    let options = ["--at", "wall=1.2", "--of", "history_x"];
    let lines = &data(&work, "spectrum", &options)["history_x"];
    let largest = lines.iter().copied().reduce(|a, b| if a[1] > b[1] { a } else { b });
    let [frequency, amplitude] = largest.expect("a line");
    let exact = f / f64::hypot(1.0 - w * w, c * w);
    assert!((frequency - w / TAU).abs() < 1e-9 && (amplitude - exact).abs() < 1e-9, "{lines:?}");
    data(&work, "section", &["--at", "wall=0.5"]);
    // Recordings are those of the capsule.
    let rows: Vec<String> = (0..20).map(|it| format!("{},{it}\n", 0.1 * f64::from(it))).collect();
    work.put("r.csv", format!("t [s],x2 [mm]\n{}", rows.concat()));
    for command in [&["compare", "r.csv", "a.toml"][..], &["synthesize", "a.toml", "--output", "r"]]
    {
        work.run(command).refused(&["the model impact-oscillator", "the capsule alone"]);
    }
    let said = ["figure", "a.h5", "--kind", "history", "--of", "history_r"];
    work.run(&said).refused(&["history_r", "history_x, history_v, history_force, history_spring"]);
}

#[test]
fn without_a_drive_basins_and_branches_are_drawn_and_histories_refused() {
    let work = work();
    work.put("a.toml", BELT);
    work.run(&["sweep", "a.toml", "--output", "a.h5", "--no-figures"]).done();
    work.run(&["continue", "a.toml", "--output", "a.h5", "--no-figures"]).done();
    let inspected = work.run(&["inspect", "a.h5"]).done().out;
    assert!(inspected.contains("model: belt"), "{inspected}");
    assert!(!inspected.contains("phase") && !inspected.contains("impact"), "{inspected}");
    // The stable cycle turns into the unstable one, which ends where steady sliding is no longer stable.
    let drawn = data(&work, "bifurcation", &["--x", "v", "--of", "section_x"]);
    let of = |wanted: &str| -> Vec<[f64; 2]> {
        let lines = drawn.iter().filter(|it| it.0.starts_with(wanted));
        lines.flat_map(|it| it.1).copied().collect()
    };
    let [stable, unstable] = ["stable orbits", "unstable orbits"].map(of);
    let least = |all: &[[f64; 2]]| all.iter().map(|it| it[0]).fold(f64::INFINITY, f64::min);
    let exact = 0.5 * f64::ln(0.5 / (0.1 * 0.5));
    assert_eq!(least(&stable), 1.0);
    assert!((least(&unstable) - exact).abs() < 1e-7, "{} {exact}", least(&unstable));
    // Starts at rest within the unstable cycle slide on steadily, and those beyond it come to stick.
    let edge =
        unstable.iter().copied().min_by(|a, b| (a[0] - 1.5).abs().total_cmp(&(b[0] - 1.5).abs()));
    let [_, edge] = edge.expect("an orbit");
    let starts = data(&work, "basin", &[]);
    let cells = fs::read_to_string(work.path("basin.csv")).expect("data");
    let at_rest = starts["attractor"].iter().filter(|it| it[1] == 0.0 && it[0] > 0.5);
    let mut sides = [0, 0];
    for [x, _] in at_rest {
        let sticks = cells.contains(&format!("\n1,attractor,{x},0,0\n"));
        assert_eq!(sticks, *x > edge, "{x} {edge}");
        sides[usize::from(sticks)] += 1;
    }
    assert!(sides[0] > 5 && sides[1] > 0, "{sides:?}");
    let section = ["figure", "a.h5", "--kind", "section"];
    work.run(&section).refused(&["section points of one coordinate have no plane"]);
    work.put("b.toml", BELT.replace("\"belt\"", "\"belts\""));
    let refused = work.run(&["sweep", "b.toml", "--output", "b.h5"]);
    refused.refused(&["b.toml: 1 fault", "unknown model \"belts\"; did you mean \"belt\"?"]);
    work.put("b.toml", format!("{BELT}[history]\ncycles = 2\n"));
    let refused = work.run(&["sweep", "b.toml", "--output", "b.h5"]);
    refused.refused(&["history", "the model belt", "none of a drive"]);
}

/// What `simulate --json` prints of a command that the page was given.
fn simulated(work: &WorkDir, told: &Value) -> Value {
    let command = told["command"].as_str().expect("a command");
    let arguments = command.strip_prefix("capsulemap").expect("a command of the program");
    work.shell(&format!("\"$0\" {arguments} --json")).json()
}

#[test]
fn the_page_shows_what_the_model_says_of_itself() {
    let work = work();
    work.put("plane.toml", PLANE);
    work.run(&["sweep", "plane.toml", "--output", "plane.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["plane.h5"]);
    let model = &explorer.object("/api/file")["model"];
    let names = |list: &Value| -> Vec<String> {
        let list = list.as_array().expect("a list").iter();
        list.map(|it| it["name"].as_str().expect("a name").to_owned()).collect()
    };
    assert_eq!(names(&model["starts"]), ["start_x", "start_v", "start_phase"]);
    assert_eq!(names(&model["portrait"]), ["history_x", "history_v"]);
    assert!(names(&model["costs"]).is_empty(), "{model}");
    let refused = explorer.get("/api/trade-off");
    assert!(refused.status == 400 && refused.text().contains("gain nothing"), "{}", refused.text());
    let told = explorer.object("/api/motion?wall=1.4&w=1.7&cycles=3&start_x=-0.53&start_v=0.05");
    assert_eq!(told["simulate"], simulated(&work, &told));
    let history = &told["history"];
    let signals = &history["signals"];
    let [x, v] = ["history_x", "history_v"].map(|name| numbers(&signals[name]));
    let mut free = 0;
    for (at, time) in numbers(&history["t"]).into_iter().enumerate() {
        let exact = without_wall(0.1, 1.0, 1.7, 1.7 * time);
        // The page has the digits of a screen.
        free += usize::from((x[at] - exact[0]).abs().max((v[at] - exact[1]).abs()) < 1e-6);
    }
    assert_eq!(free, x.len());
    let passes = explorer.lines("/api/basin?wall=0.5&w=1.5");
    let attractors = &passes.last().expect("a pass")["attractors"];
    assert!(!attractors.as_array().expect("a list").is_empty(), "{attractors}");
    let line = explorer.lines("/api/line?wall=0.4&w=1.5&to_wall=1.4&to_w=1.5&count=20");
    let values: Vec<&Value> = line.iter().filter(|it| it.get("section_x").is_some()).collect();
    assert_eq!(values.len(), 20, "{line:?}");
    for kind in ["history", "phase-portrait"] {
        let figure = explorer.get(&format!("/api/figure?format=svg&kind={kind}&wall=1&w=1.5"));
        assert_eq!(figure.status, 200, "{}", figure.text());
    }
}

#[test]
fn the_page_shows_motions_without_a_drive() {
    let work = work();
    work.put("belts.toml", BELTS);
    work.run(&["sweep", "belts.toml", "--output", "belts.h5", "--no-figures"]).done();
    let explorer = Explorer::new(&work, &["belts.h5"]);
    let told = explorer.object("/api/motion?v=1&s=0.5&cycles=3");
    assert_eq!(told["simulate"], simulated(&work, &told));
    let history = &told["history"];
    let signals = &history["signals"];
    let [x, u, friction] =
        ["history_x", "history_v", "history_friction"].map(|name| numbers(&signals[name]));
    // The motion closes after each of its cycles, and friction is never above what holds the mass at rest.
    let size = x.iter().fold(0.0, |most: f64, it| most.max(it.abs()));
    assert!((x[0] - x[x.len() - 1]).abs() < 1e-6 * size, "{} {}", x[0], x[x.len() - 1]);
    assert!(friction.iter().all(|it| it.abs() <= 1.0 + 1e-6));
    let stuck = u.iter().zip(&friction).zip(&x).filter(|((u, _), _)| **u == 1.0);
    let mut held = 0;
    for ((_, friction), x) in stuck {
        assert!((friction - x - 0.1).abs() < 1e-6 || friction.abs() > 0.999, "{friction} {x}");
        held += 1;
    }
    assert!(held > 10, "{held}");
    let passes = explorer.lines("/api/basin?v=1.5&s=0.5");
    let last = passes.last().expect("a pass");
    assert!(!last["attractors"].as_array().expect("a list").is_empty(), "{last}");
    let refused = explorer.get("/api/figure?format=svg&kind=history&v=1&s=0.5");
    assert_eq!(refused.status, 400);
    assert!(refused.text().contains("without a drive"), "{}", refused.text());
}
