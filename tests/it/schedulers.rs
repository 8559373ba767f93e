//! Studies that schedulers share among machines: by the variables that each sets, with the scripts for them, and with disks of their own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::interrupted_runs::LongRun;
use super::program::Ran;

const PROGRAM: &str = env!("CARGO_BIN_EXE_capsulemap");

/// A sweep with these variables set.
fn sweep(long: &LongRun, variables: &[(&str, &str)], more: &[&str]) -> Ran {
    let mut command = long.command(&[&["sweep", "long.toml", "--no-figures"], more].concat());
    command.envs(variables.iter().copied());
    Ran::from(command.output().expect("the program starts"))
}

#[test]
fn each_scheduler_says_which_task_it_is() {
    let long = LongRun::new();
    let grid = [("SGE_TASK_FIRST", "2"), ("SGE_TASK_LAST", "6"), ("SGE_TASK_STEPSIZE", "2")];
    let first = sweep(&long, &[&[("SGE_TASK_ID", "2")], grid.as_slice()].concat(), &[]).done();
    assert!(first.err.contains("task 1 of 3, as SGE_TASK_ID says"), "{}", first.err);
    let of_batch = [("AWS_BATCH_JOB_ARRAY_INDEX", "1"), ("AWS_BATCH_JOB_ARRAY_SIZE", "3")];
    assert!(sweep(&long, &of_batch, &["--task", "auto"]).done().err.contains("task 2 of 3"));
    assert_eq!(long.run(&["join", "long.toml", "--missing", "3"]).done().out, "3\n");
    let of_lsf = [("LSB_JOBINDEX", "3"), ("LSB_JOBINDEX_STEP", "1"), ("LSB_JOBINDEX_END", "3")];
    let granted = [("NSLOTS", "1"), ("OMP_NUM_THREADS", "7")];
    let third = sweep(&long, &[of_lsf.as_slice(), &granted].concat(), &[]).done();
    assert!(third.err.contains("task 3 of 3") && third.err.contains("1 thread, as NSLOTS says"));
    assert_eq!(long.run(&["join", "long.toml", "--missing", "3"]).done().out, "\n");
    long.run(&["join", "long.toml", "--no-figures"]).done();
    long.assert_undisturbed();
    assert_eq!(long.run(&["join", "long.toml", "--missing", "3"]).done().out, "\n");
}

#[test]
fn an_array_whose_size_is_not_said_computes_nothing_unasked() {
    let long = LongRun::new();
    for (name, told) in [
        ("PBS_ARRAY_INDEX", "--task $PBS_ARRAY_INDEX/N"),
        ("JOB_COMPLETION_INDEX", "--first-task 0"),
    ] {
        sweep(&long, &[(name, "1")], &[]).refused(&[told, "--task 1/1"]);
    }
    sweep(&long, &[("PARALLEL_SEQ", "1")], &["--task", "auto"]).refused(&["$PARALLEL_SEQ/N"]);
    sweep(&long, &[], &["--task", "auto"]).refused(&["no scheduler has started an array"]);
    for (wrong, first) in [("3/3", "0"), ("0/3", "1"), ("0/0", "0")] {
        let refused = sweep(&long, &[], &["--task", wrong, "--first-task", first]);
        refused.refused(&["expected I/N with I from"]);
    }
    assert!(long.blocks().is_empty());
    // What runs something else in each element is left alone.
    sweep(&long, &[("PARALLEL_SEQ", "2"), ("HQ_TASK_ID", "0")], &[]).done();
    long.assert_undisturbed();
}

#[test]
fn a_task_is_estimated_by_itself() {
    let long = LongRun::new();
    let whole = sweep(&long, &[], &["--dry-run"]).done().out;
    let part = sweep(&long, &[], &["--dry-run", "--task", "2/4"]).done().out;
    assert!(part.contains("task 2 of 4: 6 blocks with 3 072 cases"), "{part}");
    assert!(!whole.contains("task") && long.blocks().is_empty());
}

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts").join(name)
}

