//! Studies with random changes, and random parameters at the ends of what is allowed: an answer or a refusal.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::time::Instant;

use capsulemap::capsule::{
    CapsuleParameters as _, Case, Output, Parameter, Parameters, Resistance, State, Switching,
    settle_case,
};
use capsulemap::figure::{Place, draw};
use capsulemap::orbit::{Outcome, Proof, Protocol};
use capsulemap::run::{self, Machine};
use capsulemap::store;
use capsulemap::study::Study;
use proptest::prelude::*;

use super::damage::fuzz;
use super::draws::Random;

/// The studies of the project, and one with all that they do not use.
const STUDIES: [&str; 6] = [
    include_str!("../../studies/overview.toml"),
    include_str!("../../studies/hysteresis.toml"),
    include_str!("../../studies/cascade.toml"),
    include_str!("../../studies/regions.toml"),
    include_str!("../../studies/fig6.toml"),
    r#"
[parameters]
k2 = "18.96 kN/m"
resistance = "medium"
friction_switching = "filippov"
delta = "1.5 mm"
p_d = "4 N"
c1 = "0.1 N s/m"
[draws]
kind = "uniform"
count = 9
seed = 4
[[axes]]
name = "start_y1"
from = "-1 m/s"
to = "1 m/s"
[[axes]]
name = "omega"
from = "20 rad/s"
to = "60 rad/s"
spacing = "logarithmic"
[protocol]
tolerance = 1e-10
[history]
from = "start"
[[figures]]
name = "a"
kind = "trade-off"
at = { omega = "30 rad/s" }
"#,
];

/// What a word of a study may become.
const WORDS: [&str; 44] = [
    "0",
    "-1",
    "1e308",
    "-1e308",
    "5e-324",
    "nan",
    "inf",
    "-inf",
    "1e-300",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "true",
    "\"\"",
    "\"\\u0000\"",
    "\"0 N\"",
    "\"1e308 N\"",
    "\"-1e308 rad/s\"",
    "\"5e-324 m\"",
    "\"nan mm\"",
    "\"1 furlong\"",
    "[]",
    "[1]",
    "[[]]",
    "{}",
    "{ omega = 1 }",
    "=",
    ".",
    "[",
    "]",
    "\n",
    "\"",
    "'''",
    "#",
    "omega",
    "p_d",
    "start_r",
    "\"omega\"",
    "\"upward\"",
    "\"map\"",
    "\"trade-off\"",
    "\"phase\"",
    "1",
    "2",
];

/// A change of a text: at which of its words, what is done, and with which word.
type Edit = (f64, u8, usize);

fn edits() -> impl Strategy<Value = (usize, Vec<Edit>)> {
    let edit = (0.0..1.0, 0..5_u8, 0..WORDS.len());
    (0..STUDIES.len(), proptest::collection::vec(edit, 1..6))
}

/// A study with changes.
fn mutant((study, edits): &(usize, Vec<Edit>)) -> String {
    let mut words: Vec<String> = Vec::new();
    for line in STUDIES[*study].lines() {
        words.extend(line.split_inclusive(' ').map(str::to_owned));
        words.push("\n".to_owned());
    }
    for (share, what, word) in edits {
        let at = ((share * words.len() as f64) as usize).min(words.len() - 1);
        let other = WORDS[*word].to_owned() + " ";
        match what {
            0 => words[at] = other,
            1 => words.insert(at, other),
            2 => drop(words.remove(at)),
            3 => words.insert(at, words[at].clone()),
            _ => {
                let next = (at + 7) % words.len();
                words.swap(at, next);
            }
        }
    }
    words.concat()
}

#[test]
fn any_text_is_a_study_or_has_faults() {
    let tried = fuzz(&edits(), |edits| {
        let text = mutant(&edits);
        match Study::parse("s", &text) {
            Ok(study) => {
                let again = Study::parse("s", &study.to_toml());
                prop_assert!(again.is_ok(), "{}\n{}", text, again.expect_err("faults"));
            }
            Err(faults) => prop_assert!(!faults.faults.is_empty(), "{}", text),
        }
        Ok(())
    });
    println!("{tried} texts");
}

