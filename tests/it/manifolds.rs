//! Boundaries of basins as curves: their points against starts that are followed on both sides, in the capsule and in an oscillator with
//! two wells, where the boundary is smooth and where it is fractal; threads, texts and what is told.

use std::f64::consts::TAU;

use capsulemap::attractor::{CurveEnd, Manifolds};
use capsulemap::capsule::{Case, Output, State};
use capsulemap::description::Section;
use capsulemap::orbit::Machine;
use capsulemap::run::{self, Attractors};
use capsulemap::study::Study;

use super::program::{TWO_MOTIONS, WorkDir};

/// Points of curves that are looked at.
fn count() -> usize {
    std::env::var("MANIFOLD_POINTS").map_or(24, |it| it.parse().expect("a number"))
}

fn capsule(points: usize) -> Study {
    let axis = |name: &str, most: &str| {
        format!(
            "[[axes]]\nname = \"{name}\"\nfrom = \"-{most}\"\nto = \"{most}\"\npoints = {points}\n"
        )
    };
    let axes = axis("start_r", "6 mm") + &axis("start_y1", "1.5 m/s");
    let text = format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}[basin]\nmanifolds = true\n");
    Study::parse("study.toml", &text).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The attractors of a study and its manifolds.
fn found(study: &Study, machine: Machine) -> (Attractors, Manifolds<Section>) {
    let chains: Vec<usize> = (0..study.chains()).collect();
    let records = run::run_sample(study, machine, &chains, || ()).expect("the study runs");
    let motions = run::final_motions(study, &records);
    let found = run::attractors(study, &motions, machine, || ()).expect("the threads start");
    let mut edges = run::edges(study, &found, machine);
    let manifolds =
        run::manifolds(study, &found, &mut edges, machine, |_| ()).expect("they are asked for");
    (found, manifolds)
}

/// A place on a curve, and the directions to its left.
struct Beside {
    at: [f64; 2],
    left: [f64; 2],
    sides: [u32; 2],
}

/// The attractors that starts lead to.
type LeadTo<'a> = dyn Fn(&[[f64; 2]]) -> Vec<Option<u32>> + 'a;

/// Evenly chosen points of some curves, and the middles of the chords from them on.
fn places(curves: &[(Vec<[f64; 2]>, [u32; 2])], size: [f64; 2], count: usize) -> [Vec<Beside>; 2] {
    let total: usize = curves.iter().map(|(points, _)| points.len() - 1).sum();
    let mut chords = Vec::new();
    for (points, sides) in curves {
        chords.extend(points.windows(2).map(|pair| (pair[0], pair[1], *sides)));
    }
    let chosen = (0..count).map(|number| number * total / count).map(|place| &chords[place]);
    let beside = |share: f64, (a, b, sides): &([f64; 2], [f64; 2], [u32; 2])| {
        let chord = [0, 1].map(|i| (b[i] - a[i]) / size[i]);
        let length = chord[0].hypot(chord[1]).max(1e-300);
        let left = [-chord[1] / length * size[0], chord[0] / length * size[1]];
        Beside { at: [0, 1].map(|i| a[i] + share * (b[i] - a[i])), left, sides: *sides }
    };
    [0.0, 0.5].map(|share| chosen.clone().map(|it| beside(share, it)).collect())
}

/// How far the boundary is from each place along the normal, the sides of the plane being one: bisection between starts on the left and
/// on the right, as far apart as they lead to the two attractors; none where they do at no distance.
fn distances(places: &[Beside], leads: &LeadTo<'_>) -> Vec<Option<f64>> {
    let moved = |it: &Beside, by: f64| [0, 1].map(|i| it.at[i] + by * it.left[i]);
    let mut brackets: Vec<Option<[f64; 2]>> = vec![None; places.len()];
    let mut width = 2e-3;
    while width > 1e-9 {
        let open: Vec<usize> = (0..places.len()).filter(|it| brackets[*it].is_none()).collect();
        let starts: Vec<[f64; 2]> = open
            .iter()
            .flat_map(|it| [moved(&places[*it], width), moved(&places[*it], -width)])
            .collect();
        for (place, leads) in open.iter().zip(leads(&starts).chunks(2)) {
            let sides = places[*place].sides.map(Some);
            if leads == sides {
                brackets[*place] = Some([-width, width]);
            }
        }
        // Another curve may be as near as the chord is to its own.
        width /= 1.5;
    }
    for _ in 0..22 {
        let known: Vec<usize> = (0..places.len()).filter(|it| brackets[*it].is_some()).collect();
        let middles: Vec<f64> =
            known.iter().map(|it| brackets[*it].map_or(0.0, |[a, b]| 0.5 * (a + b))).collect();
        let starts: Vec<[f64; 2]> =
            known.iter().zip(&middles).map(|(it, middle)| moved(&places[*it], *middle)).collect();
        for ((place, middle), leads) in known.iter().zip(middles).zip(leads(&starts)) {
            if let Some(bracket) = &mut brackets[*place] {
                let is_left = leads == Some(places[*place].sides[0]);
                bracket[usize::from(is_left)] = middle;
            }
        }
    }
    brackets.into_iter().map(|it| it.map(|[a, b]| a.abs().max(b.abs()))).collect()
}

