//! The answer of a trade-off as a table for people, as JSON and as comma-separated values.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::optima_notes::{counts_of_draws, write_limits, write_starts, write_tolerances};
use super::readable::{count, counted};
use crate::campaign::{
    Answer, Gain, Margin, MarginEnd, Margins, Named, Robustness, Row, Slopes, Tolerances,
};
use crate::description::{Output, Parameter};
use crate::store::catalogue::{ATTRACTOR, OUTCOME, PERIOD};
use crate::study::Coordinate;
use crate::tradeoff::Direction;

/// One JSON object.
pub fn json(answer: &Answer) -> Value {
    let point = |row: &Row| json_of_row(row, answer.of);
    let mut object = Map::new();
    object.insert("of".to_owned(), json!(answer.of.name()));
    object.insert("moving".to_owned(), json!(answer.direction.name()));
    object.insert("cases".to_owned(), json!(answer.cases));
    object.insert("left_out".to_owned(), json!(answer.left_out));
    object.insert("speed_at_rest".to_owned(), json!(answer.at_rest.0));
    object.insert("where".to_owned(), json!(answer.conditions));
    let [budget, least_speed] = answer.limits;
    object.insert("budget".to_owned(), json!(budget));
    object.insert("least_speed".to_owned(), json!(least_speed));
    if let Some(Gain { searched, found, seed, drawn, hypervolumes: [of_cases, whole] }) =
        &answer.refined
    {
        let gain = json!({
            "scope": "local",
            "searches": searched.searches,
            "starts": searched.starts,
            "points_drawn": drawn.map(|[points, _]| points),
            "points_searched_from": drawn.map(|[_, begun]| begun),
            "unsettled": searched.unsettled,
            "found": found,
            "seed": seed,
            "hypervolume_of_cases": of_cases,
            "hypervolume": whole,
        });
        object.insert("refined".to_owned(), gain);
    }
    object.insert("front".to_owned(), Value::Array(answer.front.iter().map(point).collect()));
    for Named { name, row } in &answer.named {
        object.insert((*name).to_owned(), row.as_ref().map_or(Value::Null, point));
    }
    if let Some(Tolerances { each, draws, seed }) = &answer.tolerances {
        let each: Map<String, Value> =
            each.iter().map(|(it, most)| (it.symbol().to_owned(), json!(most))).collect();
        let asked = json!({
            "each": each,
            "each_is": "half width",
            "distribution": "uniform",
            "draws": draws,
            "seed": seed,
            "conditions_not_judged": answer.not_judged,
        });
        object.insert("tolerances".to_owned(), asked);
        object.insert("robust_front".to_owned(), json!(answer.robust_front));
    }
    if !answer.top.is_empty() {
        object.insert("top".to_owned(), Value::Array(answer.top.iter().map(point).collect()));
    }
    Value::Object(object)
}

