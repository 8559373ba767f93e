//! Standard errors of the means of motions that do not repeat.

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
