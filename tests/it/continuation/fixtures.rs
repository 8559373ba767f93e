//! Synthetic branches for the tests of the file and the figures of branches.

use capsulemap::branch::{Codim2, Codim2Kind, Curve, End, SpecialKind};
use capsulemap::capsule::Output;
use capsulemap::capsule::branch::{Branch, Found, Point, Special};
use capsulemap::capsule::description::CAPSULE;
use capsulemap::description::Outputs;
use capsulemap::orbit::matrix::Complex;
use capsulemap::run::{Continued, NotContinued};
use capsulemap::store::{self, Dataset};
use capsulemap::study::Study;

/// A study of three branches, the last of which leads nowhere.
pub const STUDY: &str = r#"title = "Continued"
outputs = ["progression_speed", "work_net"]
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "omega"
from = "110 rad/s"
to = "180 rad/s"
points = 8
[[axes]]
name = "p_d"
values = ["2 N", "4 N"]
[[branches]]
name = "moving on"
along = "omega"
at = { omega = "155 rad/s", p_d = "4 N" }
second = { name = "p_d", from = "1 N", to = "5 N" }
doublings = 1
[[branches]]
name = "in amplitude"
along = "p_d"
at = { omega = "120 rad/s", p_d = "3 N" }
orbit = "newton"
period = 1
[[branches]]
name = "lost"
along = "omega"
at = { omega = "155 rad/s", p_d = "4 N" }
[[figures]]
name = "b"
kind = "bifurcation"
at = { p_d = "4 N" }
[[figures]]
name = "c"
kind = "curves"
[[figures]]
name = "m"
kind = "map"
"#;

/// An orbit whose motion is determined by `height`.
pub fn point(parameter: f64, period: usize, height: f64, multiplier: f64) -> Point {
    let mut outputs = Outputs::unknown(&CAPSULE);
    outputs[Output::ProgressionSpeed] = 1e-3 * height;
    outputs[Output::WorkNet] = 2e-3 + 1e-4 * height * height;
    Point {
        parameter,
        section: vec![[1e-3 * height, 0.1 * height, 0.0].into(); period],
        multipliers: [multiplier, 0.1, 0.0].map(|re| Complex { re, im: 0.0 }).to_vec(),
        residual: 1e-13,
        measured: outputs,
        sequence: usize::from(height > 2.0),
    }
}

/// Along a branch that turns back twice: the parameter at `share` of its length, and the height there.
fn bent(share: f64) -> (f64, f64) {
    let s = 2.4 * share - 1.2;
    (145.0 + 12.0 * s - 9.5 * s * s * s, 3.0 * s + 1.0)
}

/// The branch that turns back twice, with one special point of each kind.
pub fn bent_branch(count: usize) -> Branch {
    let at = |place: f64| bent(place / (count - 1) as f64);
    let parameter = |place: usize| at(place as f64).0;
    let rising = |place: usize| parameter(place + 1) > parameter(place);
    let turns: Vec<usize> =
        (0..count - 2).filter(|&place| rising(place) != rising(place + 1)).collect();
    let stable = |place: usize| turns.iter().filter(|&&turn| place > turn).count() != 1;
    let orbit = |place: f64, multiplier: f64| {
        let (parameter, height) = at(place);
        point(parameter, 1, height, multiplier)
    };
    let points = (0..count)
        .map(|place| orbit(place as f64, if stable(place) { 0.8 } else { 1.4 }))
        .collect();
    let special = |kind, after: usize| Special {
        kind,
        after,
        point: orbit(after as f64 + 0.5, 1.0),
        curve: None,
    };
    let mut specials: Vec<Special> =
        turns.iter().map(|&turn| special(SpecialKind::Fold, turn)).collect();
    let others = [
        (SpecialKind::PeriodDoubling, 1),
        (SpecialKind::Grazing, 2),
        (SpecialKind::EventSequence, 3),
        (SpecialKind::NeimarkSacker, 4),
    ];
    specials.extend(others.map(|(kind, place)| special(kind, count * place / 24)));
    specials.sort_by_key(|special| special.after);
    Branch { period: 1, parent: None, points, special: specials, ends: [End::Bound; 2] }
}

