//! Names, links, files of others and what killed runs leave: refused or cleared, and never in the way of a run.

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use std::process::Stdio;
use std::time::{Duration, Instant};

use super::program::{Ran, WorkDir};

/// A study that is quickly swept, continued and drawn.
const QUICK: &str = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
p_d = "4 N"
[[axes]]
name = "omega"
from = "20 rad/s"
to = "21 rad/s"
points = 6
[protocol]
max_cycles = 200
points = 1
impact_points = 0
[[branches]]
name = "b"
along = "omega"
at = { omega = "20.73 rad/s" }
most_points = 4
[[figures]]
name = "speed"
kind = "bifurcation"
"#;

/// A folder with the study.
fn place() -> WorkDir {
    let dir = WorkDir::new();
    dir.put("s.toml", QUICK);
    dir
}

fn sweep(dir: &WorkDir, output: &str, more: &[&str]) -> Ran {
    dir.run(&[&["sweep", "s.toml", "--output", output, "--formats", "svg"], more].concat())
}

#[test]
fn names_that_no_file_can_have_are_refused_at_the_start() {
    let dir = place();
    let name = |bytes: usize| format!("{}.h5", "n".repeat(bytes - 3));
    for bytes in [242, 244, 250, 255, 300] {
        for dry in [&[][..], &["--dry-run"]] {
            let ran = sweep(&dir, &name(bytes), dry);
            ran.refused(&[&format!("the name has {bytes} bytes; 241 are the most")]);
        }
    }
    // What has the name of the file with another extension can be written, too.
    sweep(&dir, &name(241), &["--no-figures"]).done();
    dir.run(&["report", &name(241)]).done();
    let mut command = dir.command(&["sweep", "s.toml", "--output"]);
    let ran = Ran::from(command.arg(OsStr::from_bytes(b"a\xffb.h5")).output().expect("it starts"));
    ran.refused(&["is not text in UTF-8"]);
    let page = name(241).replace(".h5", ".html");
    assert_eq!(dir.files(), [name(241), page, "s.toml".to_owned()]);
}

#[test]
fn a_folder_whose_name_is_no_text_is_refused_before_anything_is_computed() {
    let dir = place();
    let folder = dir.folder().join(OsStr::from_bytes(b"a\xffb"));
    fs::create_dir(&folder).expect("a folder");
    for (output, dry) in [("s.h5", &[][..]), ("s.h5", &["--dry-run"]), ("deep/s.h5", &[])] {
        let mut command = dir.command(&["sweep", "../s.toml", "--no-figures", "--output", output]);
        let ran = Ran::from(command.args(dry).current_dir(&folder).output().expect("it starts"));
        ran.refused(&["is not text in UTF-8"]);
        assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 0);
    }
}

#[test]
fn results_in_a_folder_whose_name_is_no_text_are_refused_for_that() {
    let dir = place();
    sweep(&dir, "s.h5", &[]).done();
    let folder = dir.folder().join(OsStr::from_bytes(b"a\xffb"));
    fs::create_dir(&folder).expect("a folder");
    fs::copy(dir.path("s.h5"), folder.join("s.h5")).expect("a copy");
    for command in ["inspect", "report", "verify"] {
        let mut command = dir.command(&[command, "s.h5"]);
        let ran = Ran::from(command.current_dir(&folder).output().expect("it starts"));
        ran.refused(&["is not text in UTF-8"]);
    }
}

#[test]
fn a_file_in_the_place_of_a_folder_is_told_as_one() {
    let dir = place();
    sweep(&dir, "s.h5", &[]).done();
    dir.run(&["synthesize", "s.toml", "--output", "rig"]).done();
    dir.put("mine", "notes");
    let smooth = ["smooth", "rig/motion.csv", "--window", "5 ms", "--output", "mine/a.csv"];
    for command in [
        &smooth[..],
        &["synthesize", "s.toml", "--output", "mine"],
        &["synthesize", "s.toml", "--output", "mine/rig"],
        &["identify", "rig", "--m1", "0.11 kg", "--m2", "0.53 kg", "--output", "mine/a.toml"],
        &["report", "s.h5", "--output", "mine/a.html"],
        &["figure", "s.h5", "--kind", "bifurcation", "--folder", "mine"],
    ] {
        dir.run(command).refused(&["mine is a file, not a folder"]);
    }
    assert_eq!(fs::read_to_string(dir.path("mine")).expect("it is read"), "notes");
}

