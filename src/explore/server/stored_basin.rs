//! What a file of basins tells of them: its attractors, the saddles between the basins, and their manifolds.

use axum::response::Response;
use serde_json::{Value, json};

use super::answer::{Refusal, json as json_answer};
use super::asked::Asked;
use super::explored::Explored;
use super::map;
use super::units::Units;
use crate::figure::{
    BasinAttractor, BasinCurve, BasinSaddle, OverBasin, over_basin, over_basin_variables,
};
use crate::store::catalogue::{ATTRACTOR, PERIOD};
use crate::study::DrawingKind;

/// What lies over the basins of the plane that a request names.
///
/// Fails where an axis is no coordinate of a start.
pub fn stored_basin(explored: &Explored, asked: &Asked) -> Result<Response, Refusal> {
    let drawing = map::drawing(explored, asked, DrawingKind::Basin)?;
    let names = over_basin_variables(&drawing, explored.model());
    let dataset = explored.part(names, &drawing)?;
    let told = over_basin(&*dataset, &drawing).map_err(Refusal::undrawn)?;
    Ok(json_answer(&basin_json(explored, &Units::of(asked)?, &told)))
}

fn basin_json(explored: &Explored, units: &Units, told: &OverBasin) -> Value {
    let outputs = told.attractors.first().map_or(&[][..], |it| &it.outputs);
    let outputs = units.all(outputs.iter().map(|(output, _)| output.name()), explored);
    json!({
        "outputs": outputs,
        "attractors": told.attractors.iter().map(attractor_json).collect::<Vec<_>>(),
        "saddles": told.saddles.iter().map(saddle_json).collect::<Vec<_>>(),
        "stable": told.stable.iter().map(curve_json).collect::<Vec<_>>(),
        "unstable": told.unstable.iter().map(curve_json).collect::<Vec<_>>(),
        "projected": told.is_projected,
        "left_out": told.left_out,
    })
}

fn attractor_json(it: &BasinAttractor) -> Value {
    json!({
        "colour": it.colour,
        "basin": it.basin,
        "motion": it.motion,
        "case": it.case,
        "outputs": it.outputs.iter().map(|(_, value)| *value).collect::<Vec<f64>>(),
        "share": it.share,
        "multipliers": it.multipliers,
        "points": it.points,
    })
}

fn saddle_json(it: &BasinSaddle) -> Value {
    json!({
        "between": it.between,
        (PERIOD.name): it.period,
        "misses": it.residual,
        "multipliers": it.multipliers,
        "points": it.points,
    })
}

fn curve_json(it: &BasinCurve) -> Value {
    json!({ "saddle": it.saddle, (ATTRACTOR.name): it.attractors, "points": it.points })
}
