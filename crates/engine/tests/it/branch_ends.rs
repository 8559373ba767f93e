//! Why branches end where they do, and how little that depends on how the first orbit was found.

use capsulemap_engine::branch::{self, End, SpecialKind};
use capsulemap_engine::orbit::{self, Case, Outcome, Protocol};
use capsulemap_models::capsule::branch::{Branch, follow};
use capsulemap_models::capsule::{CapsuleParameters as _, Parameter, Parameters, State, settle};

use super::branch::{assert_closed, moving, quiet, relative, request};
use super::branch_curves::folding;
use super::contract::systems::belt::Belt;

#[test]
fn a_branch_says_why_it_ends() {
    let mut request = moving([128.0, 132.0]);
    let found = follow(&request).expect("a branch");
    let branch = &found.branches[0];
    let ends = [branch.points.first(), branch.points.last()].map(|it| it.expect("one").parameter);
    assert_eq!((branch.ends, ends), ([End::Bound; 2], request.range));
    request.most_points = 6;
    let found = follow(&request).expect("a branch");
    assert_eq!(found.branches[0].ends, [End::MostPoints; 2]);
    assert_eq!(found.branches[0].points.len(), 6);
    // From the end of the range the branch leads in one direction, and the first orbit is there once.
    request = moving([130.0, 132.0]);
    let found = follow(&request).expect("a branch");
    let points = &found.branches[0].points;
    assert_eq!(found.branches[0].ends, [End::Bound; 2]);
    assert!(points.windows(2).all(|pair| pair[0].parameter < pair[1].parameter));
}

#[test]
fn a_doubled_branch_ends_at_orbits_of_half_its_period() {
    let mut request = moving([122.0, 135.0]);
    request.doublings = 1;
    let found = follow(&request).expect("a branch");
    assert_eq!(found.branches[1].ends, [End::Merged; 2]);
}

/// The special points of a branch: what happens, and where.
fn happens(branch: &Branch) -> Vec<(SpecialKind, f64)> {
    branch.special.iter().map(|special| (special.kind, special.point.parameter)).collect()
}

#[test]
fn a_poor_guess_leads_to_the_same_branch_as_a_good_one() {
    let mut p = folding();
    p[Parameter::Pd] = 5.0;
    let mut request = request(&p, [0.2, 30.0, 0.0], 3, Parameter::Omega, [25.0, 35.0]);
    let poor = follow(&request).expect("a branch");
    assert_closed(&poor);
    let there = poor.branches[0].points.iter().find(|point| point.parameter == 30.0);
    request.section = there.expect("the first orbit").section[0];
    let good = follow(&request).expect("a branch");
    let [poor, good] = [poor, good].map(|found| happens(&found.branches[0]));
    let folds = good.iter().filter(|(kind, _)| *kind == SpecialKind::Fold);
    assert_eq!((poor.len(), folds.count()), (good.len(), 4));
    for ((kind, at), (other, expected)) in poor.iter().zip(&good) {
        assert!(kind == other && relative(*at, *expected) < 1e-9, "{at} {expected}");
    }
}

#[test]
fn a_branch_of_tiny_steps_neither_closes_nor_goes_on_for_ever() {
    let p = Parameters::with(&[(Parameter::Omega, 20.0), (Parameter::Pd, 0.5)]);
    for longest_step in [1e-3, 1e-6, 1e-9, 1e-13, 1e-16, 0.0] {
        let mut request = request(&p, quiet(&p), 1, Parameter::Omega, [15.0, 25.0]);
        (request.longest_step, request.most_points) = (longest_step, 12);
        let found = follow(&request).expect("the stuck capsule oscillates");
        let Branch { points, ends, .. } = &found.branches[0];
        let expected = if longest_step > 1e-12 { End::MostPoints } else { End::Stopped };
        assert!(ends.iter().all(|&end| end == expected), "{longest_step:e}: {ends:?}");
        assert!(points.len() <= 12, "{longest_step:e}");
        let rises = points.is_sorted_by(|a, b| a.parameter < b.parameter);
        assert!(rises, "{longest_step:e}: {:?}", points.iter().map(|it| it.parameter));
    }
}

#[test]
fn a_branch_does_not_turn_back_onto_itself_at_a_corner() {
    let mut p = Parameters::with(&[
        (Parameter::K2, 18.96e3),
        (Parameter::Delta, 1.5e-3),
        (Parameter::Pd, 4.0),
        (Parameter::Omega, 20.73),
    ]);
    p[Parameter::MuS] = 0.72;
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
    let mut request = request(&p, orbit.section[0], 1, Parameter::MuS, [0.73, 0.74]);
    request.setting.parameters[Parameter::MuS] = 0.735;
    let found = follow(&request).expect("the orbit goes on");
    let Branch { points, special, ends, .. } = &found.branches[0];
    assert!(points.is_sorted_by(|a, b| a.parameter < b.parameter), "it turns back");
    assert_eq!(special.len(), 1, "one period doubling, before the corner");
    assert!(relative(special[0].point.parameter, 0.7373639061) < 1e-8);
    assert_eq!(*ends, [End::Bound, End::Corner]);
    assert!(relative(points[points.len() - 1].parameter, 0.7373639075) < 1e-8);
}

/// On a slow belt the mass sticks for about 2 a / v, until the spring is stretched to the friction at rest.
#[test]
fn a_branch_whose_orbits_take_longer_and_longer_ends_at_the_longest_wait() {
    let slow = Belt { c: 0.1, a: 0.5, s: 0.01, v: 0.1 };
    let found = orbit::settle(&Case::new(slow, [1.0, 0.0]), &Protocol::default());
    assert_eq!((found.outcome, found.period), (Outcome::Periodic, 1));
    let mut last = Vec::new();
    for longest_step in [0.01, 0.05, 0.2] {
        let request = branch::Request {
            system: slow,
            section: found.section[0],
            period: 1,
            along: "v",
            range: [1e-3, 0.2],
            doublings: 0,
            second: None,
            curve_range: None,
            longest_step,
            most_points: 2000,
            tolerance: 1e-12,
        };
        let found = branch::follow(&request).expect("a branch");
        let branch = &found.branches[0];
        assert_eq!(branch.ends, [End::LongestWait, End::Bound], "{longest_step}");
        last.push(branch.points[0].parameter);
    }
    // The return takes 100 there: the belt stretches the spring by nearly 2 a, which gave way as the mass slipped.
    assert!(
        last.iter().all(|v| (0.009..0.01).contains(v) && relative(*v, last[0]) < 1e-6),
        "{last:?}"
    );
}
