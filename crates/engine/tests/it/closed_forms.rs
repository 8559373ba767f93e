//! Motions with a closed form: the stuck capsule, free decay, coasting, Den Hartog's oscillator.

use std::f64::consts::PI;

use capsulemap_engine::orbit::{Outcome, Protocol};
use capsulemap_models::capsule::{
    CapsuleParameters as _, EventKind, Output, Parameter, Parameters, Resistance, State,
};

use super::forms::{settle, simulate};

const TOLERANCE: f64 = 1e-12;

/// Parameters under which the capsule sticks and the mass stays clear of the stop.
fn stuck(omega: f64, p_d: f64) -> Parameters {
    Parameters::with(&[(Parameter::Omega, omega), (Parameter::Pd, p_d), (Parameter::Delta, 1.0)])
}

/// Impedance Z and the response of F, sqrt(k1^2 + c^2 w^2).
fn impedance(p: &Parameters) -> (f64, f64) {
    let w = p[Parameter::Omega];
    let spring = p[Parameter::K1] - p[Parameter::M1] * w * w;
    let damper = p[Parameter::C] * w;
    (spring.hypot(damper), p[Parameter::K1].hypot(damper))
}

fn relative(a: f64, b: f64) -> f64 {
    ((a - b) / b).abs()
}

#[test]
fn stuck_capsule_is_a_forced_linear_oscillator() {
    for omega in [15.0, 60.0, 113.0, 180.0] {
        let p = stuck(omega, 0.3);
        let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
        assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
        let (z, _) = impedance(&p);
        let amplitude = p[Parameter::Pd] / z;
        // r = R cos(wt - phi), with tan phi = c w / (k1 - m1 w^2).
        let [r, y1, y2] = orbit.section[0].array();
        assert!(relative(r.hypot(y1 / omega), amplitude) < 1e-10, "{omega}");
        let phi =
            (p[Parameter::C] * omega).atan2(p[Parameter::K1] - p[Parameter::M1] * omega * omega);
        assert!((r - amplitude * phi.cos()).abs() < 1e-10 * amplitude);
        assert_eq!(y2, 0.0);
        let work = PI * p[Parameter::C] * omega * amplitude * amplitude;
        assert!(relative(orbit.outputs[Output::WorkNet], work) < 1e-10);
        assert!(relative(orbit.outputs[Output::DamperLoss], work) < 1e-10);
        assert_eq!(orbit.outputs[Output::ProgressionSpeed], 0.0);
        assert_eq!(orbit.outputs[Output::StickShare], 1.0);
        assert!(orbit.outputs[Output::CostOfTransport].is_infinite());
        // The integral of |p cos wt * y1|: the phase between force and velocity is known.
        let power = p[Parameter::Pd] * amplitude * omega;
        let exact = signed_parts(phi);
        assert!(relative(orbit.outputs[Output::WorkPositive], power / omega * exact.0) < 1e-10);
        assert!(relative(orbit.outputs[Output::WorkAbsolute], power / omega * exact.1) < 1e-10);
        let mean = power * exact.0 / (2.0 * PI);
        assert!(relative(orbit.outputs[Output::Power], mean) < 1e-10);
        assert!(orbit.outputs[Output::EnergyPerMetre].is_infinite());
        let margin = 1.0 - amplitude;
        assert!(relative(orbit.outputs[Output::GrazingMargin], margin) < 1e-12);
    }
}

/// Integrals over a cycle of max(0, f) and |f|, f = -cos(x) sin(x - phi).
fn signed_parts(phi: f64) -> (f64, f64) {
    // f = (sin phi - sin(2x - phi)) / 2 is negative where sin(2x - phi) > sin phi, that is for 2x - phi
    // between phi and pi - phi, twice a cycle.
    let net = PI * phi.sin();
    let negative = ((PI - 2.0 * phi) / 2.0).abs() * phi.sin() - phi.cos().abs();
    (net - negative, net - 2.0 * negative)
}

