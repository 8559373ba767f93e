//! Points of codimension 2 against closed forms, on each of the curves that meet there, and curves of Neimark-Sacker points against
//! finite differences.

mod mapped;
mod van_der_pol;

use capsulemap_engine::branch::Codim2Kind::{self, *};
use capsulemap_engine::branch::{self, Codim2, Curve, End, FoundOf, SpecialKind};
use capsulemap_engine::flow::System;
use capsulemap_engine::orbit::matrix::{Matrix, determinant, less_identity, solve};
use capsulemap_engine::orbit::return_map::{Cycles, returned};

use mapped::Mapped;
use van_der_pol::VanDerPol;

/// The longest steps that are tried.
const STEPS: [f64; 3] = [0.02, 0.05, 0.15];

/// Hénon's map beside a stable fixed point of z, -0.4, which touches no wall.
const HENON: Mapped<f64> = Mapped {
    a: 0.3,
    b: 0.3,
    s: 0.0,
    q: 1.0,
    k: 0.0,
    c: -0.16,
    high: 1.0,
    skew: 0.5,
    wall: 5.0,
    kick: 0.0,
};

/// A parameter with the range in which it is followed.
type Range = (&'static str, [f64; 2]);

/// What is found along one parameter, and along a second one.
fn followed<M: System<D, Parameter = &'static str>, const D: usize>(
    system: M,
    section: [f64; D],
    [(along, range), second]: [Range; 2],
    longest_step: f64,
) -> FoundOf<M, D> {
    let request = branch::Request {
        system,
        section,
        period: 1,
        along,
        range,
        doublings: 0,
        second: Some(second),
        curve_range: None,
        longest_step,
        most_points: 4000,
        tolerance: 1e-12,
    };
    branch::follow(&request).expect("a branch")
}

/// The only curve of a kind.
fn curve<O, P>(found: &branch::Found<O, P>, kind: SpecialKind) -> &Curve {
    let curves: Vec<&Curve> = found.curves.iter().filter(|curve| curve.kind == kind).collect();
    assert_eq!(curves.len(), 1, "{:?}", found.curves);
    curves[0]
}

/// Sure that a curve has these points of codimension 2 and no others, in either order.
fn assert_points(curve: &Curve, expected: &[(Codim2Kind, [f64; 2])]) {
    let told: Vec<_> = curve.codim2.iter().map(|it| (it.kind, it.parameters)).collect();
    assert_eq!(told.len(), expected.len(), "{told:?}");
    for (kind, at) in expected {
        let same = told.iter().filter(|it| it.0 == *kind);
        let away = same.map(|(_, [a, b])| (a - at[0]).abs().max((b - at[1]).abs()));
        let least = away.fold(f64::INFINITY, f64::min);
        assert!(least < 1e-11, "{kind:?}: {least:e} in {told:?}");
    }
    // Each lies no farther from the points beside it than neighbours are apart.
    let apart = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let step = curve.points.windows(2).map(|pair| apart(&pair[0], &pair[1])).fold(0.0, f64::max);
    for Codim2 { after, parameters, .. } in &curve.codim2 {
        let beside = &curve.points[*after..after + 2];
        assert!(beside.iter().all(|it| apart(it, parameters) <= step), "{after} {parameters:?}");
    }
}

