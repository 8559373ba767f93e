//! The uncertainty exponent against boundaries of known dimension, and against one that has none.

use std::f64::consts::{PI, TAU};

use capsulemap::attractor::{Label, Uncertainty, uncertainty};
use capsulemap::store;

use super::program::{TWO_MOTIONS, WorkDir};

/// What the labels of a function over the unit square say, on a grid of so many starts a side.
fn of(side: usize, label: impl Fn(f64, f64) -> u32) -> Uncertainty {
    let at = |index: usize| index as f64 / (side - 1) as f64;
    let labels: Vec<Label> =
        (0..side * side).map(|it| Label::Attractor(label(at(it / side), at(it % side)))).collect();
    uncertainty(&[side, side], |start| labels[start]).expect("a boundary")
}

/// So many standard errors a local slope is from the truth, for each that has an error.
fn deviations(found: &Uncertainty, truth: f64) -> Vec<f64> {
    let known = found.slopes.iter().filter(|it| it.slope.error > 0.0 && it.slope.error.is_finite());
    known.map(|it| (it.slope.value - truth) / it.slope.error).collect()
}

/// A random ellipse within the square: its centre, its half axes, and the direction of the first.
fn ellipse(draw: &mut fastrand::Rng) -> [f64; 5] {
    let [x, y, a, b, angle] = std::array::from_fn(|_| draw.f64());
    [0.4 + 0.2 * x, 0.4 + 0.2 * y, 0.1 + 0.25 * a, 0.1 + 0.25 * b, PI * angle]
}

fn inside(ellipse: &[f64; 5], x: f64, y: f64) -> bool {
    let [x0, y0, a, b, angle] = *ellipse;
    let (sin, cos) = angle.sin_cos();
    let (along, across) = ((x - x0) * cos + (y - y0) * sin, (y - y0) * cos - (x - x0) * sin);
    (along / a).hypot(across / b) < 1.0
}

#[test]
fn smooth_boundaries_have_the_exponent_one_within_the_errors() {
    // The outline of an ellipse is smooth: dimension 1, exponent 1.
    let mut draw = fastrand::Rng::with_seed(7);
    const REPETITIONS: usize = 100;
    let (mut within, mut scaling, mut all) = (0, 0, Vec::new());
    for _ in 0..REPETITIONS {
        let outline = ellipse(&mut draw);
        let found = of(200, |x, y| u32::from(inside(&outline, x, y)));
        let off = (found.exponent.value - 1.0).abs();
        within += usize::from(off <= 2.0 * found.exponent.error);
        scaling += usize::from(found.scales);
        all.extend(deviations(&found, 1.0));
    }
    let spread = (all.iter().map(|it| it * it).sum::<f64>() / all.len() as f64).sqrt();
    println!("within two errors {within}, scaling {scaling} of {REPETITIONS}; spread {spread:.2}");
    assert!(within >= 90 && scaling >= 97, "{within} {scaling}");
    // Errors are those of the slopes, neither half nor twice as large.
    assert!((0.6..1.5).contains(&spread), "{spread}");
}

/// The ends of the gaps of a random Cantor set down to a `width`: of each interval a third is left out, at a random place.
fn gaps(from: f64, to: f64, width: f64, draw: &mut fastrand::Rng, found: &mut Vec<[f64; 2]>) {
    let length = to - from;
    if length < width {
        return;
    }
    let begin = from + 2.0 / 3.0 * length * draw.f64();
    let end = begin + length / 3.0;
    gaps(from, begin, width, draw, found);
    found.push([begin, end]);
    gaps(end, to, width, draw, found);
}

