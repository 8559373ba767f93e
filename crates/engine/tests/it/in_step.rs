//! Orbits along several parameters that change in step: held against each parameter by itself.

use capsulemap_engine::branch::{Along, Segment, SegmentEnd, SpecialKind, segment};
use capsulemap_engine::orbit::passage::OneByOne;
use capsulemap_engine::orbit::{Case, Outcome, Protocol, Varied, settle};

use super::contract::systems::duffing::Duffing;

const FROM: Duffing<f64> = Duffing { c: 0.08, p: 0.2 };
/// Where the subharmonic motions have ceased.
const TO: Duffing<f64> = Duffing { c: 0.17, p: 0.12 };
/// A share of the way on which none has ceased yet.
const PART: f64 = 0.05;
const TOLERANCE: f64 = 1e-12;

/// What becomes of an orbit that is given by the number and its section points.
fn along(
    system: Duffing<f64>,
    varied: Varied<&'static str>,
    from: (f64, &[[f64; 2]]),
    to: f64,
) -> Segment<[f64; 2]> {
    let along = Along { system, varied, tolerance: TOLERANCE };
    segment(&OneByOne, &along, from, to).expect("the orbit closes")
}

fn both() -> Varied<&'static str> {
    let each = [("c", [FROM.c, TO.c]), ("p", [FROM.p, TO.p])];
    Varied::in_step([0.0, 1.0], each.into_iter())
}

fn at(share: f64) -> Duffing<f64> {
    let value = |name| both().value(name, share).expect("it varies");
    Duffing { c: value("c"), p: value("p") }
}

/// The orbit of the same branch where both have these values, by way of the amplitude and then the damping; or the last fold on it.
fn one_by_one(points: &[[f64; 2]], to: Duffing<f64>) -> Segment<[f64; 2]> {
    let first = along(FROM, Varied::One("p"), (FROM.p, points), to.p);
    let SegmentEnd::Reached(corner) = first.end else { return first };
    let system = Duffing { p: to.p, ..FROM };
    along(system, Varied::One("c"), (FROM.c, &corner.points), to.c)
}

#[test]
fn orbits_and_folds_along_two_parameters_are_those_of_each_by_itself() {
    let protocol = Protocol::with_tolerance(TOLERANCE);
    let (mut reached, mut folds) = (0, 0);
    for start in [[0.1, 0.0], [-0.5, 0.5], [0.4, 0.3], [-0.3, -0.2], [0.9, 0.1], [-0.8, 0.4]] {
        let orbit = settle(&Case::new(FROM, start), &protocol);
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        let points = &orbit.section[..orbit.period as usize];
        // On a part of the way all orbits go on.
        let part = (along(FROM, both(), (0.0, points), PART).end, one_by_one(points, at(PART)).end);
        if let (SegmentEnd::Reached(end), SegmentEnd::Reached(other)) = part {
            let apart = end.points.iter().flatten().zip(other.points.iter().flatten());
            let apart = apart.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-9, "{start:?}: {apart:e}");
            reached += 1;
        }
        let found = along(FROM, both(), (0.0, points), 1.0);
        for fold in found.special.iter().filter(|it| it.kind == SpecialKind::Fold) {
            let there = at(fold.value);
            let beyond = Duffing { c: there.c + 0.01, ..there };
            let other = one_by_one(points, beyond);
            let other = other.special.iter().find(|it| it.kind == SpecialKind::Fold);
            let other = other.unwrap_or_else(|| panic!("no fold near {there:?}"));
            assert!((other.value - there.c).abs() < 1e-8, "{} {there:?}", other.value);
            folds += 1;
        }
    }
    assert!(reached > 2 && folds > 2, "{reached} {folds}");
}
