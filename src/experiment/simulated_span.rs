//! How long a record is simulated at most, by its samples rather than by its clock.

use super::recording::{GAP, Sampling};

/// So many cycles of the drive are simulated for each sample of a record at most, in the mean, so that coarse records and gaps
/// are.
const PER_SAMPLE: f64 = 10.0;
/// So many more, so that short records may have long gaps.
const BESIDES: f64 = 1000.0;
/// So many of the longest gaps are named.
const NAMED: usize = 3;

/// Checks that a record at `times` since its first sample [s] spans no more cycles of this `period` [s] than its samples allow: ten
/// for each, and 1000 more.
///
/// Fails with the longest gaps, or with the interval of the samples where there is no gap.
pub fn check_span(times: &[f64], sampling: &Sampling, period: f64) -> Result<(), String> {
    check(times, sampling, period, "cycles of the drive")
}

/// The same of an oscillator without a drive, by how long its section is waited for [s].
///
/// Fails in the same manner.
pub fn check_wait(times: &[f64], sampling: &Sampling, within: f64) -> Result<(), String> {
    check(times, sampling, within, "times that the section is waited for")
}

/// `what` is what the record spans so many of.
fn check(times: &[f64], sampling: &Sampling, period: f64, what: &str) -> Result<(), String> {
    let cycles = times[times.len() - 1] / period;
    let most = BESIDES + PER_SAMPLE * times.len() as f64;
    if cycles <= most {
        return Ok(());
    }
    let Sampling { interval, gaps, .. } = sampling;
    let spans = format!(
        "it spans {cycles:.3e} {what}, of which {most} at most are simulated: {PER_SAMPLE} for each of its {} samples, and \
         {BESIDES} more",
        times.len()
    );
    let mut long: Vec<&(f64, f64)> =
        gaps.iter().filter(|(_, length)| length / period > PER_SAMPLE).collect();
    if long.is_empty() {
        let apart = format!("the samples are {interval} s apart in the median");
        return Err(format!("{apart}, and {spans}; check the unit of t"));
    }
    long.sort_by(|a, b| b.1.total_cmp(&a.1));
    let named =
        long.iter().take(NAMED).map(|(begins, length)| format!("{length} s at t = {begins} s"));
    let named = named.collect::<Vec<_>>().join(", ");
    let longest = if long.len() == 1 { "a gap of" } else { "the longest gaps:" };
    Err(format!(
        "{longest} {named} (a gap is more than {GAP} times the median interval of {interval} s), and {spans}; where the clock was \
         set while it recorded, cut the file there and take the parts by themselves"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::recording::Recording;

    fn checked(times: &[f64]) -> Result<(), String> {
        let rows: Vec<String> = times.iter().map(f64::to_string).collect();
        let text = format!("t [s]\n{}\n", rows.join("\n"));
        let known = [crate::experiment::Column {
            name: "t",
            dimension: crate::quantity::Dimension::Time,
            presence: crate::experiment::Presence::Required,
        }];
        let sampling = Recording::read("rig.csv", &text, &known, 2).expect("readable").sampling();
        let since: Vec<f64> = times.iter().map(|time| time - times[0]).collect();
        check_span(&since, &sampling, 0.1)
    }

    #[test]
    fn the_samples_bound_the_cycles_and_gaps_are_named() {
        let even = |count: u32, interval: f64| -> Vec<f64> {
            (0..count).map(|i| interval * f64::from(i)).collect()
        };
        assert_eq!(checked(&even(100, 0.01)), Ok(()));
        assert_eq!(checked(&even(100, 1.0)), Ok(()));
        let coarse = checked(&even(300, 2.0)).expect_err("refused");
        assert!(
            coarse.contains("2 s apart in the median") && coarse.contains("unit of t"),
            "{coarse}"
        );
        let mut jump = even(100, 0.01);
        jump[50..].iter_mut().for_each(|time| *time += 150.0);
        assert_eq!(checked(&jump), Ok(()));
        jump[50..].iter_mut().for_each(|time| *time += 1.8e9);
        let refused = checked(&jump).expect_err("refused");
        assert!(refused.contains("a gap of 1800000150.01 s at t = 0.49 s"), "{refused}");
        jump[80..].iter_mut().for_each(|time| *time += 2e9);
        let refused = checked(&jump).expect_err("refused");
        assert!(refused.contains("gaps: 2000000000.0"), "{refused}");
    }
}
