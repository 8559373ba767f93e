//! Processes that come and go and share a study by claims: killed at random, paused, stopped by a signal, and beside other runs.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::Child;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

use capsulemap::campaign::{
    Campaign, CampaignError, Cause, Claims, Done, Event, Task, block_path, silent,
};
use capsulemap::run::Machine;
use capsulemap::study::spread;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use super::campaign::place::{long_study, names, place, timeless, uninterrupted};
use super::interrupted_runs::{LINES, LONG_STUDY, LongRun, drawn, said};
use super::program::Ran;

/// Claims whose owners are silent for a second are taken over.
const QUICK: [&str; 5] = ["--claim", "--claim-limit", "1", "--threads", "1"];

/// A refined basin of four tiles.
const REFINED: &str = r#"
[parameters]
m2 = "0.2 kg"
c = "1.77 N s/m"
mu_s = 0.33
mu_d = 0.165
p_d = "2.79 N"
k2 = "65.518 kN/m"
delta = "4.33 mm"
omega = "155 rad/s"
[[axes]]
name = "start_r"
from = "-6 mm"
to = "6 mm"
points = 140
[[axes]]
name = "start_y1"
from = "-1.5 m/s"
to = "1.5 m/s"
points = 130
[protocol]
points = 1
impact_points = 0
[basin]
refine = true
"#;

/// A third of the long study, in eight blocks.
fn eight_blocks() -> LongRun {
    LongRun::of(&LONG_STUDY.replace("points = 96", "points = 32"))
}

/// The claims that are there, by their names.
fn claims(long: &LongRun) -> Vec<String> {
    let entries = fs::read_dir(long.dir.path("results/long/long.blocks")).into_iter().flatten();
    let names = entries.flatten().map(|it| it.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.starts_with("claim-")).collect()
}

/// Waits until a child holds a claim, and is at work with its block.
fn wait_for_a_claim(long: &LongRun) {
    let begun = Instant::now();
    let folder = long.dir.path("results/long/long.blocks");
    let is_written = |name: &String| fs::read(folder.join(name)).is_ok_and(|it| !it.is_empty());
    while !claims(long).iter().any(is_written) {
        assert!(begun.elapsed() < Duration::from_secs(60), "no claim came");
        sleep(Duration::from_millis(2));
    }
    sleep(Duration::from_millis(20));
}

fn signal(long: &LongRun, name: &str, child: &Child) {
    let ran = long.dir.shell(&format!("kill -{name} {}", child.id()));
    assert_eq!(ran.code, 0, "{}", ran.err);
}

/// Starts processes that share a study, and kills one after the other at random moments, each time starting another in its
/// place, until so many were killed while they were at work or the study is whole; returns how many were.
fn kill_among(long: &LongRun, processes: usize, most: u32, random: &mut ChaCha8Rng) -> u32 {
    let mut all: Vec<Child> = (0..processes).map(|_| long.start(&QUICK)).collect();
    let mut kills = 0;
    while kills < most && !long.file().exists() {
        sleep(Duration::from_millis(u64::from(random.next_u32() % 120)));
        let child = &mut all[random.next_u32() as usize % processes];
        let ended = child.try_wait().expect("a process");
        child.kill().expect("it is killed or has ended");
        let status = child.wait().expect("a process");
        match ended {
            Some(_) => assert!(status.success(), "{}", said(child)),
            None => kills += 1,
        }
        *child = long.start(&QUICK);
    }
    for mut child in all {
        assert!(child.wait().expect("a process").success(), "{}", said(&mut child));
    }
    kills
}

/// In the long form `CLAIM_KILLS=60`: eight processes, and so many kills of each of three studies.
#[test]
fn processes_that_are_killed_at_random_end_in_the_file_of_one() {
    let asked = std::env::var("CLAIM_KILLS").ok().and_then(|text| text.parse().ok());
    let (processes, wanted) = asked.map_or((3, 4), |kills: u32| (8, kills));
    let studies = [LINES, LONG_STUDY, &drawn(10_000)];
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for study in &studies[..if asked.is_some() { 3 } else { 1 }] {
        let long = LongRun::of(study);
        let (mut kills, mut runs) = (0, 0);
        while kills < wanted {
            kills += kill_among(&long, processes, wanted - kills, &mut random);
            long.assert_undisturbed();
            long.forget();
            runs += 1;
            assert!(runs < 20 * wanted, "kills come too late");
        }
        println!("{kills} kills of {processes} processes in {runs} runs, and the file of one");
    }
}

