//! Measured points over a bifurcation diagram stand where they were measured, in its units, and none is left out in silence.

use std::fs;

use super::program::{TWO_MOTIONS, WorkDir};

/// A sweep over the frequency.
fn results() -> WorkDir {
    let work = WorkDir::new();
    let axis =
        "[[axes]]\nname = \"omega\"\nfrom = \"110 rad/s\"\nto = \"180 rad/s\"\npoints = 15\n";
    work.put("sweep.toml", format!("{TWO_MOTIONS}{axis}"));
    work.run(&["sweep", "sweep.toml", "--output", "sweep.h5"]).done();
    work
}

const COMMON: [&str; 10] = [
    "figure",
    "sweep.h5",
    "--kind",
    "bifurcation",
    "--name",
    "it",
    "--formats",
    "svg",
    "--data",
    "--overwrite",
];

/// The rows of measured points in the data of a figure: abscissa and ordinate.
fn measured(data: &str) -> Vec<(f64, f64)> {
    rows(data, "measured")
}

/// The rows of a series.
fn rows(data: &str, series: &str) -> Vec<(f64, f64)> {
    let cells = data.lines().map(|line| line.split(',').collect());
    let rows = cells.filter(|cells: &Vec<&str>| cells.get(1) == Some(&series));
    rows.map(|it| (it[2].parse().expect("a number"), it[3].parse().expect("a number"))).collect()
}

#[test]
fn measured_points_stand_over_a_diagram_in_its_units() {
    let work = results();
    work.put(
        "rig.csv",
        "# a rig\nomega (Hz),progression_speed (m/s),operator\n18,0.002,7\n20,-0.004,7\n33,0.05,7\n",
    );
    let draw = |more: &[&str]| {
        let ran = work.run(&[&COMMON[..], &["--points", "rig.csv"], more].concat()).done();
        let text = |name: &str| fs::read_to_string(work.path(name)).expect("written");
        (ran.out + &ran.err, measured(&text("it.csv")), text("it.svg"))
    };
    let near = |found: &[(f64, f64)], expected: &[(f64, f64)]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, expected) in found.iter().zip(expected) {
            let apart = (found.0 - expected.0).abs().max((found.1 - expected.1).abs());
            assert!(apart < 1e-9, "{found:?}, not {expected:?}");
        }
    };
    let turns = std::f64::consts::TAU;
    let (told, points, _) = draw(&["--of", "progression_speed"]);
    // The axes reach as far as the points: 33 Hz is beyond the sweep.
    near(&points, &[(18.0 * turns, 2.0), (20.0 * turns, -4.0), (33.0 * turns, 50.0)]);
    assert!(!told.contains("outside"), "{told}");
    let (told, points, _) =
        draw(&["--of", "progression_speed", "--limits", "omega=110 rad/s,180 rad/s"]);
    near(&points, &[(18.0 * turns, 2.0), (20.0 * turns, -4.0)]);
    assert!(told.contains("1 measured point lies outside the limits"), "{told}");
    let (_, points, svg) =
        draw(&["--of", "section_r,progression_speed", "--unit", "omega=Hz", "--svg-text"]);
    near(&points, &[(18.0, 2.0), (20.0, -4.0), (33.0, 50.0)]);
    assert!(svg.contains("measured") && !svg.contains("with errors"));

    // Errors stand as bars along both axes, where a row has one, and the axes reach to their ends.
    work.put(
        "rig.csv",
        "omega (Hz),omega_error (Hz),progression_speed (m/s),progression_speed_error (mm/s)\n\
         18,0.5,0.002,30\n20,,-0.004,4\n",
    );
    let ran =
        work.run(&[&COMMON[..], &["--points", "rig.csv", "--of", "progression_speed"]].concat());
    ran.done();
    let data = fs::read_to_string(work.path("it.csv")).expect("written");
    near(&measured(&data), &[(18.0 * turns, 2.0), (20.0 * turns, -4.0)]);
    let ends = [
        (17.5 * turns, 2.0),
        (18.5 * turns, 2.0),
        (18.0 * turns, -28.0),
        (18.0 * turns, 32.0),
        (20.0 * turns, -8.0),
        (20.0 * turns, 0.0),
    ];
    near(&rows(&data, "ends of measured errors"), &ends);
}

#[test]
fn measured_points_that_do_not_go_with_a_figure_are_refused() {
    let work = results();
    for (text, more, message) in [
        ("omega (Hz),p_d (N)\n18,1\n", &[][..], "the measured points have a column of none of"),
        (
            "delta (mm),progression_speed (mm/s)\n18,1\n",
            &[],
            "the measured points have no column omega (their columns: delta, progression_speed)",
        ),
        (
            "omega (mm),progression_speed (mm/s)\n18,1\n",
            &[],
            "rig.csv: 1 fault\n  line 1: \"omega (mm)\": expected a frequency",
        ),
        ("omega (Hz),progression_speed (mm/s)\n", &[], "0 rows of numbers; at least 1"),
        (
            "omega (Hz),progression_speed (mm/s)\n18,1\n",
            &["--kind", "trade-off"],
            "measured points stand over a bifurcation diagram",
        ),
    ] {
        work.put("rig.csv", text);
        let (kind, rest) = (["figure", "sweep.h5"], &COMMON[4..]);
        let kind_option = if more.is_empty() { &COMMON[2..4] } else { more };
        let ran = work.run(&[&kind[..], kind_option, rest, &["--points", "rig.csv"]].concat());
        assert_eq!(ran.code, 2, "{text}: {}", ran.err);
        assert!(ran.err.contains(message), "{text}: {}", ran.err);
        assert!(!work.path("it.svg").exists());
    }
}

#[test]
fn points_without_a_value_are_left_out_and_counted() {
    let work = results();
    work.put("rig.csv", "omega (Hz),progression_speed (mm/s)\n18,2\n19,\n,3\n20,-4\n");
    let draw = ["--of", "progression_speed", "--points", "rig.csv"];
    let ran = work.run(&[&COMMON[..], &draw].concat()).done();
    let told = ran.out + &ran.err;
    assert!(
        told.contains(
            "2 measured points without a value of omega or progression_speed are left out"
        ),
        "{told}"
    );
    let data = fs::read_to_string(work.path("it.csv")).expect("written");
    let speeds: Vec<f64> = measured(&data).iter().map(|it| it.1).collect();
    assert_eq!(speeds, [2.0, -4.0]);
}
