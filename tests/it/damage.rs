//! Files of results and blocks with random damage: refused, or read to the same numbers; never a crash.

use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use capsulemap::store::block_file::{self, Column, Numbers};
use capsulemap::store::{self, Summary};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::program::{Ran, WorkDir};
use super::store::rich;

/// A change of the bytes of a file, with places as shares of it.
#[derive(Debug, Clone)]
pub enum Damage {
    /// A bit is flipped.
    Flip(f64, u8),
    /// Bytes are zero.
    Zeros(f64, usize),
    /// The file ends there.
    Cut(f64),
    /// The last bytes are zero.
    ZeroTail(usize),
    /// Bytes stand where others stood.
    Copy(f64, f64, usize),
    /// Bytes follow.
    Append(Vec<u8>),
}

impl Damage {
    /// Every kind, anywhere.
    pub fn any() -> impl Strategy<Value = Vec<Damage>> {
        let place = 0.0..1.0;
        let one = prop_oneof![
            4 => (place.clone(), 0..8_u8).prop_map(|(at, bit)| Damage::Flip(at, bit)),
            2 => (place.clone(), 1..600_usize).prop_map(|(at, count)| Damage::Zeros(at, count)),
            1 => place.clone().prop_map(Damage::Cut),
            2 => (1..5000_usize).prop_map(Damage::ZeroTail),
            1 => (place.clone(), place, 1..600_usize).prop_map(|(a, b, n)| Damage::Copy(a, b, n)),
            1 => proptest::collection::vec(any::<u8>(), 1..40).prop_map(Damage::Append),
        ];
        proptest::collection::vec(one, 1..4)
    }

    /// Does it to a file.
    pub fn apply(&self, bytes: &mut Vec<u8>) {
        let length = bytes.len();
        let place = |share: f64| (share * length as f64) as usize;
        match self {
            Damage::Flip(at, bit) => {
                bytes.iter_mut().skip(place(*at)).take(1).for_each(|byte| *byte ^= 1 << bit);
            }
            Damage::Zeros(at, count) => {
                bytes.iter_mut().skip(place(*at)).take(*count).for_each(|byte| *byte = 0);
            }
            Damage::Cut(at) => bytes.truncate(place(*at)),
            Damage::ZeroTail(count) => {
                bytes.iter_mut().rev().take(*count).for_each(|byte| *byte = 0);
            }
            Damage::Copy(from, to, count) => {
                let part: Vec<u8> = bytes.iter().skip(place(*from)).take(*count).copied().collect();
                let places = bytes.iter_mut().skip(place(*to));
                places.zip(part).for_each(|(byte, other)| *byte = other);
            }
            Damage::Append(more) => bytes.extend(more),
        }
    }
}

/// Runs a property again and again with other random numbers, for FUZZ_SECONDS or for a moment; returns how often.
pub fn fuzz<S: Strategy>(
    strategy: &S,
    property: impl Fn(S::Value) -> Result<(), TestCaseError>,
) -> u32 {
    const ROUND: u32 = 64;
    let seconds = std::env::var("FUZZ_SECONDS").ok().and_then(|text| text.parse().ok());
    let span = Duration::from_secs(seconds.unwrap_or(2));
    let begun = Instant::now();
    let mut rounds = 0_u32;
    while rounds == 0 || begun.elapsed() < span {
        let seed: Vec<u8> = rounds.to_le_bytes().repeat(8);
        let random = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
        let config = Config { cases: ROUND, failure_persistence: None, ..Config::default() };
        let ran = TestRunner::new_with_rng(config, random).run(strategy, &property);
        ran.unwrap_or_else(|failure| panic!("round {rounds}: {failure}"));
        rounds += 1;
    }
    rounds * ROUND
}

/// Cases that settle quickly, histories, attractors, branches and figures: all that a file may hold.
const STUDY: &str = r#"
outputs = ["progression_speed", "work_positive"]
[parameters]
k2 = "18.96 kN/m"
delta = "1.5 mm"
p_d = "4 N"
[[axes]]
name = "omega"
from = "20 rad/s"
to = "22 rad/s"
points = 40
[protocol]
max_cycles = 200
points = 2
impact_points = 1
[history]
cycles = 1
samples_per_cycle = 64
[[branches]]
name = "b"
along = "omega"
at = { omega = "20.73 rad/s" }
most_points = 4
[[figures]]
name = "speed"
kind = "bifurcation"
"#;