#[test]
fn contact_begins_at_the_grazing_amplitude() {
    for omega in [20.0, 60.0, 100.0] {
        let mut p = stuck(omega, 0.0);
        p[Parameter::Delta] = 1e-4;
        let graze = p[Parameter::Delta] * impedance(&p).0;
        for (factor, touches) in [(1.0 - 1e-6, false), (1.0 + 1e-6, true)] {
            p[Parameter::Pd] = graze * factor;
            let orbit = settle(&p, 0.0, quiet_start(&p), &Protocol::default());
            assert_eq!(orbit.outcome, Outcome::Periodic);
            let impacts = orbit.outputs[Output::ImpactsPerCycle];
            assert_eq!(impacts > 0.0, touches, "omega {omega}, factor {factor}");
            assert!(orbit.outputs[Output::GrazingMargin] < 2.1e-6 * p[Parameter::Delta]);
        }
    }
}

#[test]
fn slip_begins_at_the_onset_force() {
    for omega in [20.0, 60.0, 100.0] {
        let mut p = stuck(omega, 0.0);
        let (z, response) = impedance(&p);
        let onset = p[Parameter::MuS] * p.normal_load() * z / response;
        for (factor, slips) in [(1.0 - 1e-6, false), (1.0 + 1e-6, true)] {
            p[Parameter::Pd] = onset * factor;
            let orbit = settle(&p, 0.0, quiet_start(&p), &Protocol::default());
            let share = orbit.outputs[Output::StickShare];
            assert_eq!(share < 1.0, slips, "omega {omega}, factor {factor}, share {share}");
        }
    }
}

/// The start on the linear orbit, so that no transient slips or touches.
fn quiet_start(p: &Parameters) -> State<f64> {
    let omega = p[Parameter::Omega];
    let (z, _) = impedance(p);
    let amplitude = p[Parameter::Pd] / z;
    let phi = (p[Parameter::C] * omega).atan2(p[Parameter::K1] - p[Parameter::M1] * omega * omega);
    State::of([amplitude * phi.cos(), omega * amplitude * phi.sin(), 0.0, 0.0])
}

/// A block of mass 1 on a spring k = 1 to a wall that hardly moves, sliding on plain dry friction.
fn block(friction: f64) -> Parameters {
    let mut p = Parameters::with(&[
        (Parameter::M1, 1e12),
        (Parameter::M2, 1.0),
        (Parameter::K1, 1.0),
        (Parameter::C, 0.0),
        (Parameter::K2, 0.0),
        (Parameter::Delta, 1e9),
        (Parameter::Pd, 0.0),
        (Parameter::Omega, 1.0),
    ]);
    p[Parameter::MuD] = friction / p.normal_load();
    p[Parameter::MuS] = p[Parameter::MuD];
    p.resist_by(Resistance::Coulomb);
    p
}

#[test]
fn free_coulomb_decay_steps_by_twice_friction_over_stiffness() {
    let friction = 0.1;
    let p = block(friction);
    let start = State { r: -1.03, x2: 1.03, ..State::default() };
    let simulation = simulate(&p, 0.0, start, 4, TOLERANCE);
    let turns: Vec<f64> = simulation
        .events
        .iter()
        .filter(|e| matches!(e.kind, EventKind::Reversal | EventKind::Stick))
        .map(|e| e.t)
        .collect();
    // Half periods of pi until |x| <= f/k: 1.03, -0.83, 0.63, -0.43, 0.23, -0.03.
    assert_eq!(turns.len(), 5, "{turns:?}");
    for (i, turn) in turns.iter().enumerate() {
        assert!((turn - PI * (i + 1) as f64).abs() < 1e-10, "{turns:?}");
    }
    let end = simulation.section.last().expect("a section");
    assert!((end.x2 + 0.03).abs() < 1e-10 && end.y2 == 0.0, "{end:?}");
    // What the spring lost, friction took.
    let lost = (1.03_f64.powi(2) - 0.03_f64.powi(2)) / 2.0;
    assert!(relative(end.energies.friction_loss, lost) < 1e-10);
}

