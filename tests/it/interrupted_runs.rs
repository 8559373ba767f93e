//! Long runs that are interrupted: kills, signals, damaged blocks, a changed study, two runs at once, and tasks that are joined.

mod long_run;

use std::fs;
use std::path::PathBuf;
use std::process::Child;
use std::thread::sleep;
use std::time::{Duration, Instant};

use capsulemap::store::{self, Values};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use super::program::{Ran, WorkDir};
pub use long_run::{LINES, LONG_STUDY, LongRun, drawn, said};

/// How often runs were killed while cases were computed, and while blocks were joined.
type Kills = [u32; 2];

/// Starts a run again and again, each killed at a random moment, until it ends or has been killed thrice and
/// may end.
fn kill_and_resume(long: &LongRun, whole: Duration, random: &mut ChaCha8Rng) -> Kills {
    let mut kills = [0, 0];
    for times in 1..=3 {
        let mut child = long.start(&[]);
        let share = f64::from(random.next_u32()) / f64::from(u32::MAX);
        // Later starts have less to do, so that kills must come sooner to come in time.
        sleep(whole.mul_f64(share / f64::from(times)));
        let ended = child.try_wait().expect("a process");
        child.kill().expect("it is killed or has ended");
        let status = child.wait().expect("a process");
        if ended.is_some() {
            assert!(status.success(), "{}", said(&mut child));
            return kills;
        }
        kills[usize::from(long.is_being_joined())] += 1;
    }
    long.sweep(&[]).done();
    kills
}

/// In the long form `KILLS=100`; a run that ends before it is killed does not count.
#[test]
fn runs_that_are_killed_at_random_and_resumed_end_in_the_same_bytes() {
    let asked = std::env::var("KILLS").ok().and_then(|text| text.parse().ok());
    let wanted = asked.unwrap_or(4);
    let draws = drawn(if asked.is_some() { 10_000 } else { 1_500 });
    let long_runs = [LONG_STUDY, LINES, &draws].map(|study| {
        let long = LongRun::of(study);
        let begun = Instant::now();
        long.sweep(&[]).done();
        long.assert_undisturbed();
        long.forget();
        (long, begun.elapsed())
    });
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let (mut runs, mut kills) = (0, [0, 0]);
    for attempt in 0..10 * wanted {
        let (long, whole) = &long_runs[attempt % long_runs.len()];
        let more = kill_and_resume(long, *whole, &mut random);
        long.assert_undisturbed();
        long.forget();
        kills = [kills[0] + more[0], kills[1] + more[1]];
        runs += usize::from(more != [0, 0]);
        if runs == wanted {
            break;
        }
    }
    let [computing, joining] = kills;
    println!(
        "{runs} runs were killed, {computing} times while cases were computed and {joining} times while \
         blocks were joined, and ended in the same bytes"
    );
    assert_eq!(runs, wanted, "kills come too late");
}

#[cfg(unix)]
#[test]
fn signals_keep_what_is_done_and_say_how_to_go_on() {
    use std::os::unix::process::ExitStatusExt;
    let long = LongRun::new();
    let mut attempts_left = 10;
    let mut signals = vec!["INT", "TERM"];
    while let Some(signal) = signals.pop() {
        let mut child = long.start(&[]);
        long.wait_for(3);
        let ran = long.dir.shell(&format!("kill -{signal} {}", child.id()));
        assert_eq!(ran.code, 0, "{}", ran.err);
        let asked = Instant::now();
        let status = child.wait().expect("a process");
        assert!(asked.elapsed() < Duration::from_secs(10));
        if status.success() && attempts_left > 0 {
            // On a busy machine the run may be done before it is asked to stop.
            attempts_left -= 1;
            long.forget();
            signals.push(signal);
            continue;
        }
        assert_eq!(status.signal(), Some(if signal == "INT" { 2 } else { 15 }));
        let text = said(&mut child);
        let last = text.lines().last().expect("a last line");
        assert!(last.contains(" blocks are done and kept in results/long/long.blocks"), "{text}");
        assert!(last.ends_with("the same command resumes from there"), "{text}");
        let there = long.blocks().len();
        let resumed = long.sweep(&[]).done();
        let kept = format!("{there} of 24 blocks are done and kept");
        assert!(resumed.err.contains(&kept), "{kept}: {}", resumed.err);
        long.assert_undisturbed();
        long.forget();
    }
}

