//! A study on a cluster: a real Slurm of one machine runs the scripts of `scripts/slurm`, and tasks die.

mod cluster;

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::store::say;
use cluster::{Cluster, said};

/// The program of this build.
const PROGRAM: &str = env!("CARGO_BIN_EXE_capsulemap");
/// Instead of the time at which a result was made.
const EPOCH: &str = "1500000000";
/// Sixty-four blocks of one frequency each, near the period doublings, where cases settle slowly; what
/// starts with the same parameters lead to is compared when the blocks are joined.
const STUDY: &str = "\
title = \"Starts below the first period doublings\"
outputs = [\"progression_speed\", \"energy_residual\"]

[parameters]
c = \"0.44 N s/m\"
mu_s = 0.437
mu_d = 0.2185
p_d = \"3.4 N\"
k2 = \"86.8 kN/m\"
delta = \"2.45 mm\"

[[axes]]
name = \"omega\"
from = \"39.2 rad/s\"
to = \"40.33 rad/s\"
points = 64

[[axes]]
name = \"start_y1\"
from = \"-0.4 m/s\"
to = \"0.4 m/s\"
points = 1536

[protocol]
points = 1
impact_points = 0
";
/// How many blocks that are.
const BLOCKS: usize = 192;
/// The tasks that it is computed in, each of some seconds, so that it can be killed before it ends.
const TASKS: usize = 8;

/// A file of `scripts/slurm`.
fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/slurm").join(name)
}

/// Submits by a command line, with the program and the time of every run here; returns what is printed.
fn submit(command: &mut Command) -> String {
    said(command.env("CAPSULEMAP", PROGRAM).env("SOURCE_DATE_EPOCH", EPOCH))
}

/// The number of the job in the line of `printed` that begins with `name`.
fn number(printed: &str, name: &str) -> String {
    let line = printed.lines().find_map(|line| line.strip_prefix(name)).expect(name);
    let digits = line.trim_start_matches(": job ").split(',').next();
    digits.expect("a number").to_owned()
}

/// The blocks in the jobs' folder, by name, each with the number of its file.
fn blocks(cluster: &Cluster) -> BTreeMap<String, u64> {
    let folder = cluster.dir().join("results/starts/starts.blocks");
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let entry = entry.expect("the folder can be read");
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.strip_prefix("block-").is_some_and(|number| number.parse::<usize>().is_ok()) {
            found.insert(name, entry.metadata().expect("a block stays").ino());
        }
    }
    found
}

/// Sure that what was there `before` has not been computed again.
fn assert_kept(before: &BTreeMap<String, u64>, cluster: &Cluster) {
    let after = blocks(cluster);
    for (name, file) in before {
        assert_eq!(after.get(name), Some(file), "{name} was computed twice or is lost");
    }
}

/// Kills the programs of tasks while they compute, as a machine out of memory does.
fn kill(cluster: &Cluster, tasks: &[&str]) {
    for task in tasks {
        cluster.run("scancel", &["--batch", "--signal=KILL", task]);
    }
    for task in tasks {
        cluster.wait_for(task, "FAILED");
        assert_eq!(cluster.job(task, "ExitCode"), "0:9", "task {task} was not killed");
    }
}

fn log(cluster: &Cluster, name: &str) -> String {
    fs::read_to_string(cluster.dir().join(name)).expect("a log")
}

/// The file that the study gives without a cluster.
fn computed_plainly() -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("starts.toml"), STUDY).expect("a study");
    let mut command = Command::new("timeout");
    command.args(["180", PROGRAM, "sweep", "starts.toml", "--no-figures"]);
    said(command.current_dir(folder.path()).env("SOURCE_DATE_EPOCH", EPOCH));
    fs::read(folder.path().join("results/starts/starts.h5")).expect("the results")
}

#[test]
fn tasks_that_die_cost_nothing_but_time() {
    if let Some(missing) = Cluster::lacks() {
        say(&format!("SKIPPED: a study on a cluster (Slurm is not installed: no {missing})"));
        return;
    }
    let cluster = Cluster::start();
    fs::write(cluster.dir().join("starts.toml"), STUDY).expect("a study");
    let tasks = TASKS.to_string();
    let mut command = cluster.command(script("submit.sh"));
    let printed = submit(command.args(["starts.toml", &tasks, "--cpus-per-task=1"]));
    let (array, join) = (number(&printed, "tasks"), number(&printed, "join"));
    let early = interrupt(&cluster, &array);
    assert_join_names_what_is_missing(&cluster, &join);
    assert_all_but_task_2_have_ended_well(&cluster, &array);
    assert_kept(&early, &cluster);

    let late = blocks(&cluster);
    let again = ["--array=2", "--cpus-per-task=1"];
    run_alone(&cluster, &again, "array.sh", &["starts.toml", &tasks]);
    assert_kept(&late, &cluster);
    assert_eq!(blocks(&cluster).len(), BLOCKS);
    run_alone(&cluster, &["--cpus-per-task=2"], "join.sh", &["starts.toml"]);
    let joined = fs::read(cluster.dir().join("results/starts/starts.h5")).expect("the results");
    assert!(joined == computed_plainly(), "the cluster's file differs from the plain one");
}

