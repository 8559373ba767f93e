//! A comparison of a record with an oscillator given as text, in words and as JSON.

use serde_json::json;

use super::identify_report::unit;
use crate::description::StateCoordinate;
use crate::experiment::history::Channel;
use crate::experiment::text_comparison::{StateDifference, TextComparison};
use crate::orbit::Outcome;
use crate::store::catalogue::{CYCLES, OUTCOME, PERIOD};

/// The comparison in lines.
pub fn told_of(it: &TextComparison, doubts: &[String]) -> String {
    let mut text =
        format!("record:       {} samples over {:.2} cycles\n", it.sampling.count, cycles(it));
    let recorded = match it.recorded_period {
        Some(period) => format!("period {period}"),
        None => "no period up to 8".to_owned(),
    };
    let simulated = match it.outcome {
        (Outcome::Periodic, period) => format!("periodic, period {period} simulated"),
        (other, _) => format!("{} simulated: histories need not agree", other.name()),
    };
    text += &format!("motion:       {recorded} recorded; {simulated}\n");
    let start: Vec<String> = it.motion.start.each().map(|(it, value)| started(it, value)).collect();
    text += &format!("first sample: {} simulated\n", start.join(", "));
    it.differences.iter().for_each(|it| text += &told_of_difference(it));
    text.extend(doubts.iter().map(|it| format!("warning: {it}\n")));
    text
}

/// A state where the simulation starts.
fn started(coordinate: StateCoordinate, value: f64) -> String {
    format!("{} = {value:.6e}{}", coordinate.name(), unit(coordinate.start().dimension))
}

/// Cycles in the record.
fn cycles(it: &TextComparison) -> f64 {
    it.times[it.times.len() - 1] / it.cycle
}

/// The error of a state.
fn told_of_difference(it: &StateDifference) -> String {
    let Channel { name, .. } = it.channel;
    match it.error {
        Some(error) => format!("error of {:<5}{:.2} %\n", format!("{name}:"), 100.0 * error),
        None => format!(
            "error of {:<5}none: {name} does not vary; no error relative to it\n",
            format!("{name}:")
        ),
    }
}

/// The comparison as JSON.
pub fn as_json(it: &TextComparison, doubts: &[String]) -> serde_json::Value {
    let start: serde_json::Map<String, serde_json::Value> =
        it.motion.start.each().map(|(it, value)| (it.name().to_owned(), json!(value))).collect();
    let errors = it.differences.iter().map(|it| {
        json!({
            "signal": it.channel.name,
            "unit": it.channel.dimension.unit(),
            "error": it.error,
        })
    });
    json!({
        "samples": it.sampling.count,
        "gaps": it.sampling.gaps,
        CYCLES.name: cycles(it),
        "cycle_duration": it.cycle,
        "period_recorded": it.recorded_period,
        OUTCOME.name: it.outcome.0.name(),
        PERIOD.name: it.outcome.1,
        "start": start,
        "errors": errors.collect::<Vec<_>>(),
        "warnings": doubts,
    })
}
