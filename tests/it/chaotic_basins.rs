//! Basins of motions that do not repeat: one chaotic attractor has one number, two have two.

use capsulemap::capsule::Output;
use capsulemap::orbit::Outcome;
use capsulemap::run::{self, Attractors, Machine, Record};
use capsulemap::study::Study;

/// Starts of a capsule at one drive, with the attractors that they lead to.
fn found(drive: &str, starts: usize) -> (Vec<Record>, Attractors) {
    let text = format!(
        "[parameters]\nk2 = \"40 kN/m\"\nc = \"0.2 N s/m\"\nmu_s = 0.4\nmu_d = 0.2\ndelta = \"2 mm\"\n{drive}\n\
         [[axes]]\nname = \"start_r\"\nfrom = \"-15 mm\"\nto = \"2 mm\"\npoints = {starts}\n\
         [[axes]]\nname = \"start_y1\"\nfrom = \"-1 m/s\"\nto = \"1 m/s\"\npoints = {starts}\n\
         [protocol]\nmeasured_cycles = 400\n"
    );
    let study = Study::parse("study.toml", &text).unwrap_or_else(|faults| panic!("{faults}"));
    let machine = Machine::default();
    let chains: Vec<usize> = (0..study.chains()).collect();
    let records = run::run_sample(&study, machine, &chains, || ()).expect("the study runs");
    let motions = run::final_motions(&study, &records);
    let attractors = run::attractors(&study, &motions, machine, || ()).expect("threads");
    (records, attractors)
}

/// The numbers of the attractors of the starts whose motion is chaotic, each once.
fn chaotic(records: &[Record], attractors: &Attractors) -> Vec<u32> {
    let is_chaotic = |record: &&Record| record.orbit.outcome == Outcome::Chaotic;
    let number = |record: &Record| attractors.of_case[record.index].expect("an attractor");
    let mut numbers: Vec<u32> = records.iter().filter(is_chaotic).map(number).collect();
    numbers.sort();
    numbers.dedup();
    numbers
}

/// This motion mixes so slowly that 64 points of two starts often lie in other parts of the attractor.
#[test]
fn starts_in_one_slowly_mixing_motion_have_one_attractor() {
    let (records, attractors) = found("p_d = \"4 N\"\nomega = \"19.16666666 rad/s\"", 7);
    assert!(records.iter().all(|record| record.orbit.outcome == Outcome::Chaotic));
    assert_eq!(chaotic(&records, &attractors), [0]);
}

/// The mean speed is measured without any section point: it is the same on one attractor and other on the other.
#[test]
fn two_chaotic_attractors_are_told_apart_as_their_speeds_are() {
    let (records, attractors) = found("p_d = \"6 N\"\nomega = \"16.66666667 rad/s\"", 8);
    let speed = |record: &Record| 1e3 * record.orbit.outputs[Output::ProgressionSpeed];
    let numbers = chaotic(&records, &attractors);
    assert_eq!(numbers.len(), 2, "{numbers:?}");
    for record in records.iter().filter(|record| record.orbit.outcome == Outcome::Chaotic) {
        let own: f64 = speed(record);
        let expected: f64 = if own > 0.0 { 2.1 } else { -6.4 };
        assert!((own - expected).abs() < 0.7, "{own} mm/s");
        let first = records
            .iter()
            .find(|it| attractors.of_case[it.index] == attractors.of_case[record.index]);
        let of_attractor = speed(first.expect("a first case"));
        assert!((of_attractor - expected).abs() < 0.7, "{of_attractor} and {own} mm/s");
    }
}