#[test]
fn memory_may_be_asked_for_in_either_form_and_studies_have_any_name() {
    if let Some(missing) = Cluster::lacks() {
        say(&format!("SKIPPED: options of jobs (Slurm is not installed: no {missing})"));
        return;
    }
    let cluster = Cluster::start();
    let study = STUDY.replace("points = 1536", "points = 2").replace("points = 64", "points = 2");
    fs::write(cluster.dir().join("-n.toml"), study).expect("a study");
    for (options, field, expected) in [
        (&[][..], "MinMemoryCPU", "1G"),
        (&["--mem=900M"], "MinMemoryNode", "900M"),
        (&["--mem", "901M"], "MinMemoryNode", "901M"),
        (&["--mem-per-cpu=300M"], "MinMemoryCPU", "300M"),
    ] {
        let mut command = cluster.command(script("submit.sh"));
        let arguments = [&["-n.toml", "1", "--cpus-per-task=1"], options].concat();
        let printed = submit(command.args(arguments));
        let jobs = [number(&printed, "tasks") + "_1", number(&printed, "join")];
        for job in jobs {
            cluster.wait_for(&job, "COMPLETED");
            assert_eq!(cluster.job(&job, field), expected, "{options:?}");
        }
        assert!(cluster.dir().join("results/-n/-n.h5").exists());
    }
}

/// Does to tasks of the job `array` what happens on clusters; returns the blocks that are done by then.
fn interrupt(cluster: &Cluster, array: &str) -> BTreeMap<String, u64> {
    let [first, second, third] = [1, 2, 3].map(|number| format!("{array}_{number}"));
    // Task 1 is killed and put back in the queue, as if its node had failed; task 2 stays dead.
    cluster.wait_for(&second, "RUNNING");
    cluster.wait_while_running(&first, || blocks(cluster).len() > 1);
    kill(cluster, &[&first, &second]);
    cluster.run("scontrol", &["requeue", &first]);
    // Task 3 makes room for others: it is asked to stop, and goes back to the queue.
    cluster.wait_for(&third, "RUNNING");
    let before = blocks(cluster).len();
    cluster.wait_while_running(&third, || blocks(cluster).len() > before);
    cluster.run("scontrol", &["requeue", &third]);
    blocks(cluster)
}

/// While task 2 is dead the join fails, names blocks, and leaves no file that could be taken for whole.
fn assert_join_names_what_is_missing(cluster: &Cluster, join: &str) {
    cluster.wait_for(join, "FAILED");
    assert_eq!(cluster.job(join, "ExitCode"), "2:0");
    let ran = log(cluster, &format!("capsulemap-join-{join}.log"));
    assert!(ran.contains("missing"), "the join does not say what is missing:\n{ran}");
    assert!(!cluster.dir().join("results/starts/starts.h5").exists());
    let whole = blocks(cluster).len();
    assert!((1..BLOCKS).contains(&whole), "{whole} blocks are there");
}

/// The tasks that were put back in the queue have run twice, and say why.
fn assert_all_but_task_2_have_ended_well(cluster: &Cluster, array: &str) {
    for number in (1..=TASKS).filter(|number| *number != 2) {
        let task = format!("{array}_{number}");
        let restarts = if [1, 3].contains(&number) { "1" } else { "0" };
        assert_eq!(cluster.job(&task, "JobState"), "COMPLETED", "task {number}");
        assert_eq!(cluster.job(&task, "Restarts"), restarts, "task {number}");
    }
    let ran = log(cluster, &format!("capsulemap-{array}-3.log"));
    assert!(ran.contains("resumes from there"), "task 3 does not say how to resume:\n{ran}");
}

/// Submits a script by itself, as it says in its first lines, and waits until it has succeeded.
fn run_alone(cluster: &Cluster, options: &[&str], name: &str, arguments: &[&str]) {
    let mut command = cluster.command("sbatch");
    command.arg("--parsable").args(options).arg(script(name)).args(arguments);
    let job = submit(&mut command);
    cluster.wait_for(&job, "COMPLETED");
}
