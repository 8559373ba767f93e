//! Points of codimension 2 of the example of docs/branches.md: in what the program says, in its file and in its figures.

use std::collections::BTreeMap;
use std::fs;

use capsulemap::branch::{Codim2Kind, SpecialKind};
use capsulemap::store::{self, Dataset};

use super::program::WorkDir;

/// The blocks of a document that begin so.
fn blocks<'a>(document: &'a str, begins: &str) -> Vec<&'a str> {
    let parts = document.split("```").skip(1).step_by(2);
    parts.filter_map(|part| part.strip_prefix(begins)).collect()
}

/// A variable of a file; of several numbers in a row the first.
fn column(dataset: &Dataset, name: &str) -> Vec<f64> {
    let values = dataset.variable(name).expect(name).values.to_real();
    values.outer_iter().filter_map(|row| row.first().copied()).collect()
}

#[test]
fn the_example_of_the_document_has_its_points() {
    let document = fs::read_to_string("docs/branches.md").expect("the document");
    let dir = WorkDir::new();
    dir.put("forced.toml", blocks(&document, "toml\n")[0]);
    let ran = dir.run(&["continue", "forced.toml", "--formats", "svg"]).done().out;
    // The first line has the time that it took.
    for line in blocks(&document, "text\n")[0].lines().skip(1) {
        assert!(ran.contains(line), "{line}\nin\n{ran}");
    }
    let dataset = store::read(&dir.path("results/forced/forced.h5")).expect("a result");
    let names = ["kind", "curve", "after", "f", "w", "multiplier_real"];
    let of: BTreeMap<&str, Vec<f64>> =
        names.iter().map(|name| (*name, column(&dataset, &format!("codim2_{name}")))).collect();
    let resonances: Vec<usize> = (0..of["kind"].len())
        .filter(|&at| of["kind"][at] == f64::from(Codim2Kind::Resonance1 as u8))
        .collect();
    let [curve, kinds] = ["curve", "curve_kind"].map(|name| column(&dataset, name));
    let [at] = resonances[..] else { panic!("one resonance 1:1\n{ran}") };
    let after = of["after"][at] as usize;
    assert_eq!(curve[after], of["curve"][at]);
    assert_eq!(kinds[after], f64::from(SpecialKind::NeimarkSacker as u8));
    assert!((of["multiplier_real"][at] - 1.0).abs() < 1e-6);
    // The curve ends there.
    for name in ["f", "w"] {
        let on_curve = column(&dataset, &format!("curve_{name}"));
        assert!([on_curve[after], on_curve[after + 1]].contains(&of[name][at]), "{name}");
    }
    let words = ["--kind", "curves", "--name", "words", "--formats", "svg", "--svg-text"];
    dir.run(&[&["figure", "results/forced/forced.h5"], &words[..]].concat()).done();
    let figure = fs::read_to_string(dir.path("results/forced/words.svg")).expect("a figure");
    let words: String =
        figure.split('<').filter_map(|it| it.split_once('>')).map(|it| it.1).collect();
    assert!(words.contains("resonance 1:1"), "the legend has it: {words}");
}

/// The frequencies of the folds along the branch of `studies/regions.toml` near a frequency, at an amplitude of the drive [N].
fn folds(dir: &WorkDir, text: &str, p_d: f64, omega: f64) -> Vec<f64> {
    let one = text.lines().filter(|line| !line.starts_with("second"));
    let one = one.take_while(|line| *line != "[[figures]]").collect::<Vec<_>>().join("\n");
    dir.put("one.toml", one.replace("\"2.79 N\"", &format!("\"{p_d} N\"")));
    dir.run(&["continue", "one.toml", "--no-figures", "--overwrite"]).done();
    let dataset = store::read(&dir.path("results/one/one.h5")).expect("a result");
    let [kinds, omegas] = ["kind", "omega"].map(|it| column(&dataset, &format!("special_{it}")));
    let is_fold = |at: &usize| kinds[*at] == f64::from(SpecialKind::Fold as u8);
    let folds = (0..kinds.len()).filter(is_fold).map(|at| omegas[at]);
    folds.filter(|it| (it - omega).abs() < 0.01).collect()
}

#[test]
fn the_two_folds_of_the_hysteresis_vanish_in_a_cusp() {
    let text = fs::read_to_string("studies/regions.toml").expect("the study");
    let dir = WorkDir::new();
    dir.put("regions.toml", &text);
    let ran = dir.run(&["continue", "regions.toml", "--no-figures"]).done().out;
    let dataset = store::read(&dir.path("results/regions/regions.h5")).expect("a result");
    let [kinds, omega, p_d] =
        ["kind", "omega", "p_d"].map(|it| column(&dataset, &format!("codim2_{it}")));
    let is_cusp = |at: &usize| kinds[*at] == f64::from(Codim2Kind::Cusp as u8);
    let cusps: Vec<usize> = (0..kinds.len()).filter(is_cusp).collect();
    let [cusp] = cusps[..] else { panic!("one cusp\n{ran}") };
    // Along the branch there are two folds just above its amplitude, and none just below.
    let [below, above] =
        [-1e-4, 1e-4].map(|by| folds(&dir, &text, p_d[cusp] + by, omega[cusp]).len());
    assert_eq!((below, above), (0, 2), "{ran}");
}
