//! The cases of a study that draws them, as columns: what is drawn, and what came of it.

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::answer::Refusal;
use super::asked::Asked;
use super::explored::Explored;
use super::units::Units;
use crate::store::Dataset;
use crate::study::{Drawing, DrawingKind, Spacing};

/// Cases that the page is given at most, the first: more points would hide each other.
const MOST_CASES: usize = 4000;

/// What is drawn of each case, and the key numbers of its motion that the file has, in SI; null where there is none.
///
/// Fails where the cases of the file are not drawn.
pub fn draws(explored: &Explored, asked: &Asked) -> Result<Value, Refusal> {
    asked.only(explored.model(), &[])?;
    let ranges = explored.ranges();
    if ranges.is_empty() {
        return Err(Refusal::unfit("the cases of these results are not drawn"));
    }
    let outputs = explored.model().key_outputs().filter(|it| explored.has(*it));
    let outputs: Vec<&str> = outputs.map(|it| it.name()).collect();
    let drawn = ranges.iter().map(|it| it.coordinate.name());
    let names: BTreeSet<String> = drawn.chain(outputs.iter().copied()).map(str::to_owned).collect();
    let dataset = explored.part(names, &Drawing::new("draws", DrawingKind::Map))?;
    let units = Units::of(asked)?;
    let column = |name: &str, is_log: bool| {
        let mut told = units.json(name, explored);
        told["log"] = json!(is_log);
        told["values"] = json!(values(&dataset, name));
        told
    };
    let of_draws = ranges.iter().map(|range| {
        let is_log = range.spacing == Spacing::Logarithmic;
        column(range.coordinate.name(), is_log)
    });
    Ok(json!({
        "cases": explored.study.cases(),
        "draws": of_draws.collect::<Vec<_>>(),
        "outputs": outputs.iter().map(|it| column(it, false)).collect::<Vec<_>>(),
    }))
}

/// A quantity of the first cases in SI.
fn values(dataset: &Dataset, name: &str) -> Vec<Option<f64>> {
    let variable = dataset.variable(name).or_else(|| dataset.coordinate(name));
    let values = variable.map(|it| it.values.to_real()).into_iter().flatten();
    values.take(MOST_CASES).map(|it| Some(it).filter(|it| it.is_finite())).collect()
}
