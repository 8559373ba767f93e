//! The answer of a trade-off as a table for people.

use std::fmt::Write;

use super::optima_notes::{counts_of_draws, write_limits, write_starts, write_tolerances};
use super::readable::{count, counted};
use crate::campaign::{Answer, Named, Refined, Row};
use crate::tradeoff::{Direction, GainAndCost, unit_behind};

/// A table for people.
pub fn table(answer: &Answer) -> String {
    let mut text = String::new();
    write_cases(&mut text, answer);
    if let Some(refined) = &answer.refined {
        write_refined(&mut text, refined);
    }
    let condition = match answer.conditions.is_empty() {
        true => String::new(),
        false => format!(" where {}", answer.conditions.join(" and ")),
    };
    let _ = writeln!(
        text,
        "Pareto front of {} ({}) and {}{condition}: {}",
        answer.of.gain.name(),
        answer.direction.name(),
        answer.of.cost.name(),
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
    let (least, without) = answer.at_rest;
    let against = match answer.direction {
        Direction::Either => "",
        _ => " or in the other direction",
    };
    let why = match answer.of.has_own_gain() {
        true => format!("at rest (no faster than {least:.1e} m/s)"),
        false => {
            format!("without gain (no more than {least:.1e}{})", unit_behind(answer.of.gain))
        }
    };
    let _ = writeln!(text, "\n{} left out {why}{against}", count(without));
}

/// What searches between the cases have brought.
fn write_refined(text: &mut String, refined: &Refined) {
    let Refined { searched, found, drawn, hypervolumes: [of_cases, whole], .. } = refined;
    let growth = 100.0 * (whole / of_cases - 1.0);
    let grows = match growth.is_finite() {
        true => format!("; the area that the front dominates grows by {growth:.3} %"),
        false => String::new(),
    };
    let (searches, found) = (searched.in_words(), counted(*found, "motion"));
    let _ = writeln!(
        text,
        "{searches} between the cases led to {found}{grows}; each search is local: a better motion may lie elsewhere"
    );
    write_starts(text, searched, *drawn);
}

/// The optima, the front and the motions with the most gain, a line each, and how the optima are computed again.
fn write_motions(text: &mut String, answer: &Answer) {
    let _ = writeln!(text, "{:<26} {}  motion", "", headings(answer.of));
    for Named { name, row } in &answer.named {
        match row {
            Some(row) => write_row(text, answer, &name.replace('_', " "), row),
            None => _ = writeln!(text, "{:<26} none", name.replace('_', " ")),
        }
    }
    write_margins(text, answer);
    let top = if answer.of.has_own_gain() { "the fastest" } else { "the most gain" };
    for (heading, rows) in [("front", &answer.front), (top, &answer.top)] {
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

/// The gain, the cost and the cost per gain with their units, of the speed in mm/s.
fn names(of: GainAndCost) -> [String; 3] {
    if of.has_own_gain() {
        let cost = format!("{} [{}]", of.cost.name(), of.cost.unit());
        return ["speed [mm/s]".to_owned(), cost, "J/m".to_owned()];
    }
    let [gain, cost] = of.both().map(|it| match it.unit() {
        "1" => it.name().to_owned(),
        unit => format!("{} [{unit}]", it.name()),
    });
    [gain, cost, "cost per gain".to_owned()]
}

/// These above their columns.
fn headings(of: GainAndCost) -> String {
    let [gain, cost, per_gain] = names(of);
    match of.has_own_gain() {
        true => format!("{gain:>14} {cost:>16} {per_gain:>12}"),
        false => format!("{gain:>16} {cost:>16} {per_gain:>16}"),
    }
}

/// The numbers of a motion below these headings.
fn numbers(of: GainAndCost, row: &Row) -> String {
    let Row { gain, price, per_gain, .. } = row;
    if of.has_own_gain() {
        return format!("{:>14.6} {price:>16.6e} {per_gain:>12.6}", 1e3 * gain);
    }
    let [a, b, c] = names(of).map(|name| name.chars().count().max(16));
    format!("{gain:>a$.6e} {price:>b$.6e} {per_gain:>c$.6e}")
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
            let error = row.errors.map(|it| match answer.of.has_own_gain() {
                true => format!(" \u{b1} {:.6} mm/s", 1e3 * it.gain),
                false => format!(" \u{b1} {:.2e}{}", it.gain, unit_behind(answer.of.gain)),
            });
            format!("{}, means{}", row.outcome, error.unwrap_or_default())
        }
    };
    let basin =
        row.share.map_or(String::new(), |share| format!(", {:.1} % of the starts", 100.0 * share));
    let robust = under_tolerances(answer, row);
    let _ = writeln!(
        text,
        "{what:<26} {}  {motion}{basin}; {}; {}{robust}",
        numbers(answer.of, row),
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
    let (of, kept) = (answer.of, 100.0 * it.kept);
    let (reached, unit) = match of.has_own_gain() {
        true => (
            format!("{:.4} mm/s or more {}", 1e3 * it.gain, answer.direction.adverb()),
            format!(" {}", of.cost.unit()),
        ),
        false => (format!("{:.4e}{} or more", it.gain, unit_behind(of.gain)), unit_behind(of.cost)),
    };
    format!(
        "; under tolerances 95 % of the draws reach {reached}, 95 % take {:.4e}{unit} or less, {kept:.1} % keep the period{}",
        it.price,
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
