//! Commands that the program prints as advice run as they are printed, with the output that was given.

use super::program::{Ran, WorkDir};

/// A study of three blocks that is quickly swept.
const STUDY: &str = r#"outputs = ["progression_speed"]
[parameters]
p_d = "4 N"
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "omega"
from = "20 rad/s"
to = "30 rad/s"
points = 1100
[protocol]
max_cycles = 5
measured_cycles = 1
exponent_cycles = 0
"#;

/// Runs the advice that follows `before` in what a command has said, up to `after`, as a shell does.
fn follow(dir: &WorkDir, said: &str, before: &str, after: &str) -> Ran {
    let rest = said.split_once(before).unwrap_or_else(|| panic!("no {before}: {said}")).1;
    let advice = rest.split(after).next().expect("an end");
    dir.shell(&format!("\"$0\" {advice}"))
}

#[test]
fn advice_names_the_study_and_the_output() {
    let dir = WorkDir::new();
    dir.put("my study.toml", STUDY);
    let output = ["--output", "in a folder/of its own.h5", "--no-figures"];
    let sweep = |more: &[&str]| {
        let arguments = [&["sweep", "my study.toml"], &output[..], more].concat();
        dir.run(&arguments)
    };
    let said = sweep(&["--task", "1/2"]).done().err.clone();
    let status = ["status", "my study.toml", "--output", "in a folder/of its own.h5"];
    let found = dir.run(&status).done().out.clone();
    assert!(found.contains("no run is active"), "{found}");
    follow(&dir, &found, "`capsulemap ", "`").done();
    let found = dir.run(&status).done().out.clone();
    assert!(found.starts_with("in a folder/of its own.h5: all cases"), "{found}");
    // A second run by tasks ends with the advice to join them.
    std::fs::remove_file(dir.path("in a folder/of its own.h5")).expect("removed");
    sweep(&["--task", "1/2"]).done();
    sweep(&["--task", "2/2"]).done();
    let found = dir.run(&status).done().out.clone();
    assert!(found.contains("all blocks are there"), "{found}");
    follow(&dir, &said, "once all tasks are done: capsulemap ", "\n").done();
    assert!(dir.path("in a folder/of its own.h5").exists());
}
