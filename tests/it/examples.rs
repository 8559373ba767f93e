//! The examples hold what they claim, as one object each.

use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

/// The object that an example prints, which has asserted its claims by then.
fn object(name: &str) -> Value {
    let mut path = PathBuf::from(env!("CARGO_BIN_EXE_capsulemap"));
    path.pop();
    let output = Command::new(path.join("examples").join(name))
        .arg("--json")
        .output()
        .expect("the example is built with the tests");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{name}: {said}");
    serde_json::from_slice(&output.stdout).expect("one object")
}

#[test]
fn duffings_oscillator_has_five_attractors() {
    let duffing = object("duffing");
    assert_eq!(duffing["attractors"], 5);
    let sum: f64 =
        duffing["shares"].as_array().expect("a list").iter().filter_map(Value::as_f64).sum();
    assert!((sum - 1.0).abs() < 1e-12, "every start leads to one of them: {sum}");
}

#[test]
fn the_belts_cycle_disappears_where_published() {
    let belt = object("belt");
    let number = |name: &str| belt[name].as_f64().expect("a number");
    assert!((number("cycle_disappears_v") - 1.8366).abs() < 5e-5);
    // Steady sliding loses its stability where the slope of friction beats the damper, at s ln(a/(c s)).
    assert!((number("sliding_unstable_v") - 0.5 * 10.0_f64.ln()).abs() < 1e-9);
}