#[test]
fn damaged_and_foreign_blocks_are_named_and_computed_again() {
    let long = LongRun::new();
    for part in ["1/3", "2/3", "3/3"] {
        long.sweep(&["--task", part]).done();
    }
    let bytes = |number| fs::read(long.block(number)).expect("a block");
    let mut flipped = bytes(3);
    let middle = flipped.len() / 2;
    flipped[middle] ^= 4;
    let cut = &bytes(5)[..700];
    // The same grid with another tolerance is another study; a build of another commit another version.
    let other = WorkDir::new();
    other.put("long.toml", LONG_STUDY.replace("max_cycles = 300", "max_cycles = 301"));
    other.run(&["sweep", "long.toml", "--task", "1/2"]).done();
    let foreign: Vec<PathBuf> = fs::read_dir(other.path("results/long/long.blocks"))
        .expect("blocks")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    let foreign = foreign.iter().find(|path| path.to_string_lossy().contains("block-"));
    let foreign = foreign.expect("a block").clone();
    let number = foreign.file_name().expect("a name").to_string_lossy()[6..].parse::<usize>();
    let number = number.expect("a number");
    let spare = (7..24).find(|it| ![number, 3, 5].contains(it)).expect("another block");
    fs::write(long.block(3), flipped).expect("it is flipped");
    fs::write(long.block(5), cut).expect("it is cut");
    fs::copy(foreign, long.block(number)).expect("it is foreign");
    fs::write(long.block(spare), written_by_another_version(&bytes(spare))).expect("it is old");
    let refused = long.run(&["join", "long.toml"]);
    refused.refused(&["4 blocks missing: ", "block-0000003: it is torn", "--partial"]);
    let ran = long.sweep(&[]).done();
    let line = |number: usize| {
        let name = format!("block-{number:07}: it is ");
        let line = ran.err.lines().find(|line| line.contains(&name));
        line.unwrap_or_else(|| panic!("{name} is missing from:\n{}", ran.err)).to_owned()
    };
    assert!(line(3).contains("torn") && line(5).contains("torn"));
    assert!(line(number).contains("foreign: made for another study; it is computed again"));
    let old = line(spare);
    assert!(old.contains("foreign: made by another version, capsulemap 0.0.9"), "{old}");
    assert!(ran.err.contains("20 of 24 blocks are done and kept"), "{}", ran.err);
    long.assert_undisturbed();
}

/// A block as an older program would have written it, with a valid checksum.
fn written_by_another_version(bytes: &[u8]) -> Vec<u8> {
    let body = &bytes[..bytes.len() - 14];
    let own = format!("capsulemap {}", env!("CARGO_PKG_VERSION")).into_bytes();
    let at = body.windows(own.len()).position(|part| part == own).expect("the program's name");
    let old = [&body[..at], b"capsulemap 0.0.9", &body[at + own.len()..]].concat();
    let sum = crc32fast::hash(&old);
    [&old[..], b"capsulemap", &sum.to_le_bytes()].concat()
}

#[test]
fn a_changed_study_does_not_mix_with_older_blocks() {
    let long = LongRun::new();
    long.sweep(&["--task", "1/4"]).done();
    let there = long.blocks().len();
    long.dir.put("long.toml", LONG_STUDY.replace("to = \"8 N\"", "to = \"7 N\""));
    long.sweep(&[]).refused(&[
        "long.blocks: holds blocks of another run",
        "- to = \"8 N\"",
        "+ to = \"7 N\"",
        "begun.toml",
        "--overwrite",
    ]);
    long.run(&["join", "long.toml"]).refused(&["- to = \"8 N\""]);
    assert_eq!(long.blocks().len(), there, "nothing is lost by a refusal");
    // What does not change a case does not matter.
    let words = LONG_STUDY.replace("A long run", "Another title") + "# a remark\n";
    long.dir.put("long.toml", words);
    let ran = long.sweep(&["--task", "2/4"]).done();
    assert!(!ran.err.contains("computed again") && long.blocks().len() > there);
    // Blocks of another build are not mixed either.
    long.dir.put("long.toml", LONG_STUDY);
    let begun = long.dir.path("results/long/long.blocks/begun.json");
    let text = fs::read_to_string(&begun).expect("what it was begun with");
    let commit = text.split("\"commit\": \"").nth(1).and_then(|rest| rest.split('"').next());
    fs::write(&begun, text.replace(commit.expect("a commit"), "0123456789ab")).expect("it is old");
    long.sweep(&[]).refused(&["the blocks were made by capsulemap", "(commit 0123456789ab)"]);
    long.sweep(&["--overwrite"]).done();
    long.assert_undisturbed();
}

