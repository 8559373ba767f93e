//! The examples hold what they claim, as one object each.

use std::process::Command;

use serde_json::Value;

/// The object that an example prints with these arguments, which has asserted its claims by then.
fn object(name: &str, arguments: &[&str]) -> Value {
    // Beside the folder of the tests.
    let tests = std::env::current_exe().expect("the path of this program");
    let built = tests.ancestors().nth(2).expect("the folder of what is built");
    let output = Command::new(built.join("examples").join(name))
        .arg("--json")
        .args(arguments)
        .output()
        .expect("the example is built with the tests");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{name}: {said}");
    serde_json::from_slice(&output.stdout).expect("one object")
}

#[test]
fn duffings_oscillator_has_five_attractors() {
    let duffing = object("duffing", &[]);
    assert_eq!(duffing["attractors"], 5);
    let numbers = |name: &str| -> Vec<f64> {
        duffing[name].as_array().expect("a list").iter().filter_map(Value::as_f64).collect()
    };
    let (shares, errors) = (numbers("shares"), numbers("errors"));
    let sum: f64 = shares.iter().sum();
    assert!((sum - 1.0).abs() < 1e-12, "every start leads to one of them: {sum}");
    // Stender and Hoffmann (2021), 4000 starts drawn from the same window; which of two orbits of one period is which is
    // not published.
    let published = [[0.1955, 0.4945], [0.026, 0.0275]];
    let of_period = [[shares[0], shares[1]], [shares[2], shares[3]]];
    let mut compared = vec![(shares[4], errors[4], 0.256)];
    for (place, (mut ours, theirs)) in of_period.into_iter().zip(published).enumerate() {
        ours.sort_by(f64::total_cmp);
        let error = errors[2 * place].max(errors[2 * place + 1]);
        compared.extend(ours.into_iter().zip(theirs).map(|(ours, theirs)| (ours, error, theirs)));
    }
    for (ours, error, theirs) in compared {
        let drawn = (theirs * (1.0 - theirs) / 4000.0_f64).sqrt();
        let apart = (ours - theirs) / drawn.hypot(error);
        println!("{ours:.4} +- {error:.4}, published {theirs}: {apart:+.1} standard errors");
        assert!(apart.abs() < 3.0, "{ours} instead of {theirs}");
    }
}

#[test]
fn the_impact_oscillator_goes_on_beyond_its_grazing() {
    let impactor = object("impact_oscillator", &[]);
    let number = |name: &str| impactor[name].as_f64().expect("a number");
    assert_eq!(impactor["attractors"], 2);
    assert!((number("grazing_w") - 1.99_f64.sqrt()).abs() < 1e-11);
    // Where the closed form of the orbits of one impact has a double root, by another program.
    assert!((number("fold_w") - 1.703_193_808_401_035).abs() < 1e-9);
}

#[test]
fn the_valve_loses_stability_and_grazes_where_it_does() {
    let valve = object("relief_valve", &["--values", "640"]);
    let number = |name: &str| valve[name].as_f64().expect("a number");
    // The closed form, by bisection in a few lines of another language: 8.49111763518333.
    assert!((number("loss_of_stability_q") - 8.491_117_635_183_33).abs() < 1e-9);
    // Another code (DOP853 at 3e-14, cycles closed by Newton's method without the seat): the least y1 of the cycle
    // at nine flow rates on both sides, interpolated to zero.
    assert!((number("first_touch_q") - 7.557_210_971_877).abs() < 1e-9);
    assert!(number("values_per_second") > 0.0);
}

#[test]
fn the_belts_cycle_disappears_where_published() {
    let belt = object("belt", &[]);
    let number = |name: &str| belt[name].as_f64().expect("a number");
    assert!((number("cycle_disappears_v") - 1.8366).abs() < 5e-5);
    // Steady sliding loses its stability where the slope of friction beats the damper, at s ln(a/(c s)).
    assert!((number("sliding_unstable_v") - 0.5 * 10.0_f64.ln()).abs() < 1e-8);
    // Stender and Hoffmann (2021): 2000 starts at each speed of the belt from 0.5 in steps of 0.075, there and here.
    let mut published = vec![1.0; 9];
    published.extend([0.982, 0.920, 0.8465, 0.774, 0.702, 0.618, 0.550, 0.4915, 0.432]);
    published.extend([0.0; 3]);
    let shares: Vec<f64> =
        belt["shares"].as_array().expect("a list").iter().filter_map(Value::as_f64).collect();
    assert_eq!(shares.len(), published.len());
    for (place, (ours, theirs)) in shares.into_iter().zip(published).enumerate() {
        // Where all starts lead to one motion there is no error.
        let error = (2.0 * theirs * (1.0 - theirs) / 2000.0_f64).sqrt();
        println!("v {:.3}: {ours:.4}, published {theirs}", 0.5 + 0.075 * place as f64);
        assert!((ours - theirs).abs() <= 3.0 * error, "{place}: {ours} instead of {theirs}");
    }
}
