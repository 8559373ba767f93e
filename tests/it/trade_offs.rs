//! Trade-offs: a front for each direction, none of rounding, and every case shown or counted.

use std::fs;

use capsulemap::figure::{Format, draw};
use capsulemap::study::{Drawing, DrawingKind};

use super::figure::fixtures::{Fixture, OUTCOMES, plane, steps};
use super::figure::{by_work, drawing, folder, into};
use super::program::WorkDir;

/// A trade-off over motions with these speeds [m/s] and outcomes.
fn trade_off(speeds: &[f64], outcomes: &[i64]) -> String {
    let (speeds, outcomes) = (speeds.to_vec(), outcomes.to_vec());
    let dataset = Fixture::default()
        .coordinate("omega", "rad/s", steps(10.0, 20.0, speeds.len()))
        .real("work_positive", &["omega"], |at| 1e-3 * (1 + at[0]) as f64)
        .real("progression_speed", &["omega"], move |at| speeds[at[0]])
        .integer("outcome", &["omega"], &OUTCOMES, move |at| outcomes[at[0]])
        .0;
    let request = by_work("directions");
    let paths =
        draw(&dataset, &request, &into(&folder("directions"), &[Format::Svg])).unwrap().paths;
    fs::read_to_string(&paths[0]).unwrap()
}

#[test]
fn a_trade_off_has_a_front_for_each_direction_and_none_of_rounding() {
    let front = "#d55e00";
    assert!(trade_off(&[-0.01, -0.02, -0.03], &[0; 3]).contains(front));
    assert!(trade_off(&[0.01, 0.02, 0.03], &[0; 3]).contains(front));
    assert!(!trade_off(&[1e-17, -2e-17, 3e-17], &[0; 3]).contains(front));
    // What is undecided is shown and counted, and on no front.
    let mixed = trade_off(&[0.01, 0.02, 0.03, f64::NAN], &[3, 3, 0, 4]);
    assert!(!mixed.contains(front));
    // What is chaotic takes part by its means, as in `capsulemap tradeoff`.
    assert!(trade_off(&[0.01, 0.02, 0.03, f64::NAN], &[1, 3, 0, 4]).contains(front));
    let counted =
        "1 periodic cases, 0 others as means over their cycles, 2 undecided, 1 without values";
    assert!(mixed.contains(counted), "{mixed}");
    let of = vec!["outcome".to_string()];
    let request = Drawing { of, ..drawing("outcome", DrawingKind::TradeOff) };
    let said =
        draw(&plane(5, 5), &request, &into(&folder("directions"), &[])).expect_err("no output");
    assert!(said.to_string().contains("`outcome` is no output of a motion"), "{said}");
}

/// The refined motions of a study are on the front of its figure as soon as their searches are kept, and are counted.
#[test]
fn a_trade_off_shows_what_was_found_between_the_cases() {
    let folder = WorkDir::new();
    folder.put(
        "study.toml",
        "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\n\
         [[axes]]\nname = \"p_d\"\nfrom = \"7 N\"\nto = \"8 N\"\npoints = 3\n\
         [[axes]]\nname = \"omega\"\nfrom = \"50 rad/s\"\nto = \"60 rad/s\"\npoints = 4\n",
    );
    folder.run(&["sweep", "study.toml"]).done();
    let file = "results/study/study.h5";
    let drawn = || {
        let figure = ["figure", file, "--kind", "trade-off", "--of", "power", "--formats", "svg"];
        folder.run(&figure).done();
        fs::read_to_string(folder.path("results/study/trade-off-power.svg")).expect("a figure")
    };
    let alone = drawn();
    assert!(alone.contains(" 0 periodic motions between the cases"));
    // The power is the cost where none is named, as for the table.
    folder.run(&["figure", file, "--kind", "trade-off", "--formats", "svg"]).done();
    let usual = fs::read_to_string(folder.path("results/study/trade-off.svg")).expect("a figure");
    let about = |svg: &str| svg.split("progression_speed, power").nth(1).map(str::len);
    assert!(about(&usual).is_some() && about(&alone).is_some(), "{usual}");
    folder.run(&["tradeoff", file, "--refine"]).done();
    let kept = fs::read_to_string(folder.path("results/study/study.searches")).expect("searches");
    let found = kept.matches("\"held_by\"").count();
    let with_motions = drawn();
    let said = with_motions.split(" periodic motions between the cases").next().expect("a part");
    let shown: usize = said.rsplit(' ').next().and_then(|it| it.parse().ok()).expect("a number");
    // Several searches lead to one motion.
    assert!((1..=found).contains(&shown), "{shown} of {found}");
    // The front of the cases alone is a line of its own now.
    let lines = |svg: &str| svg.matches("#d55e00").count();
    assert!(lines(&with_motions) >= lines(&alone) && with_motions != alone);
    // Of other results they are not shown, and that is said.
    folder.put(
        "results/study/study.searches",
        kept.replacen("fingerprint\":\"", "fingerprint\":\"0", 1),
    );
    let figure = ["figure", file, "--kind", "trade-off", "--of", "power", "--formats", "svg"];
    let said = folder.run(&figure).done().err;
    assert!(said.contains("searches of another study") && said.contains("not shown"), "{said}");
    assert!(drawn() == alone);
}
