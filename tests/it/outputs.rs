//! Outputs of every command are plain files or nothing: no device, pipe, folder, socket, or link to one is replaced.

use std::fs;
use std::os::unix::fs::{FileTypeExt, symlink};
use std::os::unix::net::UnixListener;

use super::program::{CASES_AND_BRANCH, FIG5, WorkDir};

/// What is in the place of an output, and what it is called in the message.
const PLACES: [(&str, &str); 8] = [
    ("pipe", "not a plain file"),
    ("socket", "not a plain file"),
    ("null", "not a plain file"),
    ("folder", "is a folder"),
    ("to-pipe", "not a plain file"),
    ("to-socket", "not a plain file"),
    ("to-folder", "is a folder"),
    ("to-nothing", "is a link that leads to no file"),
];

/// Makes what is in the place of an output; what is of no kind that this user may make is left out.
fn occupied(dir: &WorkDir, kind: &str, name: &str) -> bool {
    let (kind, path) = match kind.strip_prefix("to-") {
        Some(kind) => {
            let file = name.rsplit('/').next().expect("a name");
            symlink(format!("{file}.behind"), dir.path(name)).expect("a link");
            (kind, format!("{name}.behind"))
        }
        None => (kind, name.to_owned()),
    };
    let created = |command: &str| dir.shell(&format!("{command} '{path}'")).code == 0;
    match kind {
        "pipe" => created("mkfifo"),
        "socket" => UnixListener::bind(dir.path(&path)).is_ok(),
        // The device that takes everything, under a name of its own: only root makes one.
        "null" => dir.shell(&format!("mknod '{path}' c 1 3 2>/dev/null")).code == 0,
        "folder" => fs::create_dir(dir.path(&path)).is_ok(),
        _ => true,
    }
}

/// What there is, by name, with its kind.
fn kinds(dir: &WorkDir) -> Vec<String> {
    let kind = |name: String| {
        let found = fs::symlink_metadata(dir.path(&name)).expect("it is there").file_type();
        let kinds = [
            found.is_fifo(),
            found.is_socket(),
            found.is_char_device(),
            found.is_dir(),
            found.is_symlink(),
        ];
        format!("{name} {kinds:?}")
    };
    dir.files().into_iter().map(kind).collect()
}

#[test]
fn no_command_replaces_what_is_no_plain_file() {
    let dir = WorkDir::new();
    dir.put("s.toml", CASES_AND_BRANCH.replace("points = 40", "points = 4"));
    dir.put("fig5.toml", FIG5);
    dir.run(&["sweep", "s.toml", "--output", "r.h5", "--no-figures"]).done();
    dir.run(&["synthesize", "fig5.toml", "--output", "rig", "--cycles", "2"]).done();
    // Each command with an output, by the name of the file that it would write.
    let fit = ["fit", "rig/motion.csv", "--study", "fig5.toml", "--vary", "k2=2 kN/m..3 kN/m"];
    let figure = ["figure", "r.h5", "--kind", "bifurcation", "--formats", "svg"];
    let commands: [(&str, &[&str]); 11] = [
        ("o.h5", &["sweep", "s.toml", "--no-figures", "--output", "o.h5"]),
        ("o.h5", &["continue", "s.toml", "--no-figures", "--output", "o.h5"]),
        ("o.h5", &["join", "s.toml", "--no-figures", "--output", "o.h5"]),
        ("o.csv", &["smooth", "rig/motion.csv", "--window", "20 ms", "--output", "o.csv"]),
        ("out/pull.csv", &["synthesize", "fig5.toml", "--output", "out"]),
        ("o.toml", &[&fit[..], &["--output", "o.toml"]].concat()),
        (
            "o.toml",
            &["identify", "rig", "--m1", "0.11 kg", "--m2", "1.42 kg", "--output", "o.toml"],
        ),
        (
            "figures/free-vibration.png",
            &["identify", "rig", "--m1", "0.11 kg", "--m2", "1.42 kg", "--figures", "figures"],
        ),
        ("o.png", &["compare", "rig/motion.csv", "fig5.toml", "--output", "o"]),
        ("o.html", &["report", "r.h5", "--output", "o.html"]),
        ("bifurcation.svg", &figure),
    ];
    let mut tried = 0;
    for (name, command) in commands {
        for (kind, said) in PLACES {
            ["out", "figures"]
                .iter()
                .for_each(|it| fs::create_dir_all(dir.path(it)).expect("a folder"));
            if !occupied(&dir, kind, name) {
                continue;
            }
            let before = kinds(&dir);
            let ran = dir.run(&[command, &["--overwrite"]].concat());
            assert_eq!(ran.code, 2, "{kind} {command:?}: {}", ran.err);
            assert!(
                ran.err.contains(name) && ran.err.contains(said),
                "{kind} {command:?}: {}",
                ran.err
            );
            assert_eq!(kinds(&dir), before, "{kind} {command:?}");
            tried += 1;
            dir.shell(&format!("rm -rf '{name}' '{name}.behind' out figures")).done();
        }
    }
    println!("{tried} outputs");
    assert!(tried >= 7 * commands.len());
}

#[test]
fn a_link_to_a_file_leads_there_and_stays() {
    let dir = WorkDir::new();
    dir.put("fig5.toml", FIG5);
    dir.run(&["synthesize", "fig5.toml", "--output", "rig", "--cycles", "2"]).done();
    fs::create_dir(dir.path("elsewhere")).expect("a folder");
    dir.put("elsewhere/o.csv", "older");
    symlink("elsewhere/o.csv", dir.path("o.csv")).expect("a link");
    let smooth = ["smooth", "rig/motion.csv", "--window", "20 ms", "--output"];
    dir.run(&[&smooth[..], &["o.csv"]].concat()).refused(&["o.csv: exists", "--overwrite"]);
    dir.run(&[&smooth[..], &["o.csv", "--overwrite"]].concat()).done();
    assert!(dir.path("o.csv").is_symlink());
    let written = fs::read_to_string(dir.path("elsewhere/o.csv")).expect("a file");
    assert!(written.starts_with("t [s],"), "{written}");
    // To standard output goes the same, and what is said of it to standard error.
    for name in ["-", "/dev/stdout"] {
        let ran = dir.run(&[&smooth[..], &[name]].concat()).done();
        assert!(ran.out == written && ran.err.contains("window: "), "{}", ran.err);
        let fit = ["fit", "rig/motion.csv", "--study", "fig5.toml", "--vary", "k2=2 kN/m..3 kN/m"];
        dir.run(&[&fit[..], &["--output", name]].concat()).refused(&[name, "name a file"]);
    }
    assert!(!dir.path("-").exists());
}