fn largest(distances: &[Option<f64>]) -> (f64, usize) {
    let known = distances.iter().flatten().copied().fold(0.0, f64::max);
    (known, distances.iter().filter(|it| it.is_none()).count())
}

#[test]
fn points_of_the_curves_lie_on_the_boundary_of_the_capsule() {
    let study = capsule(24);
    let (known, manifolds) = found(&study, Machine::default());
    let speed = |case: usize| {
        let case = study.case(case);
        study.model().settle(&case, &study.protocol, None).outputs[Output::ProgressionSpeed]
    };
    let speeds: Vec<f64> = known.of_starts.iter().map(|it| speed(it.case)).collect();
    // The side is told by the speed of what starts settle to.
    let leads = |starts: &[[f64; 2]]| {
        let case = |[r, y1]: &[f64; 2]| Case {
            start: State::of([*r, *y1, 0.0, 0.0]).into(),
            ..study.case(0)
        };
        let cases: Vec<Case> = starts.iter().map(case).collect();
        let orbits = study.model().settle_all(&cases, &study.protocol, Machine::default());
        let number = |speed: f64| speeds.iter().position(|it| (it - speed).abs() < 1e-8);
        let found = orbits.iter().map(|it| number(it.outputs[Output::ProgressionSpeed]));
        found.map(|it| it.map(|it| it as u32)).collect()
    };
    let coverage = manifolds.coverage;
    println!("{coverage:?}");
    for it in &manifolds.stable {
        let divided = it.divided.iter().filter(|it| **it).count();
        println!(
            "{:?} {:?}: {} points, {divided} divided, {:?}, {:.3} long, error {:.1e}",
            it.saddle,
            it.sides,
            it.points.len(),
            it.ends,
            it.length,
            it.error
        );
    }
    let curves: Vec<_> = manifolds.stable.iter().map(|it| (it.points.clone(), it.sides)).collect();
    let [points, middles] = places(&curves, [12e-3, 3.0], count());
    let [at, between] = [points, middles].map(|it| largest(&distances(&it, &leads)));
    println!("capsule: points {at:?}, between {between:?}");
    assert!(coverage.uncovered * 50 <= coverage.crossings, "{coverage:?}");
    assert!(at.0 < 1e-7 && between.0 < 1e-3, "{at:?} {between:?}");
    assert!(at.1 + between.1 <= count() / 12, "{at:?} {between:?}");
}

#[test]
fn manifolds_have_the_same_bits_on_any_number_of_threads() {
    let study = capsule(10);
    let (_, one) = found(&study, Machine::single());
    let (_, more) = found(&study, Machine { threads: Some(3), ..Machine::default() });
    assert_eq!(one, more);
    assert!(!one.stable.is_empty() && !one.unstable.is_empty());
}

