//! Studies that are valid and extreme: an answer or a refusal, never a panic.

use super::program::WorkDir;

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
    let c1 = said("", "c1", r#"["1 N s/m", "2 N s/m"]"#);
    assert!(c1.contains("note: c1 has no effect under the law `coulomb-stribeck`"), "{c1}");
    let v_s = said("resistance = \"coulomb\"", "v_s", r#"["0.1 m/s", "0.2 m/s"]"#);
    assert!(v_s.contains("note: v_s has no effect under the law `coulomb`"), "{v_s}");
    assert!(!said("", "v_s", r#"["0.1 m/s", "0.2 m/s"]"#).contains("note:"));
}