fn json_of_row(row: &Row, of: Output) -> Value {
    let (parameters, start): (Vec<_>, Vec<_>) =
        row.coordinates.iter().partition(|(it, ..)| matches!(it, Coordinate::Parameter(_)));
    let values = |all: Vec<&(Coordinate, f64, bool)>| -> Map<String, Value> {
        all.into_iter().map(|(it, value, _)| (it.name().to_owned(), json!(value))).collect()
    };
    let mut point = Map::new();
    point.insert("case".to_owned(), json!(row.case));
    point.insert("parameters".to_owned(), Value::Object(values(parameters)));
    point.insert("start".to_owned(), Value::Object(values(start)));
    point.insert(of.model().speed().name().to_owned(), json!(row.speed));
    point.insert(of.model().energy_per_distance().name().to_owned(), json!(row.energy_per_metre));
    point.insert(of.name().to_owned(), json!(row.price));
    let errors = row.errors.map(|it| {
        let speed = (of.model().speed().name().to_owned(), json!(it.speed));
        Value::Object([speed, (of.name().to_owned(), json!(it.price))].into_iter().collect())
    });
    point.insert("standard_errors".to_owned(), json!(errors));
    point.insert(PERIOD.name.to_owned(), json!(row.period));
    point.insert(OUTCOME.name.to_owned(), json!(row.outcome));
    point.insert(ATTRACTOR.name.to_owned(), json!(row.attractor));
    point.insert("share".to_owned(), json!(row.share));
    let of_speed =
        |(it, [speed, _]): &(Parameter, [f64; 2])| (it.symbol().to_owned(), json!(speed));
    let of_price =
        |(it, [_, price]): &(Parameter, [f64; 2])| (it.symbol().to_owned(), json!(price));
    let Slopes { sensitivity, stationarity, held_by } = &row.slopes;
    let each: Map<String, Value> = sensitivity.iter().map(of_speed).collect();
    let price: Map<String, Value> = sensitivity.iter().map(of_price).collect();
    point.insert("held_by".to_owned(), json!(held_by));
    point.insert("stationarity".to_owned(), json!(stationarity));
    point.insert("sensitivity".to_owned(), Value::Object(each));
    point.insert(format!("sensitivity_of_{}", of.name()), Value::Object(price));
    let robustness = row.robustness.map(|it| {
        json!({
            "draws": it.draws,
            "kept": it.kept,
            "speed_of_slowest_5_percent": it.speed,
            "price_of_dearest_5_percent": it.price,
            "meet_conditions": it.meet_conditions,
            "within_budget": it.within_budget,
            "meet_conditions_within_budget": it.meet_both,
        })
    });
    point.insert("robustness".to_owned(), json!(robustness));
    if !row.margins.is_empty() {
        let both = |it: &Margins| json!({ "down": margin(&it.down), "up": margin(&it.up) });
        let margins = row.margins.iter().map(|it| (it.parameter.symbol().to_owned(), both(it)));
        let margins: Map<String, Value> = margins.collect();
        point.insert("margins".to_owned(), Value::Object(margins));
    }
    point.insert("replay".to_owned(), json!(row.replay));
    Value::Object(point)
}

fn margin(margin: &Margin) -> Value {
    let (end, uncertainty) = match margin.end {
        MarginEnd::Range => ("none", None),
        MarginEnd::NotFollowed => ("not known", None),
        MarginEnd::Bifurcation(change) => (change.name(), Some(change.uncertainty)),
    };
    let passed: Vec<Value> = margin
        .passed
        .iter()
        .map(|it| json!({ "value": it.value, "uncertainty": it.uncertainty, "what": it.name() }))
        .collect();
    json!({ "until": margin.until, "end": end, "uncertainty": uncertainty, "passed": passed })
}

