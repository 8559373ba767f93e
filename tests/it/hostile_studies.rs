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
