//! Derivatives of sampled histories in parameters and starts, against differences, over the box of parameters that users may set.

use capsulemap::capsule::{
    CapsuleParameters as _, CapsuleState as _, Case, Parameter, Resistance, simulate_case,
};
use capsulemap::experiment::{Direction, Signal, Started, sampled};

use super::draws;

const TOLERANCE: f64 = 1e-14;
/// Signals, sizes of which the errors are relative to.
const SIGNALS: [Signal; 5] = [Signal::R, Signal::X2, Signal::Y1, Signal::Y2, Signal::A1];

const DIRECTIONS: [Direction; 11] = [
    Direction::Parameter(Parameter::K1),
    Direction::Parameter(Parameter::C),
    Direction::Parameter(Parameter::K2),
    Direction::Parameter(Parameter::Delta),
    Direction::Parameter(Parameter::MuD),
    Direction::Parameter(Parameter::Vs),
    Direction::Parameter(Parameter::Omega),
    Direction::Parameter(Parameter::Pd),
    Direction::StartR,
    Direction::StartY1,
    Direction::StartPhase,
];

/// A length of change in a direction that is small, but far from rounding.
fn reach(motion: &Started, direction: Direction) -> f64 {
    let size = match direction {
        Direction::StartR | Direction::StartX2 => 1e-3,
        Direction::StartY1 | Direction::StartY2 => 0.1,
        Direction::Parameter(Parameter::Delta) => 1e-3,
        Direction::Parameter(Parameter::MuD) => 0.1,
        Direction::StartPhase => 1.0,
        other => motion.value(other).abs().max(1e-3),
    };
    1e-5 * size
}

/// The differences of all samples in a direction, and how far those of two lengths are apart, relative to their largest by signal.
fn differences(
    motion: &Started,
    times: &[f64],
    direction: Direction,
) -> Option<(Vec<Vec<f64>>, f64)> {
    let at = motion.value(direction);
    let values = |offset: f64| {
        let moved = motion.with(direction, at + offset);
        sampled(&moved, times, &SIGNALS, &[], TOLERANCE).ok().map(|it| it.values)
    };
    let by = |h: f64| -> Option<Vec<Vec<f64>>> {
        let (above, below) = (values(h)?, values(-h)?);
        let pairs = above.iter().zip(&below);
        let slope = |(a, b): (&Vec<f64>, &Vec<f64>)| {
            a.iter().zip(b).map(|(a, b)| (a - b) / (2.0 * h)).collect()
        };
        Some(pairs.map(slope).collect())
    };
    let reach = reach(motion, direction);
    let (wide, near) = (by(2.0 * reach)?, by(reach)?);
    let extrapolate = |(wide, near): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
        wide.iter().zip(near).map(|(w, n)| (4.0 * n - w) / 3.0).collect()
    };
    let best: Vec<Vec<f64>> = wide.iter().zip(&near).map(extrapolate).collect();
    let doubt = apart(&near, &best);
    Some((best, doubt))
}

/// The largest difference of two sets of samples, relative to the largest sample of its signal.
fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let of_signal = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        let size = a.iter().fold(1e-300, |most: f64, it| most.max(it.abs()));
        a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs() / size))
    };
    a.iter().zip(b).map(of_signal).fold(0.0, f64::max)
}

#[test]
fn derivatives_of_histories_are_those_of_differences() {
    let (mut compared, mut left_out, mut with_events, mut worst) = (0, 0, 0, 0.0_f64);
    for case in draws::wide(60, 41, Resistance::CoulombStribeck) {
        let Case { parameters, start, start_phase, .. } = case.clone();
        let period = parameters.drive_period();
        let times: Vec<f64> = (1..=20).map(|i| 0.1 * f64::from(i) * period).collect();
        let events =
            simulate_case(&Case { section_phase: start_phase, ..case }, 2, 1e-12).events.len();
        let motion = Started { parameters, start: start.capsule(), phase: start_phase };
        let Ok(found) = sampled(&motion, &times, &SIGNALS, &DIRECTIONS, TOLERANCE) else {
            continue;
        };
        with_events += usize::from(events >= 4);
        for (i, &direction) in DIRECTIONS.iter().enumerate() {
            let exact: Vec<Vec<f64>> = found
                .slopes
                .iter()
                .map(|times| times.iter().map(|slopes| slopes[i]).collect())
                .collect();
            let Some((by_differences, doubt)) = differences(&motion, &times, direction) else {
                continue;
            };
            // Differences that disagree among themselves tell nothing: an event changes within their reach, or the motion
            // is so sensitive that they are rounding.
            if doubt > 1e-7 {
                left_out += 1;
                continue;
            }
            compared += 1;
            let error = apart(&exact, &by_differences);
            worst = worst.max(error);
            assert!(error < 1e-6, "{direction:?} of {motion:?}: {error:e}, doubt {doubt:e}");
        }
    }
    println!(
        "{compared} compared, {left_out} left out, {with_events} with four events or more, worst {worst:e}"
    );
    assert!(compared > 2 * left_out && compared > 250, "{compared} compared, {left_out} left out");
    assert!(with_events > 30, "{with_events}");
}