/// Computes and draws the first cases of a study, on a small budget.
fn try_out(mut study: Study) {
    study.case_set.truncate(3);
    let protocol = &mut study.protocol;
    protocol.max_cycles = protocol.max_cycles.min(20);
    protocol.max_steps = protocol.max_steps.min(20_000);
    protocol.measured_cycles = protocol.measured_cycles.min(4);
    protocol.exponent_cycles = protocol.exponent_cycles.min(16);
    protocol.points = protocol.points.min(4);
    protocol.impact_points = protocol.impact_points.min(4);
    protocol.max_period = protocol.max_period.min(8);
    if let Some(span) = &mut protocol.history {
        (span.cycles, span.per_cycle) = (span.cycles.min(2), span.per_cycle.min(9));
    }
    if study.cases() > 500 {
        return;
    }
    let records = Mutex::new(Vec::new());
    let keep = |record| records.lock().expect("no panic").push(record);
    run::run(&study, Machine { threads: Some(1), instructions: None }, keep).expect("it runs");
    let mut records = records.into_inner().expect("no panic");
    records.sort_by_key(|record| record.index);
    let dataset = store::dataset(&study, &records);
    let folder = std::env::temp_dir();
    let place = Place { folder: &folder, formats: &[], overwrite: false };
    for drawing in &study.drawings {
        // A figure that does not fit the results is refused.
        let _ = draw(&dataset, drawing, &place);
    }
}

/// In the long form `MUTANTS=3000`, all of which are computed and drawn where they are studies.
#[test]
fn what_is_a_study_runs_and_is_drawn() {
    let wanted = std::env::var("MUTANTS").ok().and_then(|text| text.parse().ok()).unwrap_or(60);
    let mut random = Random::new(77);
    let mut valid = 0;
    for number in 0..wanted {
        let count = 1 + random.uniform(0.0, 3.0) as usize;
        let mut share = |most: f64| random.uniform(0.0, most);
        let study = share(STUDIES.len() as f64) as usize;
        let edits = (0..count).map(|_| (share(1.0), share(5.0) as u8, share(44.0) as usize));
        let text = mutant(&(study, edits.collect()));
        let Ok(parsed) = Study::parse("s", &text) else { continue };
        valid += 1;
        let ran = catch_unwind(AssertUnwindSafe(|| try_out(parsed)));
        assert!(ran.is_ok(), "mutant {number} panics:\n{text}");
    }
    println!("{wanted} mutants, {valid} of them studies");
    assert!(valid > wanted / 20);
}

/// A number of any size that a parameter may have.
fn extreme(random: &mut Random, parameter: Parameter) -> f64 {
    let usual = Parameters::default()[parameter].max(1e-3);
    let decades = [0.3, 3.0, 8.0, 30.0, 200.0][random.uniform(0.0, 5.0) as usize];
    let value = usual * libm::exp10(random.uniform(-decades, decades));
    let value = if random.uniform(0.0, 12.0) < 1.0 { 0.0 } else { value };
    if parameter.allowed().admits(value) { value } else { usual }
}

/// In the long form `EXTREMES=3000`.
#[test]
fn extreme_parameters_have_an_outcome_in_time() {
    let wanted = std::env::var("EXTREMES").ok().and_then(|text| text.parse().ok()).unwrap_or(40);
    let protocol = Protocol { max_steps: 1_000_000, ..Protocol::default() };
    let mut random = Random::new(78);
    let (mut counts, mut longest) = ([0; 5], 0.0_f64);
    for number in 0..wanted {
        let mut parameters = Parameters::default();
        for &parameter in Parameter::ALL {
            if random.uniform(0.0, 2.0) < 1.0 {
                parameters[parameter] = extreme(&mut random, parameter);
            }
        }
        let law = random.uniform(0.0, 3.0) as usize;
        parameters.resist_by(Resistance::NAMES[law].1);
        parameters.switch_by(Switching::NAMES[random.uniform(0.0, 1.1) as usize].1);
        if !parameters.faults().is_empty() {
            continue;
        }
        let mut start = || random.uniform(-1.0, 1.0) * libm::exp10(random.uniform(-9.0, 9.0));
        let start = State::of([start(), start(), start(), start()]);
        let case = Case { parameters, start: start.into(), start_phase: 0.0, section_phase: 0.0 };
        let begun = Instant::now();
        let ran = catch_unwind(AssertUnwindSafe(|| settle_case(&case, &protocol)));
        let Ok(orbit) = ran else { panic!("case {number} panics: {case:?}") };
        let took = begun.elapsed().as_secs_f64();
        longest = longest.max(took);
        assert!(took < 120.0, "case {number} takes {took} s: {case:?}");
        counts[orbit.outcome as usize] += 1;
        assert_eq!(orbit.outcome == Outcome::Failed, orbit.failure.is_some(), "case {number}");
        if orbit.outcome == Outcome::Periodic && orbit.certificate.proof != Proof::None {
            let about = || format!("case {number}: {case:?}: {:?}", orbit.outputs);
            let residual = orbit.outputs[Output::MomentumResidual].abs();
            // Without a drive a medium leaves no force to compare with.
            let is_free = case.parameters[Parameter::Pd] == 0.0 && residual.is_infinite();
            assert!(residual <= 1e-5 || is_free, "{}", about());
            assert!(orbit.outputs[Output::ProgressionSpeed].is_finite(), "{}", about());
        }
    }
    println!("{wanted} sets: outcomes {counts:?}, the longest took {longest:.1} s");
}
