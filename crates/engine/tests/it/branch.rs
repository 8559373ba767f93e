//! Branches of periodic orbits: onsets in closed form, folds, doublings and curves by second methods.

use std::f64::consts::PI;

use capsulemap_engine::branch::{NotFollowed, SpecialKind};
use capsulemap_engine::flow::Metric;
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::branch::{Branch, Found, Request, Special, follow};
use capsulemap_models::capsule::{
    CapsuleParameters as _, Orbit, Output, Parameter, Parameters, State, Switching, settle,
    simulate,
};

use super::draws;
use capsulemap_models::description::Section;
use capsulemap_models::motion::Setting;

const TOLERANCE: f64 = 1e-12;

/// The size of a section point under a drive of this frequency [m/s].
fn size(omega: f64, point: &[f64; 3]) -> f64 {
    Metric::new([omega, 1.0, 1.0]).size(point)
}

/// The request to follow the orbit near a section point.
pub fn request(
    parameters: &Parameters,
    section: impl Into<Section>,
    period: u64,
    along: Parameter,
    range: [f64; 2],
) -> Request {
    Request {
        setting: Setting { parameters: parameters.clone(), phase: 0.0 },
        section: section.into(),
        period,
        along: along.into(),
        range,
        doublings: 0,
        second: None,
        curve_range: None,
        longest_step: 0.02,
        most_points: 1000,
        tolerance: TOLERANCE,
    }
}

/// How far a number is from another, relative to it.
pub fn relative(a: f64, b: f64) -> f64 {
    ((a - b) / b).abs()
}

/// k1 - m1 w^2, c w, the impedance Z, and the response of F.
fn oscillator(p: &Parameters) -> [f64; 4] {
    let w = p[Parameter::Omega];
    let spring = p[Parameter::K1] - p[Parameter::M1] * w * w;
    let damper = p[Parameter::C] * w;
    [spring, damper, spring.hypot(damper), p[Parameter::K1].hypot(damper)]
}

/// The section point of the stuck capsule that does not touch.
pub fn quiet(p: &Parameters) -> [f64; 3] {
    let [spring, damper, z, _] = oscillator(p);
    let (amplitude, phi) = (p[Parameter::Pd] / z, damper.atan2(spring));
    [amplitude * phi.cos(), p[Parameter::Omega] * amplitude * phi.sin(), 0.0]
}

/// The cases of the paper whose stuck capsule touches before it slips, at the drive that makes it touch.
///
/// Fig 5 is none of them: with a gap of 3.5 mm, F would be 4.97 N and more when contact begins, above the
/// 4.14 N at which it slips.
fn grazing_cases() -> Vec<Parameters> {
    let cases =
        [(18.96e3, 20.73), (59.41e3, 26.58), (59.41e3, 37.33), (59.41e3, 46.0), (59.41e3, 54.6)];
    let case = |&(k2, omega): &(f64, f64)| {
        let mut p = Parameters::with(&[
            (Parameter::K2, k2),
            (Parameter::Omega, omega),
            (Parameter::Delta, 1.5e-3),
        ]);
        let [_, _, z, response] = oscillator(&p);
        p[Parameter::Pd] = p[Parameter::Delta] * z;
        assert!(response * p[Parameter::Delta] < p[Parameter::MuS] * p.normal_load());
        p
    };
    cases.iter().map(case).collect()
}

/// The special points of a kind.
pub fn of_kind(branch: &Branch, kind: SpecialKind) -> Vec<&Special> {
    branch.special.iter().filter(|special| special.kind == kind).collect()
}

/// Every orbit of every branch closes to rounding in the plain motion.
pub fn assert_closed(found: &Found) {
    for branch in &found.branches {
        let special = branch.special.iter().map(|special| &special.point);
        for point in branch.points.iter().chain(special) {
            assert!(point.residual < 1e-9, "{} {:e}", point.parameter, point.residual);
            assert_eq!(point.section.len() as u64, branch.period);
        }
        assert!(branch.special.iter().all(|special| special.after + 1 < branch.points.len()));
    }
}

