//! Motions without a drive come to rest, which is one attractor whatever they began from, and found by few cycles.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use capsulemap::capsule::{CapsuleState as _, Output, Parameter};
use capsulemap::orbit::{Outcome, Proof};
use capsulemap::run::{self, Attractors, Machine, Record};
use capsulemap::study::Study;

/// A capsule whose mass is damped beyond oscillation, over so many starts, with this amplitude of the drive [N].
fn overdamped(p_d: &str, starts: [usize; 2], more: &str) -> Study {
    let [y1, r] = starts;
    let text = format!(
        "[parameters]\nomega = \"1.8469921409094814 rad/s\"\np_d = \"{p_d} N\"\nk2 = \"496.15415590572 N/m\"\n\
         delta = \"0.00016649251031683565 m\"\nk1 = \"442.24832390145684 N/m\"\nc = \"32.81178933376257 N s/m\"\n\
         mu_s = 1.5843537384451625\ng = \"89.13879405652 m/s^2\"\n\
         [[axes]]\nname = \"start_y1\"\nfrom = \"-0.004428 m/s\"\nto = \"0.004428 m/s\"\npoints = {y1}\n\
         [[axes]]\nname = \"start_r\"\nfrom = \"-0.000389 m\"\nto = \"0.000389 m\"\npoints = {r}\n\
         [protocol]\nmax_cycles = 5\nexponent_cycles = 0\nmeasured_cycles = 1\n{more}"
    );
    parsed(&text)
}

fn parsed(text: &str) -> Study {
    Study::parse("study.toml", text).unwrap_or_else(|faults| panic!("{faults}"))
}

fn records(study: &Study) -> Vec<Record> {
    let records = Mutex::new(Vec::new());
    let keep = |record| records.lock().expect("a lock").push(record);
    run::run(study, Machine::default(), keep).expect("the study runs");
    let mut records = records.into_inner().expect("a lock");
    records.sort_by_key(|record: &Record| record.index);
    records
}

fn attractors(study: &Study, records: &[Record]) -> Attractors {
    let motions = run::final_motions(study, records);
    run::attractors(study, &motions, Machine::default(), || ()).expect("the threads start")
}

/// Cycles that all cases have been followed for.
fn cycles(records: &[Record]) -> u64 {
    records.iter().map(|record| record.orbit.cycles).sum()
}

#[test]
fn all_starts_without_a_drive_lead_to_one_rest() {
    for starts in [[3, 3], [5, 5], [15, 9]] {
        let rest = overdamped("0", starts, "");
        let at_rest = records(&rest);
        for Record { orbit, .. } in &at_rest {
            assert_eq!((orbit.outcome, orbit.period), (Outcome::Periodic, 1));
            assert_eq!(orbit.certificate.proof, Proof::Newton);
            assert_eq!(
                [orbit.end.capsule().r, orbit.end.capsule().y1, orbit.end.capsule().y2],
                [0.0; 3]
            );
            assert_eq!(orbit.outputs[Output::StickShare], 1.0);
        }
        let found = attractors(&rest, &at_rest);
        assert_eq!(found.of_starts.len(), 1);
        assert!(found.of_case.iter().all(|number| *number == Some(0)));
        // One attractor has no boundary to search, and rest takes no more cycles to know than a driven motion, but one.
        assert!(run::edges(&rest, &found, Machine::default()).is_empty());
        let driven = overdamped("0.01", starts, "");
        let moving = records(&driven);
        assert_eq!(attractors(&driven, &moving).of_case, found.of_case);
        let most = 2 * cycles(&moving) + 2 * at_rest.len() as u64;
        assert!(cycles(&at_rest) <= most, "{} {most}", cycles(&at_rest));
    }
}

#[test]
fn a_drive_too_weak_to_be_told_from_none_leads_to_one_orbit() {
    for p_d in ["1e-12", "1e-40", "1e-60", "1e-200"] {
        let study = overdamped(p_d, [3, 3], "");
        let records = records(&study);
        let found = attractors(&study, &records);
        assert!(found.of_case.iter().all(|number| *number == Some(0)), "{p_d}: {found:?}");
        // The orbit is that of the drive, not nothing: the amplitude goes with the force.
        let force: f64 = p_d.parse().expect("a number");
        let share = records[0].orbit.end.capsule().r / force * study.base[Parameter::K1];
        assert!((share - 1.0).abs() < 0.1, "{p_d}: {share}");
    }
}

#[test]
fn plain_integration_ends_where_rest_is_told() {
    let accelerated = overdamped("0", [3, 3], "");
    let plain = overdamped("0", [3, 3], "accelerate = false\n");
    let (a, b) = (records(&accelerated), records(&plain));
    assert_eq!(attractors(&accelerated, &a).of_case, attractors(&plain, &b).of_case);
}

#[test]
fn rest_goes_on_along_a_parameter_without_a_search() {
    let study = parsed(
        "[parameters]\np_d = \"0 N\"\nk2 = \"496 N/m\"\ndelta = \"0.166 mm\"\n\
         [[axes]]\nname = \"omega\"\nfrom = \"1 rad/s\"\nto = \"100 rad/s\"\npoints = 50\n\
         [[axes]]\nname = \"start_r\"\nfrom = \"-1 mm\"\nto = \"1 mm\"\npoints = 5\n",
    );
    let records = records(&study);
    let linked = AtomicUsize::new(0);
    let count = || {
        linked.fetch_add(1, Ordering::Relaxed);
    };
    let motions = run::final_motions(&study, &records);
    let found = run::attractors(&study, &motions, Machine::default(), count).expect("threads");
    assert!(found.of_case.iter().all(|number| *number == Some(0)), "{:?}", found.of_case);
    assert!(found.events.is_empty(), "{:?}", found.events);
    assert_eq!(linked.into_inner(), run::links(&study));
}
