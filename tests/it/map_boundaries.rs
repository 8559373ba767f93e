//! The boundaries of the regions of a map, against closed forms and against motions between the cases.

use std::sync::OnceLock;

use capsulemap::campaign::{InMemory, Wanted, silent};
use capsulemap::motion::Case;
use capsulemap::of::settle_case;
use capsulemap::run::{Machine, PairState};
use capsulemap::store::Dataset;
use capsulemap::study::Study;

use super::program::WorkDir;

/// An oscillator before a rigid wall: below the curve on which the forced vibration reaches the wall nothing is met.
const IMPACTOR: &str = r#"
[system]
name = "oscillator before a wall"
states = { x = "1", v = "1" }
section = { every = "2*pi/w" }
[system.parameters]
c = 0.1
f = 0.2
w = 1.0
r = 0.7
wall = 1.0
[system.rates]
x = "v"
v = "f*cos(w*t) - x - c*v"
[[system.events]]
name = "impact"
while = "x < wall"
reset = { x = "wall", v = "-r*v" }

[[axes]]
name = "w"
from = "0.6"
to = "1.5"
points = 10
[[axes]]
name = "f"
from = "0.05"
to = "0.6"
points = 8
[map]
boundaries = true
"#;

/// The amplitude of the force at which the forced vibration of [`IMPACTOR`] just reaches the wall.
fn grazing_force(w: f64) -> f64 {
    (1.0 - w * w).hypot(0.1 * w)
}

fn computed(text: &str, threads: usize) -> Dataset {
    let study = Study::parse("map.toml", text).unwrap_or_else(|faults| panic!("{faults}"));
    let machine = Machine { threads: Some(threads), instructions: None };
    let wanted = Wanted { cases: true, branches: true };
    InMemory::new(study, machine).run(wanted, &silent).expect("results")
}

/// The boundaries of [`IMPACTOR`], computed once for all tests.
fn boundaries() -> &'static Dataset {
    static KNOWN: OnceLock<Dataset> = OnceLock::new();
    KNOWN.get_or_init(|| computed(IMPACTOR, 2))
}

fn column(dataset: &Dataset, name: &str) -> Vec<f64> {
    dataset.variable(name).expect(name).values.to_real().into_iter().collect()
}

/// A curve in the plane of `w` and `f`.
struct Curve {
    kind: String,
    period: f64,
    points: Vec<[f64; 2]>,
}

fn curves(dataset: &Dataset, axes: [&str; 2]) -> Vec<Curve> {
    let kinds = dataset.variable("curve_kind").expect("kinds");
    let names = kinds.names();
    let [number, period] = ["curve", "curve_period"].map(|name| column(dataset, name));
    let [x, y] = axes.map(|name| column(dataset, &format!("curve_{name}")));
    let mut all: Vec<Curve> = Vec::new();
    for at in 0..number.len() {
        if number[at] as usize == all.len() {
            let kind = names[at].unwrap_or_default().to_owned();
            all.push(Curve { kind, period: period[at], points: Vec::new() });
        }
        if let Some(curve) = all.last_mut() {
            curve.points.push([x[at], y[at]]);
        }
    }
    all
}

/// The values of the second coordinate at which a curve passes a value of the first.
fn crossings(curve: &Curve, at: f64) -> Vec<f64> {
    let pairs = curve.points.windows(2).filter(|it| (it[0][0] - at) * (it[1][0] - at) <= 0.0);
    let between = pairs.map(|it| {
        let width = it[1][0] - it[0][0];
        let share = if width == 0.0 { 0.5 } else { (at - it[0][0]) / width };
        it[0][1] + share * (it[1][1] - it[0][1])
    });
    between.collect()
}