/// One point of codimension 2 of each kind, spread over a curve.
fn codim2_on(points: &[[f64; 2]]) -> Vec<Codim2> {
    let kinds = Codim2Kind::NAMES.iter().zip((1..).step_by(3));
    let points = kinds.map(|((_, kind), after)| Codim2 {
        kind: *kind,
        after,
        parameters: points[after],
        section: vec![1e-3, 0.1, 0.0],
        multipliers: [1.0, 0.1, 0.0].map(|re| Complex { re, im: 0.0 }).to_vec(),
    });
    points.collect()
}

/// What the first branch of `STUDY` might lead to.
pub fn found() -> Found {
    let mut first = bent_branch(121);
    let is_doubling = |special: &Special| special.kind == SpecialKind::PeriodDoubling;
    let doubling = first.special.iter().position(is_doubling).expect("one doubles");
    let left = first.special[doubling].point.clone();
    let points = (0..40)
        .map(|step| {
            let share = f64::from(step) / 39.0;
            let height = left.section[0][0] * 1e3 - share;
            let mut orbit = point(left.parameter, 2, height, if step < 25 { 0.5 } else { -1.3 });
            orbit.parameter += 12.0 * share;
            let apart = 2e-3 * share.sqrt();
            orbit.section[0][0] += apart;
            orbit.section[1][0] -= apart;
            // The engine may begin the period at any of its cycles.
            orbit.section.rotate_left(usize::from(step % 7 == 3));
            orbit
        })
        .collect();
    let (parent, ends) = (Some((0, doubling)), [End::Merged, End::MostPoints]);
    let doubled = Branch { period: 2, parent, points, special: Vec::new(), ends };
    let curve = |special: usize, bend: f64| {
        let at = first.special[special].point.parameter;
        let step = |place: i32| {
            let second = 1.0 + 0.1 * f64::from(place);
            [at + bend * (second - 4.0) + 0.7 * bend * (second - 4.0) * (second - 4.0), second]
        };
        let kind = first.special[special].kind;
        let points: Vec<[f64; 2]> = (0..=40).map(step).collect();
        let ends = [End::Bound, End::Corner];
        let codim2 = if special == 0 { codim2_on(&points) } else { Vec::new() };
        Curve { kind, through: (0, special), period: 1, points, codim2, ends }
    };
    let bends = [2.0, -1.5, 0.8, 2.6, -2.2, 1.2];
    let curves = (0..first.special.len()).zip(bends).map(|(at, bend)| curve(at, bend)).collect();
    first.special.iter_mut().enumerate().for_each(|(at, special)| special.curve = Some(at));
    Found { branches: vec![first, doubled], curves, not_left: Vec::new() }
}

/// What the branches of `STUDY` might lead to.
pub fn continued() -> Vec<Continued> {
    let orbits = (0..30).map(|step| point(1.0 + 0.1 * f64::from(step), 1, 0.5, 0.3)).collect();
    let ends = [End::Bound; 2];
    let plain = Branch { period: 1, parent: None, points: orbits, special: Vec::new(), ends };
    let second = Found { branches: vec![plain], curves: Vec::new(), not_left: Vec::new() };
    vec![Ok(found()), Ok(second), Err(NotContinued::NoOrbit)]
}

/// The study of these branches.
pub fn study() -> Study {
    Study::parse("study.toml", STUDY).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The file of `STUDY` with branches alone.
pub fn branches_alone() -> Dataset {
    let study = study();
    with_branches(store::frame(&study), &study, &continued())
}

/// `dataset` with what came of the branches of `study`.
pub fn with_branches(mut dataset: Dataset, study: &Study, continued: &[Continued]) -> Dataset {
    store::add_branches(&mut dataset, study, &study.branches, continued);
    dataset
}
