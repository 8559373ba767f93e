//! The capsule with a rigid stop, and with stops that are left by their force, against closed forms.

use std::f64::consts::PI;

use capsulemap_engine::flow::Reason;
use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    CapsuleParameters as _, CapsuleState as _, DriveKind, EventKind, Output, Parameter, Parameters,
    Release, Resistance, Simulation, State, settle, simulate,
};

use super::impact_orbits::OneImpact;

/// A mass of 1 kg on a capsule so heavy that no impact moves it, before a rigid stop at r = 0.
fn held(restitution: f64, others: &[(Parameter, f64)]) -> Parameters {
    let mut p = Parameters::with(&[
        (Parameter::M1, 1.0),
        (Parameter::M2, 1e14),
        (Parameter::K1, 0.0),
        (Parameter::C, 0.0),
        (Parameter::Delta, 0.0),
        (Parameter::MuS, 1.0),
        (Parameter::MuD, 1.0),
        (Parameter::Restitution, restitution),
    ]);
    p.resist_by(Resistance::Coulomb);
    for (parameter, value) in others {
        p[*parameter] = *value;
    }
    p
}

/// The times of a kind of event.
fn times(run: &Simulation, kind: EventKind) -> Vec<f64> {
    run.events.iter().filter(|it| it.kind == kind).map(|it| it.t).collect()
}

/// Orbits of one impact in n periods: those of a mass between a spring and a fixed stop, in closed form.
#[test]
fn one_impact_orbits_of_a_held_capsule_are_in_closed_form() {
    let mut met = 0;
    for n in 1..=4_u32 {
        for (c, e, share) in
            [(0.1, 0.3, 0.85), (0.1, 0.6, 1.15), (0.0, 0.8, 0.93), (0.1, 0.95, 1.3)]
        {
            let orbit = OneImpact::new(u64::from(n), 2.0 * f64::from(n) * share, e, c);
            if !orbit.is_possible() {
                continue;
            }
            let omega = orbit.oscillator.omega;
            let p = held(
                e,
                &[
                    (Parameter::K1, 1.0),
                    (Parameter::C, c),
                    (Parameter::Pd, 1.0),
                    (Parameter::Omega, omega),
                ],
            );
            let [r, y1] = orbit.section();
            let run = simulate(&p, 0.0, State::of([r, y1, 0.0, 0.0]), orbit.n, 1e-13);
            assert!(run.failure.is_none(), "{:?}", run.failure);
            let last = run.section.last().expect("a section");
            let miss = (last.r - r).abs().max((last.y1 - y1).abs()) / orbit.speed.max(1e-3);
            assert!(miss < 1e-10, "n {n} {e} {c}: {miss:e}");
            assert_eq!(times(&run, EventKind::ContactClosed).len(), 1);
            met += 1;
        }
    }
    assert!(met >= 8, "{met}");
}

/// A mass under a constant force towards the stop bounces as a ball on the ground does: its flights are a geometric series, and it stays
/// at the stop when they are over, until the force turns round.
#[test]
fn impacts_that_accumulate_end_in_a_contact_that_lasts() {
    for e in [0.0, 0.3, 0.5, 0.8, 0.9] {
        let (force, height) = (2.0, 0.02);
        let mut p = held(
            e,
            &[
                (Parameter::Pd, force),
                (Parameter::PLow, -1.0),
                (Parameter::Duty, 0.9),
                (Parameter::Period, 20.0),
            ],
        );
        p.drive_by(DriveKind::Square);
        let start = State { r: -height, ..State::default() };
        let run = simulate(&p, 0.0, start, 1, 1e-13);
        assert!(run.failure.is_none(), "{e}: {:?}", run.failure);
        let impacts = times(&run, EventKind::ContactClosed);
        let first = (2.0 * height / force).sqrt();
        let speed = force * first;
        let (mut expected, mut flight) = (first, 2.0 * e * speed / force);
        for t in &impacts {
            assert!((t - expected).abs() < 1e-11, "{e}: {t} {expected}");
            (expected, flight) = (expected + flight, e * flight);
        }
        // The flights that are left out would be over within 1e-9 of the period beside a capsule that still slides; with one more they
        // would not.
        let over = flight * force / ((force + 9.81) * (1.0 - e));
        assert!(e == 0.0 || (over < 20e-9 * e && over > 20e-9 * e * e), "{e}: {over:e}");
        let opened = times(&run, EventKind::ContactOpened);
        assert_eq!(opened, [18.0], "{e}: it is let go at the edge of the drive");
        let last = run.section.last().expect("a section");
        assert!((last.r + 0.5 * 4.0).abs() < 1e-12, "{e}: {}", last.r);
    }
}

