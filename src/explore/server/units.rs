//! The units in which a request wants quantities shown: one of a dimension, for all that have it.

use serde_json::{Value, json};

use super::answer::Refusal;
use super::asked::{Asked, UNITS};
use super::explored::Explored;
use crate::figure::{ShownQuantity, shown_quantity};
use crate::quantity::Dimension;
use crate::study::Settings;
use crate::study::appearance::{dimension_of, quantities};

/// The dimensions with a choice of units, what each is called, and the units that figures of capsules and oscillators have.
const OFFERED: [(Dimension, &str, &[&str]); 9] = [
    (Dimension::AngularFrequency, "Frequency", &["rad/s", "Hz", "kHz", "rpm"]),
    (Dimension::Velocity, "Velocity", &["m/s", "mm/s", "cm/s", "um/s"]),
    (Dimension::Length, "Length", &["m", "mm", "cm", "um", "in"]),
    (Dimension::Force, "Force", &["N", "mN", "kN"]),
    (Dimension::Stiffness, "Stiffness", &["N/m", "kN/m", "N/mm"]),
    (Dimension::Mass, "Mass", &["kg", "g", "mg"]),
    (Dimension::Energy, "Energy", &["J", "mJ", "uJ"]),
    (Dimension::Power, "Power", &["W", "mW", "uW"]),
    (Dimension::Angle, "Angle", &["rad", "deg"]),
];

/// The units that a request asks for, at most one of a dimension.
pub struct Units(Vec<(Dimension, &'static str)>);

impl Units {
    /// Fails if one is not offered, or there are two of a dimension.
    pub fn of(asked: &Asked) -> Result<Units, Refusal> {
        let mut chosen: Vec<(Dimension, &'static str)> = Vec::new();
        for wanted in asked.text(UNITS).unwrap_or_default().split(',').filter(|it| !it.is_empty()) {
            let mut all =
                OFFERED.iter().flat_map(|(of, _, units)| units.iter().map(|it| (*of, *it)));
            let Some(found) = all.find(|it| it.1 == wanted) else {
                let all: Vec<&str> = OFFERED.iter().flat_map(|it| it.2).copied().collect();
                let all = all.join(", ");
                return Err(Refusal::unfit(format!(
                    "{UNITS}: expected of {all}, a comma between two"
                )));
            };
            if let Some((_, other)) = chosen.iter().find(|it| it.0 == found.0) {
                let why = format!("{UNITS}: {other} and {wanted} are units of one dimension");
                return Err(Refusal::unfit(why));
            }
            chosen.push(found);
        }
        Ok(Units(chosen))
    }

    /// The unit of a dimension; none where that is as usual.
    fn of_dimension(&self, dimension: Dimension) -> Option<&'static str> {
        self.0.iter().find(|it| it.0 == dimension).map(|it| it.1)
    }

    /// The unit in which the quantity called `name` is to be shown; none where that is as usual.
    fn unit(&self, name: &str, explored: &Explored) -> Option<&'static str> {
        self.of_dimension(dimension_of(name, explored.model()).ok()?)
    }

    /// How the quantity called `name` is shown.
    pub fn shown(&self, name: &str, explored: &Explored) -> ShownQuantity {
        shown_quantity(name, explored.archive.frame(), self.unit(name, explored))
    }

    /// The same as an object, with the unit that was asked for.
    pub fn json(&self, name: &str, explored: &Explored) -> Value {
        let asked = self.unit(name, explored);
        let it = shown_quantity(name, explored.archive.frame(), asked);
        json!({ "name": name, "label": it.label, "unit": it.unit, "factor": it.factor, "asked": asked })
    }

    /// The same of several.
    pub fn all<'a>(
        &self,
        names: impl IntoIterator<Item = &'a str>,
        explored: &Explored,
    ) -> Vec<Value> {
        names.into_iter().map(|name| self.json(name, explored)).collect()
    }

    /// Sets the units of a figure, of all that it may show.
    pub fn set(&self, settings: &mut Settings, explored: &Explored) {
        for (name, dimension) in quantities(explored.model()) {
            if let Some(unit) = self.of_dimension(dimension) {
                settings.entry(name.to_owned()).or_default().unit = Some(unit);
            }
        }
    }

    /// What can be chosen for the quantities of a model, and what is.
    pub fn offered(&self, explored: &Explored) -> Vec<Value> {
        let known = quantities(explored.model());
        let occurring = OFFERED.iter().filter(|it| known.iter().any(|known| known.1 == it.0));
        let one = |(dimension, words, units): &(Dimension, &str, &[&str])| json!({ "words": words, "units": units, "now": self.of_dimension(*dimension) });
        occurring.map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::units::unit;

    #[test]
    fn each_unit_is_one_of_its_dimension_and_of_no_other() {
        for (dimension, words, units) in OFFERED {
            for name in units {
                assert!(unit(name, dimension).is_some(), "{words}: {name}");
                assert_eq!(OFFERED.iter().filter(|it| it.2.contains(name)).count(), 1, "{name}");
            }
        }
    }
}
