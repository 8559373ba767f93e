//! `capsulemap tradeoff --refine --where`: motions between the cases keep the conditions, and no case that keeps them is better.

use serde_json::Value;

use super::program::WorkDir;

/// Where the paper's capsule moves fast; a fine grid of the same plane is the check.
fn study(points: [u32; 2]) -> String {
    let [forces, frequencies] = points;
    format!(
        "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\n\
         [[axes]]\nname = \"p_d\"\nfrom = \"7 N\"\nto = \"8 N\"\npoints = {forces}\n\
         [[axes]]\nname = \"omega\"\nfrom = \"50 rad/s\"\nto = \"60 rad/s\"\npoints = {frequencies}\n"
    )
}

fn number(point: &Value, key: &str) -> f64 {
    point[key].as_f64().unwrap_or_else(|| panic!("{key} in {point}"))
}

fn holds(point: &Value) -> Vec<&str> {
    let holds = point["held_by"].as_array().expect("a list");
    holds.iter().filter_map(Value::as_str).collect()
}

/// The answer of a trade-off between a file's motions that keep a condition.
fn answer(folder: &WorkDir, file: &str, condition: &str, more: &[&str]) -> Value {
    let asked = ["tradeoff", file, "--where", condition, "--direction", "backward", "--json"];
    folder.run(&[&asked[..], more].concat()).json()
}

#[test]
fn motions_between_the_cases_keep_limits_and_bounds_and_are_the_best_that_do() {
    let folder = WorkDir::new();
    folder.put("coarse.toml", study([4, 5]));
    folder.put("fine.toml", study([61, 81]));
    folder.run(&["sweep", "coarse.toml"]).done();
    folder.run(&["sweep", "fine.toml", "--no-figures"]).done();
    let (coarse, fine) = ("results/coarse/coarse.h5", "results/fine/fine.h5");
    let free = folder.run(&["tradeoff", coarse, "--refine", "--json"]).json();
    let peak = |point: &Value| {
        let replay = point["replay"].as_str().expect("a command");
        let arguments: Vec<&str> = replay.split(' ').skip(1).chain(["--json"]).collect();
        number(&folder.run(&arguments).json()["orbit"], "peak_contact_force")
    };
    // A limit that the best motion exceeds by a tenth.
    let most = peak(&free["fastest"]) / 1.1;
    for (condition, hold) in [
        (format!("peak_contact_force < {most:?} N"), "limit of peak_contact_force"),
        ("p_d < 7.4 N and outcome = periodic".to_owned(), "upper bound of p_d"),
    ] {
        let refined = answer(&folder, coarse, &condition, &["--refine"]);
        let grid = answer(&folder, fine, &condition, &[]);
        let best = &refined["fastest"];
        assert!(holds(best).contains(&hold), "{best}");
        assert!(number(best, "stationarity") <= 1e-8, "{best}");
        let mut held = 0;
        for point in refined["front"].as_array().expect("a front") {
            held += usize::from(holds(point).contains(&hold));
            if hold.starts_with("limit") {
                assert!(peak(point) <= most * (1.0 + 2e-8), "{point}");
            } else {
                assert!(number(&point["parameters"], "p_d") <= 7.4, "{point}");
            }
        }
        assert!(held >= 2, "{condition}: {held}");
        // No case of the fine grid is faster, and the fastest of them, at most a step away, is not much slower.
        let [best, of_grid] = [best, &grid["fastest"]].map(|it| -number(it, "progression_speed"));
        assert!(best >= of_grid && of_grid > 0.97 * best, "{best} {of_grid}");
    }
}

#[test]
fn conditions_that_cannot_be_kept_between_the_cases_are_refused_at_once() {
    let folder = WorkDir::new();
    folder.put("coarse.toml", study([2, 2]));
    folder.run(&["sweep", "coarse.toml", "--no-figures"]).done();
    let refused = |conditions: &str, more: &[&str], parts: &[&str]| {
        let asked = ["tradeoff", "results/coarse/coarse.h5", "--refine", "--where", conditions];
        folder.run(&[&asked[..], more].concat()).refused(parts);
    };
    refused(
        "impacts_per_cycle < 2 and p_d != 7 N and power = 3 mW",
        &["--of", "impacts_per_cycle"],
        &[
            "\"impacts_per_cycle < 2\": `--refine` cannot keep it between the cases",
            "\"p_d != 7 N\": `--refine` cannot leave out a value",
            "\"power = 3 mW\": `--refine` takes only < <= > >=",
            "`impacts_per_cycle` has no derivatives",
        ],
    );
    refused(
        "power < 1 W and work_net < 1 J and damper_loss < 1 J and peak_contact_force < 1 kN",
        &[],
        &["4 limits of outputs; `--refine` keeps 3 at most"],
    );
}
