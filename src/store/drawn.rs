//! The draws of a study in its file: their numbers as a coordinate, what was drawn along it, and the design that they are.

use super::catalogue::{DRAW, Entry};
use super::{Dataset, Values};
use crate::study::{Draws, Saltelli};

/// The attribute of the number of rows of a design.
const BASE_SAMPLES: &str = "draws_base_samples";
/// The attribute of the quantities of a design, in the order of its cases.
const QUANTITIES: &str = "draws_quantities";
/// Between them.
const COMMA: &str = ", ";

/// Adds the draws by their numbers, what was drawn as variables over them, and how they were drawn.
pub(super) fn add(dataset: &mut Dataset, draws: &Draws) {
    dataset.put_coordinate(DRAW, Values::count(draws.count));
    for (place, range) in draws.ranges.iter().enumerate() {
        let values = (0..draws.count).map(|index| draws.value(index, place)).collect();
        let entry = Entry::of_coordinate(range.coordinate);
        dataset.put(entry, &[DRAW.name], Values::reals(values));
    }
    dataset.attributes.insert("draws_kind".to_owned(), draws.kind.name().to_owned());
    dataset.attributes.insert("draws_seed".to_owned(), draws.seed.to_string());
    if let Some(design) = draws.saltelli() {
        let names: Vec<&str> = draws.ranges.iter().map(|it| it.coordinate.name()).collect();
        let rows = draws.count / design.row_length();
        dataset.attributes.insert(BASE_SAMPLES.to_owned(), rows.to_string());
        dataset.attributes.insert(QUANTITIES.to_owned(), names.join(COMMA));
    }
}

/// The design of Saltelli whose draws the cases of a file are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Design {
    /// Number of rows: base samples.
    pub base_samples: usize,
    /// The names of the quantities that are drawn, in the order of the cases of a row.
    pub quantities: Vec<String>,
}

impl Design {
    /// That of a file; none where its cases are no such draws.
    pub fn of(dataset: &Dataset) -> Option<Design> {
        let base_samples = dataset.attributes.get(BASE_SAMPLES)?.parse().ok()?;
        let names = dataset.attributes.get(QUANTITIES)?;
        let quantities = names.split(COMMA).map(str::to_owned).collect();
        let design = Design { base_samples, quantities };
        let draws = dataset.coordinate(DRAW.name)?.values.shape();
        let is_whole =
            base_samples.checked_mul(design.rows().row_length()) == draws.first().copied();
        is_whole.then_some(design)
    }

    /// How its cases lie in rows.
    pub fn rows(&self) -> Saltelli {
        Saltelli { quantities: self.quantities.len() }
    }
}
