//! The ends of an axis of a figure, as a request gives them.

use super::answer::Refusal;
use super::asked::Asked;
use super::explored::Explored;
use super::units::Units;
use crate::figure::ShownQuantity;
use crate::quantity::Dimension;
use crate::study::appearance::SettingText;
use crate::study::{Setting, Settings};

/// A number as requests have it, in whatever unit is meant.
pub fn read(text: &str, _: Dimension) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "a number is expected".to_owned())
}

/// Sets the ends of the quantity `name` to those that a request gives after `key`, in the unit shown, if it does.
///
/// Fails if they are not two numbers, the lower first.
pub fn limited(
    explored: &Explored,
    asked: &Asked,
    key: &str,
    name: &str,
    settings: &mut Settings,
) -> Result<(), Refusal> {
    let Some(text) = asked.text(key) else { return Ok(()) };
    let unfit = |why: String| Refusal::unfit(format!("{key}: {why}"));
    let parts = ends(&Units::of(asked)?.shown(name, explored), text).map_err(unfit)?;
    let dimension = Dimension::Number;
    let set = settings.entry(name.to_owned()).or_default();
    set.put(Setting::Limits, SettingText { parts: &parts, dimension, read }).map_err(unfit)
}

/// The ends of a quantity in SI, from a text that has them in the unit shown.
pub fn ends(quantity: &ShownQuantity, text: &str) -> Result<Vec<String>, String> {
    let factor = quantity.factor;
    let ends = text.split(',').map(|it| read(it, Dimension::Number));
    let ends: Vec<f64> = ends.collect::<Result<_, String>>()?;
    Ok(ends.into_iter().map(|it| (it / factor).to_string()).collect())
}
