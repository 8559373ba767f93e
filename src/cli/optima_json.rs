//! The answer of a trade-off as JSON.

use serde_json::{Map, Value, json};

use crate::campaign::{
    Answer, Margin, MarginEnd, Named, Refined, Robustness, Row, Slopes, Tolerances,
};
use crate::description::Parameter;
use crate::store::catalogue::{ATTRACTOR, OUTCOME, PERIOD};
use crate::study::Coordinate;
use crate::tradeoff::GainAndCost;

/// One JSON object.
pub fn json(answer: &Answer) -> Value {
    let of = answer.of;
    let mut object = Map::new();
    let [at_rest, least] = match of.has_own_gain() {
        true => ["speed_at_rest", "least_speed"],
        false => ["gain_at_rest", "least_gain"],
    };
    object.insert("of".to_owned(), json!(of.cost.name()));
    if !of.has_own_gain() {
        object.insert("for".to_owned(), json!(of.gain.name()));
    }
    object.insert("moving".to_owned(), json!(answer.direction.name()));
    object.insert("cases".to_owned(), json!(answer.cases));
    object.insert("left_out".to_owned(), json!(answer.left_out));
    object.insert(at_rest.to_owned(), json!(answer.at_rest.0));
    object.insert("where".to_owned(), json!(answer.conditions));
    let [budget, least_gain] = answer.limits;
    object.insert("budget".to_owned(), json!(budget));
    object.insert(least.to_owned(), json!(least_gain));
    if let Some(refined) = &answer.refined {
        object.insert("refined".to_owned(), json_of_refined(refined));
    }
    object.insert("front".to_owned(), json_of_rows(&answer.front, of));
    for Named { name, row } in &answer.named {
        let row = row.as_ref().map_or(Value::Null, |row| json_of_row(row, of));
        object.insert((*name).to_owned(), row);
    }
    if let Some(tolerances) = &answer.tolerances {
        let told = json_of_tolerances(tolerances, &answer.not_judged);
        object.insert("tolerances".to_owned(), told);
        object.insert("robust_front".to_owned(), json!(answer.robust_front));
    }
    if !answer.top.is_empty() {
        object.insert("top".to_owned(), json_of_rows(&answer.top, of));
    }
    Value::Object(object)
}

/// What searches between the cases have brought.
fn json_of_refined(refined: &Refined) -> Value {
    let Refined { searched, found, seed, drawn, hypervolumes: [of_cases, whole] } = refined;
    json!({
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
    })
}

/// What tolerances are asked for, with the conditions that are not judged under them.
fn json_of_tolerances(tolerances: &Tolerances, not_judged: &[String]) -> Value {
    let Tolerances { each, draws, seed } = tolerances;
    let each: Map<String, Value> =
        each.iter().map(|(it, most)| (it.symbol().to_owned(), json!(most))).collect();
    json!({
        "each": each,
        "each_is": "half width",
        "distribution": "uniform",
        "draws": draws,
        "seed": seed,
        "conditions_not_judged": not_judged,
    })
}

fn json_of_rows(rows: &[Row], of: GainAndCost) -> Value {
    Value::Array(rows.iter().map(|row| json_of_row(row, of)).collect())
}

/// A motion, with this gain and this cost.
fn json_of_row(row: &Row, of: GainAndCost) -> Value {
    let (parameters, start): (Vec<_>, Vec<_>) =
        row.coordinates.iter().partition(|(it, ..)| matches!(it, Coordinate::Parameter(_)));
    let [gain, cost] = of.both().map(|it| it.name().to_owned());
    let mut point = Map::new();
    point.insert("case".to_owned(), json!(row.case));
    point.insert("parameters".to_owned(), json_of_coordinates(&parameters));
    point.insert("start".to_owned(), json_of_coordinates(&start));
    let per_gain = of.told_per_gain().map_or("cost_per_gain", |it| it.name());
    point.insert(gain.clone(), json!(row.gain));
    point.insert(per_gain.to_owned(), json!(row.per_gain));
    point.insert(cost.clone(), json!(row.price));
    let errors = row.errors.map(|it| {
        let both = [(gain.clone(), json!(it.gain)), (cost.clone(), json!(it.price))];
        Value::Object(both.into_iter().collect())
    });
    point.insert("standard_errors".to_owned(), json!(errors));
    point.insert(PERIOD.name.to_owned(), json!(row.period));
    point.insert(OUTCOME.name.to_owned(), json!(row.outcome));
    point.insert(ATTRACTOR.name.to_owned(), json!(row.attractor));
    point.insert("share".to_owned(), json!(row.share));
    let Slopes { sensitivity, stationarity, held_by } = &row.slopes;
    point.insert("held_by".to_owned(), json!(held_by));
    point.insert("stationarity".to_owned(), json!(stationarity));
    let of_gain = sensitivity.iter().map(|(it, [gain, _])| (*it, *gain));
    point.insert("sensitivity".to_owned(), by_symbol(of_gain));
    let of_price = sensitivity.iter().map(|(it, [_, price])| (*it, *price));
    point.insert(format!("sensitivity_of_{cost}"), by_symbol(of_price));
    let robustness = row.robustness.as_ref().map(|it| json_of_robustness(it, of));
    point.insert("robustness".to_owned(), json!(robustness));
    if !row.margins.is_empty() {
        let margins = row.margins.iter().map(|it| {
            let both = json!({ "down": margin(&it.down), "up": margin(&it.up) });
            (it.parameter.symbol().to_owned(), both)
        });
        point.insert("margins".to_owned(), Value::Object(margins.collect()));
    }
    point.insert("replay".to_owned(), json!(row.replay));
    Value::Object(point)
}

/// Parameters, or coordinates of a start, by their names.
fn json_of_coordinates(all: &[&(Coordinate, f64, bool)]) -> Value {
    let values = all.iter().map(|(it, value, _)| (it.name().to_owned(), json!(value)));
    Value::Object(values.collect())
}

/// Numbers of parameters by their symbols.
fn by_symbol(all: impl Iterator<Item = (Parameter, f64)>) -> Value {
    Value::Object(all.map(|(it, value)| (it.symbol().to_owned(), json!(value))).collect())
}

fn json_of_robustness(it: &Robustness, of: GainAndCost) -> Value {
    let gain = match of.has_own_gain() {
        true => "speed_of_slowest_5_percent",
        false => "gain_of_least_5_percent",
    };
    json!({
        "draws": it.draws,
        "kept": it.kept,
        (gain): it.gain,
        "price_of_dearest_5_percent": it.price,
        "meet_conditions": it.meet_conditions,
        "within_budget": it.within_budget,
        "meet_conditions_within_budget": it.meet_both,
    })
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