#[cfg(unix)]
#[test]
fn a_paused_process_loses_its_blocks_and_does_no_harm_when_it_wakes() {
    let long = LongRun::of(LINES);
    let mut paused = long.start(&QUICK);
    wait_for_a_claim(&long);
    signal(&long, "STOP", &paused);
    let held = claims(&long);
    assert!(!held.is_empty(), "it was paused with a claim");
    long.sweep(&[]).refused(&["another run computes this study now"]);
    let status = long.run(&["status", "long.toml"]).done().out;
    assert!(status.contains(&format!("claimed by process {} on ", paused.id())), "{status}");
    let other = long.sweep(&QUICK).done();
    for part in ["waiting for ", "taken over from process ", "has not renewed its claim for 1.0 s"]
    {
        assert!(other.err.contains(part), "{part}: {}", other.err);
    }
    long.assert_undisturbed();
    signal(&long, "CONT", &paused);
    assert!(paused.wait().expect("a process").success(), "{}", said(&mut paused));
    let text = said(&mut paused);
    assert!(text.contains("is whole; another process has joined it"), "{text}");
    long.assert_undisturbed();
}

#[cfg(unix)]
#[test]
fn a_signal_gives_the_claims_up_and_a_kill_is_seen_at_once() {
    let long = eight_blocks();
    let hour = ["--claim", "--claim-limit", "3600", "--threads", "1"];
    for name in ["TERM", "INT", "KILL"] {
        let mut child = long.start(&hour);
        wait_for_a_claim(&long);
        signal(&long, name, &child);
        assert!(!child.wait().expect("a process").success(), "{name}");
        assert_eq!(claims(&long).is_empty(), name != "KILL");
    }
    let status = long.run(&["status", "long.toml"]).done().out;
    assert!(status.contains(", which does not run any more: "), "{status}");
    let begun = Instant::now();
    let other = long.sweep(&hour).done();
    assert!(begun.elapsed() < Duration::from_secs(60) && other.err.contains("taken over from"));
    long.assert_undisturbed();
}

/// Runs the first of two tasks, which another process does at the same time once its first block is there, and then `meddles`; returns
/// what came of it, and how many blocks both have computed.
fn run_twice(
    campaign: &Campaign<'_>,
    meddle: impl Fn(&Path) + Sync,
) -> (Result<Done, CampaignError>, usize) {
    let task = Task { number: 1, of: 2 };
    let (is_begun, twice) = (AtomicBool::new(false), AtomicUsize::new(0));
    let done = campaign.run(task, &|event| {
        match event {
            Event::Block(_) if !is_begun.swap(true, Ordering::Relaxed) => {
                campaign.run(task, &silent).expect("the other runs");
                let last = *task.share(spread(campaign.study.blocks())).last().expect("a block");
                meddle(&block_path(campaign.output).join(format!("block-{last:07}")));
            }
            Event::Twice { .. } => {
                twice.fetch_add(1, Ordering::Relaxed);
            }
            _ => {}
        }
        ControlFlow::Continue(())
    });
    (done, twice.into_inner())
}