/// An image of a point of an unstable manifold lies on the manifold again: beside a chord of it, or beyond its end.
#[test]
fn the_return_map_leads_the_unstable_manifold_into_itself() {
    let study = capsule(10);
    let (_, manifolds) = found(&study, Machine::default());
    let case = study.case(0);
    let scales = study.model().scales(&capsulemap::model::Setting::of(&case));
    let scaled = |point: &Section| [0, 1, 2].map(|i| scales[i] * point[i]);
    let mut farthest: f64 = 0.0;
    for branch in &manifolds.unstable {
        let period = manifolds.saddles[branch.saddle].saddle.points.len() as u64;
        let curve: Vec<[f64; 3]> = branch.points.iter().map(scaled).collect();
        let size = curve.iter().flatten().fold(0.0, |size: f64, it| size.max(it.abs()));
        for point in branch.points.iter().step_by(1 + branch.points.len() / 40) {
            let setting = capsulemap::model::Setting::of(&case);
            let returns = study.model().section_points(&setting, *point, period, 1e-12);
            let image = scaled(returns.expect("it goes on").last().expect("a point"));
            let distance = |pair: &[[f64; 3]]| {
                let along = [0, 1, 2].map(|i| pair[1][i] - pair[0][i]);
                let away = [0, 1, 2].map(|i| image[i] - pair[0][i]);
                let square: f64 = along.iter().map(|it| it * it).sum();
                let product: f64 = (0..3).map(|i| along[i] * away[i]).sum();
                let share = (product / square.max(1e-300)).clamp(0.0, 1.0);
                (0..3).map(|i| (away[i] - share * along[i]).powi(2)).sum::<f64>().sqrt()
            };
            let nearest = curve.windows(2).map(distance).fold(f64::INFINITY, f64::min);
            farthest = farthest.max(nearest / size);
        }
    }
    println!("images are {farthest:.1e} of the motion from the chords");
    assert!(farthest < 2e-3, "{farthest:e}");
}

const WELLS: &str = r#"system = "duffing.toml"
[parameters]
p = P
[[axes]]
name = "start_x"
from = -2
to = 2
points = POINTS
[[axes]]
name = "start_v"
from = -2
to = 2
points = POINTS
[basin]
manifolds = true
"#;

const DUFFING: &str = r#"[system]
name = "Duffing oscillator with two wells"
states = { x = "1", v = "1" }
section = { every = "2*pi" }

[system.parameters]
c = 0.25
p = 0.1

[system.rates]
x = "v"
v = "p*cos(t) - c*v + x - x^3"
"#;

/// The well in which a start of the oscillator ends, by the classical method of Runge and Kutta: 0 on the left.
fn well(p: f64, start: [f64; 2]) -> u32 {
    const STEPS: usize = 300;
    let h = TAU / STEPS as f64;
    let rate = |[x, v]: [f64; 2], t: f64| [v, p * t.cos() - 0.25 * v + x - x * x * x];
    let moved = |[x, v]: [f64; 2], [a, b]: [f64; 2], h: f64| [x + h * a, v + h * b];
    let mut state = start;
    for step in 0..25 * STEPS {
        let t = (step % STEPS) as f64 * h;
        let a = rate(state, t);
        let b = rate(moved(state, a, h / 2.0), t + h / 2.0);
        let c = rate(moved(state, b, h / 2.0), t + h / 2.0);
        let d = rate(moved(state, c, h), t + h);
        state = moved(state, [0, 1].map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0), h);
    }
    u32::from(state[0] > 0.0)
}

/// The manifolds of the oscillator, as the program tells them.
fn wells(p: f64, points: usize) -> (WorkDir, serde_json::Value) {
    let folder = WorkDir::new();
    folder.put("duffing.toml", DUFFING);
    let study = WELLS.replace("= P\n", &format!("= {p}\n")).replace("POINTS", &points.to_string());
    folder.put("wells.toml", study);
    let ran = folder.run(&["sweep", "wells.toml", "--no-figures"]).done();
    // It is long, and nothing else is told meanwhile.
    assert!(ran.err.contains("their manifolds are followed"), "{}", ran.err);
    let told = folder.run(&["inspect", "results/wells/wells.h5", "--json"]).done().json();
    (folder, told["manifolds"].clone())
}