/// A contact that lasts ends where the force of the stop falls to zero, and the mass leaves it with the third derivative.
#[test]
fn a_contact_that_lasts_ends_where_its_force_does() {
    let (k1, force) = (3.0, 2.0);
    let p = held(
        0.4,
        &[
            (Parameter::K1, k1),
            (Parameter::Delta, 0.1),
            (Parameter::Pd, force),
            (Parameter::Omega, 0.1),
        ],
    );
    // From the stop on, pressed by 2 N against 0.3 N.
    let start = State { r: 0.1, ..State::default() };
    let run = simulate(&p, 0.0, start, 1, 1e-13);
    let opened = times(&run, EventKind::ContactOpened);
    let expected = libm::acos(k1 * 0.1 / force) / 0.1;
    assert!((opened[0] - expected).abs() < 1e-11, "{} {expected}", opened[0]);
    assert!(times(&run, EventKind::ContactClosed).iter().all(|t| *t > opened[0]));
}

/// A free capsule and its mass keep their momentum in an impact, also out of rest, and lose the energy of the restitution.
#[test]
fn an_impact_keeps_the_momentum_and_sets_a_resting_capsule_in_motion() {
    for (m2, y2, e) in [(0.5, 0.0, 0.6), (2.0, -0.3, 0.8), (0.5, -0.05, 0.2), (1.0, 0.2, 1.0)] {
        let mut p = held(e, &[(Parameter::M2, m2), (Parameter::Delta, 1.0), (Parameter::Pd, 0.0)]);
        p[Parameter::MuS] = 2.0;
        let period = 1e-3;
        p[Parameter::Period] = period;
        let y1 = 0.7;
        let run = simulate(&p, 0.0, State::of([1.0 - 1e-14, y1, 0.0, y2]), 1, 1e-13);
        let (relative, total) = (y1 - y2, 1.0 + m2);
        let mass = y1 - (1.0 + e) * m2 / total * relative;
        let capsule = y2 + (1.0 + e) / total * relative;
        // The capsule then slides forward under friction alone.
        let deceleration = total * 9.81 / m2;
        let last = run.section.last().expect("a section");
        let slid = capsule * period - 0.5 * deceleration * period * period;
        assert!((last.y1 - mass).abs() < 1e-11, "{} {mass}", last.y1);
        assert!((last.y2 - (capsule - deceleration * period)).abs() < 1e-11, "{}", last.y2);
        assert!((last.x2 - slid).abs() < 1e-11, "{} {slid}", last.x2);
    }
}

/// A stop that damps and may not pull lets go where its force falls to zero: with stiffness k and damping c on a free mass that meets it
/// with the speed v, that is at a known time and speed.
#[test]
fn a_damped_stop_lets_go_where_its_force_falls_to_zero() {
    let (k, c, speed) = (400.0, 6.0, 0.5);
    let mut p = Parameters::with(&[
        (Parameter::M1, 1.0),
        (Parameter::M2, 1e14),
        (Parameter::K1, 0.0),
        (Parameter::C, 0.0),
        (Parameter::K2, k),
        (Parameter::Delta, 0.0),
        (Parameter::Pd, 0.0),
        (Parameter::K2Damping, c),
    ]);
    // In contact r = v/w e^(-c t/2) sin(w t), and the force is zero where tan(w t) = w c/(c^2/2 - k).
    let turns = (k - 0.25 * c * c).sqrt();
    let when = [Release::Geometry, Release::Force].map(|release| {
        p.release_by(release);
        let start = State { r: -0.1, y1: speed, ..State::default() };
        let run = simulate(&p, 0.0, start, 20, 1e-13);
        let [closed, opened] =
            [EventKind::ContactClosed, EventKind::ContactOpened].map(|kind| times(&run, kind)[0]);
        assert!((closed - 0.2).abs() < 1e-12, "{closed}");
        (opened - closed, run.section.last().expect("a section").y1)
    });
    let by_geometry = PI / turns;
    assert!((when[0].0 - by_geometry).abs() < 1e-11, "{:?}", when[0]);
    assert!((when[0].1 + speed * libm::exp(-0.5 * c * by_geometry)).abs() < 1e-11, "{:?}", when[0]);
    let by_force = libm::atan2(turns * c, 0.5 * c * c - k) / turns;
    let (sin, cos) = (libm::sin(turns * by_force), libm::cos(turns * by_force));
    let leaves = speed * libm::exp(-0.5 * c * by_force) * (cos - 0.5 * c / turns * sin);
    assert!((when[1].0 - by_force).abs() < 1e-11, "{:?} {by_force}", when[1]);
    assert!((when[1].1 - leaves).abs() < 1e-11, "{:?} {leaves}", when[1]);
}

