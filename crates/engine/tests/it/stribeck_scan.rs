//! The motion at every width of the friction layer, against a second method that shares no code with the series.

use capsulemap_models::capsule::{Parameter, State};

use super::contract::example;
use super::forms::simulate;
use super::second_method::follow;

const CYCLES: u64 = 6;

#[test]
fn the_motion_is_that_of_a_second_method_at_every_stribeck_velocity() {
    let mut worst = (0.0, 0.0);
    for i in 0..=28 {
        let v_s = 1e-4 * libm::pow(5e4, f64::from(i) / 28.0);
        let mut p = example().parameters;
        p[Parameter::Vs] = v_s;
        let ours = simulate(&p, 0.0, State::default(), CYCLES, 1e-12);
        let theirs = follow(&p, 0.0, State::default(), CYCLES);
        let omega = p[Parameter::Omega];
        let size = ours.section.iter().map(|s| s.y1.abs().max(s.y2.abs())).fold(0.0, f64::max);
        let mut error = 0.0_f64;
        for (a, [r, y1, x2, y2]) in ours.section.iter().zip(theirs) {
            let apart = [omega * (a.r - r), a.y1 - y1, omega * (a.x2 - x2), a.y2 - y2];
            error = apart.iter().fold(error, |error, x| error.max(x.abs() / size));
        }
        if error > worst.0 {
            worst = (error, v_s);
        }
    }
    println!("largest difference {:.1e} of the velocity, at v_s = {:.2e} m/s", worst.0, worst.1);
    assert!(worst.0 < 1e-9, "{:e} at v_s = {} m/s", worst.0, worst.1);
}
