//! Kills at the calls that change the disk: whichever is the last, the same command ends in the same files.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use super::kept_searches::{self, REFINE, SEARCHES};
use super::program::WorkDir;
use super::store::say;

/// Calls of the system that change the disk, as families of what the kernel has.
const CALLS: [&str; 5] = [
    "rename,renameat,renameat2",
    "unlink,unlinkat,rmdir",
    "fsync,fdatasync",
    "write,pwrite64",
    "mkdir",
];
/// The calls of each family at which the program is killed, unless CALLS says up to which.
const SOME: [usize; 9] = [1, 2, 3, 4, 5, 8, 13, 29, 73];

/// Four blocks, attractors to link, branches to keep and a figure to draw, quickly.
const STUDY: &str = r#"
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
[[axes]]
name = "omega"
from = "18 rad/s"
to = "80 rad/s"
points = 40
[[axes]]
name = "p_d"
from = "1 N"
to = "2 N"
points = 50
[protocol]
points = 1
impact_points = 0
max_cycles = 30
exponent_cycles = 0
measured_cycles = 4
[[figures]]
name = "speed"
kind = "map"
"#;

/// The commands whose kills are tried.
const COMMANDS: [&[&str]; 2] = [
    &["sweep", "s.toml", "--formats", "svg", "--threads", "1"],
    &["sweep", "s.toml", "--formats", "svg", "--threads", "1", "--overwrite"],
];

/// The command with a fixed time of creation, so that files can be compared.
fn command(dir: &WorkDir, arguments: &[&str]) -> Command {
    let mut command = dir.command(arguments);
    command.env("SOURCE_DATE_EPOCH", "1700000000").env_remove("SLURM_ARRAY_TASK_ID");
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// The files in a folder, with what they hold.
fn contents(dir: &WorkDir) -> Vec<(String, Vec<u8>)> {
    let files = dir.files().into_iter();
    let read = |name: String| {
        let path = dir.path(&name);
        let bytes = if path.is_dir() { Vec::new() } else { fs::read(path).expect("a file") };
        (name, bytes)
    };
    files.map(read).collect()
}

/// Runs a command under strace, which kills it at the `n`-th call of a family of any thread; whether that came.
fn killed(dir: &WorkDir, arguments: &[&str], calls: &str, n: usize) -> bool {
    let program = command(dir, arguments);
    let mut strace = Command::new("strace");
    strace.args(["-f", "-qqq", "-o", "/dev/null"]);
    strace.arg(format!("--trace={calls}")).arg(format!("--inject={calls}:signal=KILL:when={n}"));
    strace.arg(program.get_program()).args(program.get_args()).current_dir(dir.folder());
    for (key, value) in program.get_envs() {
        value.map(|value| strace.env(key, value));
    }
    let ended = strace.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status();
    !ended.expect("strace starts").success()
}

/// Whether strace can be used, which some machines forbid.
fn can_trace() -> bool {
    let mut strace = Command::new("strace");
    let tried = strace.args(["-f", "-qqq", "-o", "/dev/null", "--trace=write", "true"]);
    tried.stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// In the long form `CALLS=200`: at each of the first 200 calls of each family.
#[test]
fn a_kill_at_any_call_costs_nothing_but_time() {
    if !can_trace() {
        say("SKIPPED: kills at the n-th call (strace is not there or not allowed)");
        return;
    }
    let asked = std::env::var("CALLS").ok().and_then(|most| most.parse::<usize>().ok());
    let tried: Vec<usize> = asked.map_or(SOME.to_vec(), |most| (1..=most).collect());
    let mut kills = 0;
    for arguments in COMMANDS {
        let dir = WorkDir::new();
        dir.put("s.toml", STUDY);
        let again = |dir: &WorkDir| {
            let status = command(dir, COMMANDS[0]).status().expect("the program starts");
            assert!(status.success(), "{status}");
        };
        again(&dir);
        let undisturbed = contents(&dir);
        let names: Vec<&str> = undisturbed.iter().map(|(name, _)| name.as_str()).collect();
        let results = ["results", "results/s", "results/s/s.h5", "results/s/speed.svg", "s.toml"];
        assert_eq!(names, results);
        for calls in CALLS {
            for &n in &tried {
                if !arguments.contains(&"--overwrite") {
                    fs::remove_dir_all(dir.path("results")).expect("the results are removed");
                }
                if !killed(&dir, arguments, calls, n) {
                    break;
                }
                kills += 1;
                again(&dir);
                let found = contents(&dir);
                let left: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
                assert_eq!(left, names, "{arguments:?} killed at {calls} {n}");
                assert!(found == undisturbed, "{arguments:?} killed at {calls} {n}: other bytes");
            }
            assert!(Path::new(&dir.path("results/s/s.h5")).exists());
        }
    }
    println!("killed {kills} times, and the same files each time");
    assert!(kills > 30, "{kills}");
}

/// In the long form `CALLS=200`, as above.
#[test]
fn a_kill_at_any_call_of_a_refinement_loses_no_search_that_is_done() {
    if !can_trace() {
        say("SKIPPED: kills at the n-th call of a refinement (strace is not there or not allowed)");
        return;
    }
    let asked = std::env::var("CALLS").ok().and_then(|most| most.parse::<usize>().ok());
    let tried: Vec<usize> = asked.map_or(vec![1, 3, 13], |most| (1..=most).collect());
    let dir = kept_searches::swept(kept_searches::STUDY);
    let whole = dir.run(&REFINE).done();
    let all = kept_searches::lines(&dir);
    let mut kills = 0;
    for calls in ["write,pwrite64", "fsync,fdatasync", "ftruncate"] {
        for &n in &tried {
            fs::remove_file(dir.path(SEARCHES)).expect("it is there");
            let ended = !killed(&dir, &REFINE, calls, n);
            kills += usize::from(!ended);
            assert!(kept_searches::lines(&dir).is_subset(&all), "killed at {calls} {n}");
            assert_eq!(dir.run(&REFINE).done().out, whole.out, "killed at {calls} {n}");
            assert!(kept_searches::lines(&dir) == all, "killed at {calls} {n}");
            if ended {
                break;
            }
        }
    }
    println!("killed {kills} times, and the same searches each time");
    assert!(kills > 5, "{kills}");
}
