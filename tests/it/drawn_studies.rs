//! Studies whose cases are drawn: where the draws lie, how evenly, and the results of them.

use std::collections::{BTreeMap, BTreeSet};

use capsulemap::capsule::Output;
use capsulemap::capsule::description::CAPSULE;
use capsulemap::run::{self, Machine};
use capsulemap::store;
use capsulemap::study::{CaseSet, Coordinate, DrawKind, Draws, Range, Spacing, Study};

use super::program::{FIG5, WorkDir};

/// The capsule of `studies/hysteresis.toml` where it has two motions, with starts drawn.
const STARTS: &str = r#"[parameters]
m2 = "0.2 kg"
c = "1.77 N s/m"
mu_s = 0.33
mu_d = 0.165
p_d = "2.79 N"
k2 = "65.518 kN/m"
delta = "4.33 mm"
omega = "158 rad/s"
[draws]
kind = "low-discrepancy"
count = 400
seed = 4
[[axes]]
name = "start_y1"
from = "-1 m/s"
to = "1 m/s"
[[axes]]
name = "start_phase"
from = "0 deg"
to = "360 deg"
"#;

/// Parameters drawn, one on a logarithmic scale, and a trade-off of what comes out.
const PARAMETERS: &str = r#"[parameters]
delta = "1.5 mm"
omega = "20.73 rad/s"
[draws]
count = 60
seed = 9
[[axes]]
name = "k2"
from = "2 kN/m"
to = "100 kN/m"
spacing = "logarithmic"
[[axes]]
name = "p_d"
from = "5 N"
to = "3 N"
[[figures]]
name = "trade-off"
kind = "trade-off"
of = ["work_positive"]
"#;

