//! A run beside other programs: files of others, a second run, readers that stall, forged blocks.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use capsulemap::store;

use super::interrupted_runs::{LINES, LONG_STUDY};
use super::program::{CASES_AND_BRANCH, Ran, WorkDir};

#[test]
fn a_folder_of_somebody_else_is_left_alone() {
    let dir = WorkDir::new();
    dir.put("a.toml", CASES_AND_BRANCH);
    fs::create_dir(dir.path("a.blocks")).expect("a folder");
    dir.put("a.blocks/thesis.txt", "years of work");
    let sweep = |more: &[&str]| {
        dir.run(&[&["sweep", "a.toml", "--no-figures", "--output", "a.h5"], more].concat())
    };
    sweep(&[]).refused(&["a.blocks: is where the blocks of this study go, and holds other things"]);
    sweep(&["--overwrite"]).refused(&["holds other things"]);
    // What is put there later stays too.
    fs::rename(dir.path("a.blocks"), dir.path("b.blocks")).expect("it is moved");
    sweep(&["--task", "1/2"]).done();
    fs::rename(dir.path("b.blocks/thesis.txt"), dir.path("a.blocks/thesis.txt")).expect("back");
    sweep(&[]).done();
    assert_eq!(fs::read_dir(dir.path("a.blocks")).expect("a folder").count(), 1);
    sweep(&[]).done();
    assert_eq!(fs::read(dir.path("a.blocks/thesis.txt")).expect("it is there"), b"years of work");
    dir.run(&["sweep", "a.toml", "--output", "r.blocks"]).refused(&["for the folder of blocks"]);
}

#[test]
fn cases_and_branches_written_at_once_lose_nothing() {
    let dir = WorkDir::new();
    for (name, first, second) in [("s", "sweep", "continue"), ("f", "continue", "sweep")] {
        let study = format!("{name}.toml");
        dir.put(&study, CASES_AND_BRANCH);
        let start = |command: &str| {
            let mut command = dir.command(&[command, &study, "--no-figures"]);
            command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts")
        };
        let both = [start(first), start(second)];
        for child in both {
            let ended = child.wait_with_output().expect("a process");
            assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        }
        let file = dir.path(&format!("results/{name}/{name}.h5"));
        let dataset = store::read(&file).expect("a result");
        assert!(store::has_cases(&dataset) && store::has_branches(&dataset), "{first} first");
    }
}

#[cfg(unix)]
#[test]
fn a_log_that_nobody_reads_does_not_keep_a_run_from_stopping() {
    let dir = WorkDir::new();
    dir.put("long.toml", LONG_STUDY.replace("points = 128", "points = 1280"));
    let mut command = dir.command(&["sweep", "long.toml"]);
    let mut child = command.stderr(Stdio::piped()).spawn().expect("the program starts");
    // The pipe is never read, so that it is full after some hundred lines.
    std::thread::sleep(Duration::from_secs(6));
    let asked = Instant::now();
    let kill = Command::new("kill").arg(child.id().to_string()).status().expect("kill starts");
    assert!(kill.success(), "the run was over too soon");
    while child.try_wait().expect("a process").is_none() {
        assert!(asked.elapsed() < Duration::from_secs(10), "it still runs");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_that_was_to_be_ignored_is() {
    let dir = WorkDir::new();
    dir.put("a.toml", LINES);
    let script = "trap '' INT; \"$0\" sweep a.toml --no-figures & sleep 0.5; kill -INT $!; wait $!";
    dir.shell(script).done();
    assert!(dir.path("results/a/a.h5").is_file());
}

#[test]
fn what_is_missing_in_a_file_is_not_verified() {
    let dir = WorkDir::new();
    dir.put("a.toml", CASES_AND_BRANCH);
    dir.run(&["sweep", "a.toml", "--no-figures", "--output", "a.h5"]).done();
    let mut dataset = store::read(&dir.path("a.h5")).expect("a result");
    dataset.variables.remove("progression_speed").expect("a speed");
    store::write(&dataset, &dir.path("less.h5")).expect("it is written");
    let ran = dir.run(&["verify", "less.h5"]);
    assert_eq!(ran.code, 3, "{}", ran.err);
    assert!(ran.err.contains("the variable progression_speed is not there"), "{}", ran.err);
}

#[test]
fn a_block_with_a_valid_checksum_and_the_wrong_contents_is_refused() {
    let dir = WorkDir::new();
    dir.put("a.toml", CASES_AND_BRANCH);
    dir.run(&["sweep", "a.toml", "--no-figures", "--task", "1/2"]).done();
    let block = dir.path("results/a/a.blocks/block-0000000");
    let bytes = fs::read(&block).expect("a block");
    let body = &bytes[..bytes.len() - 14];
    let (right, wrong) = (b"\"cases\":40".as_slice(), b"\"cases\":41".as_slice());
    let at = body.windows(right.len()).position(|part| part == right).expect("its cases");
    let forged = [&body[..at], wrong, &body[at + right.len()..]].concat();
    let sum = crc32fast::hash(&forged);
    let with_checksum = [&forged[..], b"capsulemap", &sum.to_le_bytes()].concat();
    fs::write(&block, with_checksum).expect("it is forged");
    dir.run(&["join", "a.toml"]).refused(&["1 block missing: 0", "block-0000000: it is torn"]);
    let ran = dir.run(&["sweep", "a.toml", "--no-figures"]).done();
    assert!(ran.err.contains("block-0000000: it is torn"), "{}", ran.err);
}

#[test]
fn a_link_to_a_file_of_results_is_followed() {
    let dir = WorkDir::new();
    dir.put("a.toml", CASES_AND_BRANCH);
    dir.run(&["sweep", "a.toml", "--no-figures", "--output", "data/a.h5"]).done();
    std::os::unix::fs::symlink("data/a.h5", dir.path("link.h5")).expect("a link");
    let ran: Ran =
        dir.run(&["sweep", "a.toml", "--no-figures", "--output", "link.h5", "--overwrite"]);
    ran.done();
    assert!(dir.path("link.h5").is_symlink() && !dir.path("data/a.blocks").exists());
}
