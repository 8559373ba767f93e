//! Speeds, impacts and pulses of synthesised records are those of the motion, with errors that say how far they scatter.

use std::time::Instant;

use capsulemap::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, Parameter, Parameters, State, settle_case,
};
use capsulemap::experiment::progression::progression;
use capsulemap::experiment::recorded_period::period_of;
use capsulemap::experiment::synthesis::recorded;
use capsulemap::experiment::{
    Column, Comparison, Presence, Recording, Sensor, Signal, Started, compare, sampled,
};
use capsulemap::orbit::Protocol;

use super::program::WorkDir;

const FIG5: [(Parameter, f64); 4] = [
    (Parameter::Omega, 77.91),
    (Parameter::Pd, 4.0),
    (Parameter::K2, 2420.0),
    (Parameter::Delta, 3.5e-3),
];

/// The cases of studies/fig6.toml and studies/fig7.toml, and that of Fig 5 with half the drive: omega, p_d, k2, delta.
const OTHERS: [[f64; 4]; 6] = [
    [77.91, 2.0, 2420.0, 3.5e-3],
    [20.73, 4.0, 18_960.0, 1.5e-3],
    [26.58, 2.5, 59_410.0, 1.5e-3],
    [37.33, 2.5, 59_410.0, 1.5e-3],
    [46.0, 2.5, 59_410.0, 1.5e-3],
    [54.6, 2.5, 59_410.0, 1.5e-3],
];

/// The motion that a capsule with these parameters settles to, at a phase of the drive.
fn settled(parameters: &Parameters, phase: f64) -> Started {
    let case = Case::at_section(parameters.clone(), State::default(), phase);
    let end = settle_case(&case, &Protocol::default()).end;
    Started { parameters: parameters.clone(), start: State { x2: 0.0, ..end.capsule() }, phase }
}

/// A record of a motion over some cycles at this rate [Hz], with this noise of the accelerometer [m/s2].
fn record(motion: &Started, (rate, cycles, noise): (f64, f64, f64), seed: u64) -> Recording {
    let sensors =
        [(Signal::X2, 1e-5), (Signal::R, 2e-5), (Signal::A1, noise), (Signal::Drive, 0.05)]
            .map(|(signal, noise)| Sensor { signal, noise, quantum: 0.0 });
    let count = (cycles * motion.parameters.drive_period() * rate) as u32;
    let times: Vec<f64> = (0..count).map(|i| f64::from(i) / rate).collect();
    let values = recorded(motion, &times, &sensors, seed).expect("followed");
    let mut text = String::from("t [s],x2 [m],r [m],a1 [m/s2],drive [N]\n");
    for (i, time) in times.iter().enumerate() {
        let [x2, r, a1, drive] = [0, 1, 2, 3].map(|signal| values[signal][i]);
        text += &format!("{time:e},{x2:e},{r:e},{a1:e},{drive:e}\n");
    }
    let known: Vec<Column> = [Signal::X2, Signal::R, Signal::A1, Signal::Drive]
        .map(|it| (it.name(), it.dimension()))
        .into_iter()
        .chain([("t", capsulemap::quantity::Dimension::Time)])
        .map(|(name, dimension)| Column { name, dimension, presence: Presence::Required })
        .collect();
    Recording::read("motion.csv", &text, &known, 16).expect("readable")
}

fn compared(record: &Recording, parameters: &Parameters) -> Comparison {
    let case = Case::at_section(parameters.clone(), State::default(), 0.0);
    compare(record, &case, &Protocol::default()).expect("compared")
}

#[test]
fn recorded_speeds_scatter_as_their_errors_say() {
    let parameters = Parameters::with(&FIG5);
    let motion = settled(&parameters, 0.3);
    let shares = (0..40).map(|seed| {
        let found = compared(&record(&motion, (1e3, 20.0, 0.1), seed), &parameters);
        let speed = found.recorded_speed.expect("a speed");
        (speed.value - found.simulated_speed.value) / speed.standard_error.expect("known")
    });
    let rms = (shares.map(|it| it * it).sum::<f64>() / 40.0).sqrt();
    println!("deviation over standard error: {rms:.3}");
    assert!((0.8..1.25).contains(&rms), "{rms}");
}

/// The capsule of studies/chaos.toml.
fn chaotic() -> Parameters {
    Parameters::with(&[
        (Parameter::K2, 60e3),
        (Parameter::C, 0.2),
        (Parameter::MuS, 0.3),
        (Parameter::MuD, 0.25),
        (Parameter::Delta, 2e-3),
        (Parameter::Omega, 15.0),
        (Parameter::Pd, 5.0),
    ])
}

