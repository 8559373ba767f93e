//! The answer of a trade-off as comma-separated values.

use crate::campaign::{Answer, Robustness, Row};
use crate::store::catalogue::{ATTRACTOR, OUTCOME, PERIOD};

/// Comma-separated values: a header, then the optima, the front and the fastest, each with what it is.
pub fn csv(answer: &Answer) -> String {
    let optima = answer.named.iter().filter_map(|it| Some((it.name, it.row.as_ref()?)));
    let front = answer.front.iter().map(|row| ("front", row));
    let top = answer.top.iter().map(|row| ("top", row));
    let all: Vec<(&str, &Row)> = optima.chain(front).chain(top).collect();
    let Some((_, first)) = all.first() else { return String::new() };
    let mut text = format!("{}\n", header(answer, first).join(","));
    for (what, row) in all {
        text += &format!("{}\n", cells(what, row).join(","));
    }
    text
}

/// What the columns are called, by the first of the motions.
fn header(answer: &Answer, first: &Row) -> Vec<&'static str> {
    let names = first.coordinates.iter().map(|(it, ..)| it.name());
    let of = answer.of;
    let fixed = ["what", "case", of.gain.name(), of.cost.name()];
    let rest = [OUTCOME.name, PERIOD.name, ATTRACTOR.name, "share"];
    let [error, least] = match of.has_own_gain() {
        true => ["standard_error_of_speed", "speed_of_slowest_5_percent"],
        false => ["standard_error_of_gain", "gain_of_least_5_percent"],
    };
    let more = [
        of.told_per_gain().map_or("cost_per_gain", |it| it.name()),
        error,
        "standard_error_of_price",
        "held_by",
        "stationarity",
        "kept",
        least,
        "price_of_dearest_5_percent",
        "draws",
        "meet_conditions",
        "within_budget",
        "meet_conditions_within_budget",
        "replay",
    ];
    fixed.into_iter().chain(rest).chain(names).chain(more).collect()
}

/// A motion, in the columns of the header.
fn cells(what: &str, row: &Row) -> Vec<String> {
    let mut cells = vec![
        what.to_owned(),
        optional(row.case),
        format!("{:?}", row.gain),
        format!("{:?}", row.price),
        row.outcome.clone(),
        optional(row.period),
        optional(row.attractor),
        optional(row.share),
    ];
    cells.extend(row.coordinates.iter().map(|(_, value, _)| format!("{value:?}")));
    cells.extend([
        format!("{:?}", row.per_gain),
        optional(row.errors.map(|it| it.gain)),
        optional(row.errors.map(|it| it.price)),
        row.slopes.held_by.join("; "),
        optional(row.slopes.stationarity),
    ]);
    cells.extend(row.robustness.as_ref().map(cells_of_draws).unwrap_or_default());
    // A command has commas.
    cells.push(format!("\"{}\"", row.replay.replace('"', "\"\"")));
    cells
}

/// What tolerances leave of a motion.
fn cells_of_draws(it: &Robustness) -> [String; 7] {
    [
        it.kept.to_string(),
        it.gain.to_string(),
        it.price.to_string(),
        it.draws.to_string(),
        optional(it.meet_conditions),
        optional(it.within_budget),
        optional(it.meet_both),
    ]
}

/// A number; nothing where there is none.
fn optional(number: Option<impl ToString>) -> String {
    number.map_or(String::new(), |it| it.to_string())
}
