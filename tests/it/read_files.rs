//! What a person names to be read: plain files and pipes of the shell; nothing else is waited for, and all messages are lines.

use std::fs;

use super::program::{FIG5, WorkDir};

/// A folder with a study, a recording, a FIFO and links to what does not end.
fn place() -> WorkDir {
    let dir = WorkDir::new();
    dir.put("s.toml", FIG5);
    let rows: String = (0..40).map(|i| format!("{},{}\n", 1e-3 * f64::from(i), i % 7)).collect();
    dir.put("rig.csv", format!("t [s],r [mm]\n{rows}"));
    dir.shell("mkfifo fifo && ln -s /dev/urandom endless && ln -s /proc/kmsg kernel").done();
    dir
}

/// What comes of a command that is given twenty seconds.
fn within_time(dir: &WorkDir, arguments: &str) -> super::program::Ran {
    let ran = dir.shell(&format!("timeout -k 1 60 \"$0\" {arguments}"));
    assert_ne!(ran.code, 124, "{arguments}: not done in time");
    ran
}

#[test]
fn what_does_not_end_is_not_read() {
    let dir = place();
    for name in ["fifo", "endless", "kernel"] {
        dir.put("including.toml", format!("include = \"{name}\"\n{FIG5}"));
        for command in ["sweep including.toml --no-figures", "continue including.toml"] {
            within_time(&dir, command).refused(&[name]);
        }
        for command in [
            format!("sweep {name} --output s.h5"),
            format!("simulate --study {name} --case 0"),
            format!("smooth {name} --window '5 ms' --output smooth.csv"),
            format!("compare {name} s.toml"),
            format!("compare rig.csv {name}"),
            format!("fit {name} --study s.toml --vary 'k2=1 kN/m..10 kN/m'"),
            format!("identify --static-force {name}"),
            format!("inspect {name}"),
        ] {
            let ran = within_time(&dir, &command);
            assert_eq!(ran.code, 2, "{command}: {}", ran.err);
            // A file of the kernel counts as an empty one.
            let told = if name == "kernel" { "" } else { "not a plain file" };
            assert!(ran.err.contains(told), "{command}: {}", ran.err);
        }
    }
    assert!(!dir.path("s.h5").exists() && !dir.path("smooth.csv").exists());
}

/// What it took as absent would be a parameter that is missing without a word.
#[test]
fn a_recording_in_a_folder_that_is_no_plain_file_is_not_passed_over() {
    let dir = place();
    dir.run(&["synthesize", "s.toml", "--output", "rig"]).done();
    for place in ["mkfifo rig/pull.csv", "ln -s nowhere rig/pull.csv"] {
        dir.shell(&format!("rm -f rig/pull.csv && {place}")).done();
        let ran = within_time(&dir, "identify rig --m1 '0.11 kg' --m2 '0.53 kg'");
        ran.refused(&["rig/pull.csv"]);
    }
    within_time(&dir, "identify fifo").refused(&["fifo: is no folder"]);
}

#[test]
fn a_pipe_that_the_shell_has_opened_is_read() {
    let dir = place();
    let smooth = "--window '5 ms' --output";
    within_time(&dir, &format!("smooth rig.csv {smooth} a.csv")).done();
    within_time(&dir, &format!("smooth <(sleep 0.2; cat rig.csv) {smooth} b.csv")).done();
    within_time(&dir, &format!("smooth /dev/stdin {smooth} c.csv < rig.csv")).done();
    let read = |name| fs::read(dir.path(name)).expect("a file");
    assert_eq!([read("b.csv"), read("c.csv")], [read("a.csv"), read("a.csv")]);
    dir.run(&["synthesize", "s.toml", "--output", "rig"]).done();
    let plain = within_time(&dir, "compare rig/motion.csv s.toml --json").done().out;
    let pipes = within_time(&dir, "compare <(cat rig/motion.csv) <(cat s.toml) --json").done().out;
    assert_eq!(plain, pipes);
    within_time(&dir, "compare <(true) s.toml").refused(&["is a pipe that holds nothing"]);
    // A study that stands for all recordings is read once: a pipe holds it no longer then.
    let fit = "fit rig/motion.csv rig/motion.csv --vary 'k2=1 kN/m..10 kN/m' --study";
    let plain = within_time(&dir, &format!("{fit} s.toml")).done().out;
    assert_eq!(within_time(&dir, &format!("{fit} <(cat s.toml)")).done().out, plain);
}

#[test]
fn a_parameter_file_that_includes_another_is_refused() {
    let dir = WorkDir::new();
    dir.put("s.toml", format!("include = \"one.toml\"\n{FIG5}"));
    dir.put("one.toml", "# rig 3\ninclude = \"two.toml\"\n[parameters]\nc = 0.3\n");
    dir.put("two.toml", "[parameters]\nmu_s = 0.4\n");
    dir.run(&["sweep", "s.toml"])
        .refused(&["s.toml: one.toml: line 2: include: ", "may include no other"]);
}

#[test]
fn names_with_ends_of_lines_are_shown_on_one_line() {
    let dir = place();
    let name = "a\ncapsulemap: all is well\tb";
    let shown = "a\\ncapsulemap: all is well\\tb";
    for arguments in [
        vec!["sweep", name],
        vec!["inspect", name],
        vec!["compare", name, "s.toml"],
        vec!["smooth", name, "--window", "5 ms", "--output", "x.csv"],
        vec!["identify", "--static-force", name],
    ] {
        dir.run(&arguments).refused(&[shown]);
    }
    dir.put(name, "t [s],r [mm]\n0,one\n");
    let ran = dir.run(&["smooth", name, "--window", "5 ms", "--output", "x.csv"]);
    ran.refused(&[&format!("{shown}: 1 fault"), "line 2: r: \"one\" is not a number"]);
    dir.put(name, format!("{FIG5}\"k\\n2\" = 3\n"));
    let ran = dir.run(&["sweep", name, "--output", "s.h5"]);
    ran.refused(&[&format!("{shown}: 1 fault"), "parameters.k\\n2"]);
    let result = format!("{name}.h5");
    dir.put(name, FIG5);
    let ran = dir.run(&["sweep", name, "--no-figures", "--output", &result]).done();
    let all = [ran.out, ran.err].concat();
    assert!(
        all.contains(shown) && !all.lines().any(|it| it.starts_with("capsulemap: all")),
        "{all}"
    );
}