#[test]
fn folds_and_doublings_of_a_plane_map_meet_where_the_closed_form_says() {
    let x = -0.65 + libm::sqrt(0.65 * 0.65 + 0.3);
    for step in STEPS {
        let ranges = [("a", [-1.2, 3.5]), ("b", [-1.4, 1.4])];
        let found = followed(HENON, [x, x, -0.4], ranges, step);
        let both = (FoldFlip, [0.0, -1.0]);
        assert_points(curve(&found, SpecialKind::Fold), &[(Resonance1, [-1.0, 1.0]), both]);
        assert_points(
            curve(&found, SpecialKind::PeriodDoubling),
            &[(Resonance2, [3.0, 1.0]), both],
        );
        let ranges = [("b", [0.3, 1.3]), ("a", [-1.5, 3.5])];
        let x = -0.65 + libm::sqrt(0.65 * 0.65 + 1.0);
        let found = followed(Mapped { a: 1.0, ..HENON }, [x, x, -0.4], ranges, step);
        let torus = curve(&found, SpecialKind::NeimarkSacker);
        assert_eq!(torus.ends, [End::StrongResonance; 2]);
        assert_points(
            torus,
            &[
                (Resonance1, [1.0, -1.0]),
                (Resonance4, [1.0, 0.0]),
                (Resonance3, [1.0, 1.25]),
                (Resonance2, [1.0, 3.0]),
            ],
        );
        let away = torus.points.iter().map(|[b, _]| (b - 1.0).abs()).fold(0.0, f64::max);
        assert!(away < 1e-12, "{away:e}");
        let angles = torus.codim2.iter().map(|it| (it.kind, it.multipliers[0].re));
        for (kind, cosine) in angles.filter(|it| [Resonance3, Resonance4].contains(&it.0)) {
            let right = if kind == Resonance3 { -0.5 } else { 0.0 };
            assert!((cosine - right).abs() < 1e-11, "{kind:?} {cosine}");
        }
    }
}

#[test]
fn a_cusp_is_found_from_either_parameter() {
    let cubic = Mapped { s: 2.0, q: 0.0, k: 1.0, ..HENON };
    for step in STEPS {
        let ranges = [("a", [-0.5, 0.5]), ("s", [0.9, 3.0])];
        let found = followed(Mapped { a: 0.3, ..cubic }, [1.0, 1.0, -0.4], ranges, step);
        let folds = found.branches[0].special.iter().filter(|it| it.kind == SpecialKind::Fold);
        let curves: Vec<_> = folds.map(|it| it.curve).collect();
        assert!(curves.len() == 2 && curves[0].is_some() && curves[0] == curves[1], "{curves:?}");
        assert_points(curve(&found, SpecialKind::Fold), &[(Cusp, [0.0, 1.3])]);
        let ranges = [ranges[1], ranges[0]];
        let found = followed(Mapped { a: 0.1, ..cubic }, [-0.76, -0.76, -0.4], ranges, step);
        assert_points(curve(&found, SpecialKind::Fold), &[(Cusp, [1.3, 0.0])]);
    }
}

#[test]
fn a_pair_on_the_unit_circle_meets_a_third_multiplier_on_each_curve() {
    let x = -0.95 + libm::sqrt(0.95 * 0.95 + 1.0);
    let system = Mapped { a: 1.0, b: 0.9, ..HENON };
    let (b, c) = (("b", [0.6, 1.2]), ("c", [-1.4, 0.3]));
    for step in STEPS {
        let found = followed(system, [x, x, -0.4], [b, c], step);
        assert_points(
            curve(&found, SpecialKind::NeimarkSacker),
            &[(FoldNeimarkSacker, [1.0, 0.0]), (FlipNeimarkSacker, [1.0, -1.0])],
        );
        let found = followed(system, [x, x, -0.4], [c, b], step);
        assert_points(curve(&found, SpecialKind::Fold), &[(FoldNeimarkSacker, [0.0, 1.0])]);
        let flips = [(FlipNeimarkSacker, [-1.0, 1.0])];
        assert_points(curve(&found, SpecialKind::PeriodDoubling), &flips);
    }
}

#[test]
fn a_neutral_saddle_is_no_point_of_codimension_two() {
    // At the fold of z the other two multipliers are real and have the product one where b is: 3 and 1/3.
    let x = -(10.0 / 3.0) / 2.0;
    let (a, b) = (x * x + 1.9 * x, 0.9);
    let ranges = [("c", [-0.5, 0.3]), ("b", [0.85, 1.2])];
    let found = followed(Mapped { a, b, ..HENON }, [x, x, -0.4], ranges, 0.05);
    assert_points(curve(&found, SpecialKind::Fold), &[]);
}

