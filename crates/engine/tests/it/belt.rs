//! The stick-slip oscillator on a belt that the capsule becomes with a heavy mass: published shares.

use std::f64::consts::PI;

use super::forms::simulate;
use capsulemap_models::capsule::{CapsuleParameters as _, Parameter, Parameters, State, Switching};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

const STARTS: usize = 2000;

/// The belt's oscillator, with a section every half second.
fn belt(switching: Switching) -> Parameters {
    let mut p = Parameters::with(&[
        (Parameter::M1, 1e12),
        (Parameter::M2, 1.0),
        (Parameter::K1, 1.0),
        (Parameter::C, 0.1),
        (Parameter::K2, 0.0),
        (Parameter::Delta, 1e9),
        (Parameter::Pd, 0.0),
        (Parameter::Vs, 0.5),
        (Parameter::Omega, 4.0 * PI),
    ]);
    p[Parameter::MuD] = 0.5 / p.normal_load();
    p[Parameter::MuS] = 1.0 / p.normal_load();
    p.switch_by(switching);
    p
}

/// Share of starts, uniform over [-2, 2] x [0, 2], whose |v| exceeds 0.2 in the last 100 of 500 s.
fn stick_slip_share(v_d: f64, switching: Switching, starts: usize) -> f64 {
    let p = belt(switching);
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut uniform = |low: f64, high: f64| {
        low + (high - low) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut sticking = 0;
    for _ in 0..starts {
        let (x, v) = (uniform(-2.0, 2.0), uniform(0.0, 2.0));
        let start = State::of([-x, -v_d, x, v - v_d]);
        let simulation = simulate(&p, 0.0, start, 1000, 1e-12);
        assert!(simulation.failure.is_none());
        let mut late = simulation.section.iter().filter(|sample| sample.t > 400.0);
        sticking += usize::from(late.any(|sample| (sample.y2 - sample.y1).abs() > 0.2));
    }
    sticking as f64 / starts as f64
}

#[test]
fn shares_of_stick_slip_are_the_published_ones() {
    // Stender and Hoffmann (2021), friction case; 2000 starts there and here.
    for (v_d, published) in [(1.25, 0.920), (1.475, 0.702), (1.7, 0.4915)] {
        let share = stick_slip_share(v_d, Switching::Filippov, STARTS);
        let error: f64 = published * (1.0 - published) / STARTS as f64;
        let apart = (share - published) / (2.0 * error).sqrt();
        println!("v_d {v_d}: {share:.4}, published {published:.4}, {apart:+.1} standard errors");
        assert!(apart.abs() < 3.0, "v_d {v_d}: {share} instead of {published}");
    }
    assert_eq!(stick_slip_share(1.0, Switching::Filippov, 200), 1.0);
    assert_eq!(stick_slip_share(1.9, Switching::Filippov, 200), 0.0);
}

#[test]
fn steady_sliding_loses_stability_where_the_formula_says() {
    // The friction's slope beats the damper below v_d = 0.5 ln 10.
    let critical = 0.5 * 10.0_f64.ln();
    for (factor, decays) in [(0.98, false), (1.02, true)] {
        let v_d = critical * factor;
        let p = belt(Switching::Filippov);
        let friction = 0.5 * (1.0 + (-v_d / 0.5_f64).exp());
        // At rest in the room the spring carries the friction, and r = -x2.
        let start = State::of([-friction + 1e-6, -v_d, friction, -v_d]);
        let simulation = simulate(&p, 0.0, start, 4000, 1e-12);
        let departure = |n: usize| {
            let sample = &simulation.section[n];
            (sample.y2 + v_d).hypot(sample.r + friction)
        };
        assert_eq!(departure(4000) < departure(400), decays, "{factor}");
    }
}

#[test]
fn as_printed_nearly_everything_sticks() {
    let share = stick_slip_share(1.7, Switching::AsPrinted, 300);
    println!("as printed, v_d 1.7: {share:.3}");
    assert!(share > 0.95, "{share}");
}