#[test]
fn a_second_run_on_the_same_study_stops_at_once() {
    let long = LongRun::of(&LONG_STUDY.replace("points = 128", "points = 640"));
    let mut first = long.start(&[]);
    long.wait_for(1);
    let begun = Instant::now();
    long.sweep(&[]).refused(&["another run computes this study now"]);
    long.sweep(&["--task", "1/2"]).refused(&["another run computes this study now"]);
    long.run(&["join", "long.toml"]).refused(&["another run computes this study now"]);
    assert!(begun.elapsed() < Duration::from_secs(10));
    let status = long.run(&["status", "long.toml"]).done();
    assert!(status.out.contains("a run is active") || long.file().exists(), "{}", status.out);
    assert!(first.wait().expect("a process").success(), "{}", said(&mut first));
    long.assert_undisturbed();
}

#[test]
fn tasks_that_share_a_study_are_joined_to_the_file_of_one_run() {
    let long = LongRun::new();
    let mut twins: Vec<Child> =
        ["1/3", "2/3", "2/3"].iter().map(|part| long.start(&["--task", part])).collect();
    for twin in &mut twins {
        assert!(twin.wait().expect("a process").success(), "{}", said(twin));
    }
    let refused = long.run(&["join", "long.toml"]);
    refused.refused(&["8 blocks missing: ", "--partial"]);
    let status = long.run(&["status", "long.toml"]).done().out;
    for part in ["16 of 24 blocks", "8 192 of 12 288 cases", "no run is active", "16 blocks by"] {
        assert!(status.contains(part), "{part}: {status}");
    }
    // Slurm says which task it is where the command does not.
    let mut third = long.command(&["sweep", "long.toml"]);
    for (name, value) in [("ID", "30"), ("MIN", "10"), ("STEP", "10"), ("COUNT", "3")] {
        third.env(format!("SLURM_ARRAY_TASK_{name}"), value);
    }
    let third = Ran::from(third.env("SLURM_CPUS_PER_TASK", "1").output().expect("it starts"));
    assert!(third.done().err.contains("task 3 of 3"));
    long.run(&["join", "long.toml", "--no-figures"]).done();
    long.assert_undisturbed();
    let again = long.run(&["join", "long.toml", "--no-figures"]).done();
    assert!(again.err.contains("is there, whole"), "{}", again.err);
    for wrong in ["0/3", "4/3", "x", "3"] {
        long.sweep(&["--task", wrong]).refused(&["--task", "expected I/N"]);
    }
}

#[test]
fn stripes_and_attractors_are_joined_from_tasks_as_well() {
    let long = LongRun::of(LINES);
    for part in ["3/3", "1/3", "2/3"] {
        long.sweep(&["--task", part]).done();
    }
    long.run(&["join", "long.toml", "--no-figures", "--threads", "1"]).done();
    long.assert_undisturbed();
    let dataset = store::read(&long.file()).expect("a result");
    assert!(dataset.variable("attractor").is_some() && dataset.variable("event_kind").is_some());
    let ran = long.run(&["verify", "results/long/long.h5", "--cases", "50"]).done();
    assert!(ran.out.contains("80 cases drawn"), "whole lines are computed: {}", ran.out);
}

#[test]
fn blocks_that_a_kill_has_left_beside_the_joined_file_are_cleared_away() {
    let long = LongRun::new();
    long.sweep(&["--task", "1/2"]).done();
    fs::copy(long.dir.path("whole.h5"), long.file()).expect("the joined file");
    assert!(long.sweep(&[]).done().err.contains("already computed"));
    long.assert_undisturbed();
}