#[test]
fn motions_without_impact_end_where_the_forced_vibration_reaches_the_wall() {
    let dataset = boundaries();
    let all = curves(dataset, ["w", "f"]);
    let is_closed_form = |curve: &&Curve| {
        let off = curve.points.iter().map(|[w, f]| (f - grazing_force(*w)).abs());
        (curve.kind.as_str(), curve.period) == ("grazing", 1.0) && off.fold(0.0, f64::max) < 1e-6
    };
    let found: Vec<&Curve> = all.iter().filter(is_closed_form).collect();
    assert!(!found.is_empty(), "no curve has the closed form");
    let frequencies = (0..=60).map(|at| 0.66 + 0.01 * f64::from(at));
    for w in frequencies.filter(|w| (0.05..=0.6).contains(&grazing_force(*w))) {
        let nearest = found.iter().flat_map(|curve| crossings(curve, w));
        let off = nearest.map(|f| (f - grazing_force(w)).abs()).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-3, "at w = {w} the curve is {off} away");
    }
}

/// What tells the regions of a map apart, of each case: the period and the impacts in it.
fn kinds(dataset: &Dataset) -> Vec<[i64; 2]> {
    let [periods, impacts] = ["period", "impact_per_cycle"].map(|name| column(dataset, name));
    let each = periods.iter().zip(&impacts);
    each.map(|(period, impacts)| match *period > 0.0 {
        true => [*period as i64, (period * impacts).round() as i64],
        false => [0, 0],
    })
    .collect()
}

#[test]
fn every_pair_of_two_kinds_is_counted_once() {
    let dataset = boundaries();
    let kinds = kinds(dataset);
    let [slow, fast] = [10, 8];
    let differ = |one: usize, other: usize| usize::from(kinds[one] != kinds[other]);
    let mut all = 0;
    for i in 0..slow {
        for j in 0..fast {
            let case = i * fast + j;
            all += if i + 1 < slow { differ(case, case + fast) } else { 0 };
            all += if j + 1 < fast { differ(case, case + 1) } else { 0 };
        }
    }
    let pairs = column(dataset, "boundary_pairs");
    assert_eq!(pairs.iter().sum::<f64>(), all as f64, "{pairs:?}");
    assert_eq!(pairs[PairState::NotTried as usize], 0.0, "{pairs:?}");
}

#[test]
fn boundaries_do_not_depend_on_the_threads() {
    let told = |dataset: &Dataset| format!("{:?} {:?}", dataset.variables, dataset.coordinates);
    let few = IMPACTOR.replace("boundaries = true", "boundaries = { most_tries = 5 }");
    assert!(told(&computed(&few, 1)) == told(&computed(&few, 3)));
}

/// Where the motion that is followed upward between the values of the map changes its period, a curve passes.
#[test]
fn changes_between_the_cases_lie_at_curves() {
    let dataset = boundaries();
    let all = curves(dataset, ["w", "f"]);
    let study = Study::parse("map.toml", IMPACTOR).expect("a study");
    let kind = |f: f64, w: f64, from: Option<&Case>| {
        let mut case = study.case(0);
        let model = study.base.model();
        case.parameters[model.parameter("f").expect("f")] = f;
        case.parameters[model.parameter("w").expect("w")] = w;
        if let Some(from) = from {
            (case.start, case.start_phase) = (from.start.clone(), from.start_phase);
        }
        let orbit = settle_case(&case, &study.protocol);
        let after = Case { start: orbit.end.clone(), start_phase: case.section_phase, ..case };
        (orbit.period, after)
    };
    // Of what no two neighbours tell there need not be a curve.
    let kinds = kinds(dataset);
    let neighbours =
        (0..kinds.len()).flat_map(|case| [case + 1, case + 8].map(|next| [case, next]));
    let pairs = neighbours.filter(|[_, next]| *next < kinds.len());
    let pairs: Vec<[u64; 2]> = pairs.map(|pair| pair.map(|case| kinds[case][0] as u64)).collect();
    let is_told = |pair: [u64; 2]| {
        let is_known = pairs.contains(&pair) || pairs.contains(&[pair[1], pair[0]]);
        pair[0] != pair[1] && !pair.contains(&0) && is_known
    };
    let mut changes = 0;
    for w in [0.733, 0.867] {
        let values: Vec<f64> = (0..=220).map(|at| 0.05 + 0.0025 * f64::from(at)).collect();
        let mut before: Option<(u64, Case)> = None;
        for pair in values.windows(2) {
            let (period, case) = before.take().unwrap_or_else(|| kind(pair[0], w, None));
            let (next, after) = kind(pair[1], w, Some(&case));
            if is_told([period, next]) {
                let near = all.iter().flat_map(|curve| crossings(curve, w));
                let off = near.map(|f| {
                    let middle = 0.5 * (pair[0] + pair[1]);
                    (f - middle).abs()
                });
                let off = off.fold(f64::INFINITY, f64::min);
                // Half a step, and what a polygon deviates from the curve.
                assert!(off < 0.002, "at w = {w}, f = {}: {period} to {next}, {off}", pair[1]);
                changes += 1;
            }
            before = Some((next, after));
        }
    }
    assert!(changes > 1, "{changes}");
}

