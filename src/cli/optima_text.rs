//! The answer of a trade-off as a table for people.

use std::fmt::Write;

use super::optima_notes::{counts_of_draws, write_limits, write_starts, write_tolerances};
use super::readable::{count, counted};
use crate::campaign::{Answer, Gain, Named, Row};
use crate::tradeoff::Direction;

/// A table for people.
pub fn table(answer: &Answer) -> String {
    let mut text = String::new();
    write_cases(&mut text, answer);
    if let Some(gain) = &answer.refined {
        write_gain(&mut text, gain);
    }
    let condition = match answer.conditions.is_empty() {
        true => String::new(),
        false => format!(" where {}", answer.conditions.join(" and ")),
    };
    let _ = writeln!(
        text,
        "Pareto front of {} ({}) and {}{condition}: {}",
        answer.of.model().speed().name(),
        answer.direction.name(),
        answer.of.name(),
        counted(answer.front.len(), "motion")
    );
    write_limits(&mut text, answer);
    write_tolerances(&mut text, answer);
    text.push('\n');
    if !answer.front.is_empty() {
        write_motions(&mut text, answer);
    }
    text
}

/// How many cases there are, and which take no part.
fn write_cases(text: &mut String, answer: &Answer) {
    let _ = write!(text, "{}: {}", answer.file, counted(answer.cases, "case"));
    let left_out: Vec<String> =
        answer.left_out.iter().map(|(why, cases)| format!("{} {why}", count(*cases))).collect();
    if !left_out.is_empty() {
        let _ = write!(text, "; left out: {}", left_out.join(", "));
    }
    let (speed, slow) = answer.at_rest;
    let against = match answer.direction {
        Direction::Either => "",
        _ => " or in the other direction",
    };
    let _ = writeln!(
        text,
        "\n{} left out at rest (no faster than {speed:.1e} m/s){against}",
        count(slow)
    );
}

/// What searches between the cases have brought.
fn write_gain(text: &mut String, gain: &Gain) {
    let Gain { searched, found, drawn, hypervolumes: [of_cases, whole], .. } = gain;
    let gain = 100.0 * (whole / of_cases - 1.0);
    let grows = match gain.is_finite() {
        true => format!("; the area that the front dominates grows by {gain:.3} %"),
        false => String::new(),
    };
    let (searches, found) = (searched.in_words(), counted(*found, "motion"));
    let _ = writeln!(
        text,
        "{searches} between the cases led to {found}{grows}; each search is local: a better motion may lie elsewhere"
    );
    write_starts(text, searched, *drawn);
}

/// The optima, the front and the fastest, a line each, and how the optima are computed again.
fn write_motions(text: &mut String, answer: &Answer) {
    let _ = writeln!(
        text,
        "{:<26} {:>14} {:>16} {:>12}  motion",
        "",
        "speed [mm/s]",
        format!("{} [{}]", answer.of.name(), answer.of.unit()),
        "J/m"
    );
    for Named { name, row } in &answer.named {
        match row {
            Some(row) => write_row(text, answer, &name.replace('_', " "), row),
            None => _ = writeln!(text, "{:<26} none", name.replace('_', " ")),
        }
    }
    write_margins(text, answer);
    for (heading, rows) in [("front", &answer.front), ("the fastest", &answer.top)] {
        for (place, row) in rows.iter().enumerate() {
            write_row(text, answer, if place == 0 { heading } else { "" }, row);
        }
    }
    text.push('\n');
    for Named { name, row } in &answer.named {
        if let Some(row) = row {
            let _ = writeln!(text, "replay of {}: {}", name.replace('_', " "), row.replay);
        }
    }
}

/// How far the parameters of the optima may change.
fn write_margins(text: &mut String, answer: &Answer) {
    let rows = answer.named.iter().filter_map(|Named { name, row }| Some((name, row.as_ref()?)));
    for (name, row) in rows.filter(|(_, row)| !row.margins.is_empty()) {
        let _ = writeln!(
            text,
            "{:<26} bifurcations, as its parameters fall and rise:",
            name.replace('_', " ")
        );
        for margins in &row.margins {
            let [down, up] = margins.in_words();
            let _ = writeln!(text, "{:<26} {:<7} {down}; {up}", "", margins.parameter.symbol());
        }
    }
}

fn write_row(text: &mut String, answer: &Answer, what: &str, row: &Row) {
    let motion = match row.period {
        Some(period) => format!("period {period}"),
        None => {
            let error = row.errors.map(|it| format!(" \u{b1} {:.6} mm/s", 1e3 * it.speed));
            format!("{}, means{}", row.outcome, error.unwrap_or_default())
        }
    };
    let basin =
        row.share.map_or(String::new(), |share| format!(", {:.1} % of the starts", 100.0 * share));
    let robust = under_tolerances(answer, row);
    let _ = writeln!(
        text,
        "{what:<26} {:>14.6} {:>16.6e} {:>12.6}  {motion}{basin}; {}; {}{robust}",
        1e3 * row.speed,
        row.price,
        row.energy_per_metre,
        varied_values(row),
        match row.case {
            Some(case) => format!("case {case}"),
            None => format!("between cases, active constraint: {}", row.slopes.held_by.join(", ")),
        }
    );
}

/// What tolerances leave of a motion, if they are asked for.
fn under_tolerances(answer: &Answer, row: &Row) -> String {
    if answer.tolerances.is_some() && row.period.is_none() {
        return "; not judged under tolerances, as it does not repeat".to_owned();
    }
    let Some(it) = &row.robustness else { return String::new() };
    let (kept, speed) = (100.0 * it.kept, 1e3 * it.speed);
    format!(
        "; under tolerances 95 % of the draws reach {speed:.4} mm/s or more {}, 95 % take {:.4e} {} or less, {kept:.1} % keep the period{}",
        answer.direction.adverb(),
        it.price,
        answer.of.unit(),
        counts_of_draws(it)
    )
}

/// The values of what varies in the file.
fn varied_values(row: &Row) -> String {
    let varied = row.coordinates.iter().filter(|(.., varies)| *varies);
    let values = varied.map(|(it, value, _)| {
        let unit = Some(it.dimension().unit()).filter(|unit| *unit != "1");
        let value = format!("{value:.7}");
        let value = value.trim_end_matches('0').trim_end_matches('.');
        format!("{} = {value}{}", it.name(), unit.map_or(String::new(), |it| format!(" {it}")))
    });
    values.collect::<Vec<String>>().join(", ")
}