#[test]
fn links_that_lead_nowhere_are_refused_and_stay() {
    let dir = place();
    symlink("nothing.h5", dir.path("dangling.h5")).expect("a link");
    symlink("loop.h5", dir.path("loop.h5")).expect("a link");
    for link in ["dangling.h5", "loop.h5"] {
        sweep(&dir, link, &[]).refused(&[link, "is a link that leads to no file"]);
        assert!(dir.path(link).is_symlink());
    }
}

#[test]
fn a_linked_folder_of_blocks_serves_and_stays() {
    let dir = place();
    fs::create_dir(dir.path("scratch")).expect("a folder");
    symlink("scratch", dir.path("s.blocks")).expect("a link");
    sweep(&dir, "s.h5", &["--task", "1/2"]).done();
    assert!(fs::read_dir(dir.path("scratch")).expect("a folder").count() > 1);
    sweep(&dir, "s.h5", &[]).done();
    assert!(dir.path("s.blocks").is_symlink());
    assert_eq!(fs::read_dir(dir.path("scratch")).expect("a folder").count(), 0);
    let status = dir.run(&["status", "s.toml", "--output", "s.h5"]).done().out;
    assert!(status.contains("all cases"), "{status}");
    sweep(&dir, "s.h5", &["--overwrite"]).done();
}

#[test]
fn what_only_looks_like_a_block_stays() {
    let dir = place();
    sweep(&dir, "s.h5", &["--task", "1/2"]).done();
    let names = ["block-diagram.odt", "block-12", ".block-notes.tmp", "begun.json.orig"];
    names.iter().for_each(|name| dir.put(&format!("s.blocks/{name}"), "years of work"));
    sweep(&dir, "s.h5", &[]).done();
    for name in names {
        assert!(dir.path(&format!("s.blocks/{name}")).exists(), "{name}");
    }
    assert_eq!(fs::read_dir(dir.path("s.blocks")).expect("a folder").count(), names.len());
}

#[test]
fn what_killed_runs_have_left_is_cleared() {
    let litter = |dir: &WorkDir| {
        fs::create_dir_all(dir.path("partial")).expect("a folder");
        for name in [".s.h5.aB3xYz.tmp", "partial/.s.h5.aB3xYz.tmp"] {
            dir.put(name, "half a file");
        }
        // Those of others are not touched.
        dir.put(".other.h5.aB3xYz.tmp", "half a file");
    };
    let left = |dir: &WorkDir| {
        let files = dir.files().into_iter();
        files.filter(|name| name.ends_with(".tmp") || name.contains("blocks")).collect::<Vec<_>>()
    };
    let dir = place();
    litter(&dir);
    dir.run(&["continue", "s.toml", "--output", "s.h5", "--no-figures"]).done();
    assert_eq!(left(&dir), [".other.h5.aB3xYz.tmp", "partial/.s.h5.aB3xYz.tmp"]);
    litter(&dir);
    sweep(&dir, "s.h5", &[]).done();
    assert_eq!(left(&dir), [".other.h5.aB3xYz.tmp"]);
    // A run was killed before it removed the last of its blocks, their lock.
    litter(&dir);
    fs::create_dir(dir.path("s.blocks")).expect("a folder");
    dir.put("s.blocks/lock", "");
    sweep(&dir, "s.h5", &[]).done();
    assert_eq!(left(&dir), [".other.h5.aB3xYz.tmp"]);
    // A figure that was abandoned is, one that is under way is not.
    let [_, held] = ["old", "held"]
        .map(|name| fs::File::create(dir.path(&format!(".speed.svg.{name}.tmp"))).expect("a file"));
    held.lock().expect("a lock");
    dir.run(&["figure", "s.h5", "--formats", "svg"]).done();
    assert_eq!(left(&dir), [".other.h5.aB3xYz.tmp", ".speed.svg.held.tmp"]);
}

