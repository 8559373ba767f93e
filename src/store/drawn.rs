//! The draws of a study in its file: their numbers as a coordinate, and what was drawn along it.

use super::catalogue::{DRAW, Entry};
use super::{Dataset, Values};
use crate::study::Draws;

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
}
