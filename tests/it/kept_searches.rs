//! The searches of a refinement are kept as they are done: killed and resumed it ends in the same bytes, and repeats nothing.

use std::cell::Cell;
use std::collections::BTreeSet;
use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use capsulemap::campaign::{Between, KeptSearches, TradeOff, silent, study_of};
use capsulemap::capsule::Output;
use capsulemap::store::{self, Archive};
use capsulemap::study::Study;
use capsulemap::tradeoff::{Direction, GainAndCost};
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use super::damage::{Damage, fuzz};
use super::program::WorkDir;

/// The paper's capsule on a coarse grid over two parameters.
pub const STUDY: &str = "[parameters]\nk2 = \"20 kN/m\"\ndelta = \"3 mm\"\n\
     [[axes]]\nname = \"p_d\"\nfrom = \"7 N\"\nto = \"8 N\"\npoints = 6\n\
     [[axes]]\nname = \"omega\"\nfrom = \"50 rad/s\"\nto = \"65 rad/s\"\npoints = 16\n";
/// Few points are drawn, so that many refinements take little time.
pub const REFINE: [&str; 6] =
    ["tradeoff", "results/study/study.h5", "--refine", "--starts", "8", "--json"];
pub const SEARCHES: &str = "results/study/study.searches";

/// A folder with the results of a study.
pub fn swept(study: &str) -> WorkDir {
    let folder = WorkDir::new();
    folder.put("study.toml", study);
    folder.run(&["sweep", "study.toml"]).done();
    folder
}

/// The whole lines of the file of searches, which come in any order, each once.
pub fn lines(folder: &WorkDir) -> BTreeSet<String> {
    let text = fs::read_to_string(folder.path(SEARCHES)).unwrap_or_default();
    let whole = text.rfind('\n').map_or("", |last| &text[..last]);
    whole.lines().map(str::to_owned).collect()
}