#[test]
fn a_figure_replaces_no_file_but_its_own() {
    let dir = place();
    dir.put("speed.svg", "drawn by hand");
    for command in ["sweep", "continue"] {
        let ran = dir.run(&[command, "s.toml", "--output", "s.h5", "--formats", "png,svg"]);
        ran.refused(&["speed.svg: exists, and capsulemap did not draw it", "--overwrite"]);
    }
    assert_eq!(dir.files(), ["s.toml", "speed.svg"], "it is refused before anything is computed");
    sweep(&dir, "s.h5", &["--overwrite"]).done();
    let drawn = fs::read_to_string(dir.path("speed.svg")).expect("a figure");
    assert!(drawn.starts_with("<svg"), "{drawn}");
    let figure = ["figure", "s.h5", "--formats", "svg"];
    dir.run(&figure).done();
    // A figure that was finished by hand is not drawn over.
    dir.put("speed.svg", drawn.replacen("<desc>", "<desc>as in my thesis: ", 1));
    dir.run(&figure).refused(&["speed.svg", "or it was changed since; it is not replaced"]);
    dir.run(&[&figure[..], &["--overwrite"]].concat()).done();
    assert_eq!(fs::read_to_string(dir.path("speed.svg")).expect("a figure"), drawn);
}

#[test]
fn links_and_folders_in_the_place_of_a_figure_are_seen_at_the_start() {
    let dir = place();
    symlink("nothing.svg", dir.path("speed.svg")).expect("a link");
    sweep(&dir, "s.h5", &[]).refused(&["speed.svg: is a link that leads to no file"]);
    fs::remove_file(dir.path("speed.svg")).expect("it is removed");
    fs::create_dir(dir.path("speed.svg")).expect("a folder");
    sweep(&dir, "s.h5", &[]).refused(&["speed.svg: is a folder"]);
    assert_eq!(dir.files(), ["s.toml", "speed.svg"]);
}

#[test]
fn what_is_not_begun_leaves_nothing() {
    let dir = place();
    sweep(&dir, "deep/er/s.h5", &["--dry-run"]).done();
    assert_eq!(dir.files(), ["s.toml"]);
    fs::create_dir(dir.path("s.blocks")).expect("a folder");
    dir.put("s.blocks/notes.txt", "years of work");
    sweep(&dir, "s.h5", &[]).refused(&["s.blocks: is where the blocks", "holds other things"]);
    assert_eq!(dir.files(), ["s.blocks", "s.blocks/notes.txt", "s.toml"]);
}

#[test]
fn a_pipe_is_not_waited_for() {
    let dir = place();
    dir.shell("mkfifo f.h5").done();
    for command in ["inspect", "verify", "figure"] {
        dir.run(&[command, "f.h5"]).refused(&["f.h5: ", "it is not a plain file"]);
    }
    sweep(&dir, "s.h5", &["--task", "2/2"]).done();
    dir.shell("rm -f s.blocks/block-0000000 && mkfifo s.blocks/block-0000000").done();
    let status = dir.run(&["status", "s.toml", "--output", "s.h5"]).done().out;
    assert!(status.contains("it is not a plain file"), "{status}");
}

#[test]
fn a_block_that_was_cut_is_not_counted() {
    let dir = place();
    sweep(&dir, "s.h5", &["--task", "1/2"]).done();
    let block = dir.path("s.blocks/block-0000000");
    let whole = fs::read(&block).expect("a block");
    fs::write(&block, &whole[..whole.len() - 40]).expect("it is cut");
    let status = dir.run(&["status", "s.toml", "--output", "s.h5"]).done().out;
    assert!(status.contains("0 of 1 blocks") && status.contains("it is torn"), "{status}");
}

#[test]
fn a_time_that_is_none_is_refused() {
    let dir = place();
    for time in ["abc", "-5", "", "1e3", "99999999999999999999"] {
        let mut command = dir.command(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]);
        let ran = Ran::from(command.env("SOURCE_DATE_EPOCH", time).output().expect("it starts"));
        ran.refused(&[&format!("SOURCE_DATE_EPOCH = \"{time}\""), "seconds since 1970"]);
    }
}

#[test]
fn control_characters_from_files_are_shown_and_not_obeyed() {
    let dir = WorkDir::new();
    let key = format!("\"\\u001b[2J{}\" = 1\n", '\u{9b}');
    dir.put("s.toml", key + QUICK);
    let ran = sweep(&dir, "s.h5", &[]);
    ran.refused(&["\\u001b[2J\\u009b"]);
    assert!(!ran.err.contains(|c: char| c.is_control() && c != '\n'), "{:?}", ran.err);
}