#[test]
fn contact_begins_where_the_closed_form_says_in_every_parameter() {
    for exact in grazing_cases() {
        for (along, from, to) in [
            (Parameter::Pd, 0.6, 1.05),
            (Parameter::Delta, 1.6, 0.97),
            (Parameter::Omega, 0.8, 1.05),
        ] {
            let value = exact[along];
            let mut p = exact.clone();
            p[along] = from * value;
            let range = [value * from.min(to), value * from.max(to)];
            let found = follow(&request(&p, quiet(&p), 1, along, range)).expect("a branch");
            assert_closed(&found);
            let grazing = of_kind(&found.branches[0], SpecialKind::Grazing);
            let error = grazing.iter().map(|special| relative(special.point.parameter, value));
            let error = error.fold(f64::INFINITY, f64::min);
            assert!(error < 1e-11, "{along:?} {value}: {error:e}");
        }
    }
}

#[test]
fn slip_begins_where_the_closed_form_says() {
    for omega in [20.0, 60.0, 100.0] {
        let mut p = Parameters::with(&[(Parameter::Omega, omega), (Parameter::Delta, 1.0)]);
        let [_, _, z, response] = oscillator(&p);
        let onset = p[Parameter::MuS] * p.normal_load() * z / response;
        p[Parameter::Pd] = 0.5 * onset;
        let range = [0.5 * onset, 1.2 * onset];
        let found = follow(&request(&p, quiet(&p), 1, Parameter::Pd, range)).expect("a branch");
        assert_closed(&found);
        let first = found.branches[0].special.first().expect("slip begins");
        assert_eq!(first.kind, SpecialKind::EventSequence);
        let error = relative(first.point.parameter, onset);
        assert!(error < 1e-9, "{omega}: {error:e}");
        let last = found.branches[0].points.last().expect("orbits");
        assert_eq!(last.parameter, range[1]);
        assert!(last.measured[Output::StickShare] < 1.0);
    }
}

#[test]
fn multipliers_of_the_stuck_capsule_are_those_of_its_oscillator() {
    let mut p = Parameters::with(&[(Parameter::Omega, 30.0), (Parameter::Delta, 1.0)]);
    p[Parameter::Pd] = 0.1;
    let found = follow(&request(&p, quiet(&p), 1, Parameter::Omega, [25.0, 100.0]));
    let branch = &found.expect("a branch").branches[0];
    assert!(branch.points.len() > 40 && branch.special.is_empty());
    let (m, c, k) = (p[Parameter::M1], p[Parameter::C], p[Parameter::K1]);
    let (decay, turn) = (c / (2.0 * m), (k / m - (c / (2.0 * m)).powi(2)).sqrt());
    for point in &branch.points {
        let period = 2.0 * PI / point.parameter;
        let &[one, other, none] = &point.multipliers[..] else { panic!("multipliers") };
        let magnitude = (-decay * period).exp();
        let (re, im) = (magnitude * (turn * period).cos(), magnitude * (turn * period).sin());
        for multiplier in [one, other] {
            assert!(
                (multiplier.re - re).abs() < 1e-11
                    && (multiplier.im.abs() - im.abs()).abs() < 1e-11
            );
        }
        assert_eq!(none.abs(), 0.0);
        p[Parameter::Omega] = point.parameter;
        let exact = quiet(&p);
        for (i, exact) in exact.iter().enumerate() {
            let away = (point.section[0][i] - exact).abs();
            assert!(away <= 1e-11 * size(point.parameter, &point.section[0].array()));
        }
    }
}

/// Where a moving and a resting attractor coexist.
pub fn two_attractors(omega: f64) -> Parameters {
    Parameters::with(&[
        (Parameter::M2, 0.2),
        (Parameter::C, 1.77),
        (Parameter::MuS, 0.33),
        (Parameter::MuD, 0.165),
        (Parameter::Pd, 2.79),
        (Parameter::K2, 65518.0),
        (Parameter::Delta, 4.33e-3),
        (Parameter::Omega, omega),
    ])
}

/// What the motion settles to from a section point.
pub fn settled(p: &Parameters, point: impl Into<Section>) -> Orbit {
    let [r, y1, y2] = point.into().array();
    settle(p, 0.0, State::of([r, y1, 0.0, y2]), &Protocol::default())
}

/// The moving orbit at 130 rad/s followed in the frequency.
pub fn moving(range: [f64; 2]) -> Request {
    let p = two_attractors(130.0);
    let start = settled(&p, [0.0, 0.3, 0.0]);
    assert_eq!((start.outcome, start.period), (Outcome::Periodic, 1));
    request(&p, start.section[0], 1, Parameter::Omega, range)
}