fn read(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// `count` points in the unit cube of so many sides.
fn unit(kind: DrawKind, count: usize, sides: usize, seed: u64) -> Draws {
    let coordinates = Coordinate::all(&CAPSULE).take(sides);
    let range = |coordinate| Range::even(coordinate, [0.0, 1.0], Spacing::Linear);
    Draws { kind, count, seed, ranges: coordinates.map(range).collect() }
}

fn points(draws: &Draws) -> Vec<Vec<f64>> {
    let point = |index| (0..draws.ranges.len()).map(|place| draws.value(index, place)).collect();
    (0..draws.count).map(point).collect()
}

const KINDS: [DrawKind; 2] = [DrawKind::Uniform, DrawKind::LowDiscrepancy];

#[test]
fn draws_lie_in_their_ranges_and_depend_on_index_and_seed_alone() {
    for kind in KINDS {
        let ranges = [
            (2.0, 3.0, Spacing::Linear),
            (5.0, -1.0, Spacing::Linear),
            (1e-3, 1e4, Spacing::Logarithmic),
            (0.1, 0.1 + 1e-16 * 2.0, Spacing::Logarithmic),
        ];
        let own = Coordinate::all(&CAPSULE).zip(ranges);
        let range =
            |(coordinate, (from, to, spacing))| Range::even(coordinate, [from, to], spacing);
        let draws = Draws { kind, count: 4000, seed: 7, ranges: own.map(range).collect() };
        let all = points(&draws);
        for point in &all {
            for (value, (from, to, _)) in point.iter().zip(ranges) {
                assert!((from.min(to)..=from.max(to)).contains(value), "{value} {from} {to}");
            }
        }
        // Half of the logarithms lie below the middle.
        let low = all.iter().filter(|point| point[2] < libm::sqrt(10.0)).count();
        assert!((1850..2150).contains(&low), "{low}");
        let shorter = Draws { count: 50, ..draws.clone() };
        assert_eq!(points(&shorter), all[..50]);
        let other = Draws { seed: 8, ..draws.clone() };
        assert!((0..2000).all(|i| draws.value(i, 0) != other.value(i, 0)));
        let distinct: BTreeSet<u64> = all.iter().map(|point| point[0].to_bits()).collect();
        assert_eq!(distinct.len(), 4000);
    }
}

#[test]
fn uniform_draws_pass_kolmogorov_smirnov_and_chi_square() {
    let count = 20_000;
    for seed in [0, 1, 2, u64::MAX] {
        let all = points(&unit(DrawKind::Uniform, count, 3, seed));
        for side in 0..3 {
            let mut values: Vec<f64> = all.iter().map(|point| point[side]).collect();
            values.sort_by(f64::total_cmp);
            // One in a hundred thousand is beyond 2.5 over the root of the number.
            let bound = 2.5 / (count as f64).sqrt();
            assert!(line_discrepancy(&values) < bound, "seed {seed}, side {side}");
        }
        // Pairs of sides, and of neighbouring draws: 256 cells, of 255 degrees of freedom with a standard
        // deviation of 22.6; the bound is five of them away.
        let pairs = [[0, 1], [1, 2], [0, 2]];
        let within = pairs.map(|[a, b]| cells(all.iter().map(|point| [point[a], point[b]])));
        let along = cells(all.windows(2).map(|two| [two[0][0], two[1][0]]));
        for chi_square in within.into_iter().chain([along]) {
            assert!((142.0..368.0).contains(&chi_square), "seed {seed}: {chi_square}");
        }
    }
}

/// Chi-square of points over 16 by 16 cells.
fn cells(points: impl Iterator<Item = [f64; 2]>) -> f64 {
    let mut counts = [0.0; 256];
    for point in points {
        let [a, b] = point.map(|x| (16.0 * x) as usize);
        counts[16 * a + b] += 1.0;
    }
    let expected = counts.iter().sum::<f64>() / 256.0;
    counts.iter().map(|count| (count - expected) * (count - expected) / expected).sum()
}

/// The largest distance of the empirical distribution of sorted values from the even one.
fn line_discrepancy(sorted: &[f64]) -> f64 {
    let n = sorted.len() as f64;
    let off = |(i, x): (usize, &f64)| (x - i as f64 / n).abs().max((x - (i + 1) as f64 / n).abs());
    sorted.iter().enumerate().map(off).fold(0.0, f64::max)
}

/// The star discrepancy of points in the unit square, over all boxes that their coordinates make.
fn plane_discrepancy(points: &[Vec<f64>]) -> f64 {
    let n = points.len() as f64;
    let sides: [Vec<f64>; 2] = std::array::from_fn(|side| {
        let mut values: Vec<f64> = points.iter().map(|point| point[side]).collect();
        values.push(1.0);
        values.sort_by(f64::total_cmp);
        values
    });
    let mut largest: f64 = 0.0;
    for &a in &sides[0] {
        for &b in &sides[1] {
            let open = points.iter().filter(|p| p[0] < a && p[1] < b).count() as f64 / n;
            let closed = points.iter().filter(|p| p[0] <= a && p[1] <= b).count() as f64 / n;
            largest = largest.max(a * b - open).max(closed - a * b);
        }
    }
    largest
}

#[test]
fn low_discrepancy_draws_are_spread_more_evenly_than_uniform_ones() {
    for seed in 0..6 {
        let sorted = |kind| {
            let mut values: Vec<f64> =
                points(&unit(kind, 4096, 1, seed)).iter().map(|point| point[0]).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        // Multiples of the golden section: n D* stays below ln(n) for a shifted sequence.
        let [uniform, low] = KINDS.map(|kind| line_discrepancy(&sorted(kind)));
        let bound = libm::log(4096.0) / 4096.0;
        assert!(low < bound && bound < uniform, "seed {seed}: {low} {uniform}");

        // Over a square, n draws of uniform kind reach about one over the root of n: half of that bounds the
        // others, and with four times the draws they are more than twice as even.
        let plane = |kind, count| plane_discrepancy(&points(&unit(kind, count, 2, seed)));
        let [uniform, low] = KINDS.map(|kind| plane(kind, 300));
        let bound = 0.5 / 300_f64.sqrt();
        assert!(low < bound && bound < uniform, "seed {seed}: {low} {uniform}");
        let fewer = plane(DrawKind::LowDiscrepancy, 75);
        assert!(low < fewer / 2.0, "seed {seed}: {fewer} {low}");
    }
}

/// The shares of the cases of a study that end on its motion at rest and on the one that gets on, which its
/// attractors distinguish.
fn shares(study: &Study) -> [f64; 2] {
    let chains = Vec::from_iter(0..study.chains());
    let records = run::run_sample(study, Machine::default(), &chains, || ()).expect("it runs");
    let final_motions = run::final_motions(study, &records);
    let found = run::attractors(study, &final_motions, Machine::default(), || ()).expect("threads");
    let mut counts = BTreeMap::new();
    for (record, attractor) in records.iter().zip(&found.of_case) {
        let moves = record.orbit.outputs[Output::ProgressionSpeed] > 0.05;
        *counts.entry((moves, *attractor)).or_insert(0.0) += 1.0 / records.len() as f64;
    }
    let attractors: BTreeSet<_> = counts.keys().map(|(_, attractor)| attractor).collect();
    assert!(counts.len() == 2 && attractors.len() == 2, "{counts:?}");
    [false, true].map(|wanted| {
        counts.iter().filter(|((moves, _), _)| *moves == wanted).map(|(_, share)| share).sum()
    })
}

#[test]
fn a_study_of_drawn_starts_has_the_attractors_of_one_cell() {
    let study = read(STARTS);
    assert_eq!((study.cases(), study.shape(), study.dimensions()), (400, vec![400], vec!["draw"]));
    let [rests, moves] = shares(&study);
    assert!(rests > 0.0 && moves > 0.0 && (rests + moves - 1.0).abs() < 1e-12, "{rests} {moves}");
    // A grid of as many starts, in the middle of even cells, says how much of the ranges each basin has.
    let ends = STARTS.replace("1 m/s", "0.95 m/s").replace("\"0 deg", "\"9 deg");
    let ends = ends.replace("360 deg\"", "351 deg\"").replace("deg\"\n", "deg\"\npoints = 20\n");
    let ends = ends.replace("from = \"9 deg\"\npoints = 20\n", "from = \"9 deg\"\n");
    let even = ends.replace("to = \"0.95 m/s\"\n", "to = \"0.95 m/s\"\npoints = 20\n");
    let even = even.replace("[draws]\nkind = \"low-discrepancy\"\ncount = 400\nseed = 4\n", "");
    let [_, on_grid] = shares(&read(&even));
    assert!((moves - on_grid).abs() < 0.04, "{moves} {on_grid}");
    assert!(!run::has_attractors(&read(PARAMETERS)));
    let one = PARAMETERS.replace("[[axes]]\nname = \"p_d\"\nfrom = \"5 N\"\nto = \"3 N\"\n", "");
    let one = one.replace("delta =", "p_d = \"4 N\"\ndelta =");
    assert!(!run::has_attractors(&read(&one)), "each draw has a parameter of its own");
}

#[test]
fn a_file_of_draws_holds_them_along_one_dimension_and_their_figures() {
    let dir = WorkDir::new();
    dir.put("draws.toml", PARAMETERS);
    dir.run(&["sweep", "draws.toml", "--formats", "svg"]).done();
    assert!(dir.path("results/draws/trade-off.svg").is_file());
    let file = dir.path("results/draws/draws.h5");
    let dataset = store::read(&file).expect("results");
    let study = read(PARAMETERS);
    let CaseSet::Draws(draws) = &study.case_set else { panic!("draws") };
    for (place, name) in ["k2", "p_d"].into_iter().enumerate() {
        let variable = dataset.variable(name).expect(name);
        assert_eq!(variable.dimensions, ["draw"]);
        let values: Vec<f64> = variable.values.to_real().into_iter().collect();
        assert!(values.iter().copied().eq((0..60).map(|index| draws.value(index, place))));
    }
    assert_eq!(dataset.coordinates[0].0, "draw");
    assert_eq!(dataset.variables["progression_speed"].dimensions, ["draw"]);
    assert_eq!(
        (&*dataset.attributes["draws_kind"], &*dataset.attributes["draws_seed"]),
        ("uniform", "9")
    );
    assert!(dataset.variable("attractor").is_none());
    // One draw is the case with its parameters.
    let case = study.case(17);
    let ran = dir.run(&["simulate", "--study", "draws.toml", "--case", "17", "--json"]).json();
    let speed = dataset.variables["progression_speed"].values.to_real()[[17]];
    assert_eq!(ran["orbit"]["progression_speed"].as_f64(), Some(speed));
    let k2 = case.parameters[capsulemap::capsule::Parameter::K2];
    assert_eq!(ran["parameters"]["k2"].as_f64(), Some(k2));
    dir.run(&["verify", "results/draws/draws.h5", "--cases", "10"]).done();
    for kind in ["map", "bifurcation"] {
        let file = file.to_str().expect("a path");
        dir.run(&["figure", file, "--kind", kind, "--of", "progression_speed"]).refused(&["needs"]);
    }
}

#[test]
fn what_does_not_go_with_draws_is_reported_before_the_run() {
    let said = |text: &str, expected: &[&str]| {
        let faults = Study::parse("study.toml", text).expect_err(text);
        let ran: Vec<String> = faults.to_string().lines().skip(1).map(str::to_owned).collect();
        let fits = ran.len() == expected.len()
            && ran.iter().zip(expected).all(|(ran, words)| ran.contains(words));
        assert!(fits, "{ran:#?}\n{expected:#?}");
    };
    let axis = "[[axes]]\nname = \"start_r\"\n";
    let range = "from = \"0 mm\"\nto = \"1 mm\"\n";
    let draws = format!("{FIG5}[draws]\ncount = 10\n");
    assert_eq!(read(&format!("{draws}{axis}{range}")).cases(), 10);
    said(&draws, &["axes: missing; expected ranges to draw from"]);
    let start = "[start]\ninherit = \"start_r\"\ndirections = [\"upward\"]\nr = \"1 mm\"\n";
    said(
        &format!("{draws}{axis}{range}points = 3\n{start}"),
        &[
            "axes[1].points: does not go with `[draws]`",
            "start.inherit: does not go with `[draws]`",
            "start.directions: does not go with `[draws]`",
            "start.r: is given here and on an axis",
        ],
    );
    said(
        &format!("{draws}{axis}values = [\"1 mm\"]\n"),
        &["axes[1].from: missing", "axes[1].to: missing", "axes[1].values: does not go"],
    );
    said(
        &format!("{draws}{axis}{}", range.replace('1', "0")),
        &["axes[1].to: \"0 mm\" is the same"],
    );
    said(
        &format!("{FIG5}[draws]\nkind = \"unifrom\"\ncount = 0\nseed = -1\nsed = 1\n{axis}{range}"),
        &[
            "draws.kind: unknown kind \"unifrom\"; did you mean \"uniform\"?",
            "draws.count: expected a whole number, 1 to 10000000, found 0",
            "draws.seed: expected a whole number, 0 to",
            "draws.sed: unknown key \"sed\"",
        ],
    );
    said(&format!("{FIG5}[draws]\n{axis}{range}"), &["draws.count: missing"]);
    for kind in ["map", "bifurcation"] {
        let figure = format!("[[figures]]\nname = \"a\"\nkind = \"{kind}\"\n");
        let words = format!("figures[1].kind: a figure of the kind {kind} needs a grid");
        said(&format!("{draws}{axis}{range}{figure}"), &[&words]);
    }
}