#[test]
fn the_script_for_pbs_shares_a_study() {
    let long = LongRun::new();
    for (index, name) in [("1", "PBS_ARRAY_INDEX"), ("2", "PBS_ARRAYID"), ("3", "PBS_ARRAYID")] {
        let mut command = Command::new("sh");
        command
            .arg(script("pbs/array.sh"))
            .current_dir("/")
            .env("PBS_O_WORKDIR", long.dir.path(""));
        command.envs([("STUDY", "long.toml"), ("TASKS", "3"), (name, index), ("NCPUS", "1")]);
        command.envs([("CAPSULEMAP", PROGRAM), ("SOURCE_DATE_EPOCH", "1700000000")]);
        let ran = Ran::from(command.output().expect("a shell")).done();
        assert!(ran.err.contains(&format!("task {index} of 3")), "{}", ran.err);
    }
    long.run(&["join", "long.toml", "--no-figures"]).done();
    long.assert_undisturbed();
    let alone = Command::new("sh").arg(script("pbs/array.sh")).output().expect("a shell");
    assert_eq!(alone.status.code(), Some(2));
}

#[test]
fn the_job_for_kubernetes_shares_a_study() {
    let long = LongRun::new();
    let job = fs::read_to_string(script("kubernetes/array.yaml")).expect("the job");
    let line = job.lines().find_map(|line| line.trim().strip_prefix("- exec capsulemap "));
    let words =
        line.expect("the command of the job").replace("/8", "/3").replace("/data/study", "long");
    for index in 0..3 {
        let mut command = Command::new("sh");
        command.args(["-c", &format!("exec {PROGRAM} {words}")]).current_dir(long.dir.path(""));
        command.env("JOB_COMPLETION_INDEX", index.to_string());
        command.env("SOURCE_DATE_EPOCH", "1700000000");
        let ran = Ran::from(command.output().expect("a shell")).done();
        assert!(ran.err.contains(&format!("task {} of 3", index + 1)), "{}", ran.err);
    }
    long.run(&["join", "long.toml", "--output", "long.h5", "--no-figures"]).done();
    assert!(fs::read(long.dir.path("long.h5")).expect("a result") == long.undisturbed);
}

#[test]
fn folders_of_machines_without_a_common_disk_are_joined() {
    let long = LongRun::new();
    for (machine, part) in [("a", "1/3"), ("b", "2/3"), ("c", "3/3")] {
        sweep(&long, &[], &["--task", part, "--output", &format!("{machine}/long.h5")]).done();
    }
    // A block that was damaged on its way is computed again here.
    let damaged = a_block(&long, "b");
    let mut bytes = fs::read(&damaged).expect("a block");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&damaged, bytes).expect("written");
    let join = ["join", "long.toml", "--no-figures", "--from"];
    let folders = ["a/long.blocks", "b/long.blocks", "c/long.blocks"];
    let refused = long.run(&[&join[..], &folders].concat());
    refused.refused(&["8 blocks copied", "7 blocks copied", "it is left out", "1 block missing"]);
    assert_eq!(long.run(&["join", "long.toml", "--missing", "3"]).done().out, "2\n");
    sweep(&long, &[], &["--task", "2/3"]).done();
    let again = long.run(&[&join[..], &folders[..1]].concat()).done();
    assert!(again.err.contains("0 blocks copied"), "{}", again.err);
    long.assert_undisturbed();
    assert!(long.dir.path("a/long.blocks").exists(), "what is copied stays");
    long.run(&["join", "long.toml", "--from", "nowhere"]).refused(&["nowhere"]);
    let other = LongRun::of(super::interrupted_runs::LINES);
    let foreign = long.dir.path("a/long.blocks");
    let foreign = foreign.to_string_lossy();
    other.run(&["sweep", "long.toml", "--no-figures", "--task", "1/2"]).done();
    other.run(&["join", "long.toml", "--from", &foreign]).refused(&["the study has changed"]);
}

/// One of the blocks that a machine has computed.
fn a_block(long: &LongRun, machine: &str) -> PathBuf {
    let entries = fs::read_dir(long.dir.path(&format!("{machine}/long.blocks"))).expect("a folder");
    let mut paths = entries.map(|entry| entry.expect("an entry").path());
    let found = paths.find(|it| it.to_string_lossy().contains("/block-"));
    found.expect("a block")
}