/// Comma-separated values: a header, then the optima, the front and the fastest, each with what it is.
pub fn csv(answer: &Answer) -> String {
    let optima = answer.named.iter().filter_map(|it| Some((it.name, it.row.as_ref()?)));
    let front = answer.front.iter().map(|row| ("front", row));
    let top = answer.top.iter().map(|row| ("top", row));
    let all: Vec<(&str, &Row)> = optima.chain(front).chain(top).collect();
    let Some((_, first)) = all.first() else { return String::new() };
    let names = first.coordinates.iter().map(|(it, ..)| it.name());
    let fixed = ["what", "case", answer.of.model().speed().name(), answer.of.name()];
    let rest = [OUTCOME.name, PERIOD.name, ATTRACTOR.name, "share"];
    let more = [
        answer.of.model().energy_per_distance().name(),
        "standard_error_of_speed",
        "standard_error_of_price",
        "held_by",
        "stationarity",
        "kept",
        "speed_of_slowest_5_percent",
        "price_of_dearest_5_percent",
        "draws",
        "meet_conditions",
        "within_budget",
        "meet_conditions_within_budget",
        "replay",
    ];
    let header: Vec<&str> = fixed.into_iter().chain(rest).chain(names).chain(more).collect();
    let mut text = format!("{}\n", header.join(","));
    let optional = |it: Option<f64>| it.map_or(String::new(), |it| it.to_string());
    for (what, row) in all {
        let [period, attractor] =
            [row.period, row.attractor].map(|it| optional(it.map(|n| n as f64)));
        let coordinates = row.coordinates.iter().map(|(_, value, _)| format!("{value:?}"));
        let fixed = [
            what.to_owned(),
            row.case.map_or(String::new(), |case| case.to_string()),
            format!("{:?}", row.speed),
            format!("{:?}", row.price),
            row.outcome.clone(),
            period,
            attractor,
            optional(row.share),
        ];
        let robustness = |of: fn(&Robustness) -> f64| optional(row.robustness.as_ref().map(of));
        let counted_draws = |of: fn(&Robustness) -> Option<usize>| {
            optional(row.robustness.as_ref().and_then(of).map(|it| it as f64))
        };
        let more = [
            format!("{:?}", row.energy_per_metre),
            optional(row.errors.map(|it| it.speed)),
            optional(row.errors.map(|it| it.price)),
            row.slopes.held_by.join("; "),
            optional(row.slopes.stationarity),
            robustness(|it| it.kept),
            robustness(|it| it.speed),
            robustness(|it| it.price),
            robustness(|it| it.draws as f64),
            counted_draws(|it| it.meet_conditions),
            counted_draws(|it| it.within_budget),
            counted_draws(|it| it.meet_both),
            // A command has commas.
            format!("\"{}\"", row.replay.replace('"', "\"\"")),
        ];
        let cells: Vec<String> = fixed.into_iter().chain(coordinates).chain(more).collect();
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// A table for people.
pub fn table(answer: &Answer) -> String {
    let mut text = format!("{}: {}", answer.file, counted(answer.cases, "case"));
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
    if let Some(Gain { searched, found, drawn, hypervolumes: [of_cases, whole], .. }) =
        &answer.refined
    {
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
        write_starts(&mut text, searched, *drawn);
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
    if answer.front.is_empty() {
        return text;
    }
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
            Some(row) => write_row(&mut text, answer, &name.replace('_', " "), row),
            None => _ = writeln!(text, "{:<26} none", name.replace('_', " ")),
        }
    }
    write_margins(&mut text, answer);
    for (heading, rows) in [("front", &answer.front), ("the fastest", &answer.top)] {
        for (place, row) in rows.iter().enumerate() {
            write_row(&mut text, answer, if place == 0 { heading } else { "" }, row);
        }
    }
    text.push('\n');
    for Named { name, row } in &answer.named {
        if let Some(row) = row {
            let _ = writeln!(text, "replay of {}: {}", name.replace('_', " "), row.replay);
        }
    }
    text
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
    let robust = row.robustness.map_or(String::new(), |it| {
        let (kept, speed) = (100.0 * it.kept, 1e3 * it.speed);
        format!(
            "; under tolerances 95 % of the draws reach {speed:.4} mm/s or more {}, 95 % take {:.4e} {} or less, {kept:.1} % keep the period{}",
            answer.direction.adverb(),
            it.price,
            answer.of.unit(),
            counts_of_draws(&it)
        )
    });
    let is_not_judged = answer.tolerances.is_some() && row.period.is_none();
    let robust = match is_not_judged {
        true => "; not judged under tolerances, as it does not repeat".to_owned(),
        false => robust,
    };
    let basin =
        row.share.map_or(String::new(), |share| format!(", {:.1} % of the starts", 100.0 * share));
    let varied = row.coordinates.iter().filter(|(.., varies)| *varies);
    let place: Vec<String> = varied
        .map(|(it, value, _)| {
            let unit = Some(it.dimension().unit()).filter(|unit| *unit != "1");
            let value = format!("{value:.7}");
            let value = value.trim_end_matches('0').trim_end_matches('.');
            format!("{} = {value}{}", it.name(), unit.map_or(String::new(), |it| format!(" {it}")))
        })
        .collect();
    let _ = writeln!(
        text,
        "{what:<26} {:>14.6} {:>16.6e} {:>12.6}  {motion}{basin}; {}; {}{robust}",
        1e3 * row.speed,
        row.price,
        row.energy_per_metre,
        place.join(", "),
        match row.case {
            Some(case) => format!("case {case}"),
            None => format!("between cases, active constraint: {}", row.slopes.held_by.join(", ")),
        }
    );
}
