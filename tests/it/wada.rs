//! The test for Wada basins by merging: a map and a flow that have them, basins that have not, and distances by looking at every pair.

use std::f64::consts::TAU;

use capsulemap::attractor::{Label, Wada, wada};
use capsulemap::store;
use serde_json::Value;

use super::basin_measures::{grebogi, map_labels, newton};
use super::program::{TWO_MOTIONS, WorkDir};

fn of(shape: &[usize], labels: &[Label], attractors: usize) -> Option<Wada> {
    wada(shape, |start| labels[start], attractors)
}

#[test]
fn the_basins_of_newtons_method_are_wada_to_a_few_starts_at_every_resolution() {
    // Each point of the Julia set lies on the boundaries of all three basins: on a finer grid the boundaries are nearer.
    let mut before = f64::INFINITY;
    for side in [100, 200, 400] {
        let labels = map_labels(side, [[-1.0, 1.0]; 2], newton);
        let found = of(&[side, side], &labels, 3).expect("three basins");
        let starts = found.distance();
        println!(
            "Newton, {side}: {starts:.2} starts, within {:?}; {:?}",
            found.least_radius(),
            found.scales
        );
        assert!(starts <= 5.0 && found.least_radius().is_some(), "{found:?}");
        assert_eq!((found.unknown, found.pairs.len()), (0, 6));
        let in_plane = starts / side as f64;
        assert!(in_plane < 0.7 * before, "{in_plane} {before}");
        before = in_plane;
        // The test tells something: boundaries as wide as that leave most starts free.
        let scale = found.scales.iter().find(|it| it.farther == 0.0).expect("a scale");
        assert!(scale.covered < 0.4, "{scale:?}");
    }
}

#[test]
fn sectors_that_meet_at_a_point_are_not_wada() {
    // Three sectors: their boundaries are three rays, each of which two basins share.
    let side = 240;
    let sector = |[x, y]: [f64; 2]| Some((y.atan2(x).rem_euclid(TAU) / (TAU / 3.0)) as u32 % 3);
    let labels = map_labels(side, [[-1.0, 1.0]; 2], sector);
    let found = of(&[side, side], &labels, 3).expect("three basins");
    println!("sectors: {:?}", found.scales);
    assert_eq!(found.least_radius(), None);
    // Most of a boundary is far from the third ray at any radius.
    assert!(found.scales.iter().all(|it| it.farther > 0.3), "{found:?}");
    // The ray to (-1, 0) or one of the others ends on the edge of the square, a third of a turn from the nearest other ray.
    assert!((90.0..240.0).contains(&found.distance()), "{}", found.distance());
}

#[test]
fn stripes_have_the_distances_of_their_edges() {
    // Three stripes of 32 columns: the outer boundaries are 32 columns apart, and each is half of that of the middle one.
    let labels: Vec<Label> =
        (0..64 * 96).map(|start| Label::Attractor((start % 96 / 32) as u32)).collect();
    let found = of(&[64, 96], &labels, 3).expect("three basins");
    assert_eq!(found.boundaries, [128, 256, 128]);
    let told = |of: u32, from: u32| {
        let pair = found.pairs.iter().find(|it| (it.of, it.from) == (of, from));
        pair.map(|it| (it.distance, it.farther.clone())).expect("a pair")
    };
    assert_eq!(told(0, 1), (0.0, vec![0.0; 3]));
    assert_eq!(told(1, 0), (32.0, vec![0.5; 3]));
    assert_eq!(told(0, 2), (32.0, vec![1.0; 3]));
    assert_eq!(found.distance(), 32.0);
    assert_eq!(found.scales.iter().map(|it| it.radius).collect::<Vec<_>>(), [1, 2, 4]);
    // Within one of the boundary of the middle stripe lie eight columns of 96.
    assert!((found.scales[0].covered - 8.0 / 96.0).abs() < 1e-12);
}

#[test]
fn two_basins_have_no_test_though_their_boundary_is_fractal() {
    let labels = map_labels(128, [[0.0, TAU], [-0.5, 0.5]], grebogi);
    assert_eq!(of(&[128, 128], &labels, 2), None);
}

/// The same by the definition: every start with every other.
fn by_pairs(shape: &[usize], labels: &[Label], attractors: u32) -> Vec<(u32, u32, f64, f64)> {
    let place = |mut start: usize| {
        let mut place = vec![0; shape.len()];
        for (at, length) in place.iter_mut().zip(shape).rev() {
            (*at, start) = (start % length, start / length);
        }
        place
    };
    let all = 0..labels.len();
    let places: Vec<Vec<usize>> = all.clone().map(place).collect();
    let square = |a: usize, b: usize| {
        let apart = places[a].iter().zip(&places[b]).map(|(a, b)| a.abs_diff(*b).pow(2));
        apart.sum::<usize>()
    };
    let boundary = |number: u32| {
        let inside = |start: usize| labels[start] == Label::Attractor(number);
        let known = |start: usize| labels[start] != Label::Undecided;
        let meets = |start: &usize| {
            all.clone().any(|it| {
                square(*start, it) == 1
                    && known(it)
                    && known(*start)
                    && inside(it) != inside(*start)
            })
        };
        all.clone().filter(meets).collect::<Vec<usize>>()
    };
    let boundaries: Vec<Vec<usize>> = (0..attractors).map(boundary).collect();
    let mut found = Vec::new();
    for of in 0..attractors {
        for from in (0..attractors).filter(|it| *it != of) {
            let others = &boundaries[from as usize];
            let nearest = boundaries[of as usize]
                .iter()
                .map(|start| others.iter().map(|it| square(*start, *it)).min().expect("some"));
            let nearest: Vec<usize> = nearest.collect();
            let beyond = nearest.iter().filter(|it| **it > 1).count() as f64;
            let largest = *nearest.iter().max().expect("some") as f64;
            found.push((of, from, largest.sqrt(), beyond / nearest.len() as f64));
        }
    }
    found
}

