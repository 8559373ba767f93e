//! Sobol indices of the key numbers of a file whose cases are a design for them.

use axum::response::Response;
use serde_json::{Value, json};

use super::answer::{Refusal, json as json_answer};
use super::asked::Asked;
use super::explored::Explored;
use super::units::Units;
use crate::campaign::{NO_DESIGN, OutputSensitivity, Resampling, Sensitivity, SobolIndex};
use crate::description::Output;
use crate::store::Design;

/// The indices, as `capsulemap sensitivity` finds them without options.
///
/// Fails where the cases are no design.
pub fn sensitivity(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    asked.only(explored.model(), &[])?;
    if Design::of(explored.archive.frame()).is_none() {
        return Err(Refusal::unfit(NO_DESIGN));
    }
    let outputs = explored.model().key_outputs().filter(|it| explored.has(*it));
    let outputs: Vec<Output> = outputs.collect();
    let (resampling, units) = (Resampling::default(), Units::of(asked)?);
    let asked = Sensitivity {
        archive: &explored.archive,
        file: &explored.file,
        outputs: &outputs,
        resampling,
        threads: None,
    };
    let answer = asked.answer().map_err(Refusal::failed)?;
    let quantities = explored.ranges().iter().map(|it| it.coordinate.name());
    let found = answer.outputs.iter();
    let found =
        found.map(|(output, found)| with_indices(units.json(output.name(), explored), found));
    Ok(json_answer(&json!({
        "quantities": units.all(quantities, explored),
        "confidence": resampling.confidence,
        "base_samples": answer.design.base_samples,
        "outputs": found.collect::<Vec<_>>(),
    })))
}

/// What is told of an output, with its indices.
fn with_indices(mut told: Value, found: &OutputSensitivity) -> Value {
    told["rows"] = json!(found.rows);
    told["left_out"] = json!(found.rows_left_out);
    match &found.indices {
        Ok(indices) => {
            told["first"] = json!(indices.first.iter().map(index_json).collect::<Vec<_>>());
            told["total"] = json!(indices.total.iter().map(index_json).collect::<Vec<_>>());
        }
        Err(why) => told["why"] = json!(why.reason()),
    }
    told
}

fn index_json(index: &SobolIndex) -> Value {
    json!([index.value, index.half_width])
}