/// A capsule that nothing but the ground slows down, from 1 m/s, within a cycle.
fn coasting(law: Resistance, v_s: f64) -> Parameters {
    let mut p = Parameters::with(&[
        (Parameter::M1, 1e-12),
        (Parameter::M2, 0.5),
        (Parameter::K1, 0.0),
        (Parameter::C, 0.0),
        (Parameter::K2, 0.0),
        (Parameter::Pd, 0.0),
        (Parameter::Omega, 2.0 * PI),
        (Parameter::Vs, v_s),
    ]);
    if law == Resistance::Medium {
        (p[Parameter::C1], p[Parameter::C2]) = (0.4, 3.0);
    }
    p.resist_by(law);
    p
}

/// The integral of u / (1 + e^-u) from 0 to `end`: end^2/2 - pi^2/12 and what is left of the series beyond.
fn stribeck_integral(end: f64) -> f64 {
    let tail = |n: i32| {
        let n = f64::from(n);
        let sign = if n % 2.0 == 1.0 { 1.0 } else { -1.0 };
        sign * libm::exp(-n * end) * (end / n + 1.0 / (n * n))
    };
    0.5 * end * end - PI * PI / 12.0 + (1..60).map(tail).sum::<f64>()
}

#[test]
fn coasting_down_through_the_friction_layer_ends_where_and_when_the_laws_say() {
    // From 10 to 10 000 Stribeck velocities: a step that jumps over the layer around rest stops too late.
    for widths in [10.0, 33.0, 100.0, 1000.0, 10_000.0] {
        let v_s = 1.0 / widths;
        for v0 in [1.0, -1.0] {
            let start = State { y2: v0, ..State::default() };
            let p = coasting(Resistance::CoulombStribeck, v_s);
            let deceleration = p[Parameter::MuD] * p.normal_load() / p[Parameter::M2];
            let time =
                v_s / deceleration * (widths + libm::log1p(libm::exp(-widths)) - libm::log(2.0));
            let distance = v0 * v_s * v_s / deceleration * stribeck_integral(widths);
            coasts_to(&p, start, time, distance);

            let p = coasting(Resistance::Coulomb, v_s);
            coasts_to(&p, start, 1.0 / deceleration, v0 * 0.5 / deceleration);

            let p = coasting(Resistance::Medium, v_s);
            let (m2, c1, c2) = (p[Parameter::M2], p[Parameter::C1], p[Parameter::C2]);
            let simulation = simulate(&p, 0.0, start, 1, TOLERANCE);
            let end = simulation.section.last().expect("a section");
            let gone = -libm::expm1(-c1 / m2);
            let speed = v0 * libm::exp(-c1 / m2) / (1.0 + c2 / c1 * gone);
            let distance = v0 * m2 / c2 * libm::log1p(c2 / c1 * gone);
            assert!(relative(end.y2, speed) < 1e-10, "{} {speed}", end.y2);
            assert!(relative(end.x2, distance) < 1e-10, "{} {distance}", end.x2);
        }
    }
}

/// Follows the capsule to rest, and compares when and where with `time` [s] and `distance` [m].
fn coasts_to(p: &Parameters, start: State<f64>, time: f64, distance: f64) {
    let simulation = simulate(p, 0.0, start, 1, TOLERANCE);
    let stop = simulation.events.iter().find(|event| event.kind == EventKind::Stick);
    let stop = stop.expect("it stops").t;
    let end = simulation.section.last().expect("a section");
    assert_eq!(end.y2, 0.0);
    let about = format!("{:?}, v_s {}", p.resistance(), p[Parameter::Vs]);
    assert!(relative(stop, time) < 1e-10, "{about}: {stop} s, exactly {time} s");
    assert!(relative(end.x2, distance) < 1e-10, "{about}: {} m, exactly {distance} m", end.x2);
}