#[test]
fn boundaries_and_distances_are_those_of_looking_at_every_pair() {
    let mut random = fastrand::Rng::with_seed(11);
    for shape in [vec![16, 21], vec![24, 16], vec![16, 16, 17]] {
        let count: usize = shape.iter().product();
        // Patches of cells, so that boundaries are not everywhere.
        let mut labels = vec![Label::Attractor(0); count];
        for _ in 0..6 {
            let (first, length) = (random.usize(..count), random.usize(1..count / 3));
            let label = match random.u32(..5) {
                number @ 0..4 => Label::Attractor(number),
                _ => Label::Undecided,
            };
            labels[first..count.min(first + length)].fill(label);
        }
        for number in 0..4 {
            labels[random.usize(..count)] = Label::Attractor(number);
        }
        let Some(found) = of(&shape, &labels, 4) else {
            // A start beside none but those that are not known, or none of a number.
            continue;
        };
        let told: Vec<_> =
            found.pairs.iter().map(|it| (it.of, it.from, it.distance, it.farther[0])).collect();
        assert_eq!(told, by_pairs(&shape, &labels, 4));
        let unknown = labels.iter().filter(|it| **it == Label::Undecided).count();
        assert_eq!(found.unknown, unknown);
    }
}

#[test]
fn a_file_of_two_basins_says_that_the_test_is_not_applicable() {
    let axis = |name: &str, most: &str| {
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"-{most}\"\nto = \"{most}\"\npoints = 16\n")
    };
    let axes = axis("start_r", "6 mm") + &axis("start_y1", "1.5 m/s");
    let folder = WorkDir::new();
    folder.put("two.toml", format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}"));
    folder.run(&["sweep", "two.toml", "--no-figures"]).done();
    let told = folder.run(&["inspect", "results/two/two.h5"]).done().out;
    let line = "Wada test by merging: not applicable: 2 attractors, where it compares the boundaries of three or more";
    assert!(told.contains(line), "{told}");
    let told = folder.run(&["inspect", "results/two/two.h5", "--json"]).json();
    assert_eq!(told["wada"]["applicable"], false, "{told}");
}

/// The Duffing oscillator of Aguirre and Sanjuan (2002), whose three basins are Wada.
const DUFFING: &str = r#"[system]
name = "Duffing oscillator with two wells"
states = { x = "1", v = "1" }
section = { every = "2*pi" }

[system.parameters]
c = 0.15
p = 0.245

[system.rates]
x = "v"
v = "p*cos(t) - c*v + x - x^3"
"#;

/// The basins of the oscillator on a grid of so many starts a side, as the file of results has them, and what is told of them.
fn duffing(side: usize) -> (store::Dataset, Value, String) {
    let axis = |name: &str| {
        format!("[[axes]]\nname = \"start_{name}\"\nfrom = -2.0\nto = 2.0\npoints = {side}\n")
    };
    let folder = WorkDir::new();
    folder.put("duffing.toml", DUFFING);
    let study = format!(
        "system = \"duffing.toml\"\n{}{}[protocol]\npoints = 1\n[[figures]]\nname = \"basin\"\nkind = \"basin\"\n",
        axis("x"),
        axis("v")
    );
    folder.put("wells.toml", study);
    folder.run(&["sweep", "wells.toml", "--formats", "png"]).done();
    let file = "results/wells/wells.h5";
    let dataset = store::read(&folder.path(file)).expect("a file of results");
    let json = folder.run(&["inspect", file, "--json"]).json();
    (dataset, json, folder.run(&["inspect", file]).done().out)
}

/// With `WADA_SIDE=600` that many starts a side, else a few, which tell no more than that the file has the numbers.
#[test]
fn the_basins_of_a_flow_are_wada_to_a_few_starts() {
    let wanted = std::env::var("WADA_SIDE").ok();
    let side = wanted.as_ref().map_or(48, |it| it.parse().expect("a number"));
    let (dataset, told, text) = duffing(side);
    let column = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let labels: Vec<Label> = column("attractor")
        .into_iter()
        .map(|it| if it < 0.0 { Label::Undecided } else { Label::Attractor(it as u32) })
        .collect();
    let attractors = column("attractor_period").len();
    let found = of(&[side, side], &labels, attractors).expect("three basins or more");
    println!("Duffing, {side}: {} attractors\n{text}", attractors);
    assert_eq!(
        column("wada_farther"),
        found.scales.iter().map(|it| it.farther).collect::<Vec<_>>()
    );
    assert_eq!(
        column("wada_distance"),
        found.pairs.iter().map(|it| it.distance).collect::<Vec<_>>()
    );
    let boundaries = found.boundaries.iter().map(|it| *it as f64);
    assert_eq!(column("wada_boundary"), boundaries.collect::<Vec<_>>());
    assert_eq!(column("wada_least_radius"), [found.least_radius().unwrap_or(0) as f64]);
    assert_eq!(told["wada"]["least_radius"].as_u64(), found.least_radius().map(|it| it as u64));
    assert_eq!(told["wada"]["pairs"].as_array().map(Vec::len), Some(found.pairs.len()));
    assert_eq!(text.contains("not Wada at these radii"), found.least_radius().is_none(), "{text}");
    if wanted.is_some() {
        assert!(found.least_radius().is_some_and(|radius| radius <= 8), "{found:?}");
    }
}