#[test]
fn hysteresis_is_bounded_by_folds_with_an_unstable_branch_between() {
    let found = follow(&moving([126.0, 170.0])).expect("a branch");
    assert_closed(&found);
    let branch = &found.branches[0];
    let folds = of_kind(branch, SpecialKind::Fold);
    assert_eq!(folds.len(), 2);
    let [upper, lower] = [folds[0], folds[1]];
    assert!(lower.point.parameter < 152.0 && upper.point.parameter > 164.0);
    for fold in [upper, lower] {
        let &[critical, ..] = &fold.point.multipliers[..] else { panic!("multipliers") };
        assert!((critical.re - 1.0).abs() < 1e-9 && critical.im == 0.0, "{critical:?}");
    }
    // Just before the upper fold the moving orbit attracts; just beyond it there is none left.
    let speed = |omega: f64| {
        let orbit = settled(&two_attractors(omega), upper.point.section[0]);
        orbit.outputs[Output::ProgressionSpeed].abs()
    };
    let at_fold = upper.point.measured[Output::ProgressionSpeed].abs();
    let edge = upper.point.parameter;
    assert!((speed(edge - 1e-4) - at_fold).abs() < 0.02 * at_fold);
    assert!(speed(edge + 1e-2) < 0.5 * at_fold);
    // Between the folds lies an orbit that no sweep shows: it repeats, and whatever is beside it leaves.
    let between = &branch.points[upper.after + 1..lower.after];
    assert!(between.len() > 10);
    for point in between {
        let &[critical, ..] = &point.multipliers[..] else { panic!("multipliers") };
        assert!(critical.re > 1.0, "{}", point.parameter);
        let [r, y1, y2] = point.section[0].array();
        let p = two_attractors(point.parameter);
        let start = State::of([r, y1, 0.0, y2]);
        let end = simulate(&p, 0.0, start, 1, TOLERANCE).section[1];
        let apart = [end.r - r, end.y1 - y1, end.y2 - y2];
        let omega = point.parameter;
        assert!(size(omega, &apart) < 1e-11 * size(omega, &point.section[0].array()));
    }
}

#[test]
fn a_doubled_branch_leaves_and_returns() {
    let mut request = moving([122.0, 135.0]);
    request.doublings = 1;
    let found = follow(&request).expect("a branch");
    assert_closed(&found);
    let doublings = of_kind(&found.branches[0], SpecialKind::PeriodDoubling);
    assert_eq!((doublings.len(), found.branches.len()), (2, 2));
    for doubling in &doublings {
        let &[critical, ..] = &doubling.point.multipliers[..] else { panic!("multipliers") };
        assert!((critical.re + 1.0).abs() < 1e-9 && critical.im == 0.0, "{critical:?}");
    }
    let [first, last] = [doublings[0], doublings[1]].map(|doubling| doubling.point.parameter);
    let twice = &found.branches[1];
    assert_eq!(twice.period, 2);
    let ends = [twice.points.first(), twice.points.last()];
    let ends = ends.map(|point| point.expect("an orbit").parameter);
    assert!(relative(ends[0], first) < 1e-12 && relative(ends[1], last) < 1e-12, "{ends:?}");
    // What settles there has one period before the doubling, and twice that after it.
    for (omega, period) in
        [(first - 0.05, 1), (first + 0.05, 2), (last - 0.05, 2), (last + 0.05, 1)]
    {
        let start = doublings[usize::from(omega > 126.0)].point.section[0];
        let orbit = settled(&two_attractors(omega), start);
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, period), "{omega}");
    }
}

#[test]
fn the_curve_on_which_contact_begins_is_the_closed_form() {
    let exact = &grazing_cases()[4];
    let mut p = exact.clone();
    p[Parameter::Pd] *= 0.8;
    let edge = exact[Parameter::Pd];
    let mut request = request(&p, quiet(&p), 1, Parameter::Pd, [0.3 * edge, 1.05 * edge]);
    request.second = Some((Parameter::Omega.into(), [30.0, 90.0]));
    let found = follow(&request).expect("a branch");
    let curve = found.curves.iter().find(|curve| curve.kind == SpecialKind::Grazing);
    let points = &curve.expect("a curve").points;
    assert!(points.len() > 30);
    for &[p_d, omega] in points {
        p[Parameter::Omega] = omega;
        let [_, _, z, _] = oscillator(&p);
        let error = relative(p_d, p[Parameter::Delta] * z);
        assert!(error < 1e-10, "{omega}: {error:e}");
    }
}