/// In the long form `DAMAGES=1000`.
#[test]
fn no_command_takes_a_damaged_file() {
    let wanted = std::env::var("DAMAGES").ok().and_then(|text| text.parse().ok()).unwrap_or(12);
    let dir = WorkDir::new();
    dir.put("s.toml", STUDY);
    dir.run(&["sweep", "s.toml", "--output", "s.h5", "--no-figures"]).done();
    dir.run(&["continue", "s.toml", "--output", "s.h5", "--no-figures"]).done();
    let whole = fs::read(dir.path("s.h5")).expect("a result");
    let told = dir.run(&["inspect", "s.h5", "--json"]).done().out;
    let commands: [&[&str]; 7] = [
        &["inspect", "s.h5", "--json"],
        &["verify", "s.h5", "--cases", "1"],
        &["figure", "s.h5", "--formats", "svg", "--overwrite"],
        &["status", "s.toml", "--output", "s.h5"],
        &["join", "s.toml", "--output", "s.h5", "--no-figures"],
        &["sweep", "s.toml", "--output", "s.h5", "--no-figures"],
        &["continue", "s.toml", "--output", "s.h5", "--no-figures"],
    ];
    let seed = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), seed);
    let mut unchanged = 0;
    for number in 0..wanted {
        let damages = Damage::any().new_tree(&mut runner).expect("a damage").current();
        let mut bytes = whole.clone();
        damages.iter().for_each(|damage| damage.apply(&mut bytes));
        dir.put("s.h5", &bytes);
        for arguments in commands {
            let about = || format!("{number}: {damages:?}: {arguments:?}");
            // A signal has no exit code, at which this stops.
            let ran: Ran = dir.run(arguments);
            assert!(!ran.err.contains("panicked"), "{}: {}", about(), ran.err);
            let is_whole = bytes == whole;
            assert_eq!(ran.code, if is_whole { 0 } else { 2 }, "{}: {}", about(), ran.err);
            if is_whole && arguments[0] == "inspect" {
                assert_eq!(ran.out, told, "{}", about());
            }
            assert!(fs::read(dir.path("s.h5")).expect("it is there") == bytes, "{}", about());
        }
        unchanged += usize::from(bytes == whole);
    }
    println!("{wanted} damaged files, of which {unchanged} were as before; none else was taken");
    assert!(2 * unchanged < wanted.max(3));
}

#[test]
fn a_joined_file_with_damage_is_refused_or_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("r.h5");
    store::write(&rich(), &path).expect("it is written");
    let whole = fs::read(&path).expect("a file");
    let tried = fuzz(&Damage::any(), |damages| {
        let mut bytes = whole.clone();
        damages.iter().for_each(|damage| damage.apply(&mut bytes));
        fs::write(&path, &bytes).expect("it is written");
        match store::read(&path) {
            Ok(dataset) => {
                prop_assert_eq!(&bytes, &whole);
                prop_assert!(store::difference(&rich(), &dataset).is_none());
            }
            Err(refused) => prop_assert!(!refused.to_string().is_empty()),
        }
        Ok(())
    });
    println!("{tried} joined files");
}

#[test]
fn a_block_with_damage_is_refused_or_has_as_many_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path();
    let numbers = |i: usize| (i as f64).sin();
    let columns = [
        Column { name: "speed".into(), numbers: Numbers::Real((0..300).map(numbers).collect()) },
        Column { name: "period".into(), numbers: Numbers::Integer((0..100).collect()) },
    ];
    let outcomes = BTreeMap::from([("periodic".to_owned(), 100)]);
    let block = Summary { number: 0, cases: 100, computed: 100, outcomes, cycles: 9 };
    block_file::write(place, "a", block, &columns).expect("it is written");
    let path = block_file::path(place, 0);
    let whole = fs::read(&path).expect("a block");
    // With a checksum that fits, the parser is on its own.
    let strategy = (Damage::any(), any::<bool>());
    let tried = fuzz(&strategy, |(damages, forged)| {
        let mut bytes = whole.clone();
        damages.iter().for_each(|damage| damage.apply(&mut bytes));
        if forged {
            let sum = crc32fast::hash(&bytes);
            bytes.extend_from_slice(b"capsulemap");
            bytes.extend_from_slice(&sum.to_le_bytes());
        }
        fs::write(&path, &bytes).expect("it is written");
        let opened = block_file::open(place, "a", 0);
        prop_assert!(forged || opened.is_err() || bytes == whole);
        let Ok(file) = opened else { return Ok(()) };
        let read = catch_unwind(AssertUnwindSafe(|| {
            (file.reals("speed", 3), file.integers("period", 1), file.range("period"))
        }));
        let Ok((reals, integers, _)) = read else { return Err(TestCaseError::fail("a panic")) };
        let cases = file.head.block.computed;
        prop_assert!(reals.is_err() || reals.is_ok_and(|it| it.len() == 3 * cases));
        prop_assert!(integers.is_err() || integers.is_ok_and(|it| it.len() == cases));
        Ok(())
    });
    println!("{tried} blocks");
}
