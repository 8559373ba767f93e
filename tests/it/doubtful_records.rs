//! What a record has wrong is told: another speed, amplitude, sign or unit, and signals that do not vary.

use std::fs;

use serde_json::Value;

use super::program::{FIG5, Ran, WorkDir};

/// A folder with a study of Fig 5 and its record.
fn rig() -> (WorkDir, Vec<Vec<f64>>) {
    let work = WorkDir::new();
    work.put("fig5.toml", FIG5);
    work.run(&["synthesize", "fig5.toml", "--output", "rig"]).done();
    let text = fs::read_to_string(work.path("rig/motion.csv")).expect("recorded");
    let row = |line: &str| line.split(',').map(|it| it.parse().expect("a number")).collect();
    (work, text.lines().skip(1).map(row).collect())
}

/// Writes a record whose rows are changed.
fn put(work: &WorkDir, rows: &[Vec<f64>], change: impl Fn(&mut [f64])) {
    let mut text = String::from("t [s],x2 [m],r [m],a1 [m/s2],drive [N]\n");
    for row in rows {
        let mut row = row.clone();
        change(&mut row);
        let cells: Vec<String> = row.iter().map(|it| format!("{it:e}")).collect();
        text += &(cells.join(",") + "\n");
    }
    work.put("it.csv", text);
}

/// The comparison with a changed record, in words and as JSON.
fn compared((work, rows): (&WorkDir, &[Vec<f64>]), change: impl Fn(&mut [f64])) -> (String, Value) {
    put(work, rows, change);
    let arguments = ["compare", "it.csv", "fig5.toml", "--json"];
    (work.run(&arguments[..3]).done().out, work.run(&arguments).json())
}

fn fit(work: &WorkDir, more: &[&str]) -> Ran {
    let arguments = ["fit", "it.csv", "--study", "fig5.toml", "--starts", "1", "--cycles", "4"];
    work.run(&[&arguments[..], more].concat())
}

#[test]
fn another_speed_is_an_error_over_the_motion_of_the_record() {
    let (work, rows) = rig();
    put(&work, &rows, |_| ());
    work.put("k8.toml", FIG5.replace("2.42 kN/m", "8 kN/m"));
    let found = work.run(&["compare", "it.csv", "k8.toml", "--json"]).json();
    let x2 = &found["errors"][0];
    assert_eq!(x2["signal"], "x2");
    // 5.68 mm over the 0.4996 mm of the record about its own 10.3 mm/s; the shapes differ by 13 %.
    let [all, shape] = ["error", "shape_error"].map(|key| x2[key].as_f64().expect("a number"));
    assert!((11.0..11.7).contains(&all) && (0.05..0.5).contains(&shape), "{x2}");
}

#[test]
fn amplitude_and_sign_of_the_drive_are_compared_with_the_study() {
    let (work, rows) = rig();
    let (told, found) = compared((&work, &rows), |_| ());
    assert!(!told.contains("warning"), "{told}");
    assert_eq!(found["drive_may_have_other_sign"], false);
    let (told, _) = compared((&work, &rows), |row| row[4] *= 1.3);
    assert!(told.contains("amplitude 5.2") && told.contains("p_d = 4 N in the study"), "{told}");
    assert!(
        told.contains("warning: the amplitudes differ by +30.")
            || told.contains("warning: the amplitudes differ by +29."),
        "{told}"
    );
    let (told, _) = compared((&work, &rows), |row| row[4] *= 1.015);
    assert!(!told.contains("warning"), "{told}");
    let (told, found) = compared((&work, &rows), |row| row[4] *= -1.0);
    assert!(told.contains("warning: the drive may have the other sign"), "{told}");
    assert_eq!(found["drive_may_have_other_sign"], true);
}

#[test]
fn other_signs_and_units_of_signals_are_told() {
    let (work, rows) = rig();
    let (told, found) = compared((&work, &rows), |row| row[2] *= -1.0);
    assert!(told.contains("warning: r may have the other sign"), "{told}");
    assert_eq!(found["errors"][1]["may_have_other_sign"], true);
    for (column, name, factor) in [(1, "x2", 1e3), (2, "r", 1e3), (2, "r", 1e-3)] {
        let (told, _) = compared((&work, &rows), |row| row[column] *= factor);
        assert!(told.contains(&format!("warning: {name} varies ")), "{told}");
        assert!(told.contains("its unit in the header may be wrong"), "{told}");
    }
}

#[test]
fn a_signal_that_does_not_vary_is_named_and_not_divided_by() {
    let (work, rows) = rig();
    for (column, name) in [(1, "x2"), (2, "r"), (3, "a1")] {
        let (told, found) = compared((&work, &rows), |row| row[column] = 1e-3);
        assert!(told.contains(&format!("{name} does not vary; no error relative to it")), "{told}");
        assert!(found["errors"][column - 1]["error"].is_null(), "{found}");
        fit(&work, &["--vary", "k2=1 kN/m..5 kN/m"]).refused(&[
            "it.csv",
            &format!("{name} does not vary"),
            "remove the column",
        ]);
    }
}

#[test]
fn a_fit_refuses_a_study_of_another_frequency() {
    let (work, rows) = rig();
    put(&work, &rows, |_| ());
    work.put("fig5.toml", FIG5.replace("77.91 rad/s", "78.5 rad/s"));
    let vary = ["--vary", "mu_d=0.1..0.6"];
    fit(&work, &vary).refused(&[
        "it.csv: the drive has 77.9",
        "omega is 78.5 rad/s",
        "set omega = \"77.9",
    ]);
    let told = work.run(&["compare", "it.csv", "fig5.toml"]).done().out;
    assert!(told.contains("warning: the frequencies differ"), "{told}");
}
