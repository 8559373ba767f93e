//! What a long run must survive: kills, signals, damaged blocks, a changed study, two runs at once; and parts that are computed apart and joined.

mod night;

use std::fs;
use std::path::PathBuf;
use std::process::Child;
use std::thread::sleep;
use std::time::{Duration, Instant};

use capsulemap::store::{self, Values};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use super::program::{Desk, Ran};
pub use night::{LINES, NIGHT};
use night::{Night, drawn, said};

/// How often runs were killed while cases were computed, and while blocks were joined.
type Kills = [u32; 2];

/// Starts a run again and again, each killed at a random moment, until it ends or has been killed thrice and
/// may end.
fn kill_and_resume(night: &Night, whole: Duration, random: &mut ChaCha8Rng) -> Kills {
    let mut kills = [0, 0];
    for times in 1..=3 {
        let mut child = night.start(&[]);
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
        kills[usize::from(night.is_being_joined())] += 1;
    }
    night.sweep(&[]).done();
    kills
}

/// In the long form `KILLS=100`; a run that ends before it is killed does not count.
#[test]
fn runs_that_are_killed_at_random_and_resumed_end_in_the_same_bytes() {
    let long = std::env::var("KILLS").ok().and_then(|text| text.parse().ok());
    let wanted = long.unwrap_or(4);
    let draws = drawn(if long.is_some() { 10_000 } else { 1_500 });
    let nights = [NIGHT, LINES, &draws].map(|study| {
        let night = Night::of(study);
        let begun = Instant::now();
        night.sweep(&[]).done();
        night.assert_undisturbed();
        night.forget();
        (night, begun.elapsed())
    });
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let (mut runs, mut kills) = (0, [0, 0]);
    for attempt in 0..10 * wanted {
        let (night, whole) = &nights[attempt % nights.len()];
        let more = kill_and_resume(night, *whole, &mut random);
        night.assert_undisturbed();
        night.forget();
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
    let night = Night::new();
    let mut attempts_left = 10;
    let mut signals = vec!["INT", "TERM"];
    while let Some(signal) = signals.pop() {
        let mut child = night.start(&[]);
        night.wait_for(3);
        let told = night.desk.shell(&format!("kill -{signal} {}", child.id()));
        assert_eq!(told.code, 0, "{}", told.err);
        let asked = Instant::now();
        let status = child.wait().expect("a process");
        assert!(asked.elapsed() < Duration::from_secs(10));
        if status.success() && attempts_left > 0 {
            // On a busy machine the run may be done before it is told to stop.
            attempts_left -= 1;
            night.forget();
            signals.push(signal);
            continue;
        }
        assert_eq!(status.signal(), Some(if signal == "INT" { 2 } else { 15 }));
        let text = said(&mut child);
        let last = text.lines().last().expect("a last line");
        assert!(last.contains(" blocks are done and kept in results/night/night.blocks"), "{text}");
        assert!(last.ends_with("the same command goes on from there"), "{text}");
        let there = night.blocks().len();
        let resumed = night.sweep(&[]).done();
        let kept = format!("{there} of 24 blocks are done and kept");
        assert!(resumed.err.contains(&kept), "{kept}: {}", resumed.err);
        night.assert_undisturbed();
        night.forget();
    }
}

#[test]
fn damaged_and_foreign_blocks_are_named_and_computed_again() {
    let night = Night::new();
    for part in ["1/3", "2/3", "3/3"] {
        night.sweep(&["--task", part]).done();
    }
    let bytes = |number| fs::read(night.block(number)).expect("a block");
    let mut flipped = bytes(3);
    let middle = flipped.len() / 2;
    flipped[middle] ^= 4;
    let cut = &bytes(5)[..700];
    // The same grid with another tolerance is another study; a build of another commit another version.
    let other = Desk::new();
    other.put("night.toml", NIGHT.replace("max_cycles = 300", "max_cycles = 301"));
    other.run(&["sweep", "night.toml", "--task", "1/2"]).done();
    let foreign: Vec<PathBuf> = fs::read_dir(other.path("results/night/night.blocks"))
        .expect("blocks")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    let foreign = foreign.iter().find(|path| path.to_string_lossy().contains("block-"));
    let foreign = foreign.expect("a block").clone();
    let number = foreign.file_name().expect("a name").to_string_lossy()[6..].parse::<usize>();
    let number = number.expect("a number");
    let spare = (7..24).find(|it| ![number, 3, 5].contains(it)).expect("another block");
    fs::write(night.block(3), flipped).expect("it is flipped");
    fs::write(night.block(5), cut).expect("it is cut");
    fs::copy(foreign, night.block(number)).expect("it is foreign");
    fs::write(night.block(spare), sealed_by_another_version(&bytes(spare))).expect("it is old");
    let refused = night.run(&["join", "night.toml"]);
    refused.refused(&["4 blocks missing: ", "block-0000003: it is torn", "--partial"]);
    let told = night.sweep(&[]).done();
    let line = |number: usize| {
        let name = format!("block-{number:07}: it is ");
        let line = told.err.lines().find(|line| line.contains(&name));
        line.unwrap_or_else(|| panic!("{name} is missing from:\n{}", told.err)).to_owned()
    };
    assert!(line(3).contains("torn") && line(5).contains("torn"));
    assert!(line(number).contains("foreign: made for another study; it is computed again"));
    let old = line(spare);
    assert!(old.contains("foreign: made by another version, capsulemap 0.0.9"), "{old}");
    assert!(told.err.contains("20 of 24 blocks are done and kept"), "{}", told.err);
    night.assert_undisturbed();
}

/// A block as an older program would have written it, with a seal that fits.
fn sealed_by_another_version(bytes: &[u8]) -> Vec<u8> {
    let body = &bytes[..bytes.len() - 14];
    let own = format!("capsulemap {}", env!("CARGO_PKG_VERSION")).into_bytes();
    let at = body.windows(own.len()).position(|part| part == own).expect("the program's name");
    let old = [&body[..at], b"capsulemap 0.0.9", &body[at + own.len()..]].concat();
    let sum = crc32fast::hash(&old);
    [&old[..], b"capsulemap", &sum.to_le_bytes()].concat()
}

#[test]
fn a_changed_study_does_not_mix_with_older_blocks() {
    let night = Night::new();
    night.sweep(&["--task", "1/4"]).done();
    let there = night.blocks().len();
    night.desk.put("night.toml", NIGHT.replace("to = \"8 N\"", "to = \"7 N\""));
    night.sweep(&[]).refused(&[
        "night.blocks: holds blocks of another run",
        "- to = \"8 N\"",
        "+ to = \"7 N\"",
        "begun.toml",
        "--overwrite",
    ]);
    night.run(&["join", "night.toml"]).refused(&["- to = \"8 N\""]);
    assert_eq!(night.blocks().len(), there, "nothing is lost by a refusal");
    // What does not change a case does not matter.
    let words = NIGHT.replace("A night", "Another title") + "# a remark\n";
    night.desk.put("night.toml", words);
    let told = night.sweep(&["--task", "2/4"]).done();
    assert!(!told.err.contains("computed again") && night.blocks().len() > there);
    // Blocks of another build are not mixed either.
    night.desk.put("night.toml", NIGHT);
    let begun = night.desk.path("results/night/night.blocks/begun.json");
    let text = fs::read_to_string(&begun).expect("what it was begun with");
    let commit = text.split("\"commit\": \"").nth(1).and_then(|rest| rest.split('"').next());
    fs::write(&begun, text.replace(commit.expect("a commit"), "0123456789ab")).expect("it is old");
    night.sweep(&[]).refused(&["the blocks were made by capsulemap", "(commit 0123456789ab)"]);
    night.sweep(&["--overwrite"]).done();
    night.assert_undisturbed();
}

#[test]
fn a_second_run_on_the_same_study_stops_at_once() {
    let night = Night::of(&NIGHT.replace("points = 128", "points = 640"));
    let mut first = night.start(&[]);
    night.wait_for(1);
    let begun = Instant::now();
    night.sweep(&[]).refused(&["another run is at work on this study"]);
    night.sweep(&["--task", "1/2"]).refused(&["another run is at work on this study"]);
    night.run(&["join", "night.toml"]).refused(&["another run is at work on this study"]);
    assert!(begun.elapsed() < Duration::from_secs(10));
    let status = night.run(&["status", "night.toml"]).done();
    assert!(status.out.contains("at work now") || night.file().exists(), "{}", status.out);
    assert!(first.wait().expect("a process").success(), "{}", said(&mut first));
    night.assert_undisturbed();
}

#[test]
fn tasks_that_share_a_study_are_joined_to_the_file_of_one_run() {
    let night = Night::new();
    let mut twins: Vec<Child> =
        ["1/3", "2/3", "2/3"].iter().map(|part| night.start(&["--task", part])).collect();
    for twin in &mut twins {
        assert!(twin.wait().expect("a process").success(), "{}", said(twin));
    }
    let refused = night.run(&["join", "night.toml"]);
    refused.refused(&["8 blocks missing: ", "--partial"]);
    let status = night.run(&["status", "night.toml"]).done().out;
    for part in ["16 of 24 blocks", "8 192 of 12 288 cases", "nobody is at work", "16 blocks by"] {
        assert!(status.contains(part), "{part}: {status}");
    }
    // Slurm says which task it is where the command does not.
    let mut third = night.command(&["sweep", "night.toml"]);
    for (name, value) in [("ID", "30"), ("MIN", "10"), ("STEP", "10"), ("COUNT", "3")] {
        third.env(format!("SLURM_ARRAY_TASK_{name}"), value);
    }
    let third = Ran::from(third.env("SLURM_CPUS_PER_TASK", "1").output().expect("it starts"));
    assert!(third.done().err.contains("task 3 of 3"));
    night.run(&["join", "night.toml", "--no-figures"]).done();
    night.assert_undisturbed();
    let again = night.run(&["join", "night.toml", "--no-figures"]).done();
    assert!(again.err.contains("is there, whole"), "{}", again.err);
    for wrong in ["0/3", "4/3", "x", "3"] {
        night.sweep(&["--task", wrong]).refused(&["--task", "expected I/N"]);
    }
}

#[test]
fn stripes_and_attractors_are_joined_from_tasks_as_well() {
    let night = Night::of(LINES);
    for part in ["3/3", "1/3", "2/3"] {
        night.sweep(&["--task", part]).done();
    }
    night.run(&["join", "night.toml", "--no-figures", "--threads", "1"]).done();
    night.assert_undisturbed();
    let dataset = store::read(&night.file()).expect("a result");
    assert!(dataset.variable("attractor").is_some() && dataset.variable("event_kind").is_some());
    let told = night.run(&["verify", "results/night/night.h5", "--cases", "50"]).done();
    assert!(told.out.contains("80 cases drawn"), "whole lines are computed: {}", told.out);
}

#[test]
fn blocks_that_a_kill_has_left_beside_the_joined_file_are_cleared_away() {
    let night = Night::new();
    night.sweep(&["--task", "1/2"]).done();
    fs::copy(night.desk.path("whole.h5"), night.file()).expect("the joined file");
    assert!(night.sweep(&[]).done().err.contains("already computed"));
    night.assert_undisturbed();
}

#[test]
fn a_look_before_the_end_shows_what_is_there() {
    let night = Night::new();
    let figure = "[[figures]]\nname = \"speed\"\nkind = \"map\"\n";
    night.desk.put("night.toml", NIGHT.to_owned() + figure);
    night.sweep(&["--task", "1/2"]).done();
    night.run(&["join", "night.toml", "--partial", "--formats", "png"]).done();
    assert!(night.desk.path("results/night/partial/speed.png").is_file());
    let partial =
        store::read(&night.desk.path("results/night/partial/night.h5")).expect("a result");
    let whole = store::read(&night.desk.path("whole.h5")).expect("a result");
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
    night.desk.put("night.toml", NIGHT);
    night.sweep(&[]).done();
    fs::remove_dir_all(night.desk.path("results/night/partial")).expect("the look");
    night.assert_undisturbed();
}

#[test]
fn a_file_is_verified_bit_for_bit() {
    let night = Night::new();
    let verify = |file: &str, more: &[&str]| night.run(&[&["verify", file], more].concat());
    let told = verify("whole.h5", &["--cases", "300", "--seed", "3", "--instructions", "scalar"]);
    assert!(told.done().out.contains("300 cases drawn with --seed 3 came out the same in all "));
    let all = verify("whole.h5", &["--cases", "1000000"]).done();
    assert!(all.out.contains("12 288 cases"), "{}", all.out);
    let mut dataset = store::read(&night.desk.path("whole.h5")).expect("a result");
    let speed = dataset.variables.get_mut("progression_speed").expect("a speed");
    let Values::Real(speeds) = &mut speed.values else { panic!("reals") };
    let changed = f64::from_bits(speeds[[17, 5]].to_bits() ^ 1);
    speeds[[17, 5]] = changed;
    store::write(&dataset, &night.desk.path("changed.h5")).expect("it is written");
    let told = verify("changed.h5", &["--cases", "1000000"]);
    assert_eq!(told.code, 3, "{}", told.err);
    let case = format!("case {}: progression_speed is {changed:e}", 17 * 128 + 5);
    assert!(
        told.err.contains("1 number of 12 288 cases") && told.err.contains(&case),
        "{}",
        told.err
    );
    dataset.attributes.insert("commit".to_owned(), "0123456789ab".to_owned());
    store::write(&dataset, &night.desk.path("other.h5")).expect("it is written");
    let told = verify("other.h5", &["--cases", "10"]);
    assert!(told.err.contains("was made by capsulemap"), "{}", told.err);
}

#[test]
fn a_dry_run_foretells_and_leaves_nothing() {
    let night = Night::new();
    let before = night.desk.files();
    let told = night.sweep(&["--dry-run", "--threads", "2"]).done().out;
    for part in ["12 288 in 24 blocks", "with 2 threads", "room "] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert_eq!(night.desk.files(), before);
}

#[test]
fn a_clock_that_was_set_back_confuses_nobody() {
    let night = Night::new();
    night.sweep(&["--task", "1/2"]).done();
    let tomorrow = std::time::SystemTime::now() + Duration::from_secs(86_400);
    for block in night.blocks().iter().take(3) {
        let file = fs::File::options().append(true).open(block).expect("a block");
        file.set_modified(tomorrow).expect("a time");
    }
    let status = night.run(&["status", "night.toml"]).done().out;
    assert!(status.contains("12 of 24 blocks"), "{status}");
    night.sweep(&[]).done();
    night.assert_undisturbed();
}
