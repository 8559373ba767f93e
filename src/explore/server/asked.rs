//! What a request asks for, by names and values.

use super::answer::Refusal;
use crate::description::Description;
use crate::study::{Coordinate, Direction};

/// The parameter that any request may have: the units in which quantities are shown.
pub const UNITS: &str = "units";

/// The parameters of a request, each once.
pub struct Asked(Vec<(String, String)>);

impl Asked {
    /// Fails if one is given twice.
    pub fn new(pairs: Vec<(String, String)>) -> Result<Asked, Refusal> {
        for (place, (name, _)) in pairs.iter().enumerate() {
            if pairs[..place].iter().any(|it| it.0 == *name) {
                return Err(Refusal::unfit(format!("{name} is given twice")));
            }
        }
        Ok(Asked(pairs))
    }

    /// The text called `name`.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.0.iter().find(|it| it.0 == name).map(|it| it.1.as_str())
    }

    /// The finite number called `name`, in SI.
    pub fn number(&self, name: &str) -> Result<Option<f64>, Refusal> {
        let Some(text) = self.text(name) else { return Ok(None) };
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(Refusal::unfit(format!("{name}: a finite number is expected"))),
        }
    }

    /// The whole number called `name`, within bounds.
    pub fn count(&self, name: &str, bounds: [usize; 2], usual: usize) -> Result<usize, Refusal> {
        let Some(text) = self.text(name) else { return Ok(usual) };
        let [least, most] = bounds;
        match text.parse::<usize>() {
            Ok(count) if (least..=most).contains(&count) => Ok(count),
            _ => Err(Refusal::unfit(format!(
                "{name}: a whole number from {least} to {most} is expected"
            ))),
        }
    }

    /// The parameters and coordinates of the start of a model that are given, in SI.
    pub fn coordinates(
        &self,
        model: &'static Description,
    ) -> Result<Vec<(Coordinate, f64)>, Refusal> {
        self.coordinates_after("", model)
    }

    /// Those that are given with a prefix before their names.
    pub fn coordinates_after(
        &self,
        prefix: &str,
        model: &'static Description,
    ) -> Result<Vec<(Coordinate, f64)>, Refusal> {
        let mut given = Vec::new();
        for coordinate in Coordinate::all(model) {
            let value = self.number(&format!("{prefix}{}", coordinate.name()))?;
            given.extend(value.map(|value| (coordinate, value)));
        }
        Ok(given)
    }

    /// The direction in which the starts of a case were inherited, if it is given.
    pub fn sweep(&self) -> Result<Option<Direction>, Refusal> {
        let Some(text) = self.text("sweep") else { return Ok(None) };
        let known = Direction::ALL.into_iter().find(|it| it.name() == text);
        known
            .map(Some)
            .ok_or_else(|| Refusal::unfit("sweep: upward, downward or afresh is expected"))
    }

    /// Fails if there is a parameter that is neither a coordinate nor `known`.
    pub fn only(&self, model: &'static Description, known: &[&str]) -> Result<(), Refusal> {
        let is_known = self.0.iter().all(|(name, _)| {
            name == UNITS
                || known.contains(&name.as_str())
                || Coordinate::all(model).any(|it| it.name() == name)
        });
        match is_known {
            true => Ok(()),
            false => Err(Refusal::unfit("a parameter of the request is not known")),
        }
    }
}
