//! Curves of rigid grazings and folds in two parameters against their closed forms, and branches that pass a grazing.

use std::f64::consts::PI;

use capsulemap_engine::branch::{self, Curve, End, FoundOf, SpecialKind};
use capsulemap_engine::orbit::{Case, Outcome, Protocol, settle};

use super::rigid_branches::impact_oscillator::Impactor;

/// The oscillator of the published curves.
const PUBLISHED: Impactor<f64> =
    Impactor { c: 0.04, f: 0.38, w: 0.799, r: 0.9, wall: 1.0, phase: 0.0 };
/// Its fold of the orbits of one impact in two cycles, as published, and where the published curve of folds ends.
const FOLD: f64 = 0.362_836_201_980_888_74;
const LAST: f64 = 0.788_138;
/// The longest steps that are tried.
const STEPS: [f64; 5] = [0.005, 0.02, 0.05, 0.1, 0.2];

/// What is found along the amplitude of the force, and along its frequency too.
fn followed(
    system: Impactor<f64>,
    (section, period): ([f64; 2], u64),
    [f, w]: [[f64; 2]; 2],
    longest_step: f64,
) -> FoundOf<Impactor<f64>, 2> {
    let request = branch::Request {
        system,
        section,
        period,
        along: "f",
        range: f,
        doublings: 0,
        second: Some(("w", w)),
        curve_range: None,
        longest_step,
        most_points: 4000,
        tolerance: 1e-12,
    };
    branch::follow(&request).expect("a branch")
}

/// The amplitude of the force at which the motion without impacts touches the wall.
fn touching(system: &Impactor<f64>, w: f64) -> f64 {
    system.wall * libm::hypot(1.0 - w * w, system.c * w)
}

/// The amplitude of the force at the fold of orbits of one impact in n cycles.
///
/// With p and p' the steady answer and its rate at the impact, p' = rate (wall - p): the answer's amplitude has a least value,
/// at which two orbits become one.
fn folding(system: &Impactor<f64>, w: f64, n: u64) -> f64 {
    let Impactor { c, r, wall, .. } = *system;
    let duration = 2.0 * PI * n as f64 / w;
    let s = (1.0 - 0.25 * c * c).sqrt();
    let decay = libm::exp(-0.5 * c * duration);
    let (sin, cos) = (decay * libm::sin(s * duration), decay * libm::cos(s * duration));
    let b = (1.0 - cos) / sin;
    let rate = 0.5 * c - s * b - r * s * ((cos - 1.0) * b - sin) / (1.0 + r);
    let square = 1.0 + (rate / w).powi(2);
    (1.0 - 1.0 / square).sqrt() * wall * libm::hypot(1.0 - w * w, c * w)
}

/// The curve through the first special point of a kind.
fn curve(found: &FoundOf<Impactor<f64>, 2>, kind: SpecialKind) -> &Curve {
    let special = found.branches[0].special.iter().find(|it| it.kind == kind);
    &found.curves[special.expect("a special point").curve.expect("its curve")]
}

/// A curve of grazings leads from one bound to another along its closed form.
fn assert_touches(system: &Impactor<f64>, found: &FoundOf<Impactor<f64>, 2>) {
    let curve = curve(found, SpecialKind::Grazing);
    assert_eq!(curve.ends, [End::Bound; 2]);
    assert!(curve.points.len() < 1000, "{}", curve.points.len());
    for [f, w] in &curve.points {
        let away = f / touching(system, *w) - 1.0;
        assert!(away.abs() < 1e-12, "{away:e} at {f} {w}");
    }
}

#[test]
fn curves_of_rigid_grazings_are_those_of_the_closed_form() {
    for step in STEPS {
        // From the side without impacts, and from orbits of one impact in two cycles that become those without.
        let quiet = Impactor { f: 0.1, w: 0.81, ..PUBLISHED };
        let found = followed(quiet, ([0.2, 0.0], 1), [[0.05, 0.6], [0.6, 0.95]], step);
        assert_touches(&quiet, &found);
        let impacting = Impactor { w: 0.81, ..PUBLISHED };
        let found =
            followed(impacting, ([0.651_74, 0.081_55], 2), [[0.34, 0.4], [0.78, 0.83]], step);
        assert_touches(&impacting, &found);
    }
}

#[test]
fn curves_of_folds_go_on_past_an_impact_on_the_instant_of_the_section() {
    let orbit = settle(&Case::new(PUBLISHED, [0.9, -0.85]), &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 2));
    for section in &orbit.section {
        for step in STEPS {
            let found = followed(PUBLISHED, (*section, 2), [[0.34, 0.4], [LAST, 0.83]], step);
            let fold = found.branches[0].special.iter().find(|it| it.kind == SpecialKind::Fold);
            let fold = fold.expect("a fold").point.parameter;
            assert!((fold - FOLD).abs() < 1e-13, "{fold}");
            let curve = curve(&found, SpecialKind::Fold);
            let least = curve.points.iter().map(|[_, w]| *w).fold(f64::INFINITY, f64::min);
            assert!(curve.ends.contains(&End::Bound) && least == LAST, "{least} {:?}", curve.ends);
            for [f, w] in &curve.points {
                let away = f - folding(&PUBLISHED, *w, 2);
                assert!(away.abs() < 1e-11, "{away:e} at {f} {w}");
            }
        }
    }
}

/// Exercise 15.2 of Dankowicz and Schilder, Recipes for Continuation (2013): at resonance the amplitude without impacts is f / c.
#[test]
fn an_orbit_of_one_impact_is_followed_through_the_grazing_at_which_it_begins() {
    let system = Impactor { c: 0.1, f: 1.0, w: 1.0, r: 0.8, wall: 1.0, phase: 0.0 };
    for step in STEPS {
        let found = followed(system, ([0.0, 1.0], 1), [[0.05, 1.0], [0.9, 1.1]], step);
        let branch = &found.branches[0];
        assert_eq!(branch.ends, [End::Bound; 2]);
        let kinds: Vec<SpecialKind> = branch.special.iter().map(|it| it.kind).collect();
        assert_eq!(kinds, [SpecialKind::Grazing, SpecialKind::Fold]);
        let values = [0, 1].map(|at| branch.special[at].point.parameter);
        let right = [touching(&system, 1.0), folding(&system, 1.0, 1)];
        for (value, right) in values.into_iter().zip(right) {
            assert!((value - right).abs() < 1e-12, "{value} {right}");
        }
        assert_touches(&system, &found);
    }
}
