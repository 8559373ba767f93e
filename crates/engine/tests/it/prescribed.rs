//! The capsule whose mass has a prescribed relative motion, against closed forms.

use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    CapsuleParameters as _, DriveKind, Orbit, Output, Parameter, Parameters, Resistance, State,
    settle, simulate,
};

/// Phase of the section, where no velocity jumps [rad].
const SECTION: f64 = 0.2;

/// A body of 1 kg with a mass of a fifth of it inside, under Coulomb friction.
fn body(kind: DriveKind, others: &[(Parameter, f64)]) -> Parameters {
    let mut p = Parameters::with(&[
        (Parameter::M1, 0.2),
        (Parameter::M2, 0.8),
        (Parameter::Period, 0.4),
        (Parameter::MuS, 0.2),
        (Parameter::MuD, 0.2),
    ]);
    p.resist_by(Resistance::Coulomb);
    p.drive_by(kind);
    for (parameter, value) in others {
        p[*parameter] = *value;
    }
    p
}

/// What it settles to from rest; its energy balances.
fn settled(p: &Parameters) -> Orbit {
    let orbit = settle(p, SECTION, State::default(), &Protocol::default());
    assert_eq!(orbit.outcome, Outcome::Periodic, "{p:?} {:?}", orbit.failure);
    for residual in [Output::EnergyResidual, Output::MomentumResidual] {
        assert!(orbit.outputs[residual].abs() < 1e-10, "{:e}", orbit.outputs[residual]);
    }
    orbit
}

/// The mean speed of a body that moves by constant accelerations in turn, each for a time, under a friction of constant deceleration:
/// pieces of parabolas, followed until they repeat.
fn by_parabolas(accelerations: &[(f64, f64)], friction: f64) -> f64 {
    let (mut speed, mut advance, mut period) = (0.0_f64, 0.0, 0.0);
    for _ in 0..400 {
        (advance, period) = (0.0, 0.0);
        for (acceleration, duration) in accelerations {
            let mut left: f64 = *duration;
            while left > 0.0 {
                let direction = if speed == 0.0 { acceleration.signum() } else { speed.signum() };
                let sum = acceleration - direction * friction;
                if speed == 0.0 && acceleration.abs() <= friction {
                    break;
                }
                let stops = -speed / sum;
                let time = if stops > 0.0 { left.min(stops) } else { left };
                advance += speed * time + 0.5 * sum * time * time;
                speed = if time == stops { 0.0 } else { speed + sum * time };
                left -= time;
            }
            period += duration;
        }
    }
    advance / period
}

/// A sine on isotropic ground leads nowhere.
#[test]
fn a_sine_leads_nowhere() {
    for amplitude in [0.002, 0.02, 0.06] {
        let p = body(DriveKind::Prescribed, &[(Parameter::Xi1, amplitude)]);
        let speed = settled(&p).outputs[Output::ProgressionSpeed];
        assert!(speed.abs() < 1e-12, "{amplitude}: {speed:e}");
    }
    // Two harmonics do, and half a turn of the second turns it round.
    let speeds = [0.7, 0.7 + std::f64::consts::PI].map(|phase| {
        let others = [(Parameter::Xi1, 0.04), (Parameter::Xi2, 0.015), (Parameter::Phase2, phase)];
        settled(&body(DriveKind::Prescribed, &others)).outputs[Output::ProgressionSpeed]
    });
    assert!(speeds[0].abs() > 1e-3 && (speeds[0] + speeds[1]).abs() < 1e-11, "{speeds:?}");
}

/// Three phases: pieces of parabolas in closed form.
#[test]
fn three_phases_move_the_body_by_parabolas() {
    let mut moving = 0;
    for (first, second) in [(0.25, 0.5), (0.1, 0.3), (0.3, 0.1), (0.05, 0.5), (0.4, 0.45)] {
        for stroke in [0.01, 0.05, 0.2] {
            let p = body(
                DriveKind::ThreePhase,
                &[
                    (Parameter::Share1, first),
                    (Parameter::Share2, second),
                    (Parameter::Stroke, stroke),
                ],
            );
            // Velocities up and down at the inner edges, of equal areas above and below zero.
            let third: f64 = 1.0 - first - second;
            let ratio = (first + second) / (second + third);
            let up = 2.0 * stroke / (0.4 * (first + second / (1.0 + ratio)));
            let times = [first, second, third].map(|share| 0.4 * share);
            let own = [up / times[0], -up * (1.0 + ratio) / times[1], ratio * up / times[2]];
            let all: Vec<(f64, f64)> = own.map(|it| -0.2 * it).into_iter().zip(times).collect();
            let exact = by_parabolas(&all, 0.2 * 9.81);
            let found = settled(&p).outputs[Output::ProgressionSpeed];
            assert!((found - exact).abs() < 1e-11, "{first} {second} {stroke}: {found} {exact}");
            moving += usize::from(exact.abs() > 1e-3);
        }
    }
    assert!(moving >= 6, "{moving}");
}

/// Two phases: the velocity jumps by the share of the mass, and friction brings the body to rest in the longer phase.
#[test]
fn two_phases_throw_the_body_by_the_share_of_the_mass() {
    for (duty, stroke) in [(0.1, 0.05), (0.2, 0.2), (0.05, 0.02)] {
        let p = body(DriveKind::TwoPhase, &[(Parameter::Duty, duty), (Parameter::Stroke, stroke)]);
        let (period, deceleration) = (0.4, 0.2 * 9.81);
        let thrown = 0.2 * stroke / (period * duty * (1.0 - duty));
        let short = duty * period;
        assert!(thrown > deceleration * short, "the body still slides when the mass turns back");
        let exact = duty * (deceleration * short - thrown);
        let orbit = settled(&p);
        let found = orbit.outputs[Output::ProgressionSpeed];
        assert!((found - exact).abs() < 1e-12, "{duty} {stroke}: {found} {exact}");
        // The drive gives the energy of the relative motion after each jump, and takes that before it.
        let speeds = [stroke / short, stroke / (period - short)];
        let given: f64 = speeds.iter().map(|u| 0.5 * 0.2 * 0.8 * u * u).sum();
        assert!(orbit.outputs[Output::WorkPositive] >= given * (1.0 - 1e-12));
    }
}

/// Where a motion is prescribed a start has no say in the place and the velocity of the mass.
#[test]
fn the_mass_starts_where_its_motion_puts_it() {
    let p = body(DriveKind::Prescribed, &[(Parameter::Xi1, 0.03)]);
    let starts = [State::default(), State { r: 0.4, y1: -3.0, ..State::default() }];
    let runs = starts.map(|start| simulate(&p, SECTION, start, 3, 1e-12).section);
    assert_eq!(runs[0], runs[1]);
    let begins = &runs[0][0];
    assert!((begins.r - 0.03 * libm::cos(SECTION)).abs() < 1e-15);
    let speed = -0.03 * p.frequency() * libm::sin(SECTION);
    assert!((begins.y1 - begins.y2 - speed).abs() < 1e-14);
}