/// In the long form `KILLS=20`; a refinement that ends before it is killed does not count.
#[test]
fn a_refinement_that_is_killed_at_random_and_resumed_ends_in_the_same_bytes() {
    let wanted = std::env::var("KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(3);
    let folder = swept(STUDY);
    let begun = Instant::now();
    let whole = folder.run(&REFINE).done();
    let took = begun.elapsed();
    let all = lines(&folder);
    let mut random = ChaCha8Rng::seed_from_u64(16);
    let (mut kills, mut resumed) = (0, 0);
    for _ in 0..10 * wanted {
        if kills == wanted {
            break;
        }
        fs::remove_file(folder.path(SEARCHES)).expect("it is there");
        for _ in 0..3 {
            let before = lines(&folder);
            let mut command = folder.command(&REFINE);
            let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
            let mut child = quiet.spawn().expect("it starts");
            sleep(took.mul_f64(f64::from(random.next_u32()) / f64::from(u32::MAX) / 2.0));
            let ended = child.try_wait().expect("a process");
            child.kill().expect("it is killed or has ended");
            child.wait().expect("a process");
            kills += u32::from(ended.is_none());
            assert!(before.is_subset(&lines(&folder)), "a search is lost");
        }
        resumed += lines(&folder).len();
        assert_eq!(folder.run(&REFINE).done().out, whole.out);
        assert!(lines(&folder) == all, "other searches than of a whole refinement");
    }
    println!("{kills} kills; {resumed} lines were there when it was resumed");
    assert!(kills >= wanted && resumed > 0, "{kills} kills, {resumed} lines");
    let kept = fs::read(folder.path(SEARCHES)).expect("searches");
    let again = folder.run(&REFINE).done();
    assert_eq!((again.out, again.err.contains("searches have led to is kept")), (whole.out, true));
    assert!(fs::read(folder.path(SEARCHES)).expect("searches") == kept, "a search is repeated");
}

#[test]
fn searches_of_something_else_are_refused_and_replaced_only_if_asked_for() {
    let folder = swept(STUDY);
    let whole = folder.run(&REFINE).done();
    let text = fs::read_to_string(folder.path(SEARCHES)).expect("searches");
    let torn = &text[..text.len() - 7];
    folder.put(SEARCHES, torn);
    assert_eq!(folder.run(&REFINE).done().out, whole.out);
    for (kept, said) in [
        (
            text.replacen("\"fingerprint\":\"", "\"fingerprint\":\"0", 1),
            "searches of another study",
        ),
        (
            text.replacen("searches_by\":\"", "searches_by\":\"older ", 1),
            "searches by another program",
        ),
        (text.replacen("\"format\":\"", "\"format\":\"x", 1), "a first line that is damaged"),
        ("{\"format\":\"capsulemap searches 2\"}\n".to_owned(), "by another scheme"),
    ] {
        folder.put(SEARCHES, &kept);
        folder.run(&REFINE).refused(&[SEARCHES, said, "--overwrite"]);
        assert_eq!(fs::read_to_string(folder.path(SEARCHES)).expect("it stays"), kept);
    }
    let anew = folder.run(&[&REFINE[..], &["--overwrite"]].concat()).done();
    assert_eq!(anew.out, whole.out);
}

#[test]
fn what_is_no_file_of_searches_stays_whatever_is_asked_for() {
    let folder = swept(STUDY);
    let anew = [&REFINE[..], &["--overwrite"]].concat();
    for kept in ["mine\n", "mine, without a line end", "{\"mine\": 1}\r\n{\"two\": 2}\r\n", "\n"] {
        folder.put(SEARCHES, kept);
        for command in [&REFINE[..], &anew] {
            folder.run(command).refused(&[
                SEARCHES,
                "something else than searches",
                "move it away",
            ]);
            assert_eq!(fs::read_to_string(folder.path(SEARCHES)).expect("it stays"), kept);
        }
    }
    // What a kill leaves of the first line of its own is no text of others.
    folder.put(SEARCHES, "{\"fingerprint\":\"");
    folder.run(&REFINE).done();
    fs::remove_file(folder.path(SEARCHES)).expect("it is removed");
    folder.put("mine", "years of work");
    std::os::unix::fs::symlink(folder.path("mine"), folder.path(SEARCHES)).expect("a link");
    for command in [&REFINE[..], &anew] {
        let ran = folder.run(command).done();
        assert!(ran.err.contains("it is a link, which is not followed here"), "{}", ran.err);
        assert_eq!(fs::read_to_string(folder.path("mine")).expect("it stays"), "years of work");
    }
    fs::remove_file(folder.path(SEARCHES)).expect("it is removed");
    folder.shell(&format!("mkfifo {SEARCHES}")).done();
    let figure = ["figure", "results/study/study.h5", "--kind", "trade-off", "--formats", "svg"];
    for command in [&REFINE[..], &anew, &figure] {
        let ran = folder.run(command).done();
        assert!(ran.err.contains("it is not a plain file"), "{command:?}: {}", ran.err);
    }
    let page = folder.run(&["report", "results/study/study.h5", "--output", "-"]).done().out;
    assert!(page.contains("it is not a plain file"), "{page}");
}

#[test]
fn a_changed_digit_is_searched_again_and_said() {
    let folder = swept(STUDY);
    let whole = folder.run(&REFINE).done();
    let text = fs::read_to_string(folder.path(SEARCHES)).expect("searches");
    let begin = text.find('\n').expect("a first line");
    let digits: Vec<usize> = text
        .char_indices()
        .filter(|(at, it)| *at > begin && it.is_ascii_digit())
        .map(|it| it.0)
        .collect();
    for place in digits.iter().step_by(digits.len() / 5) {
        let mut changed = text.clone().into_bytes();
        changed[*place] = if changed[*place] == b'9' { b'1' } else { b'9' };
        folder.put(SEARCHES, changed);
        let ran = folder.run(&REFINE).done();
        assert_eq!(ran.out, whole.out);
        assert!(
            ran.err.contains("do not fit their checksums, cut short or changed: 1;"),
            "{}",
            ran.err
        );
    }
}

/// Searches by the library, which here reads them, too: it knows no commit, and the program's would be those of another.
fn refined(archive: &Archive, study: &Study) {
    let kept = KeptSearches::open(archive, study, false).expect("a new file");
    let trade_off = TradeOff {
        archive,
        file: archive.path(),
        of: GainAndCost::of_cost(Output::WorkPositive.into()).expect("the capsule has a speed"),
        direction: Direction::Either,
        conditions: None,
        at_rest: None,
        budget: None,
        least_gain: None,
        top: 1,
        slopes: false,
        between: Between::Sought { kept: &kept, seed: 1, points: 8 },
        under: None,
        margins: false,
        threads: None,
    };
    trade_off.answer(&silent).expect("motions between the cases");
}

#[test]
fn of_a_file_of_searches_with_damage_no_other_number_is_taken() {
    let folder = swept(STUDY);
    let path = folder.path(SEARCHES);
    let archive = store::open(&folder.path("results/study/study.h5")).expect("results");
    let study = study_of(&archive, archive.path()).expect("a study");
    refined(&archive, &study);
    let text = fs::read(&path).expect("searches");
    let taken = || -> BTreeSet<String> {
        let lines = store::read_lines(&path).expect("lines").whole;
        lines.iter().filter_map(|line| store::unsealed(line)).collect()
    };
    let (all, searches) = (taken(), KeptSearches::read(&archive, &study).expect("searches").len());
    assert_eq!(all.len(), searches + 1);
    let refused = Cell::new(0);
    let tried = fuzz(&Damage::any(), |damages| {
        let mut bytes = text.clone();
        damages.iter().for_each(|damage| damage.apply(&mut bytes));
        fs::write(&path, &bytes).expect("it is written");
        match KeptSearches::read(&archive, &study) {
            Ok(kept) => {
                let taken = taken();
                prop_assert!(taken.is_subset(&all) && kept.len() <= taken.len());
                let is_cut = text.starts_with(&bytes);
                prop_assert!(kept.len() == searches || is_cut || kept.damage(&archive).is_some());
            }
            Err(_) => refused.set(refused.get() + 1),
        }
        prop_assert_eq!(fs::read(&path).expect("searches"), bytes);
        Ok(())
    });
    println!("{tried} files of searches, {} refused whole", refused.get());
    assert!(2 * refused.get() < tried);
}

#[test]
fn two_refinements_of_one_file_are_not_mixed() {
    let folder = swept(STUDY);
    let mut command = folder.command(&REFINE);
    let mut first = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let begun = Instant::now();
    while lines(&folder).is_empty() && begun.elapsed() < Duration::from_secs(60) {
        sleep(Duration::from_millis(5));
    }
    let second = folder.run(&REFINE);
    assert!(first.wait().expect("a process").success());
    second.refused(&[SEARCHES, "another process adds to it now"]);
}
