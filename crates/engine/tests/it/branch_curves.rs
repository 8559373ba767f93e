//! Curves in two parameters: both sorts of grazing, each curve once, and none that leads elsewhere.

use capsulemap_engine::branch::{Curve, End, SpecialKind};
use capsulemap_models::capsule::branch::{Found, Request, follow};
use capsulemap_models::capsule::{CapsuleParameters as _, Parameter, Parameters};

use super::branch::{assert_closed, of_kind, relative, request, settled};

/// A capsule whose spring presses the mass against the stop, at rest on the ground.
fn pressed() -> Parameters {
    Parameters::with(&[
        (Parameter::K2, 18.96e3),
        (Parameter::Omega, 60.0),
        (Parameter::Delta, -1e-3),
    ])
}

/// The impedance of mass and both springs, and the drive at which contact opens: it takes the amplitude
/// |delta| k1 / (k1 + k2).
fn opening(p: &Parameters) -> [f64; 2] {
    let (w, springs) = (p[Parameter::Omega], p[Parameter::K1] + p[Parameter::K2]);
    let z = (springs - p[Parameter::M1] * w * w).hypot(p[Parameter::C] * w);
    [z, -p[Parameter::Delta] * p[Parameter::K1] / springs * z]
}

/// The section point of the mass that swings against the stop and never leaves it.
fn held(p: &Parameters) -> [f64; 3] {
    let (w, springs) = (p[Parameter::Omega], p[Parameter::K1] + p[Parameter::K2]);
    let amplitude = p[Parameter::Pd] / opening(p)[0];
    let phi = (p[Parameter::C] * w).atan2(springs - p[Parameter::M1] * w * w);
    let rest = p[Parameter::K2] * p[Parameter::Delta] / springs;
    [rest + amplitude * phi.cos(), w * amplitude * phi.sin(), 0.0]
}

#[test]
fn contact_opens_where_the_closed_form_says_in_two_parameters() {
    let mut p = pressed();
    let [_, edge] = opening(&p);
    p[Parameter::Pd] = 0.8 * edge;
    let range = [0.5 * edge, 1.02 * edge];
    let mut request = request(&p, held(&p), 1, Parameter::Pd, range);
    request.second = Some((Parameter::Omega.into(), [40.0, 90.0]));
    let found = follow(&request).expect("a branch");
    assert_closed(&found);
    let grazing = of_kind(&found.branches[0], SpecialKind::Grazing);
    let special = grazing.first().expect("contact opens");
    assert!(relative(special.point.parameter, edge) < 1e-13, "{}", special.point.parameter);
    let curve = &found.curves[special.curve.expect("a curve")];
    assert!(curve.points.len() > 20);
    for &[p_d, omega] in &curve.points {
        p[Parameter::Omega] = omega;
        let error = relative(p_d, opening(&p)[1]);
        assert!(error < 1e-10, "{omega}: {error:e}");
    }
}

/// Whether two curves are the same in reverse or not: whether all points of one lie on the other.
fn overlap(a: &Curve, b: &Curve) -> bool {
    let size = |i: usize| a.points.iter().map(|at| at[i].abs()).fold(0.0, f64::max);
    let scale = [size(0), size(1)];
    let apart =
        |p: &[f64; 2], q: &[f64; 2]| ((p[0] - q[0]) / scale[0]).hypot((p[1] - q[1]) / scale[1]);
    let near = |at: &&[f64; 2]| b.points.iter().any(|other| apart(at, other) < 1e-9);
    (a.kind, a.period) == (b.kind, b.period) && a.points.iter().filter(near).count() > 2
}

/// Whatever the curves are: each goes through its special points, and none is there twice.
fn assert_sound(request: &Request, found: &Found) {
    let second = request.second.expect("a second parameter").0;
    for (number, curve) in found.curves.iter().enumerate() {
        let (branch, special) = curve.through;
        let special = &found.branches[branch].special[special];
        let at = [special.point.parameter, request.setting.parameters[second]];
        let away = |it: &[f64; 2]| relative(it[0], at[0]).max(relative(it[1], at[1]));
        let least = curve.points.iter().map(away).fold(f64::INFINITY, f64::min);
        assert!(special.kind == curve.kind && least < 1e-9, "curve {number}: {least:e}");
        assert_eq!(special.curve, Some(number));
        let closed = curve.points.first() == curve.points.last();
        assert_eq!(curve.ends, if closed { [End::Closed; 2] } else { curve.ends });
        assert!(curve.points.len() <= request.most_points + 1);
        let others = &found.curves[..number];
        let twin = others.iter().position(|other| overlap(curve, other));
        assert_eq!(twin, None, "curve {number}");
    }
}

/// A mass between soft spring and hard stop whose response folds over and doubles.
pub fn folding() -> Parameters {
    Parameters::with(&[
        (Parameter::M1, 0.15),
        (Parameter::K2, 30e3),
        (Parameter::Delta, 1.2e-3),
        (Parameter::Omega, 30.0),
    ])
}

#[test]
fn every_curve_goes_through_its_special_points_and_is_there_once() {
    let mut p = folding();
    p[Parameter::Pd] = 5.92;
    let start = settled(&p, [0.0; 3]);
    let mut request = request(&p, start.section[0], start.period, Parameter::Pd, [5.4, 7.0]);
    (request.doublings, request.longest_step) = (1, 0.1);
    request.second = Some((Parameter::Omega.into(), [25.0, 35.0]));
    let found = follow(&request).expect("a branch");
    assert_closed(&found);
    assert_sound(&request, &found);
    // Minima of r touch the stop at some of these, and every one has its curve.
    let all = || found.branches.iter().flat_map(|branch| &branch.special);
    let grazing = all().filter(|special| special.kind == SpecialKind::Grazing);
    assert!(grazing.clone().count() > 8 && grazing.clone().all(|it| it.curve.is_some()));
    // Both folds lie on one curve that closes, and so do both period doublings.
    for kind in [SpecialKind::Fold, SpecialKind::PeriodDoubling] {
        let special = of_kind(&found.branches[0], kind);
        let curves: Vec<_> = special.iter().map(|special| special.curve).collect();
        assert!(curves.len() == 2 && curves[0].is_some() && curves[0] == curves[1], "{curves:?}");
    }
    let doubling = found.curves.iter().find(|it| it.kind == SpecialKind::PeriodDoubling);
    assert_eq!(doubling.expect("a curve").ends, [End::Closed; 2]);
    assert!(found.curves.iter().any(|curve| curve.ends == [End::Bound; 2]));
}
