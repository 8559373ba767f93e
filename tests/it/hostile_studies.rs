//! Studies that are valid and extreme: an answer or a refusal, never a panic.

use std::collections::BTreeMap;

use capsulemap::figure::{Format, Place, draw};
use capsulemap::store::{self, Dataset};
use capsulemap::study::{Drawing, DrawingKind};

use super::program::{FIG5, WorkDir};

/// A study over two values of the force, drawn.
fn over(values: [&str; 2]) -> String {
    let [low, high] = values;
    format!(
        r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
omega = "20 rad/s"
[[axes]]
name = "p_d"
values = ["{low}", "{high}"]
[protocol]
max_cycles = 20
[[figures]]
name = "diagram"
kind = "bifurcation"
[[figures]]
name = "trade"
kind = "trade-off"
"#
    )
}

#[test]
fn axes_that_are_too_short_or_too_long_for_marks_are_drawn() {
    let dir = WorkDir::new();
    for values in
        [["0 N", "5e-324 N"], ["0 N", "1e-300 N"], ["1e-310 N", "2e-310 N"], ["0 N", "1e300 N"]]
    {
        dir.put("s.toml", over(values));
        let ran = dir.run(&["sweep", "s.toml", "--output", "s.h5", "--overwrite"]);
        assert!(!ran.err.contains("panicked"), "{values:?}: {}", ran.err);
        assert_eq!(ran.code, 0, "{values:?}: {}", ran.err);
    }
}

#[test]
fn an_axis_without_effect_is_named_with_the_reason() {
    let dir = WorkDir::new();
    let said = |top: &str, axis: &str, values: &str| {
        dir.put(
            "s.toml",
            format!(
                "[parameters]\n{top}\nk2 = \"18.96 kN/m\"\ndelta = \"1.5 mm\"\np_d = \"4 N\"\n\
                 omega = \"20 rad/s\"\n[[axes]]\nname = \"{axis}\"\nvalues = {values}\n"
            ),
        );
        let ran = dir.run(&["sweep", "s.toml", "--output", "s.h5", "--overwrite", "--no-figures"]);
        ran.done().err
    };
    let mu_s = said("", "mu_s", "[0.1, 0.2, 0.3, 0.9]");
    assert!(mu_s.contains("note: mu_s has no effect below 2 mu_d ="), "{mu_s}");
    assert!(mu_s.contains("of its 4 values give the same motion"), "{mu_s}");
    let duty = said("", "duty", "[0.2, 0.4]");
    assert!(duty.contains("note: duty has no effect with the drive `harmonic`"), "{duty}");
    assert!(!said("", "c1", r#"["1 N s/m", "2 N s/m"]"#).contains("note:"));
    let v_s = said("resistance = \"coulomb\"", "v_s", r#"["0.1 m/s", "0.2 m/s"]"#);
    assert!(v_s.contains("note: v_s has no effect under the law `coulomb`"), "{v_s}");
    assert!(!said("", "v_s", r#"["0.1 m/s", "0.2 m/s"]"#).contains("note:"));
}

#[test]
fn a_branch_along_a_parameter_without_effect_is_named_with_the_reason() {
    let dir = WorkDir::new();
    let said = |along: &str, from: &str, to: &str| {
        let text = format!(
            "{FIG5}[[branches]]\nname = \"b\"\nalong = \"{along}\"\nfrom = {from}\nto = {to}\nmost_points = 3\n"
        );
        dir.put("s.toml", text);
        let arguments = ["continue", "s.toml", "--output", "s.h5", "--overwrite", "--no-figures"];
        dir.run(&arguments).done().err
    };
    let mu_s = said("mu_s", "0.1", "0.9");
    assert!(mu_s.contains("note: branch `b`: mu_s has no effect below 2 mu_d = 0.66"), "{mu_s}");
    let c1 = said("c1", "\"0 N s/m\"", "\"1 N s/m\"");
    assert!(c1.contains("note: branch `b`: c1 has no effect under the law"), "{c1}");
    assert!(!said("p_d", "\"3 N\"", "\"5 N\"").contains("note:"));
}

#[test]
fn directions_name_the_parameter_that_starts_are_inherited_along() {
    let dir = WorkDir::new();
    let text = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "omega"
values = ["20 rad/s", "21 rad/s"]
[[axes]]
name = "p_d"
values = ["3 N", "4 N", "5 N"]
[start]
inherit = "omega"
directions = ["upward", "downward"]
[protocol]
max_cycles = 50
[[figures]]
name = "over"
kind = "bifurcation"
x = "p_d"
at = { omega = "20 rad/s" }
"#;
    dir.put("s.toml", text);
    let ran = dir.run(&["sweep", "s.toml", "--output", "s.h5", "--formats", "svg"]);
    ran.done();
    let dataset = store::read(&dir.path("s.h5")).expect("a result");
    assert_eq!(dataset.attributes["start_inherited_along"], "omega");
    let drawing = |x: &str, at: &str| Drawing {
        x: Some(x.into()),
        of: vec!["progression_speed".into()],
        at: BTreeMap::from([(at.into(), if at == "omega" { 20.0 } else { 4.0 })]),
        ..Drawing::new("d", DrawingKind::Bifurcation)
    };
    // Over another axis the name says along which the starts were inherited: more letters, more outlines.
    let place = Place { folder: dir.folder(), formats: &[Format::Svg], overwrite: true };
    let length = |x: &str, at: &str| {
        let files = draw(&dataset, &drawing(x, at), &place).expect("a figure");
        let svg = std::fs::read_to_string(&files.paths[0]).expect("it is written");
        let plain = dataset_without_attribute(&dataset);
        let other = draw(&plain, &drawing(x, at), &place).expect("a figure");
        let bare = std::fs::read_to_string(&other.paths[0]).expect("it is written");
        (svg.len(), bare.len())
    };
    let (named, bare) = length("p_d", "omega");
    assert!(named > bare, "{named} {bare}");
    let (named, bare) = length("omega", "p_d");
    assert_eq!(named, bare);
}

/// Results that do not say along which axis their starts were inherited.
fn dataset_without_attribute(dataset: &Dataset) -> Dataset {
    let mut plain = dataset.clone();
    plain.attributes.remove("start_inherited_along");
    plain
}
