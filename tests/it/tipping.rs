//! Where motions go when a parameter steps: against direct simulation by another integrator, and against labels counted anew.

use std::f64::consts::TAU;

use capsulemap::store;
use serde_json::Value;

use super::program::{TWO_MOTIONS, WorkDir};

/// The oscillator of the test by itself; at p = 0.1 an orbit in each well and a large one on each side, at 0.15 and 0.2 those in the wells.
const DUFFING: &str = r#"[system]
name = "Duffing oscillator with two wells"
states = { x = "1", v = "1" }
section = { every = "2*pi" }

[system.parameters]
c = 0.15
p = 0.1

[system.rates]
x = "v"
v = "p*cos(t) - c*v + x - x^3"
"#;

const STUDY: &str = r#"system = "duffing.toml"
[[axes]]
name = "p"
values = [0.1, 0.15, 0.2]
[[axes]]
name = "start_x"
from = -1.6
to = 1.6
points = 9
[[axes]]
name = "start_v"
from = -1.2
to = 1.2
points = 9
[protocol]
points = 1
"#;

const FILE: &str = "results/wells/wells.h5";

fn wells() -> WorkDir {
    let folder = WorkDir::new();
    folder.put("duffing.toml", DUFFING);
    folder.put("wells.toml", STUDY);
    folder.run(&["sweep", "wells.toml", "--no-figures"]).done();
    folder
}

/// The oscillator followed by the classical method of Runge and Kutta in fixed steps.
struct Direct {
    p: f64,
    state: [f64; 2],
    time: f64,
}

impl Direct {
    /// Follows it for a time, in steps of a hundredth of a period at most.
    fn follow(&mut self, time: f64) {
        let steps = (time / TAU * 100.0).ceil().max(1.0);
        let h = time / steps;
        let rate = |[x, v]: [f64; 2], t: f64| [v, self.p * t.cos() - 0.15 * v + x - x * x * x];
        let moved = |[x, v]: [f64; 2], [a, b]: [f64; 2], h: f64| [x + h * a, v + h * b];
        let (mut state, mut t) = (self.state, self.time);
        for _ in 0..steps as usize {
            let a = rate(state, t);
            let b = rate(moved(state, a, h / 2.0), t + h / 2.0);
            let c = rate(moved(state, b, h / 2.0), t + h / 2.0);
            let d = rate(moved(state, c, h), t + h);
            let mean = [0, 1].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0);
            (state, t) = (moved(state, mean, h), t + h);
        }
        (self.state, self.time) = (state, t);
    }
}

/// The share of steps from the large orbit through a section point at p = 0.1 that end in the right well, at these parts of a period.
fn directly([x, v]: [f64; 2], to: f64, parts: impl Iterator<Item = f64>) -> f64 {
    let (mut right, mut all) = (0, 0);
    let mut orbit = Direct { p: 0.1, state: [x, v], time: 0.0 };
    orbit.follow(40.0 * TAU);
    let settled = orbit.state;
    for part in parts {
        let mut motion = Direct { p: 0.1, state: settled, time: 0.0 };
        motion.follow(part * TAU);
        motion.p = to;
        motion.follow((70.0 - part) * TAU);
        all += 1;
        right += usize::from(motion.state[0] > 0.0);
    }
    f64::from(right as u32) / f64::from(all)
}

/// The attractor at the first value that begins at the least x among those of large motions, with its section point, and the one of the right well
/// at a value, by the section points of the cases.
fn orbits(folder: &WorkDir, at: usize) -> (u64, [f64; 2], u64) {
    let dataset = store::read(&folder.path(FILE)).expect("a file of results");
    let column = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let [numbers, x, v] = ["attractor", "section_x", "section_v"].map(column);
    let large = (0..81).find(|case| x[*case] < 0.0 && v[*case] > 0.3).expect("a large orbit");
    let right = (81 * at..81 * (at + 1)).find(|case| x[*case] > 1.0).expect("the right well");
    (numbers[large] as u64, [x[large], v[large]], numbers[right] as u64)
}

/// What is told of an attractor at the step `at`: how many draws lead to another, of how many.
fn led(told: &Value, at: usize, attractor: u64, to: u64) -> &Value {
    let rows = told["steps"][at]["attractors"].as_array().expect("attractors");
    let row = rows.iter().find(|it| it["attractor"] == attractor).expect("the attractor");
    assert_eq!(row["unknown"], 0, "{row}");
    let all = row["orbit"].as_array().expect("draws");
    all.iter().find(|it| it["to"] == to).unwrap_or_else(|| panic!("none leads to {to}: {row}"))
}

