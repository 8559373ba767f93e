//! Others beside a long run: files that are not its own, a run that continues branches, and readers that stall.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use capsulemap::store;

use super::overnight::{LINES, NIGHT};
use super::program::{Desk, Ran};

/// A study that is quickly swept and continued.
const BOTH: &str = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
p_d = "4 N"
[[axes]]
name = "omega"
from = "18 rad/s"
to = "30 rad/s"
points = 40
[protocol]
points = 1
impact_points = 0
[[branches]]
name = "b"
along = "omega"
at = { omega = "20.73 rad/s" }
from = "19 rad/s"
to = "28 rad/s"
"#;

#[test]
fn a_folder_of_somebody_else_is_left_alone() {
    let desk = Desk::new();
    desk.put("a.toml", BOTH);
    fs::create_dir(desk.path("a.blocks")).expect("a folder");
    desk.put("a.blocks/thesis.txt", "years of work");
    let sweep = |more: &[&str]| {
        desk.run(&[&["sweep", "a.toml", "--no-figures", "--output", "a.h5"], more].concat())
    };
    sweep(&[]).refused(&["a.blocks: is where the blocks of this study go, and holds other things"]);
    sweep(&["--overwrite"]).refused(&["holds other things"]);
    // What is put there later stays too.
    fs::rename(desk.path("a.blocks"), desk.path("b.blocks")).expect("it is moved");
    sweep(&["--task", "1/2"]).done();
    fs::rename(desk.path("b.blocks/thesis.txt"), desk.path("a.blocks/thesis.txt")).expect("back");
    sweep(&[]).done();
    assert_eq!(fs::read_dir(desk.path("a.blocks")).expect("a folder").count(), 1);
    sweep(&[]).done();
    assert_eq!(fs::read(desk.path("a.blocks/thesis.txt")).expect("it is there"), b"years of work");
    desk.run(&["sweep", "a.toml", "--output", "r.blocks"]).refused(&["for the folder of blocks"]);
}

#[test]
fn cases_and_branches_written_at_once_lose_nothing() {
    let desk = Desk::new();
    for (name, first, second) in [("s", "sweep", "continue"), ("f", "continue", "sweep")] {
        let study = format!("{name}.toml");
        desk.put(&study, BOTH);
        let start = |command: &str| {
            let mut command = desk.command(&[command, &study, "--no-figures"]);
            command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts")
        };
        let both = [start(first), start(second)];
        for child in both {
            let ended = child.wait_with_output().expect("a process");
            assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
        }
        let file = desk.path(&format!("results/{name}/{name}.h5"));
        let dataset = store::read(&file).expect("a result");
        assert!(store::has_cases(&dataset) && store::has_branches(&dataset), "{first} first");
    }
}

#[cfg(unix)]
#[test]
fn a_log_that_nobody_reads_does_not_keep_a_run_from_stopping() {
    let desk = Desk::new();
    desk.put("night.toml", NIGHT.replace("points = 128", "points = 1280"));
    let mut command = desk.command(&["sweep", "night.toml"]);
    let mut child = command.stderr(Stdio::piped()).spawn().expect("the program starts");
    // The pipe is never read, so that it is full after some hundred lines.
    std::thread::sleep(Duration::from_secs(6));
    let asked = Instant::now();
    let kill = Command::new("kill").arg(child.id().to_string()).status().expect("kill starts");
    assert!(kill.success(), "the run was over too soon");
    while child.try_wait().expect("a process").is_none() {
        assert!(asked.elapsed() < Duration::from_secs(10), "it goes on");
        std::thread::sleep(Duration::from_millis(50));
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_that_was_to_be_ignored_is() {
    let desk = Desk::new();
    desk.put("a.toml", LINES);
    let script = "trap '' INT; \"$0\" sweep a.toml --no-figures & sleep 0.5; kill -INT $!; wait $!";
    desk.shell(script).done();
    assert!(desk.path("results/a/a.h5").is_file());
}

#[test]
fn what_is_missing_in_a_file_is_not_verified() {
    let desk = Desk::new();
    desk.put("a.toml", BOTH);
    desk.run(&["sweep", "a.toml", "--no-figures", "--output", "a.h5"]).done();
    let mut dataset = store::read(&desk.path("a.h5")).expect("a result");
    dataset.variables.remove("progression_speed").expect("a speed");
    store::write(&dataset, &desk.path("less.h5")).expect("it is written");
    let told = desk.run(&["verify", "less.h5"]);
    assert_eq!(told.code, 3, "{}", told.err);
    assert!(told.err.contains("the variable progression_speed is not there"), "{}", told.err);
}

#[test]
fn a_sealed_block_with_the_wrong_contents_is_not_trusted() {
    let desk = Desk::new();
    desk.put("a.toml", BOTH);
    desk.run(&["sweep", "a.toml", "--no-figures", "--task", "1/2"]).done();
    let block = desk.path("results/a/a.blocks/block-0000000");
    let bytes = fs::read(&block).expect("a block");
    let body = &bytes[..bytes.len() - 14];
    let (right, wrong) = (b"\"cases\":40".as_slice(), b"\"cases\":41".as_slice());
    let at = body.windows(right.len()).position(|part| part == right).expect("its cases");
    let forged = [&body[..at], wrong, &body[at + right.len()..]].concat();
    let sum = crc32fast::hash(&forged);
    let sealed = [&forged[..], b"capsulemap", &sum.to_le_bytes()].concat();
    fs::write(&block, sealed).expect("it is forged");
    desk.run(&["join", "a.toml"]).refused(&["1 block missing: 0", "block-0000000: it is torn"]);
    let told = desk.run(&["sweep", "a.toml", "--no-figures"]).done();
    assert!(told.err.contains("block-0000000: it is torn"), "{}", told.err);
}

#[test]
fn a_link_to_a_file_of_results_is_followed() {
    let desk = Desk::new();
    desk.put("a.toml", BOTH);
    desk.run(&["sweep", "a.toml", "--no-figures", "--output", "data/a.h5"]).done();
    std::os::unix::fs::symlink("data/a.h5", desk.path("link.h5")).expect("a link");
    let told: Ran =
        desk.run(&["sweep", "a.toml", "--no-figures", "--output", "link.h5", "--overwrite"]);
    told.done();
    assert!(desk.path("link.h5").is_symlink() && !desk.path("data/a.blocks").exists());
}
