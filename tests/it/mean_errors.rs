//! Standard errors of the means of motions that do not repeat.

use capsulemap::capsule::mean_errors::ERRORS;
use capsulemap::capsule::{Output, Parameters, State, settle, settle_case};
use capsulemap::orbit::{Outcome, Protocol};
use capsulemap::store;
use capsulemap::study::Study;
use serde_json::Value;

use super::program::WorkDir;

/// Frequencies at which the paper's capsule with another stop moves chaotically, measured over so many cycles.
fn study(cycles: u64) -> String {
    format!(
        "[parameters]\nk2 = \"60 kN/m\"\nc = \"0.2 N s/m\"\nmu_s = 0.3\nmu_d = 0.25\ndelta = \"2 mm\"\np_d = \"5 N\"\n\
         [[axes]]\nname = \"omega\"\nfrom = \"14.8 rad/s\"\nto = \"15.2 rad/s\"\npoints = 5\n\
         [protocol]\nmeasured_cycles = {cycles}\n"
    )
}

/// The motions of the front and the fastest, all chaotic, by case.
fn motions(folder: &WorkDir, name: &str, cycles: u64) -> Vec<Value> {
    folder.put(&format!("{name}.toml"), study(cycles));
    folder.run(&["sweep", &format!("{name}.toml"), "--no-figures"]).done();
    let file = format!("results/{name}/{name}.h5");
    let answer = folder.run(&["tradeoff", &file, "--top", "8", "--json"]).json();
    let mut rows = answer["top"].as_array().expect("a list").clone();
    rows.retain(|row| row["outcome"] == "chaotic");
    rows.sort_by_key(|row| row["case"].as_u64());
    rows
}

/// The outcomes of a file of results, and some outputs of each case.
fn outputs(folder: &WorkDir, name: &str, outputs: [&str; 4]) -> (Vec<f64>, [Vec<f64>; 4]) {
    let file = folder.path(&format!("results/{name}/{name}.h5"));
    let dataset = store::read(&file).expect("a file of results");
    let column = |name: &str| -> Vec<f64> {
        dataset.variable(name).expect(name).values.to_real().into_iter().collect()
    };
    (column("outcome"), outputs.map(column))
}

#[test]
fn means_in_files_have_errors_as_longer_means_show() {
    let folder = WorkDir::new();
    for (name, cycles) in [("short", 128), ("long", 64 * 128)] {
        folder.put(&format!("{name}.toml"), study(cycles));
        folder.run(&["sweep", &format!("{name}.toml"), "--no-figures"]).done();
    }
    for output in ["progression_speed", "work_net", "work_positive", "friction_loss"] {
        let error = format!("{output}_error");
        let names = [output, error.as_str(), "lyapunov_uncertainty", "energy_residual"];
        let (outcomes, [short, error_short, ..]) = outputs(&folder, "short", names);
        let (_, [long, error_long, ..]) = outputs(&folder, "long", names);
        let mut chaotic = 0;
        for case in (0..outcomes.len()).filter(|case| outcomes[*case] == 1.0) {
            chaotic += 1;
            let apart = (short[case] - long[case]).abs();
            assert!(apart < 4.0 * error_short[case], "{output}: {apart} {}", error_short[case]);
            // Sixty-four times as many cycles have an eighth of the error, as far as 16 batches tell it.
            let ratio = error_short[case] / error_long[case];
            assert!((2.5..25.0).contains(&ratio), "{output}: {ratio}");
        }
        assert!(chaotic >= 3, "{chaotic}");
    }
}

#[test]
fn the_mean_of_a_periodic_orbit_has_no_error() {
    let orbit = settle(&Parameters::default(), 0.0, State::default(), &Protocol::default());
    assert_eq!(orbit.outcome, Outcome::Periodic);
    assert!(ERRORS.iter().all(|output| orbit.outputs[*output] == 0.0));
}

#[test]
fn a_mean_is_measured_until_it_is_known_as_well_as_wanted_or_the_steps_are_spent() {
    let study = Study::parse("s.toml", &study(128)).expect("a study");
    let case = study.case(2);
    let settled = |protocol: Protocol| {
        let orbit = settle_case(&case, &Protocol { max_cycles: 200, ..protocol });
        assert_eq!(orbit.outcome, Outcome::Chaotic);
        let [speed, error, exponent] =
            [Output::ProgressionSpeed, Output::ProgressionSpeedError, Output::LyapunovExponent]
                .map(|output| orbit.outputs[output]);
        (speed, error, exponent)
    };
    let usual = settled(Protocol::default());
    let long = settled(Protocol { measured_cycles: 64 * 128, ..Protocol::default() });
    let relative = |(speed, error, _): (f64, f64, f64)| error / speed.abs();
    let wanted = relative(usual) / 3.0;
    let known = settled(Protocol { mean_error: Some(wanted), ..Protocol::default() });
    assert!(relative(known) <= wanted, "{known:?} {wanted}");
    assert!((known.0 - long.0).abs() < 4.0 * known.1.hypot(long.1), "{known:?} {long:?}");
    assert_eq!(known.2, usual.2);
    // Two hundred cycles to settle, 128 to be measured, those of the exponent, and a few more.
    let protocol = Protocol { mean_error: Some(1e-5), max_steps: 400_000, ..Protocol::default() };
    let spent = settled(protocol);
    assert!(relative(spent) > 1e-5 && spent.1 < usual.1, "{spent:?} {usual:?}");
}

fn speed(of: &Value) -> f64 {
    of["progression_speed"].as_f64().unwrap_or_else(|| panic!("{of}"))
}

#[test]
fn longer_means_lie_within_the_errors_of_shorter_ones() {
    let folder = WorkDir::new();
    let [short, long] =
        [("short", 128), ("long", 64 * 128)].map(|(name, cycles)| motions(&folder, name, cycles));
    assert!(short.len() >= 3 && short.len() == long.len(), "{} {}", short.len(), long.len());
    for (short, long) in short.iter().zip(&long) {
        let [error, of_long] = [short, long].map(|it| speed(&it["standard_errors"]));
        let apart = (speed(short) - speed(long)).abs();
        assert!(apart < 4.0 * error, "{apart} {error}");
        // Sixty-four times as many cycles have an eighth of the error, as far as 16 batches tell it.
        assert!((2.5..25.0).contains(&(error / of_long)), "{error} {of_long}");
    }
}