#[test]
fn a_run_ends_though_nobody_reads_its_messages() {
    let dir = place();
    let (_unread, mut messages) = std::io::pipe().expect("a pipe");
    // As much as a pipe takes.
    std::io::Write::write_all(&mut messages, &[b'\n'; 1 << 16]).expect("it is filled");
    let mut command = dir.command(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]);
    command.stdout(Stdio::null()).stderr(messages);
    let mut child = command.spawn().expect("it starts");
    let begun = Instant::now();
    let ended = loop {
        if let Some(ended) = child.try_wait().expect("a process") {
            break ended;
        }
        assert!(begun.elapsed() < Duration::from_secs(120), "it waits for a reader");
        std::thread::sleep(Duration::from_millis(50));
    };
    assert!(ended.success(), "{ended}");
    assert!(dir.path("s.h5").exists() && !dir.path("s.blocks").exists());
}

#[test]
fn a_folder_in_use_is_waited_for_with_a_word() {
    let dir = place();
    let folder = fs::File::open(dir.folder()).expect("a folder");
    folder.lock().expect("a lock");
    let mut command = dir.command(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]);
    let child = command.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().expect("it starts");
    let begun = Instant::now();
    while !dir.path("s.blocks/block-0000000").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "no block is done");
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_secs(1));
    drop(folder);
    let ran = Ran::from(child.wait_with_output().expect("a process"));
    assert!(ran.err.contains("another run writes results there; it is waited for"), "{}", ran.err);
    assert_eq!(ran.code, 0);
}

#[test]
fn status_and_join_tell_damage_and_faults_of_the_machine_apart() {
    let dir = place();
    sweep(&dir, "s.h5", &["--task", "1/1", "--no-figures"]).done();
    let whole = fs::read(dir.path("s.h5")).expect("a result");
    dir.put("s.h5", &whole[..whole.len() / 2]);
    let ran = dir.run(&["status", "s.toml", "--output", "s.h5"]);
    assert_eq!((ran.code, ran.err.contains("s.h5")), (2, true), "{}", ran.err);
    fs::remove_file(dir.path("s.h5")).expect("it is removed");
    // A block that cannot be read is a fault of the machine.
    sweep(&dir, "s.h5", &["--task", "1/2"]).done();
    let block = dir.path("s.blocks/block-0000000");
    fs::remove_file(&block).ok();
    fs::create_dir(&block).expect("a folder in its place");
    let ran = dir.run(&["join", "s.toml", "--output", "s.h5"]);
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(ran.err.contains("cannot be read"), "{}", ran.err);
}

#[test]
fn cases_and_branches_give_the_same_bytes_in_either_order() {
    let dir = place();
    let run = |command: &str, output: &str| {
        let mut command = dir.command(&[command, "s.toml", "--no-figures", "--output", output]);
        // The last second that the variable can name, too.
        command.env("SOURCE_DATE_EPOCH", u64::MAX.to_string());
        Ran::from(command.output().expect("it starts")).done();
    };
    run("sweep", "a.h5");
    run("continue", "a.h5");
    run("continue", "b.h5");
    run("sweep", "b.h5");
    let [a, b] = ["a.h5", "b.h5"].map(|name| fs::read(dir.path(name)).expect("a result"));
    assert!(a == b, "{} and {} bytes", a.len(), b.len());
    dir.run(&["verify", "a.h5"]).done();
}

#[test]
fn memory_that_is_refused_ends_the_program_in_order() {
    let dir = WorkDir::new();
    dir.put("s.toml", QUICK.replace("points = 6", "points = 9999999"));
    let ran = dir.shell("ulimit -v 262144; \"$0\" sweep s.toml --output s.h5 --threads 1");
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(ran.err.contains("capsulemap: out of memory:"), "{}", ran.err);
}

#[test]
fn the_join_of_a_part_finds_the_whole_where_the_run_has_ended() {
    let dir = place();
    sweep(&dir, "s.h5", &["--no-figures"]).done();
    let ran = dir.run(&["join", "s.toml", "--output", "s.h5", "--partial", "--no-figures"]).done();
    assert!(ran.err.contains("is there, whole"), "{}", ran.err);
    fs::remove_file(dir.path("s.h5")).expect("it is removed");
    let ran = dir.run(&["join", "s.toml", "--output", "s.h5", "--partial", "--no-figures"]);
    ran.refused(&["no blocks of this study are there"]);
    dir.run(&["join", "s.toml", "--output", "t.h5"])
        .refused(&["no blocks of this study are there"]);
    assert!(!dir.path("t.blocks").exists());
}