#[test]
fn every_point_of_a_fold_curve_is_a_fold() {
    let mut whole = moving([145.0, 170.0]);
    let p = two_attractors(150.0);
    let start = settled(&p, [0.0, 0.3, 0.0]);
    (whole.setting.parameters, whole.section) = (p, start.section[0]);
    whole.second = Some((Parameter::Pd.into(), [2.7, 2.85]));
    let found = follow(&whole).expect("a branch");
    let through = |curve: &&capsulemap_engine::branch::Curve| {
        curve.kind == SpecialKind::Fold
            && found.branches[0].special[curve.through.1].point.parameter > 160.0
    };
    let curve = found.curves.iter().find(through).expect("the curve of the upper fold");
    assert!(curve.points.len() > 20);
    for &[omega, p_d] in curve.points.iter().step_by(7) {
        let mut p = two_attractors(omega - 1.0);
        p[Parameter::Pd] = p_d;
        let start = settled(&p, start.section[0]);
        let again = request(
            &p,
            start.section[0],
            start.period,
            Parameter::Omega,
            [omega - 2.0, omega + 2.0],
        );
        let again = follow(&again).expect("a branch");
        let folds = of_kind(&again.branches[0], SpecialKind::Fold);
        let nearest = folds.iter().map(|fold| relative(fold.point.parameter, omega));
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-9, "omega {omega}, p_d {p_d}: {nearest:e}");
    }
}

#[test]
fn whatever_is_followed_closes_and_ends() {
    let along = [Parameter::Omega, Parameter::Pd, Parameter::Delta, Parameter::K2, Parameter::MuS];
    let mut followed = 0;
    for (i, case) in draws::cases(60, 21).iter().enumerate() {
        let orbit = settle(&case.parameters, case.section_phase, &case.start, &Protocol::default());
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        let along = along[i % along.len()];
        let value = case.parameters[along];
        let range = [0.8 * value, 1.3 * value + 1e-4];
        let mut request = request(&case.parameters, orbit.section[0], orbit.period, along, range);
        (request.setting.phase, request.doublings, request.most_points) =
            (case.section_phase, 1, 400);
        let found = follow(&request).unwrap_or_else(|why| panic!("case {i}: {why:?}"));
        assert_closed(&found);
        followed += 1;
    }
    assert!(followed > 50);
}

#[test]
fn what_cannot_be_followed_is_said() {
    let p = Parameters::default();
    let nowhere = request(&p, [0.0; 3], 1, Parameter::Pd, [5.0, 6.0]);
    assert_eq!(follow(&nowhere), Err(NotFollowed::OutOfRange));
}

#[test]
fn the_equation_as_printed_is_followed_too() {
    let mut p = Parameters::with(&[(Parameter::MuS, 0.2), (Parameter::MuD, 0.1)]);
    p.switch_by(Switching::AsPrinted);
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    assert_eq!(orbit.outcome, Outcome::Periodic);
    let range = [3.6, 4.4];
    let request = request(&p, orbit.section[0], orbit.period, Parameter::Pd, range);
    let found = follow(&request).expect("a branch");
    assert_closed(&found);
    let points = &found.branches[0].points;
    assert!(points.len() > 5, "{}", points.len());
    // Where the orbits attract, the motion from near them settles to the same speed.
    for point in points.iter().filter(|it| it.multipliers[0].abs() < 0.9).step_by(3) {
        p[Parameter::Pd] = point.parameter;
        let [r, y1, y2] = point.section[0].array();
        let start = State::of([r, y1 * 1.000_1, 0.0, y2]);
        let orbit = settle(&p, 0.0, start, &Protocol::default());
        let speeds = [&orbit.outputs, &point.measured].map(|it| it[Output::ProgressionSpeed]);
        assert!((speeds[0] - speeds[1]).abs() < 1e-9, "{}: {speeds:?}", point.parameter);
    }
}
