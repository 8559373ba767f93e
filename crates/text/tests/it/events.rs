//! Events, switches and pulses against closed forms.

use capsulemap_engine::flow::System as _;
use capsulemap_engine::orbit::{Case, Outcome, Protocol, Trajectory, settle};

use super::six::{A3, D3, program};

/// The state of a driven oscillator after so many cycles from a start.
fn after(text: &str, start: [f64; 5], cycles: u32) -> [f64; 5] {
    let single = D3::new(program(text)).single();
    let mut trajectory = Trajectory::<_, 3>::begun(&single, start, 0.0, 1e-14);
    for _ in 0..cycles {
        assert!(trajectory.cycle(|_| ()).is_ok(), "the motion can be followed");
    }
    trajectory.state()
}

/// Integrate and fire: x rises to 1 and begins again at 0, in a time of its own.
#[test]
fn an_event_that_leaves_its_surface_is_met_again_only_there() {
    let text = "[system]
name = \"integrate and fire\"
states = { x = \"1\", n = \"1\" }
section = { every = 10.0 }
[system.parameters]
current = 1.5
[system.rates]
x = \"current - x\"
n = \"0\"
[[system.events]]
name = \"fires\"
while = \"x < 1\"
reset = { x = \"0\", n = \"n + 1\" }
";
    let [x, n, ..] = after(text, [0.0; 5], 1);
    // From 0 to 1 it takes ln(current/(current - 1)).
    let takes = libm::log(1.5 / 0.5);
    let times = (10.0 / takes).floor();
    assert_eq!(n, times);
    let exact = 1.5 * (1.0 - libm::exp(-(10.0 - times * takes)));
    assert!((x - exact).abs() < 1e-13, "{x} {exact}");
}

/// A mass that is decelerated more while it moves forward than backward, between two walls.
#[test]
fn a_switch_follows_a_velocity_that_an_impact_turns_round() {
    let text = "[system]
name = \"drag by direction\"
states = { x = \"1\", v = \"1\" }
section = { every = 1.0 }
[system.parameters]
e = 0.8
[system.switch.forward]
where = \"v > 0\"
[system.rates]
x = \"v\"
v = \"-(0.1 + 0.3*forward)*v\"
[[system.events]]
name = \"impact\"
while = \"x < 1\"
reset = { v = \"-e*v\" }
";
    let [x, v, ..] = after(text, [0.0, 2.0, 0.0, 0.0, 0.0], 1);
    // v falls by 0.4 x on the way there, and by 0.1 x on the way back.
    let arrives = 2.0 - 0.4;
    let time = -libm::log(arrives / 2.0) / 0.4;
    let back = -0.8 * arrives;
    let exact = back * libm::exp(-0.1 * (1.0 - time));
    assert!((v - exact).abs() < 1e-13, "{v} {exact}");
    assert!((x - (1.0 + (back - exact) / 0.1)).abs() < 1e-12, "{x}");
}

/// A smooth friction so steep that a step would see nothing of its layer.
#[test]
fn a_steep_hyperbolic_tangent_is_not_jumped_over() {
    let text = "[system]
name = \"smooth friction\"
states = { x = \"1\", v = \"1\" }
section = { every = \"2*pi\" }
[system.parameters]
mu = 0.3
[system.rates]
x = \"v\"
v = \"cos(t) - mu*tanh(v/1e-4)\"
";
    let system = D3::new(program(text));
    let orbit = settle(&Case::new(system, [0.0; 5]), &Protocol::default());
    assert!(orbit.defect < 1e-9, "{:e}", orbit.defect);
    // Dry friction of the same size: v has no mean, and the largest speed is that of a mass that never rests.
    let single = D3::new(program(text)).single();
    let mut trajectory = Trajectory::<_, 3>::begun(&single, [0.0; 5], 0.0, 1e-12);
    let (mut largest, mut least) = (0.0_f64, 0.0_f64);
    for cycle in 0..60 {
        let followed = trajectory.cycle(|step| {
            if cycle == 59 {
                largest = largest.max(step.jet.registers[1][0]);
                least = least.min(step.jet.registers[1][0]);
            }
        });
        assert!(followed.is_ok());
    }
    assert!((largest + least).abs() < 0.02 && largest > 0.5, "{largest} {least}");
}

/// A start behind the bound of an event, and a duty that makes no pulse, are no motions.
#[test]
fn what_has_no_start_fails() {
    let text = super::six::characters("impact.toml");
    let system = D3::new(program(&text));
    let behind = settle(&Case::new(system, [1.5, 0.0, 0.0, 0.0, 0.0]), &Protocol::default());
    assert_eq!(behind.outcome, Outcome::Failed);
    let pulse = D3::new(program(&super::six::characters("pulse.toml")));
    for duty in [0.0, 1.0, -0.5, 1.5] {
        let system = pulse.with_named("D", duty);
        let orbit = settle(&Case::new(system, [0.0; 5]), &Protocol::default());
        assert_eq!(orbit.outcome, Outcome::Failed, "{duty}");
    }
}

/// The period of a pendulum of small amplitude, and of x'' = -sign(x) by a switch: 4 sqrt(2 x).
#[test]
fn an_autonomous_motion_takes_its_time() {
    let text = "[system]
name = \"pulled to the middle\"
states = { x = \"1\", v = \"1\" }
section = { when = \"v falls\", within = 100.0 }
[system.switch.right]
where = \"x > 0\"
[system.rates]
x = \"v\"
v = \"1 - 2*right\"
";
    let single = A3::new(program(text)).single();
    let mut trajectory = Trajectory::<_, 3>::begun(&single, [0.7, 0.0, 0.0, 0.0, 0.0], 0.0, 1e-14);
    assert!(trajectory.cycle(|_| ()).is_ok());
    let exact = 4.0 * libm::sqrt(2.0 * 0.7);
    assert!((trajectory.elapsed() - exact).abs() < 1e-12, "{} {exact}", trajectory.elapsed());
    assert!((trajectory.state()[0] - 0.7).abs() < 1e-13);
}
