//! Phases of the drive: the start may be at any, and the section at any other, of the same motion.

use std::f64::consts::{PI, TAU};
use std::sync::Mutex;

use capsulemap::capsule::{
    Capsule, CapsuleParameters as _, CapsuleState as _, Case, Output, Parameter, Parameters,
    Sample, State, settle_case, simulate_case,
};
use capsulemap::flow::{Motion, Step};
use capsulemap::lane::Instructions;
use capsulemap::orbit::{HistorySpan, Outcome, Protocol};
use capsulemap::run::{self, Machine, Record};
use capsulemap::study::{Coordinate, Study};

use super::draws;
use super::program::{FIG5, TWO_MOTIONS, WorkDir};

fn study(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn records(study: &Study) -> Vec<Record> {
    let records = Mutex::new(Vec::new());
    run::run(study, Machine::default(), |record| records.lock().expect("a lock").push(record))
        .expect("the study runs");
    let mut records = records.into_inner().expect("a lock");
    records.sort_by_key(|record| record.index);
    records
}

/// `cases` that start at one phase and are seen at another.
fn turned(cases: Vec<Case>) -> Vec<Case> {
    let phases = |(i, case): (usize, Case)| {
        let start_phase = TAU * (i as f64 * 0.618).fract();
        Case { start_phase, ..case }
    };
    cases.into_iter().enumerate().map(phases).collect()
}

#[test]
fn there_are_two_attractors_whatever_the_phase_of_the_start() {
    let axes = "[[axes]]\nname = \"start_phase\"\nfrom = \"0 deg\"\nto = \"360 deg\"\npoints = 13\n\
                [[axes]]\nname = \"start_y1\"\nfrom = \"-0.4 m/s\"\nto = \"0.4 m/s\"\npoints = 9\n";
    let omega = "delta = \"4.33 mm\"\nomega = \"158 rad/s\"";
    let study = study(&(TWO_MOTIONS.replace("delta = \"4.33 mm\"", omega) + axes));
    let records = records(&study);
    let final_motions = run::final_motions(&study, &records);
    let found =
        run::attractors(&study, &final_motions, Machine::default(), || ()).expect("threads");
    let mut speeds: [Vec<f64>; 2] = Default::default();
    for (record, attractor) in records.iter().zip(&found.of_case) {
        assert_eq!((record.orbit.outcome, record.orbit.period), (Outcome::Periodic, 1));
        let attractor = attractor.expect("an attractor") as usize;
        assert!(attractor < 2, "case {} has attractor {attractor}", record.index);
        speeds[attractor].push(record.orbit.outputs[Output::ProgressionSpeed]);
    }
    let ends = |speeds: &[f64]| {
        let low = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        [low, speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
    };
    let [mut rests, mut moves] = speeds.each_ref().map(|speeds| ends(speeds));
    if rests[1] > moves[1] {
        (rests, moves) = (moves, rests);
    }
    assert!(rests[1] < 1e-10 && moves[0] > 0.07, "{rests:?} {moves:?}");
    assert!(moves[1] - moves[0] < 1e-9, "{moves:?}");
    // At one velocity the phase of the start decides between the two, or it would say nothing here.
    let decides =
        |y1: usize| (1..12).any(|phase| found.of_case[phase * 9 + y1] != found.of_case[y1]);
    assert!((0..9).any(decides), "{:?}", found.of_case);
}

#[test]
fn the_first_section_is_where_direct_integration_is_at_its_phase() {
    for case in turned(draws::cases(40, 21)) {
        let omega = case.parameters[Parameter::Omega];
        let left = (case.section_phase - case.start_phase).rem_euclid(TAU) / omega;
        // The clock of this system begins at the start.
        let system = Capsule::single(&case.parameters, case.start_phase);
        let mut motion = Motion::new(&system, 0.0, case.start.capsule());
        let mut step = Step::default();
        while motion.time < left {
            motion.step(&system, left, 1e-12, &mut step);
        }
        let found = simulate_case(&case, 0, 1e-12);
        let [first] = &found.section[..] else { panic!("one section: {found:?}") };
        assert!((first.t - left).abs() < 1e-12 * left.max(1.0) && first.n == 0, "{first:?}");
        let State { r, y1, x2, y2, .. } = motion.state;
        let apart = omega * (first.r - r).abs().max((first.x2 - x2).abs());
        let apart = apart.max((first.y1 - y1).abs()).max((first.y2 - y2).abs());
        assert!(apart < 1e-8, "{apart:e}: {case:?}");
    }
}

#[test]
fn a_start_between_sections_ends_on_the_motion_of_a_long_integration() {
    let mut compared = 0;
    for case in turned(draws::cases(30, 22)) {
        let orbit = settle_case(&case, &Protocol::default());
        let isolated = orbit.certificate.multipliers[0].abs() < 0.98;
        if orbit.outcome != Outcome::Periodic || !isolated {
            continue;
        }
        let cycles = 1500 + orbit.period;
        let run = simulate_case(&case, cycles, 1e-12);
        let gone = run.section[cycles as usize].x2 - run.section[1500].x2;
        let speed = gone / (orbit.period as f64 * case.parameters.drive_period());
        let known = orbit.outputs[Output::ProgressionSpeed];
        assert!((speed - known).abs() < 1e-9, "{speed:e} {known:e}: {case:?}");
        let last = &run.section[cycles as usize];
        let near = orbit.section.iter().any(|point| {
            let [r, y1, y2]: [f64; 3] = point.array();
            let [r, y1, y2] = [last.r - r, last.y1 - y1, last.y2 - y2].map(f64::abs);
            case.parameters[Parameter::Omega] * r < 1e-8 && y1 < 1e-8 && y2 < 1e-8
        });
        assert!(near, "{last:?} {:?}: {case:?}", orbit.section);
        compared += 1;
    }
    assert!(compared > 15, "{compared}");
}

#[test]
fn the_speed_does_not_depend_on_where_the_section_is() {
    for mut case in draws::cases(12, 23) {
        let mut speeds = Vec::new();
        for turn in [0.0, 0.7, 2.0, 4.4, 6.1] {
            case.section_phase = case.start_phase + turn;
            let orbit = settle_case(&case, &Protocol::default());
            if orbit.outcome == Outcome::Periodic && orbit.certificate.multipliers[0].abs() < 0.99 {
                speeds.push(orbit.outputs[Output::ProgressionSpeed]);
            }
        }
        let apart = speeds.iter().map(|speed| (speed - speeds[0]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{speeds:?}: {case:?}");
    }
}

#[test]
fn a_later_start_on_the_same_motion_changes_nothing() {
    for case in turned(draws::cases(20, 24)) {
        let phase = case.start_phase + 0.4;
        let first = simulate_case(&Case { section_phase: phase, ..case.clone() }, 0, 1e-12);
        let Sample { r, y1, y2, .. } = first.section[0];
        let start = State::of([r, y1, 0.0, y2]);
        let later = Case { start: start.into(), start_phase: phase, ..case.clone() };
        let [a, b] = [&case, &later].map(|case| settle_case(case, &Protocol::default()));
        if a.outcome == Outcome::Periodic && a.certificate.multipliers[0].abs() < 0.99 {
            let [a, b] = [a, b].map(|orbit| orbit.outputs[Output::ProgressionSpeed]);
            assert!((a - b).abs() < 1e-9, "{a:e} {b:e}: {case:?}");
        }
    }
}

#[test]
fn a_linear_oscillator_passes_its_sections_as_its_closed_form_does() {
    let p = Parameters::with(&[
        (Parameter::Omega, 60.0),
        (Parameter::Pd, 0.3),
        (Parameter::Delta, 1.0),
    ]);
    let [m, k, c, w] = [Parameter::M1, Parameter::K1, Parameter::C, Parameter::Omega].map(|q| p[q]);
    let amplitude = p[Parameter::Pd] / (k - m * w * w).hypot(c * w);
    let lag = (c * w).atan2(k - m * w * w);
    let decay = c / (2.0 * m);
    let own = (k / m - decay * decay).sqrt();
    for (start_phase, section_phase) in
        [(0.0, 1.0), (1.0, 0.0), (2.5, 2.4), (5.0, 11.0), (-1.0, PI)]
    {
        let start = State { r: 1e-3, y1: -0.05, ..State::default() };
        let case = Case { parameters: p.clone(), start: start.into(), start_phase, section_phase };
        let run = simulate_case(&case, 6, 1e-12);
        assert!(run.events.is_empty(), "the capsule sticks and the mass is free");
        // From the start, r = A cos(w t + s - lag) + e^(-decay t) (a cos(own t) + b sin(own t)).
        let forced = |t: f64| {
            let at = w * t + start_phase - lag;
            [amplitude * at.cos(), -amplitude * w * at.sin()]
        };
        let [r0, v0] = forced(0.0);
        let a = start.r - r0;
        let b = (start.y1 - v0 + decay * a) / own;
        for (n, sample) in run.section.iter().enumerate() {
            let turns = ((section_phase - start_phase) / TAU).rem_euclid(1.0) + n as f64;
            let t = turns * TAU / w;
            assert!((sample.t - t).abs() < 1e-12, "{} {t}", sample.t);
            let r =
                forced(t)[0] + libm::exp(-decay * t) * (a * (own * t).cos() + b * (own * t).sin());
            assert!((sample.r - r).abs() < 1e-11 * amplitude.max(1e-3), "{} {r}", sample.r);
        }
    }
}

#[test]
fn starts_between_sections_settle_alike_alone_and_side_by_side() {
    let protocol = Protocol { max_cycles: 300, exponent_cycles: 64, ..Protocol::default() };
    let mut cases = turned(draws::cases(60, 25));
    // One that fails before its first section, and one on it.
    cases[7].start = State { r: 1e300, ..cases[7].start.capsule() }.into();
    cases[8].start_phase = cases[8].section_phase;
    // As texts, in which what is unknown in both is equal.
    let alone: Vec<String> =
        cases.iter().map(|case| format!("{:?}", settle_case(case, &protocol))).collect();
    for instructions in [Instructions::Scalar, Instructions::widest()] {
        let among = draws::settled(&cases, &protocol, instructions);
        for (i, (alone, among)) in alone.iter().zip(&among).enumerate() {
            assert_eq!(*alone, format!("{among:?}"), "case {i}");
        }
    }
    let failed = settle_case(&cases[7], &protocol);
    let failure = failed.failure.expect("it cannot be followed");
    assert!((0.0..cases[7].parameters.drive_period()).contains(&failure.time), "{failure:?}");
    assert_eq!(failed.cycles, 0);
}

#[test]
fn a_history_from_the_start_begins_there_wherever_the_section_is() {
    let span = HistorySpan { cycles: 3, per_cycle: 40, from_start: true };
    let protocol = Protocol { history: Some(span), ..Protocol::default() };
    let mut case = draws::cases(1, 26).remove(0);
    let kept = |case: &Case| settle_case(case, &protocol).history;
    case.section_phase = case.start_phase;
    let usual = kept(&case);
    case.section_phase += 1.0;
    let shifted = kept(&case);
    // Of r, y1, x2, y2 and the drive.
    let within = [1e-10, 1e-8, 1e-10, 1e-8, 1e-11 * case.parameters[Parameter::Pd]];
    assert_eq!((usual.len(), shifted.len()), (within.len(), within.len()));
    for ((usual, shifted), within) in usual.iter().zip(&shifted).zip(within) {
        assert_eq!((usual.len(), shifted.len()), (span.samples(), span.samples()));
        for (a, b) in usual.iter().zip(shifted) {
            assert!((a - b).abs() < within, "{a} {b}");
        }
    }
}

#[test]
fn an_inherited_start_lies_on_the_section() {
    let inherit = "[[axes]]\nname = \"omega\"\nvalues = [\"130 rad/s\", \"131 rad/s\"]\n[start]\n\
                  y1 = \"0.3 m/s\"\nstart_phase = \"40 deg\"\nsection_phase = \"10 deg\"\n\
                  inherit = \"omega\"\n";
    let study = study(&(TWO_MOTIONS.to_owned() + inherit));
    let [start, section] = [study.start_phase, study.section_phase];
    assert_eq!([start, section], [40.0 * (PI / 180.0), 10.0 * (PI / 180.0)]);
    let records = records(&study);
    assert_eq!([records[0].start_phase, records[1].start_phase], [start, section]);
    let case = Case { start: records[1].start.clone(), start_phase: section, ..study.case(1) };
    // As they are shown, with all digits: outputs that were not asked for are no numbers, which equal none.
    let [own, other] = [&records[1].orbit, &settle_case(&case, &study.protocol)];
    assert_eq!(format!("{own:?}"), format!("{other:?}"));
}

#[test]
fn the_older_key_is_both_phases_and_the_older_axis_that_of_the_start() {
    let with = |lines: &str| study(&format!("{FIG5}[start]\n{lines}\n"));
    let phases = |study: &Study| [study.start_phase, study.section_phase].map(f64::to_degrees);
    assert_eq!(phases(&with("phase = \"90 deg\"")), [90.0, 90.0]);
    assert_eq!(phases(&with("start_phase = \"90 deg\"")), [90.0, 0.0]);
    assert_eq!(phases(&with("section_phase = \"90 deg\"")), [0.0, 90.0]);
    let axis =
        |name: &str| format!("[[axes]]\nname = \"{name}\"\nvalues = [\"1 rad\", \"2 rad\"]\n");
    let figure =
        "[[figures]]\nname = \"a\"\nkind = \"map\"\nx = \"phase\"\nat = { phase = \"1 rad\" }";
    let old = study(&(FIG5.to_owned() + &axis("phase") + figure));
    assert_eq!(old.axes()[0].varying[0].coordinate, Coordinate::StartPhase);
    assert_eq!(old.drawings[0].x.as_deref(), Some("start_phase"));
    assert!(old.drawings[0].at.contains_key("start_phase"));
    let new =
        study(&(FIG5.to_owned() + &axis("start_phase") + &figure.replace("phase", "start_phase")));
    assert_eq!(Study { text: String::new(), ..old }, Study { text: String::new(), ..new });
    let refused = |text: String, words: &str| {
        let faults = Study::parse("study.toml", &text).expect_err(&text).to_string();
        assert!(faults.contains(words), "{faults}");
    };
    let twice = "[start]\nphase = \"1 rad\"\nsection_phase = \"2 rad\"\n";
    refused(FIG5.to_owned() + twice, "line 8: start.section_phase: does not go with `phase`");
    for name in ["phase", "start_phase", "section_phase"] {
        let both = axis(name) + "[start]\nphase = \"1 rad\"\n";
        refused(FIG5.to_owned() + &both, "start.phase: is given here and on an axis");
    }
    refused(
        FIG5.to_owned() + &axis("phase") + &axis("start_phase"),
        "a second axis \"start_phase\"",
    );
}

#[test]
fn the_program_takes_both_phases_apart_or_together() {
    let dir = WorkDir::new();
    let run = |more: &[&str]| {
        dir.run(&[&["simulate", "--omega", "130", "--cycles", "1", "--json"], more].concat()).json()
    };
    let together = run(&["--phase", "90 deg"]);
    assert_eq!(together, run(&["--start-phase", "90 deg", "--section-phase", "90 deg"]));
    let apart = run(&["--start-phase", "90 deg"]);
    let first = apart["section"][0]["t"].as_f64().expect("a time");
    assert!((first - 0.75 * TAU / 130.0).abs() < 1e-15, "{first}");
    let both = ["simulate", "--phase", "1", "--start-phase", "1"];
    dir.run(&both).refused(&["--start-phase"]);
    dir.run(&["simulate", "--section-phase", "1 m"]).refused(&["--section-phase: ", "an angle"]);
}