#[test]
fn the_boundary_at_a_cantor_set_has_its_dimension() {
    // Two parts u and 2/3 - u of an interval, u uniform: the dimension s of the set has the mean of u^s + (2/3 - u)^s one, so
    // 2 (2/3)^s = 1 + s, and the boundary, lines over it, 1 + s.
    let (mut low, mut high) = (0.3_f64, 0.9_f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let is_below = 2.0 * (2.0_f64 / 3.0).powf(middle) > 1.0 + middle;
        (low, high) = if is_below { (middle, high) } else { (low, middle) };
    }
    let truth = 1.0 - low;
    assert!((truth - 0.4195).abs() < 1e-3, "{truth}");
    let mut draw = fastrand::Rng::with_seed(3);
    const REPETITIONS: usize = 40;
    let (mut within, mut sum) = (0, 0.0);
    for _ in 0..REPETITIONS {
        let mut found = Vec::new();
        gaps(0.0, 1.0, 1e-5, &mut draw, &mut found);
        let label = |x: f64| {
            let place = found.partition_point(|gap| gap[1] < x);
            let is_in_gap = found.get(place).is_some_and(|gap| gap[0] <= x);
            // Each gap has a number of its own, so that what lies between two starts is seen.
            if is_in_gap { 1 + place as u32 } else { 0 }
        };
        // One line of labels serves all others.
        let line: Vec<Label> =
            (0..512).map(|it| Label::Attractor(label(it as f64 / 511.0))).collect();
        let found = uncertainty(&[512, 512], |start| line[start / 512]).expect("a boundary");
        within += usize::from((found.exponent.value - truth).abs() <= 2.0 * found.exponent.error);
        sum += found.exponent.value;
    }
    let mean = sum / REPETITIONS as f64;
    println!("exponent {mean:.3} on average, {truth:.3} expected; within two errors {within}");
    assert!((mean - truth).abs() < 0.05, "{mean} {truth}");
    assert!(within >= 36, "{within}");
}

#[test]
fn a_boundary_that_is_smooth_below_a_length_alone_is_told_to_have_no_exponent() {
    // y = 1/2 + 0.05 sin(75 TAU x): a strip that is filled for boxes wider than a wave, of 8 starts, and a smooth curve below.
    let wavy = of(600, |x, y| u32::from(y > 0.5 + 0.05 * (75.0 * TAU * x).sin()));
    println!("{wavy:?}");
    assert!(!wavy.scales);
    let slopes: Vec<f64> = wavy.slopes.iter().map(|it| it.slope.value).collect();
    let least = slopes.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = slopes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    assert!(greatest > 0.8 && least < 0.5, "{slopes:?}");
    // The error covers them all, each with its own.
    for it in &wavy.slopes {
        let off = (it.slope.value - wavy.exponent.value).abs();
        assert!(off <= wavy.exponent.error + it.slope.error + 1e-12, "{it:?}");
    }
    // Counts and shares tell the same slopes.
    for pair in wavy.sizes.windows(2) {
        let share = |at: usize| pair[at].crossed as f64 / pair[at].boxes as f64;
        let slope = (share(1) / share(0)).log2();
        let told = wavy.slopes.iter().find(|it| it.spans[0] == pair[0].span).expect("a slope");
        assert!((slope - told.slope.value).abs() < 1e-12, "{slope} {told:?}");
    }
}

#[test]
fn the_file_and_inspect_tell_what_the_labels_say() {
    let axis = |name: &str, most: &str| {
        format!("[[axes]]\nname = \"{name}\"\nfrom = \"-{most}\"\nto = \"{most}\"\npoints = 96\n")
    };
    let axes = axis("start_r", "6 mm") + &axis("start_y1", "1.5 m/s");
    let folder = WorkDir::new();
    folder.put("two.toml", format!("{TWO_MOTIONS}omega = \"155 rad/s\"\n{axes}"));
    folder.run(&["sweep", "two.toml"]).done();
    let file = "results/two/two.h5";
    let dataset = store::read(&folder.path(file)).expect("a file of results");
    let column = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    let labels = column("attractor");
    let label = |start: usize| match labels[start] {
        number if number < 0.0 => Label::Undecided,
        number => Label::Attractor(number as u32),
    };
    let found = uncertainty(&[96, 96], label).expect("a boundary");
    assert_eq!(column("uncertainty_exponent"), [found.exponent.value]);
    assert_eq!(column("uncertainty_exponent_error"), [found.exponent.error]);
    assert_eq!(column("boundary_dimension"), [2.0 - found.exponent.value]);
    assert_eq!(column("uncertainty_scales"), [f64::from(u8::from(found.scales))]);
    assert_eq!(column("uncertainty_span"), [1.0, 2.0, 4.0]);
    let slopes: Vec<f64> = found.slopes.iter().map(|it| it.slope.value).collect();
    assert_eq!(column("uncertainty_slope")[..2], slopes[..]);
    assert!(column("uncertainty_slope")[2].is_nan());
    let told = folder.run(&["inspect", file]).done().out;
    let line = format!("boundary of the basins: dimension {:.3} ± ", 2.0 - found.exponent.value);
    assert!(told.contains(&line), "{told}");
    assert_eq!(told.contains("\n  no power law: "), !found.scales, "{told}");
}