/// With `TIPPING_SEEDS=1000` the intervals of so many sets of draws, against a direct simulation of thousands of steps.
#[test]
fn draws_lead_where_direct_simulation_does() {
    let folder = wells();
    let seeds: Option<u64> =
        std::env::var("TIPPING_SEEDS").ok().map(|it| it.parse().expect("a number"));
    let count = if seeds.is_some() { 4000 } else { 250 };
    let mut random = fastrand::Rng::with_seed(3);
    let mut parts = Vec::new();
    // Even moments have the smaller error; random ones are the definition.
    parts.extend((0..count).map(|at| (f64::from(at) + random.f64()) / f64::from(count)));
    let (large, point, right) = orbits(&folder, 1);
    let truth = directly(point, 0.15, parts.iter().copied());
    assert!((0.05..0.95).contains(&truth), "{truth}");
    let tipping = |draws: u32, seed: u64| {
        let (draws, seed) = (draws.to_string(), seed.to_string());
        let asked = ["--from", "0.1", "--to", "0.15", "--draws", &draws, "--seed", &seed];
        folder.run(&[&["tipping", FILE, "--json"][..], &asked].concat()).json()
    };
    let told = tipping(300, 1);
    let found = led(&told, 0, large, right);
    let share = found["probability"].as_f64().expect("a number");
    println!("{share} of 300 draws, {truth} of {count} direct simulations");
    let error = (truth * (1.0 - truth) / 300.0).sqrt();
    assert!((share - truth).abs() < 3.5 * error, "{share} {truth}");
    // Those that stay in a well do so at any moment.
    let stays = told["steps"][0]["attractors"].as_array().expect("attractors");
    assert!(stays.iter().any(|it| it["orbit"][0]["probability"] == 1.0), "{told}");
    let Some(seeds) = seeds else { return };
    let mut within = 0;
    for seed in 0..seeds {
        let told = tipping(100, seed);
        let ends = &led(&told, 0, large, right)["interval"];
        let [low, high] = [0, 1].map(|end| ends[end].as_f64().expect("a number"));
        within += u64::from((low..=high).contains(&truth));
    }
    let percent = 100.0 * within as f64 / seeds as f64;
    println!("Wilson's interval has {truth} in {percent:.1} of 100 sets of draws");
    assert!((percent - 95.0).abs() <= 3.0, "{percent}");
}

#[test]
fn basins_go_where_their_labels_say() {
    let folder = wells();
    let dataset = store::read(&folder.path(FILE)).expect("a file of results");
    let labels: Vec<f64> =
        dataset.variable("attractor").expect("labels").values.to_real().into_iter().collect();
    let told = folder.run(&["tipping", FILE, "--draws", "4", "--json"]).json();
    let steps = told["steps"].as_array().expect("steps");
    assert_eq!(steps.len(), 2);
    for (at, step) in steps.iter().enumerate() {
        for row in step["attractors"].as_array().expect("attractors") {
            let own = row["attractor"].as_u64().expect("a number") as f64;
            let [before, after] = [at, at + 1].map(|it| &labels[81 * it..81 * (it + 1)]);
            let starts: Vec<f64> =
                before.iter().zip(after).filter(|it| *it.0 == own).map(|it| *it.1).collect();
            for led in row["basin"].as_array().expect("basins") {
                let to = led["to"].as_u64().expect("a number") as f64;
                let count = starts.iter().filter(|it| **it == to).count();
                assert_eq!(led["count"].as_u64(), Some(count as u64), "{row}");
                let share = count as f64 / starts.len() as f64;
                assert!((led["probability"].as_f64().expect("a number") - share).abs() < 1e-15);
            }
        }
    }
    // The same for any threads, and each step by itself.
    let told = |words: &[&str]| {
        folder.run(&[&["tipping", FILE, "--draws", "30", "--json"], words].concat()).json()
    };
    let all = told(&["--threads", "1"]);
    assert_eq!(all, told(&["--threads", "3"]));
    assert_eq!(all["steps"][1], told(&["--from", "0.15", "--to", "0.2"])["steps"][0]);
    // A wide ball takes motions out of their wells, which a step alone does not.
    let shaken = told(&["--from", "0.15", "--to", "0.2", "--ball", "1.5"]);
    let rows = shaken["steps"][0]["attractors"].as_array().expect("attractors");
    assert!(rows.iter().all(|it| it["orbit"].as_array().map(Vec::len) == Some(2)), "{shaken}");
}

#[test]
fn what_cannot_be_asked_of_tipping_is_refused() {
    let folder = wells();
    folder
        .run(&["tipping", FILE, "--from", "0.1 kg", "--to", "0.2", "--ball", "-1"])
        .refused(&["--ball: -1 is not allowed", "--from"]);
    folder.run(&["tipping", FILE, "--from", "0.1", "--to", "0.11"]).refused(&["expected two"]);
    let other = "[[axes]]\nname = \"start_y1\"\nvalues = [\"0 m/s\", \"1 m/s\"]\n";
    folder.put("starts.toml", format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{other}"));
    folder.run(&["sweep", "starts.toml", "--no-figures"]).done();
    folder
        .run(&["tipping", "results/starts/starts.h5"])
        .refused(&["results/starts/starts.h5", "holds no basins along a parameter"]);
    let told = folder.run(&["tipping", FILE, "--draws", "20"]).done().out;
    assert!(told.contains("\np from 0.1 to 0.15\n"), "{told}");
}