#[test]
fn of_two_that_compute_a_block_the_first_keeps_it_and_the_second_compares() {
    let study = long_study();
    let (folder, output) = place();
    let machine = Machine { threads: Some(1), ..Machine::default() };
    let campaign = Campaign { machine, ..Campaign::new(&study, &output) };
    let (done, twice) = run_twice(&campaign, |_| {});
    assert!(matches!(done, Ok(Done::Shared(_))) && twice == 2, "{twice}");
    let claims = Claims::new(Duration::from_secs(60));
    let joined = campaign.run_with_claims(&claims, &silent);
    assert!(matches!(joined, Ok(Done::Complete(_))));
    assert!(timeless(&output) == uninterrupted(&study), "the bytes differ");
    assert_eq!(names(folder.path()), ["a.h5"]);
    // The other process computes wrongly: its checksum is right, and a number is another.
    fs::remove_file(&output).expect("it is there");
    let (done, _) = run_twice(&campaign, |block| {
        let bytes = fs::read(block).expect("a block");
        let mut body = bytes[..bytes.len() - 14].to_vec();
        *body.last_mut().expect("a number") ^= 1;
        let sum = crc32fast::hash(&body);
        fs::write(block, [&body[..], b"capsulemap", &sum.to_le_bytes()].concat()).expect("written");
    });
    let error = done.expect_err("the two differ");
    assert!(error.to_string().contains("has computed other numbers of this block"), "{error}");
    assert!(error.cause() == Cause::Machine && !output.exists());
}

#[test]
fn claims_beside_other_options_and_runs() {
    let long = LongRun::of(LINES);
    long.sweep(&["--claim", "--task", "1/2"]).refused(&["--task"]);
    long.sweep(&["--claim", "--overwrite"]).refused(&["--overwrite"]);
    long.sweep(&["--claim-limit", "5"]).refused(&["--claim"]);
    assert!(!long.dir.path("results").exists());
    // A claim that says nothing is waited for, and given up after a while; one of a block that is there hinders nobody.
    long.sweep(&["--task", "1/2"]).done();
    let there = long.blocks()[0].to_string_lossy().replace("block-", "claim-");
    let missing = (0..).map(|number| long.block(number)).find(|it| !it.exists()).expect("one");
    let missing = missing.to_string_lossy().replace("block-", "claim-");
    for path in [&there, &missing] {
        fs::write(path, "").expect("a claim");
    }
    // A block that is damaged is computed again by who claims it.
    let damaged = long.blocks()[1].clone();
    let bytes = fs::read(&damaged).expect("a block");
    fs::write(&damaged, &bytes[..bytes.len() / 2]).expect("it is cut");
    let mut command = long.command(&[&["sweep", "long.toml", "--no-figures"], &QUICK[..]].concat());
    let ran = Ran::from(command.env("PBS_ARRAY_INDEX", "3").output().expect("it starts")).done();
    for part in ["it is torn", "a process that is not known", "whose claim cannot be read"] {
        assert!(ran.err.contains(part), "{part}: {}", ran.err);
    }
    long.assert_undisturbed();
    let again = long.sweep(&QUICK).done();
    assert!(again.err.contains("already computed"), "{}", again.err);
    long.dir.put("long.toml", LINES.replace("max_cycles = 300", "max_cycles = 301"));
    long.sweep(&QUICK).refused(&["holds results of another study"]);
}

#[test]
fn blocks_of_a_process_without_the_common_folder_are_joined() {
    let long = eight_blocks();
    let mut other = long.start(&[&QUICK[..], &["--output", "other/long.h5"]].concat());
    let begun = Instant::now();
    while !long.dir.files().iter().any(|name| name.starts_with("other/long.blocks/block-")) {
        assert!(begun.elapsed() < Duration::from_secs(60), "no block came");
        sleep(Duration::from_millis(2));
    }
    signal(&long, "TERM", &other);
    other.wait().expect("a process");
    let joined = long.run(&["join", "long.toml", "--no-figures", "--from", "other/long.blocks"]);
    joined.refused(&[" copied", " missing: "]);
    assert!(!long.blocks().is_empty());
    long.sweep(&QUICK).done();
    long.assert_undisturbed();
}

#[test]
fn a_refined_study_is_shared_tile_by_tile() {
    let long = LongRun::of(REFINED);
    let mut all: Vec<Child> = (0..3).map(|_| long.start(&QUICK)).collect();
    for child in &mut all {
        assert!(child.wait().expect("a process").success(), "{}", said(child));
    }
    long.assert_undisturbed();
}
