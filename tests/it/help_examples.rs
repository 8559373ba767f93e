//! The examples in the help of the commands of experiments run on a synthesised rig, those of others on a small study.

use std::fs;

use super::program::{FIG5, TWO_MOTIONS, WorkDir};
use super::sobol_indices::ABOUT_FIG5;
use super::text_recordings::put_wall;

/// A folder in which examples run: studies, a rig, and the files that examples name.
fn folder() -> WorkDir {
    let work = WorkDir::new();
    fs::create_dir(work.path("studies")).expect("a folder");
    for (name, text) in [
        ("studies/fig5.toml", include_str!("../../studies/fig5.toml")),
        ("studies/fig6.toml", include_str!("../../studies/fig6.toml")),
        ("a.toml", FIG5),
        ("b.toml", FIG5),
    ] {
        work.put(name, text);
    }
    put_wall(&work);
    work.put("sensitivity.toml", ABOUT_FIG5.replace("base_samples = 64", "base_samples = 4"));
    work.run(&["sweep", "sensitivity.toml", "--no-figures"]).done();
    fs::copy(work.path("results/sensitivity/sensitivity.h5"), work.path("FILE.h5"))
        .expect("copied");
    work.run(&["synthesize", "a.toml", "--output", "other"]).done();
    for (from, to) in [
        ("other/motion.csv", "a.csv"),
        ("other/motion.csv", "b.csv"),
        ("other/static-force.csv", "spring.csv"),
    ] {
        fs::copy(work.path(from), work.path(to)).expect("copied");
    }
    work
}

/// The words of a command as a shell has them: separated by spaces, in quotes kept together.
fn words(line: &str) -> Vec<String> {
    let quoted = line.split('"').enumerate();
    let mut words = vec![String::new()];
    for (i, part) in quoted {
        if i % 2 == 1 {
            words.last_mut().expect("a word").push_str(part);
            continue;
        }
        for (j, word) in part.split(' ').enumerate() {
            if j > 0 {
                words.push(String::new());
            }
            words.last_mut().expect("a word").push_str(word);
        }
    }
    words.retain(|it| !it.is_empty());
    words
}

/// The commands under "Examples:", without the name of the program; the help breaks long ones into several lines.
fn examples(help: &str) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    let lines = help.lines().skip_while(|line| *line != "Examples:").skip(1);
    for line in lines.take_while(|line| !line.trim().is_empty()) {
        match line.trim().strip_prefix("capsulemap ") {
            Some(begins) => all.push(begins.to_owned()),
            None => {
                let last = all.last_mut().expect("an example");
                *last += " ";
                *last += line.trim();
            }
        }
    }
    all
}

#[test]
fn every_example_of_the_help_runs() {
    let work = folder();
    let mut count = 0;
    for command in ["synthesize", "identify", "compare", "fit", "sensitivity"] {
        // Each command has the rig as the examples of synthesize leave it first.
        let _ = fs::remove_dir_all(work.path("rig"));
        if command != "synthesize" {
            work.run(&["synthesize", "studies/fig5.toml", "--output", "rig"]).done();
        }
        let help = work.run(&[command, "--help"]).done().out;
        for example in examples(&help) {
            let words = words(&example);
            assert_eq!(words.first().map(String::as_str), Some(command), "{example}");
            let mut arguments: Vec<&str> = words.iter().map(String::as_str).collect();
            if arguments.contains(&"--output") {
                arguments.push("--overwrite");
            }
            let ran = work.run(&arguments);
            assert_eq!(ran.code, 0, "{example}: {}", ran.err);
            count += 1;
        }
    }
    assert!(count >= 8, "{count} examples");
}

#[test]
fn the_examples_of_tipping_run() {
    let work = WorkDir::new();
    let axes = "[[axes]]\nname = \"omega\"\nvalues = [\"157 rad/s\", \"160 rad/s\", \"165 rad/s\"]\n\
                [[axes]]\nname = \"start_y1\"\nfrom = \"-1.5 m/s\"\nto = \"1.5 m/s\"\npoints = 9\n";
    work.put("erosion.toml", format!("{TWO_MOTIONS}{axes}"));
    work.run(&["sweep", "erosion.toml"]).done();
    fs::copy(work.path("results/erosion/erosion.h5"), work.path("FILE.h5")).expect("copied");
    let help = work.run(&["tipping", "--help"]).done().out;
    let all = examples(&help);
    for example in &all {
        let command = example.split(" | ").next().expect("a command");
        let words = words(command);
        let arguments: Vec<&str> = words.iter().map(String::as_str).collect();
        let ran = work.run(&arguments).done();
        assert!(ran.out.contains("omega"), "{example}: {}", ran.out);
    }
    assert_eq!(all.len(), 3);
}