#[test]
fn extrema_touch_on_each_of_the_curves_that_meet() {
    let at = |a: f64| -0.65 + libm::sqrt(0.65 * 0.65 + a);
    for step in STEPS {
        let system = Mapped { wall: 1.6, ..HENON };
        let ranges = [("a", [-0.6, 1.0]), ("wall", [0.01, 3.0])];
        let found = followed(system, [at(0.3), at(0.3), -0.4], ranges, step);
        let meet = (FoldGrazing, [-0.4225, 0.025]);
        let touches = [meet, (DoubleGrazing, [0.0, 1.0])];
        assert_points(curve(&found, SpecialKind::Grazing), &touches);
        let folds = [meet, (FoldGrazing, [-0.4225, 0.675])];
        assert_points(curve(&found, SpecialKind::Fold), &folds);

        let ranges = [("a", [0.1, 1.5]), ("wall", [1.01, 3.0])];
        let found = followed(system, [at(0.3), at(0.3), -0.4], ranges, step);
        let meet = (DoublingGrazing, [1.2675, 1.975]);
        assert_points(curve(&found, SpecialKind::Grazing), &[meet]);
        let doublings = [meet, (DoublingGrazing, [1.2675, 1.325])];
        assert_points(curve(&found, SpecialKind::PeriodDoubling), &doublings);

        let x = -0.95 + libm::sqrt(0.95 * 0.95 + 1.0);
        let ranges = [("b", [0.6, 1.2]), ("wall", [1.05, 3.0])];
        let found = followed(Mapped { a: 1.0, b: 0.9, ..system }, [x, x, -0.4], ranges, step);
        let x = libm::sqrt(2.0) - 1.0;
        let meet = (NeimarkSackerGrazing, [1.0, 1.0 + 1.5 * x]);
        assert_points(curve(&found, SpecialKind::Grazing), &[meet]);
        let tori = [meet, (NeimarkSackerGrazing, [1.0, 1.0 + 0.5 * x])];
        assert_points(curve(&found, SpecialKind::NeimarkSacker), &tori);
    }
}

#[test]
fn a_multiplier_that_jumps_over_minus_one_is_told_as_unresolved() {
    // Where the wall is met along the curve of folds, the multiplier of z is 0.2 on one side and -1.8 on the other.
    let x = -0.65 + libm::sqrt(0.65 * 0.65 + 0.3);
    let ranges = [("a", [-0.6, 1.0]), ("wall", [0.3, 3.0])];
    let system = Mapped { wall: 1.6, kick: 2.0, ..HENON };
    let found = followed(system, [x, x, -0.4], ranges, 0.05);
    let folds = curve(&found, SpecialKind::Fold);
    let kinds: Vec<_> = folds.codim2.iter().map(|it| it.kind).collect();
    assert!(kinds == [FoldGrazing, Unresolved] || kinds == [Unresolved, FoldGrazing], "{kinds:?}");
    let [first, second] = &folds.codim2[..] else { panic!("two points") };
    assert_eq!(first.after, second.after);
    let unresolved = if first.kind == Unresolved { first } else { second };
    let beside = &folds.points[unresolved.after..unresolved.after + 2];
    assert!(beside.contains(&unresolved.parameters));
}

/// Where a section point returns to.
fn mapped(system: &VanDerPol<f64>, point: [f64; 2]) -> [f64; 2] {
    let cycles = Cycles { count: 1, tolerance: 1e-14 };
    returned(system, point, &cycles, |_| ()).expect("a return")
}

/// The derivative of the return map, by central differences.
fn by_differences(system: &VanDerPol<f64>, point: [f64; 2]) -> Matrix<2> {
    let mut slopes = [[0.0; 2]; 2];
    for column in 0..2 {
        let [low, high] = [-1e-5, 1e-5].map(|by| {
            let mut beside = point;
            beside[column] += by;
            mapped(system, beside)
        });
        for (row, slope) in slopes.iter_mut().enumerate() {
            slope[column] = (high[row] - low[row]) / 2e-5;
        }
    }
    slopes
}

/// The fixed point of the return map near a guess, by Newton's method with these differences.
fn fixed(system: &VanDerPol<f64>, mut point: [f64; 2]) -> [f64; 2] {
    for _ in 0..8 {
        let end = mapped(system, point);
        let moved = [end[0] - point[0], end[1] - point[1]];
        let slopes = less_identity(&by_differences(system, point));
        let step = solve(slopes, moved).expect("no fold");
        point = [point[0] - step[0], point[1] - step[1]];
    }
    point
}