#[test]
fn speeds_of_a_chaotic_motion_scatter_as_their_errors_say() {
    let parameters = chaotic();
    let cycle = parameters.drive_period();
    for cycles in [20.0, 40.0] {
        let rate = 500.0;
        let count = (cycles * cycle * rate) as usize;
        let times: Vec<f64> = (0..20 * count).map(|i| i as f64 / rate).collect();
        let signals = [Signal::X2, Signal::R];
        let all =
            sampled(&settled(&parameters, 0.0), &times, &signals, &[], 1e-10).expect("followed");
        let (mut speeds, mut squares) = (Vec::new(), 0.0);
        for (x2, r) in all.values[0].chunks(count).zip(all.values[1].chunks(count)) {
            let period = period_of(&times[..count], r, cycle);
            assert_eq!(period, None);
            let found = progression(&times[..count], x2, cycle, period).expect("a speed");
            speeds.push(found.value);
            squares += found.standard_error.expect("known").powi(2) / 20.0;
        }
        let mean = speeds.iter().sum::<f64>() / 20.0;
        let spread = (speeds.iter().map(|it| (it - mean).powi(2)).sum::<f64>() / 19.0).sqrt();
        let ratio = spread / squares.sqrt();
        println!("{cycles} cycles: {:.2} mm/s, told {:.2}", 1e3 * spread, 1e3 * squares.sqrt());
        assert!((1.0 / 1.5..1.5).contains(&ratio), "{cycles}: {ratio}");
    }
}

#[test]
fn a_motion_that_does_not_repeat_is_measured_by_the_protocol_of_its_study() {
    let work = WorkDir::new();
    let study = include_str!("../../studies/chaos.toml");
    work.put("chaos.toml", study.replace("measured_cycles = 20000", "measured_cycles = 2000"));
    work.run(&["synthesize", "chaos.toml", "--output", "rig", "--cycles", "15"]).done();
    let arguments = ["compare", "rig/motion.csv", "chaos.toml"];
    let told = work.run(&arguments).done().out;
    assert!(told.contains("the mean of 2000 cycles of a motion that does not repeat"), "{told}");
    assert!(told.contains("recorded (no standard error: too few cycles)"), "{told}");
    let found = work.run(&[&arguments[..], &["--json"]].concat()).json();
    // 8 mm/s a cycle, and neighbours correlate: about 11.5 mm/s over the root of 2000.
    let error = found["speed_simulated_error"].as_f64().expect("a number");
    assert!((0.13e-3..0.5e-3).contains(&error), "{error}");
    assert!(found["speed_recorded_error"].is_null());
}

#[test]
fn pulses_of_the_acceleration_are_as_many_as_impacts() {
    let of = |[omega, p_d, k2, delta]: [f64; 4]| {
        let set = [(Parameter::Omega, omega), (Parameter::Pd, p_d)];
        Parameters::with(&[set[0], set[1], (Parameter::K2, k2), (Parameter::Delta, delta)])
    };
    let cases = [[77.91, 4.0, 2420.0, 3.5e-3]].into_iter().chain(OTHERS);
    let expected = [1.0, 0.0, 2.0, 3.0, 2.0, 2.0, 2.0];
    for (set, expected) in cases.zip(expected) {
        let parameters = of(set);
        for (seed, phase) in [0.0, 1.7, 3.9].into_iter().enumerate() {
            let motion = settled(&parameters, phase);
            for rate in [1e3, 2e3, 5e3, 10e3] {
                for noise in [0.1, 1.0] {
                    let record = record(&motion, (rate, 10.0, noise), seed as u64);
                    let found = compared(&record, &parameters);
                    assert_eq!(found.impacts, expected, "{set:?}");
                    let place = format!("{set:?}, phase {phase}, {rate} Hz, {noise} m/s2");
                    assert_eq!(found.spikes, Some([expected; 2]), "{place}");
                }
            }
        }
    }
}

#[test]
fn the_time_of_a_comparison_grows_with_its_record() {
    let parameters = Parameters::with(&FIG5);
    let motion = settled(&parameters, 0.0);
    let time = |cycles: f64| {
        let record = record(&motion, (1e3, cycles, 0.1), 1);
        let run = |_| {
            let begins = Instant::now();
            compared(&record, &parameters);
            begins.elapsed().as_secs_f64()
        };
        (0..3).map(run).fold(f64::INFINITY, f64::min)
    };
    let [short, long] = [100.0, 800.0].map(time);
    println!("100 cycles {short:.3} s, 800 cycles {long:.3} s");
    // Eight times the record: linear time is 8 at most, quadratic 64.
    assert!(long < 20.0 * short, "{short} s, {long} s");
}
