//! The gain and the cost that a figure of a trade-off shows: those that it names, or those of the model.

use super::error::FigureError;
use super::view::View;
use crate::description::{Description, Output};
use crate::study::Drawing;
use crate::tradeoff::GainAndCost;

/// The names of the gain and of the cost: `of` names the cost first. Unless they are named they are the speed and the
/// power, as for `capsulemap tradeoff`, of a model that has these.
pub fn names<'d>(drawing: &'d Drawing, model: &'static Description) -> [Option<&'d str>; 2] {
    let own = model.has_trade_off().then(|| [model.speed(), model.power()].map(Output::name));
    let [gain, cost] = own.map_or([None; 2], |own| own.map(Some));
    let mut named = drawing.of.iter().map(String::as_str);
    let cost = named.next().or(cost);
    [named.next().or(gain), cost]
}

/// The gain that a figure of a trade-off shows; none where it names none of the model.
pub fn gain_of(drawing: &Drawing, model: &'static Description) -> Option<Output> {
    let [gain, _] = names(drawing, model);
    model.output(gain?)
}

/// The gain and the cost that a view asks for.
///
/// Fails where one of them is no output of its model, or both are one.
pub fn outputs(view: &View<'_>) -> Result<GainAndCost, FigureError> {
    let model = view.model();
    let found = names(view.drawing, model).map(|name| {
        let name = name.ok_or_else(|| view.unfit(view.drawing.kind.needs_outputs(model)))?;
        let output = model.output(name);
        output.ok_or_else(|| view.unfit(format!("`{name}` is no output of a motion")))
    });
    let [gain, cost] = found;
    let of = GainAndCost { gain: gain?, cost: cost? };
    match of.gain == of.cost && !of.has_own_gain() {
        true => Err(view.unfit(format!("`{}` is both the gain and the cost", of.gain.name()))),
        false => Ok(of),
    }
}
