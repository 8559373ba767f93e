//! What a fit prints: units and digits of its bounds and estimates, the misfit beside the noise, outliers, drifts, and all warnings as JSON.

use std::fs;

use super::program::{FIG5, WorkDir};

/// A folder with a study of Fig 5 and its record of a seed.
fn rig(seed: &str) -> WorkDir {
    let work = WorkDir::new();
    work.put("fig5.toml", FIG5);
    work.run(&["synthesize", "fig5.toml", "--output", "rig", "--seed", seed, "--cycles", "6"])
        .done();
    work
}

const FIT: [&str; 6] = ["fit", "rig/motion.csv", "--study", "fig5.toml", "--starts", "1"];

fn told(work: &WorkDir, more: &[&str]) -> String {
    work.run(&[&FIT[..], more].concat()).done().out
}

#[test]
fn estimates_and_bounds_have_the_unit_and_the_digits_of_their_errors() {
    let work = rig("1");
    let text = told(&work, &["--vary", "delta=2 mm..5 mm"]);
    let line = text.lines().find(|it| it.starts_with("delta")).expect("a line");
    let numbers: Vec<&str> =
        line.split([' ', ',']).filter(|it| it.parse::<f64>().is_ok_and(|it| it != 95.0)).collect();
    assert_eq!(numbers.len(), 4, "{line}");
    let decimals = |text: &str| text.split_once('.').map_or(0, |it| it.1.len());
    assert!(numbers.iter().all(|it| decimals(it) == decimals(numbers[0])), "{line}");
    let digits = numbers[1].trim_start_matches(['0', '.']).len();
    assert!((2..=3).contains(&digits) && line.contains(" mm, standard error"), "{line}");
    let value: f64 = numbers[0].parse().expect("a number");
    assert!((value - 3.5).abs() < 0.02, "{line}");

    // Below 2 mu_d = 0.66 the static coefficient has no effect.
    let text = told(&work, &["--vary", "mu_s=0.1..0.6"]);
    let expected = "mu_s  not determined by these data: 0.1 to 0.6 within its bounds";
    assert!(text.contains(expected), "{text}");
    let text = told(&work, &["--vary", "k2=3 kN/m..5 kN/m"]);
    assert!(text.contains("k2 is best at the least value allowed, 3 kN/m: the true one"), "{text}");
}

#[test]
fn outliers_are_counted_and_the_robust_misfit_is_that_of_the_others() {
    let work = rig("2");
    let text = fs::read_to_string(work.path("rig/motion.csv")).expect("recorded");
    let mut rows: Vec<String> = text.lines().map(str::to_owned).collect();
    let count = rows.len();
    // One sample in a hundred of r is off by 1 mm.
    for (i, row) in rows.iter_mut().enumerate().filter(|it| it.0 % 100 == 50) {
        let mut cells: Vec<f64> = row.split(',').map(|it| it.parse().expect("a number")).collect();
        cells[2] += if i % 200 == 50 { 1e-3 } else { -1e-3 };
        *row = cells.iter().map(|it| format!("{it:e}")).collect::<Vec<_>>().join(",");
    }
    fs::write(work.path("rig/motion.csv"), rows.join("\n") + "\n").expect("written");
    let vary = ["--vary", "k2=1 kN/m..5 kN/m,mu_d=0.1..0.6"];
    let text = told(&work, &vary);
    assert!(text.contains("--robust lets outliers count little"), "{text}");
    let robust = [&vary[..], &["--robust"]].concat();
    let text = told(&work, &robust);
    let outliers = (count - 1 + 50) / 100;
    assert!(
        text.contains(&format!("{outliers} samples are more than five times the noise")),
        "{text}"
    );
    assert!(
        text.contains("units of the noise by the median") && !text.contains("warning"),
        "{text}"
    );
    let found = work.run(&[&FIT[..], &robust, &["--json"]].concat()).json();
    let misfit = found["misfit_robust"].as_f64().expect("a number");
    assert!((0.9..1.1).contains(&misfit), "{misfit}");
    // The covariance has the squares of the standard errors.
    for i in [0, 1] {
        let error = found["fitted"][i]["standard_error"].as_f64().expect("a number");
        let variance = found["covariance"][i][i].as_f64().expect("a number");
        assert!((variance.sqrt() / error - 1.0).abs() < 1e-9, "{found}");
        let profile = found["fitted"][i]["profile"].as_array().expect("points");
        let crosses = |side: bool| profile.iter().any(|it| (it[1].as_f64() >= Some(1.0)) == side);
        assert!(profile.len() >= 5 && crosses(true) && crosses(false), "{found}");
    }
}

#[test]
fn a_drift_is_told_by_signal_and_unit_and_every_warning_is_in_the_json() {
    let work = rig("3");
    let vary = ["--vary", "k2=1 kN/m..5 kN/m,mu_d=0.1..0.6,c=1 N s/m..8 N s/m"];
    let (text, found) = both(&work, &vary);
    assert!(!text.contains("warning") && found["warnings"] == serde_json::json!([]), "{text}");
    let recorded = fs::read_to_string(work.path("rig/motion.csv")).expect("recorded");
    let header = recorded.lines().next().expect("a header");
    assert!(header.starts_with("t [s],x2 [m],r [m]"), "{header}");
    for (column, signal) in [(1, "x2"), (2, "r")] {
        // 0.1 mm/s.
        let drifted = recorded.lines().enumerate().map(|(i, row)| {
            let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
            if i > 0 {
                let number = |cell: &String| cell.parse::<f64>().expect("a number");
                cells[column] = format!("{:e}", number(&cells[column]) + 1e-4 * number(&cells[0]));
            }
            cells.join(",") + "\n"
        });
        fs::write(work.path("rig/motion.csv"), drifted.collect::<String>()).expect("written");
        let (text, found) = both(&work, &vary);
        let line = text.lines().find(|it| it.contains("drifts against the fitted motion"));
        let line = line.unwrap_or_else(|| panic!("no drift: {text}"));
        assert!(line.starts_with(&format!("warning: rig/motion.csv: {signal} drifts")), "{line}");
        assert!(line.contains(" mm/s (standard error "), "{line}");
        let drifts = found["drifts"].as_array().expect("drifts");
        let own = drifts.iter().find(|it| it["signal"] == signal).expect("that of the signal");
        let of = |key: &str| own[key].as_f64().expect("a number");
        assert!((of("rate") - 1e-4).abs() < 4.0 * of("standard_error"), "{own}");
        assert_eq!(own["unit"], "m/s", "{own}");
        assert!(found["drifts"].as_array().is_some_and(|it| it.len() == 3), "{found}");
        fs::write(work.path("rig/motion.csv"), &recorded).expect("written");
    }
    // A bound, too, is in the JSON.
    both(&work, &["--vary", "k2=3 kN/m..5 kN/m"]);
}

/// A fit as text and as JSON, whose warnings are the same.
fn both(work: &WorkDir, more: &[&str]) -> (String, serde_json::Value) {
    let text = told(work, more);
    let found = work.run(&[&FIT[..], more, &["--json"]].concat()).json();
    let warnings = found["warnings"].as_array().expect("warnings").clone();
    let warnings: Vec<&str> = warnings.iter().map(|it| it.as_str().expect("text")).collect();
    let told: Vec<&str> = text.lines().filter_map(|it| it.strip_prefix("warning: ")).collect();
    assert_eq!(warnings, told, "{text}");
    if more.iter().any(|it| it.contains("=3 kN/m")) {
        assert!(told.iter().any(|it| it.contains("least value allowed")), "{text}");
    }
    (text, found)
}