/// What is found of van der Pol's oscillator from a force of this frequency to which it is locked.
fn quenched(w: f64, phase: f64, step: f64) -> (FoundOf<VanDerPol<f64>, 2>, VanDerPol<f64>) {
    let system = VanDerPol { m: 0.3, f: 2.0, w, phase };
    let settled = returned(&system, [0.0, 0.0], &Cycles { count: 100, tolerance: 1e-12 }, |_| ());
    let ranges = [("f", [0.05, 2.5]), ("w", [1.01, 1.6])];
    (followed(system, settled.expect("a motion"), ranges, step), system)
}

#[test]
fn a_curve_of_neimark_sacker_points_has_multipliers_on_the_unit_circle() {
    let (found, system) = quenched(1.3, 0.0, 0.01);
    let special = found.branches[0].special.iter().find(|it| it.kind == SpecialKind::NeimarkSacker);
    let special = &special.expect("a pair passes").point;
    let torus = curve(&found, SpecialKind::NeimarkSacker);
    let begins = torus.points.iter().position(|at| (at[0] - special.parameter).abs() < 1e-9);
    let begins = begins.expect("the special point");
    // At a resonance 1:1, where the curve may end, this Newton's method has no solution.
    let [first, beyond] = [1, torus.points.len() - 1];
    // From there each way, from point to point.
    for backward in [true, false] {
        let mut known = [special.section[0]; 2];
        let places: Vec<usize> = match backward {
            true => (first..begins).rev().collect(),
            false => (begins..beyond).collect(),
        };
        for place in places {
            let [f, w] = torus.points[place];
            let [before, last] = known;
            let ahead = [0, 1].map(|i| 2.0 * last[i] - before[i]);
            let here = VanDerPol { f, w, ..system };
            let point = fixed(&here, ahead);
            let slopes = by_differences(&here, point);
            known = [last, point];
            let (product, sum) = (determinant(slopes), slopes[0][0] + slopes[1][1]);
            assert!(
                (product - 1.0).abs() < 1e-8,
                "{product} at {f} {w}: {place} of {}",
                torus.points.len()
            );
            assert!(sum.abs() < 2.0 + 1e-6, "{sum} at {f} {w}");
        }
    }
}

#[test]
fn strong_resonances_are_the_same_from_any_phase_and_step() {
    let (found, system) = quenched(1.3, 0.0, 0.05);
    let first = curve(&found, SpecialKind::NeimarkSacker);
    assert!(first.ends.contains(&End::StrongResonance), "{:?}", first.ends);
    let resonance = first.codim2.iter().find(|it| it.kind == Resonance1).expect("two folds meet");
    let [f, w] = resonance.parameters;
    let section = [resonance.section[0], resonance.section[1]];
    let here = VanDerPol { f, w, ..system };
    let (back, slopes) = (mapped(&here, section), by_differences(&here, section));
    assert!((back[0] - section[0]).hypot(back[1] - section[1]) < 1e-11);
    assert!((determinant(slopes) - 1.0).abs() < 1e-8);
    assert!((slopes[0][0] + slopes[1][1] - 2.0).abs() < 1e-8);
    for (phase, step) in [(0.0, 0.01), (0.0, 0.2), (1.0, 0.05), (2.5, 0.03)] {
        let (found, _) = quenched(1.3, phase, step);
        let same = curve(&found, SpecialKind::NeimarkSacker);
        let told: Vec<_> = first.codim2.iter().map(|it| (it.kind, it.parameters)).collect();
        assert_points(same, &told);
    }
    // The curve of folds, which are met at a lower frequency, passes through the same point.
    let (found, _) = quenched(1.05, 0.0, 0.05);
    let folds = curve(&found, SpecialKind::Fold);
    let mut met = folds.codim2.iter().filter(|it| it.kind == Resonance1).map(|it| it.parameters);
    assert!(met.any(|it| (it[0] - f).hypot(it[1] - w) < 1e-10), "{:?} {f} {w}", folds.codim2);
}