/// The energy of certified orbits with a rigid stop balances, that of lasting contacts included.
#[test]
fn what_impacts_lose_balances_the_work_of_the_drive() {
    let mut met = [0; 2];
    for number in 0..40 {
        let mut p = Parameters::with(&[
            (Parameter::Omega, 20.0 + 3.0 * f64::from(number)),
            (Parameter::Pd, 6.0),
            (Parameter::Delta, 5e-4 * f64::from(number % 5)),
            (Parameter::Restitution, 0.1 * f64::from(number % 9)),
        ]);
        p[Parameter::MuS] = 0.4;
        p[Parameter::MuD] = 0.15;
        let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
        assert!(orbit.failure.is_none(), "{p:?}: {:?}", orbit.failure);
        if orbit.outcome != Outcome::Periodic {
            continue;
        }
        let [residual, bearing, lost] =
            [Output::EnergyResidual, Output::PeakContactForce, Output::ContactLoss]
                .map(|it| orbit.outputs[it]);
        assert!(residual.abs() < 1e-9, "{residual:e}: {p:?}");
        // A force is that of a contact that lasts.
        met[usize::from(bearing > 0.0)] += usize::from(lost > 0.0);
    }
    assert!(met[0] > 5 && met[1] > 0, "{met:?}");
}

/// A capsule that is about to break away with its mass at the stop is let go of where sliding turns the force of the stop into a pull.
#[test]
fn a_start_at_the_stop_is_decided_by_the_motion_that_follows() {
    let mut p = Parameters::with(&[
        (Parameter::Pd, 7.2),
        (Parameter::Delta, 5e-3),
        (Parameter::Restitution, 0.5),
    ]);
    p.drive_by(DriveKind::Square);
    let period = 1e-4;
    (p[Parameter::Duty], p[Parameter::Period]) = (0.999, period);
    let start = State { r: 5e-3, ..State::default() };
    let run = simulate(&p, 0.0, start, 1, 1e-13);
    let last = run.section.last().expect("a section");
    // Both are free at once: the mass under drive and spring, the capsule under the spring and twice mu_d N.
    let spring = 1420.0 * 5e-3;
    let friction = 2.0 * 0.33 * (0.11 + 0.53) * 9.81;
    let relative = (7.2 - spring) / 0.11 - (spring - friction) / 0.53;
    let exact = 0.5 * relative * period * period;
    assert!(
        relative < 0.0 && (last.r - 5e-3 - exact).abs() < 0.02 * exact.abs(),
        "{:e}",
        last.r - 5e-3
    );
    assert!(run.events.iter().all(|it| it.kind != EventKind::ContactClosed), "{:?}", run.events);
    // Behind the stop nothing starts.
    let behind = State { r: 6e-3, ..State::default() };
    assert!(simulate(&p, 0.0, behind, 1, 1e-13).failure.is_some());
}

/// Nothing is behind a rigid stop: a case that starts there fails at once, and says why.
#[test]
fn no_motion_starts_behind_a_rigid_stop() {
    let p = held(0.5, &[(Parameter::Delta, 1e-3), (Parameter::K1, 1.0)]);
    let behind = State::of([1.5e-3, 0.0, 0.0, 0.0]);
    let orbit = settle(&p, 0.0, behind, &Protocol::default());
    let failure = orbit.failure.expect("nothing is there");
    assert_eq!((orbit.outcome, failure.reason), (Outcome::Failed, Reason::NoStart));
    assert_eq!(failure.state.capsule(), behind);
    let run = simulate(&p, 0.0, behind, 3, 1e-12);
    assert_eq!(run.failure.map(|it| it.reason), Some(Reason::NoStart));
    let before = settle(&p, 0.0, State::of([1e-3, 0.0, 0.0, 0.0]), &Protocol::default());
    assert!(before.failure.is_none(), "{before:?}");
}