/// The curves of a file with the attractors on their sides.
fn curves_of(folder: &WorkDir) -> Vec<(Vec<[f64; 2]>, [u32; 2])> {
    let results = capsulemap::store::read(&folder.path("results/wells/wells.h5")).expect("a file");
    let column = |name: &str| -> Vec<f64> {
        results.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let (x, v, of) =
        (column("stable_start_x"), column("stable_start_v"), column("stable_point_curve"));
    let [left, right] = [column("stable_attractor_left"), column("stable_attractor_right")];
    let curve = |number: usize| {
        let own = (0..of.len()).filter(|place| of[*place] as usize == number);
        (own.map(|it| [x[it], v[it]]).collect(), [left[number] as u32, right[number] as u32])
    };
    (0..left.len()).map(curve).collect()
}

#[test]
fn a_smooth_boundary_of_two_wells_is_a_few_curves_on_the_boundary_by_another_integrator() {
    let (folder, told) = wells(0.1, 40);
    assert_eq!(told["uncovered"], 0, "{told}");
    assert!(told["curves"].as_array().is_some_and(|it| (1..8).contains(&it.len())), "{told}");
    let unstable = told["unstable"].as_array().expect("a list");
    assert_eq!(unstable.len(), 2);
    assert!(unstable.iter().all(|it| it["end"] == "attractor"), "{told}");
    let curves = curves_of(&folder);
    // Which attractor is in which well is told by a start on the left of a curve.
    let leads = |starts: &[[f64; 2]]| starts.iter().map(|it| Some(well(0.1, *it))).collect();
    let [points, middles] = places(&curves, [4.0, 4.0], count());
    let as_wells = |all: Vec<Beside>| -> Vec<Beside> {
        all.into_iter()
            .map(|it| {
                let start = [0, 1].map(|i| it.at[i] + 1e-5 * it.left[i]);
                let left = well(0.1, start);
                Beside { sides: [left, 1 - left], ..it }
            })
            .collect()
    };
    // Beside the middle of a chord a start so near may lie on the other side of the curve.
    let points = as_wells(points);
    let of_point = |(it, point): (Beside, &Beside)| Beside { sides: point.sides, ..it };
    let middles: Vec<Beside> = middles.into_iter().zip(&points).map(of_point).collect();
    let [at, between] = [points, middles].map(|it| largest(&distances(&it, &leads)));
    println!("wells: points {at:?}, between {between:?}");
    assert!(at.0 < 1e-6 && between.0 < 1e-3, "{at:?} {between:?}");
    assert!(at.1 + between.1 <= count() / 12, "{at:?} {between:?}");
    let text = folder.run(&["inspect", "results/wells/wells.h5"]).done().out;
    assert!(text.contains("boundary as curves: ") && text.contains("beside all"), "{text}");
}

#[test]
fn of_a_fractal_boundary_it_is_told_how_much_no_curve_makes_up() {
    let (folder, told) = wells(0.25, 11);
    println!("{}", told["uncovered"]);
    assert_eq!(told["stopped"], true, "{told}");
    assert!(told["uncovered"].as_u64().is_some_and(|it| it > 5), "{told}");
    let text = folder.run(&["inspect", "results/wells/wells.h5"]).done().out;
    let words = format!(
        "boundary not resolved as curves: {} of {} pairs of neighbouring starts",
        told["uncovered"], told["crossings"]
    );
    assert!(text.contains(&words) && text.contains("stopped at its limits"), "{text}");
}

#[test]
fn a_study_with_manifolds_is_read_as_it_is_written_and_refused_where_there_are_none() {
    let study = capsule(4);
    assert!(study.manifolds);
    let again = Study::parse("again.toml", &study.to_toml()).unwrap_or_else(|it| panic!("{it}"));
    assert!(again.manifolds);
    let without = Study { manifolds: false, ..study.clone() };
    assert_ne!(without.fingerprint(), study.fingerprint());
    assert!(!without.to_toml().contains("manifolds"));
    for (old, new, why) in [
        (
            "name = \"start_y1\"",
            "name = \"start_x1\"",
            "manifolds are for grids over two of start_r, start_y1, start_y2",
        ),
        (
            "[basin]",
            "[start]\nstart_phase = \"1 rad\"\n[basin]",
            "where `start_phase` is `section_phase`",
        ),
        (
            "from = \"-6 mm\"\nto = \"6 mm\"\npoints = 4",
            "values = [\"1 mm\", \"3 mm\", \"2 mm\"]",
            "start_r that all rise or all fall",
        ),
    ] {
        let text = study.text.replace(old, new);
        assert_ne!(text, study.text);
        let faults = Study::parse("study.toml", &text).expect_err(why).to_string();
        assert!(faults.contains("basin.manifolds") && faults.contains(why), "{faults}");
    }
}

#[test]
fn every_end_has_a_name_of_its_own() {
    let names = CurveEnd::ALL.map(CurveEnd::name);
    let mut sorted = names.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(sorted.len(), names.len());
    assert!(CurveEnd::ALL.iter().enumerate().all(|(place, end)| *end as usize == place));
}