#[test]
fn what_is_no_map_has_no_boundaries() {
    let head = "[parameters]\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\n";
    let axis =
        |name: &str, values: &str| format!("[[axes]]\nname = \"{name}\"\nvalues = {values}\n");
    let omega = axis("omega", "[\"20 rad/s\", \"30 rad/s\"]");
    let p_d = axis("p_d", "[\"2 N\", \"3 N\"]");
    let starts = axis("start_y1", "[\"0 m/s\", \"1 m/s\"]");
    let turns = axis("p_d", "[\"2 N\", \"3 N\", \"1 N\"]");
    let one = axis("p_d", "[\"2 N\"]");
    let asked = "[map]\nboundaries = true\n";
    let refused = |text: String| {
        let faults = Study::parse("a.toml", &text).expect_err("a fault").to_string();
        assert!(faults.contains("map.boundaries: is for grids of two axes"), "{faults}");
    };
    refused(format!("{head}{omega}{asked}"));
    refused(format!("{head}{omega}{starts}{asked}"));
    refused(format!("{head}{omega}{turns}{asked}"));
    refused(format!("{head}{omega}{one}{asked}"));
    refused(format!("{head}{omega}{p_d}{starts}{asked}"));
    let read = |table: &str| Study::parse("a.toml", &format!("{head}{omega}{p_d}[map]\n{table}\n"));
    assert!(read("boundaries = false").expect("a study").boundaries.is_none());
    let given = read("boundaries = { longest_step = 0.05, most_points = 9, most_tries = 3 }");
    let given = given.expect("a study").boundaries.expect("boundaries");
    assert_eq!((given.longest_step, given.most_points, given.most_tries), (0.05, 9, 3));
    let faults = read("boundaries = { longest_step = 2, most_tries = 0, steps = 1 }");
    let faults = faults.expect_err("faults").to_string();
    for key in ["longest_step", "most_tries", "steps"] {
        assert!(faults.contains(&format!("map.boundaries.{key}")), "{faults}");
    }
}

#[test]
fn boundaries_need_the_cases_and_are_drawn_over_the_map() {
    let dir = WorkDir::new();
    let figure = "[[figures]]\nname = \"m\"\nkind = \"map\"\nof = [\"period\"]\ncurves = true\n";
    let few = IMPACTOR.replace("boundaries = true", "boundaries = { most_tries = 3 }");
    dir.put("a.toml", few + figure);
    dir.run(&["continue", "a.toml"]).refused(&["`capsulemap sweep` computes them"]);
    dir.run(&["sweep", "a.toml", "--formats", "svg"]).done();
    let told = dir.run(&["continue", "a.toml", "--formats", "svg"]).done().out;
    assert!(told.contains("boundaries of the map, from 3 tries"), "{told}");
    assert!(told.contains("were not tried, as `most_tries` allows 3"), "{told}");
}