#[test]
fn coasting_in_a_medium_follows_the_drag() {
    let coast = |c1: f64, c2: f64| {
        let mut p = Parameters::with(&[
            (Parameter::M1, 1e-12),
            (Parameter::M2, 0.5),
            (Parameter::K1, 0.0),
            (Parameter::C, 0.0),
            (Parameter::K2, 0.0),
            (Parameter::Pd, 0.0),
            (Parameter::Omega, 2.0 * PI),
            (Parameter::C1, c1),
            (Parameter::C2, c2),
        ]);
        p.resist_by(Resistance::Medium);
        let start = State { y2: -2.0, ..State::default() };
        simulate(&p, 0.0, start, 3, TOLERANCE).section.last().expect("a section").y2
    };
    assert!(relative(coast(0.4, 0.0), -2.0 * (-0.4 * 3.0 / 0.5_f64).exp()) < 1e-11);
    assert!(relative(coast(0.0, 0.7), -2.0 / (1.0 + 0.7 * 2.0 * 3.0 / 0.5)) < 1e-11);
    // Both: v = v0 e^{-at} / (1 + (b/a) v0 (1 - e^{-at})), a = c1/m, b = c2/m.
    let (a, b, decay) = (0.8, 1.4, (-0.8 * 3.0_f64).exp());
    let exact = -2.0 * decay / (1.0 + b / a * 2.0 * (1.0 - decay));
    assert!(relative(coast(0.4, 0.7), exact) < 1e-11);
}

#[test]
fn den_hartogs_amplitude_is_met() {
    // A block under dry friction whose wall moves by -cos(wt): no rest for these ratios.
    for (omega, ratio) in [(0.6, 0.2), (0.8, 0.3), (1.5, 0.2), (2.0, 0.15)] {
        let mut p = block(ratio);
        p[Parameter::M1] = 1e9;
        p[Parameter::Omega] = omega;
        p[Parameter::Pd] = omega * omega * 1e9;
        p[Parameter::MuD] = ratio / p.normal_load();
        p[Parameter::MuS] = p[Parameter::MuD];
        let start = State { r: -1.0, ..State::default() };
        let protocol = Protocol { max_cycles: 400, ..Protocol::default() };
        let orbit = settle(&p, 0.0, start, &protocol);
        // Over a cycle friction acts along four amplitudes.
        let amplitude = orbit.outputs[Output::FrictionLoss] / (4.0 * ratio);
        let b = omega;
        let v = 1.0 / (1.0 - b * b);
        let u = (PI / b).sin() / (b * (1.0 + (PI / b).cos()));
        let exact = (v * v - ratio * ratio * u * u).sqrt();
        assert!(relative(amplitude, exact) < 1e-8, "w {omega}: {amplitude} {exact}");
    }
}

#[test]
fn without_a_stop_the_capsule_does_not_drift() {
    for (omega, p_d) in [(60.0, 5.0), (90.0, 6.0), (110.0, 3.0), (140.0, 8.0)] {
        let mut p = stuck(omega, p_d);
        for law in [Resistance::CoulombStribeck, Resistance::Coulomb, Resistance::Medium] {
            p.resist_by(law);
            (p[Parameter::C1], p[Parameter::C2]) = (0.8, 3.0);
            let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
            assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1), "{omega} {law:?}");
            assert!(orbit.outputs[Output::StickShare] < 1.0, "{omega} {law:?}: it must move");
            let speed = orbit.outputs[Output::ProgressionSpeed];
            // The section repeats to 1e-11 of some 0.3 m/s; drag takes a few cycles to level that out.
            assert!(speed.abs() < 1e-11, "omega {omega}, {law:?}: {speed:e} m/s");
        }
    }
}

#[test]
fn what_only_shakes_has_no_finite_cost_of_transport() {
    // Slipping to and fro without a stop: the rounding of the progression is no progress.
    let p = stuck(90.0, 6.0);
    let orbit = settle(&p, 0.0, State::default(), &Protocol::default());
    assert!(orbit.outputs[Output::StickShare] < 1.0);
    assert!(orbit.outputs[Output::CostOfTransport].is_infinite());
}