#[test]
fn a_look_before_the_end_shows_what_is_there() {
    let long = LongRun::new();
    let figure = "[[figures]]\nname = \"speed\"\nkind = \"map\"\n";
    long.dir.put("long.toml", LONG_STUDY.to_owned() + figure);
    long.sweep(&["--task", "1/2"]).done();
    long.run(&["join", "long.toml", "--partial", "--formats", "png"]).done();
    assert!(long.dir.path("results/long/partial/speed.png").is_file());
    let partial = store::read(&long.dir.path("results/long/partial/long.h5")).expect("a result");
    let whole = store::read(&long.dir.path("whole.h5")).expect("a result");
    let Values::Integer(outcomes) = &partial.variables["outcome"].values else { panic!("codes") };
    assert_eq!(partial.variables["outcome"].flags[0], (-1, "missing".to_owned()));
    let missing = outcomes.iter().filter(|&&code| code == -1).count();
    assert_eq!(missing, 6144);
    let speed = |dataset: &store::Dataset| dataset.variables["progression_speed"].values.to_real();
    for ((now, whole), code) in speed(&partial).iter().zip(&speed(&whole)).zip(outcomes) {
        let expected = if *code == -1 { f64::NAN } else { *whole };
        assert_eq!(now.to_bits(), expected.to_bits());
    }
    // The look has not touched the blocks.
    long.dir.put("long.toml", LONG_STUDY);
    long.sweep(&[]).done();
    fs::remove_dir_all(long.dir.path("results/long/partial")).expect("the look");
    long.assert_undisturbed();
}

#[test]
fn a_file_is_verified_bit_for_bit() {
    let long = LongRun::new();
    let verify = |file: &str, more: &[&str]| long.run(&[&["verify", file], more].concat());
    let ran = verify("whole.h5", &["--cases", "300", "--seed", "3", "--instructions", "scalar"]);
    assert!(ran.done().out.contains("300 cases drawn with --seed 3 came out the same in all "));
    let all = verify("whole.h5", &["--cases", "1000000"]).done();
    assert!(all.out.contains("12 288 cases"), "{}", all.out);
    let mut dataset = store::read(&long.dir.path("whole.h5")).expect("a result");
    let speed = dataset.variables.get_mut("progression_speed").expect("a speed");
    let Values::Real(speeds) = &mut speed.values else { panic!("reals") };
    let changed = f64::from_bits(speeds[[17, 5]].to_bits() ^ 1);
    speeds[[17, 5]] = changed;
    store::write(&dataset, &long.dir.path("changed.h5")).expect("it is written");
    let ran = verify("changed.h5", &["--cases", "1000000"]);
    assert_eq!(ran.code, 3, "{}", ran.err);
    let case = format!("case {}: progression_speed is {changed:e}", 17 * 128 + 5);
    assert!(ran.err.contains("1 number of 12 288 cases") && ran.err.contains(&case), "{}", ran.err);
    dataset.attributes.insert("commit".to_owned(), "0123456789ab".to_owned());
    store::write(&dataset, &long.dir.path("other.h5")).expect("it is written");
    let ran = verify("other.h5", &["--cases", "10"]);
    assert!(ran.err.contains("was made by capsulemap"), "{}", ran.err);
}

#[test]
fn a_dry_run_estimates_and_leaves_nothing() {
    let long = LongRun::new();
    let before = long.dir.files();
    let ran = long.sweep(&["--dry-run", "--threads", "2"]).done().out;
    for part in ["12 288 in 24 blocks", "with 2 threads", "room "] {
        assert!(ran.contains(part), "{part}: {ran}");
    }
    assert_eq!(long.dir.files(), before);
    // Blocks that are done are told, and are no part of what follows.
    long.sweep(&["--task", "1/2"]).done();
    let half = long.sweep(&["--dry-run"]).done().out;
    assert!(half.contains("12 blocks with 6 144 cases; what follows is of the rest"), "{half}");
    let room = |text: &str| -> f64 {
        let rest = text.split_once("room   ").expect("a size").1;
        rest.split_whitespace().next().and_then(|it| it.parse().ok()).expect("a number")
    };
    let share = room(&half) / room(&ran);
    assert!((0.4..0.6).contains(&share), "{share}: {ran} {half}");
}

#[test]
fn a_clock_that_was_set_back_confuses_nobody() {
    let long = LongRun::new();
    long.sweep(&["--task", "1/2"]).done();
    let tomorrow = std::time::SystemTime::now() + Duration::from_secs(86_400);
    for block in long.blocks().iter().take(3) {
        let file = fs::File::options().append(true).open(block).expect("a block");
        file.set_modified(tomorrow).expect("a time");
    }
    let status = long.run(&["status", "long.toml"]).done().out;
    assert!(status.contains("12 of 24 blocks"), "{status}");
    long.sweep(&[]).done();
    long.assert_undisturbed();
}
