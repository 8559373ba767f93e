//! Why branches end where they do, and how little that depends on how the first orbit was found.

use capsulemap::branch::{End, SpecialKind};
use capsulemap::capsule::Parameter;
use capsulemap::capsule::branch::{Branch, follow};

use super::branch::{assert_closed, moving, relative, request};
use super::branch_curves::folding;

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
